//! The messages themselves.

use super::Element;
use super::fields::{Fields, valued};
use crate::Error;
use std::fmt;

/// A message: what is known of it, and the rest.
///
/// `Display` writes it as XML, which is what goes into a datagram.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What it says.
    pub content: Content,
    /// What it has beside that.
    pub rest: Rest,
}

/// What a message has that is not known here, kept so that it can be written again.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rest {
    /// Attributes, names and values.
    pub attributes: Vec<(String, String)>,
    /// Elements.
    pub children: Vec<Element>,
    /// Text.
    pub text: String,
}

/// What a message says. Time codes are kept as they come, as `10 23 05` or `10 23 05 12`: hours, minutes, seconds, and
/// frames.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Content {
    /// Who is there?
    IdentifyReq,
    /// The answer to it.
    IdentifyAck {
        /// What the answering program is called.
        instance_name: String,
        /// Its addresses.
        addresses: Vec<String>,
    },
    /// Begin to record.
    StartRecordingReq {
        /// What the recording is called.
        session_name: Option<String>,
        /// The time code at which to begin.
        start_time: Option<String>,
        /// A remark.
        description: Option<String>,
    },
    /// End the recording.
    StopRecordingReq,
    /// What the next recording is called.
    CaptureName {
        /// Its name.
        name: Option<String>,
        /// The number of the take, as `001`.
        take: Option<String>,
    },
    /// Whether the name was taken.
    CaptureNameAck {
        /// Whether it was.
        success: bool,
    },
    /// Begin to record.
    CaptureStart {
        /// What the recording is called, from systems that say it here.
        name: Option<String>,
        /// The time code at which to begin.
        time_code: Option<String>,
        /// A remark.
        notes: Option<String>,
    },
    /// End the recording.
    CaptureStop {
        /// What the recording is called, from systems that say it here.
        name: Option<String>,
        /// The time code at which to end.
        time_code: Option<String>,
    },
    /// The sender's time code, once a second. It is not answered.
    TimeSync {
        /// The time code.
        time_code: Option<String>,
    },
    /// What is recorded?
    SessionInfoReq,
    /// The answer to it.
    SessionInfoAck {
        /// What the session is called.
        session_name: String,
        /// Which recording of the session it is.
        recording_trial: String,
    },
    /// What is going on?
    SessionStatusReq,
    /// The answer to it.
    SessionStatusAck {
        /// Whether something is recorded.
        is_recording: bool,
        /// Whether the playback is paused.
        is_paused: bool,
        /// Whether what is shown happens now.
        is_live: bool,
    },
    /// Send the stream there as well.
    AddNetworkStreamingTargetReq {
        /// The address.
        ip_address: String,
        /// The UDP port, which is not 0.
        port_number: u16,
    },
    /// Send the stream there no more.
    RemoveNetworkStreamingTargetReq {
        /// The address.
        ip_address: String,
        /// The UDP port, which is not 0.
        port_number: u16,
    },
    /// Pause the playback, or go on with it.
    PlayPauseReq,
    /// Play from the start.
    NavigateToStartReq,
    /// Play from this frame on. Which attribute has the number is not public: several names are understood, and `Frame` is
    /// written.
    JumpToFrameReq {
        /// The number of the frame, where one was found.
        frame: Option<u32>,
    },
    /// Mark this moment.
    AddMarkerReq,
    /// Call the session something else.
    SetSessionNameReq {
        /// What to call it.
        session_name: Option<String>,
    },
    /// Whether something was done that was asked for.
    Ack {
        /// What was asked for: `StartRecording` of `StartRecordingAck`.
        request: String,
        /// Whether it was done.
        result: bool,
        /// Why it was not.
        reason: Option<String>,
    },
    /// A message that is not known; all that is in it is in the [`Rest`].
    Unknown {
        /// Its name.
        name: String,
    },
}

impl Message {
    /// Reads what a datagram holds.
    ///
    /// # Errors
    /// [`Error::RemoteXml`] as for [`Element::decode`], [`Error::RemoteValue`] for a known attribute that is missing or has
    /// a value that it cannot have.
    pub fn decode(bytes: &[u8]) -> Result<Self, Error> {
        Self::of(Element::decode(bytes)?)
    }

    /// Understands an element.
    ///
    /// # Errors
    /// [`Error::RemoteValue`] as for [`decode`](Self::decode).
    pub fn of(element: Element) -> Result<Self, Error> {
        let name = element.name.clone();
        let mut fields = Fields(element);
        let content = Content::take(&name, &mut fields)?;
        let Element {
            attributes,
            children,
            text,
            ..
        } = fields.0;
        let rest = Rest {
            attributes,
            children,
            text,
        };
        Ok(Self { content, rest })
    }

    /// The message as an element.
    pub fn to_element(&self) -> Element {
        let mut element = self.content.to_element();
        element.attributes.extend_from_slice(&self.rest.attributes);
        element.children.extend_from_slice(&self.rest.children);
        element.text.push_str(&self.rest.text);
        element
    }
}

impl From<Content> for Message {
    fn from(content: Content) -> Self {
        let rest = Rest::default();
        Self { content, rest }
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.to_element().fmt(f)
    }
}

impl Content {
    /// What to answer to a request that was done, or that was not for this reason. `None` for what asks for nothing, as
    /// acknowledgements, and for questions, whose answers say more.
    pub fn answer(&self, done: Result<(), String>) -> Option<Self> {
        let name = match self {
            Self::CaptureName { .. } => return Some(Self::CaptureNameAck { success: done.is_ok() }),
            Self::IdentifyReq | Self::SessionInfoReq | Self::SessionStatusReq => return None,
            Self::CaptureStart { .. } => "CaptureStart".to_owned(),
            Self::CaptureStop { .. } => "CaptureStop".to_owned(),
            other => other.to_element().name.strip_suffix("Req")?.to_owned(),
        };
        Some(Self::Ack {
            request: name,
            result: done.is_ok(),
            reason: done.err(),
        })
    }

    fn take(name: &str, fields: &mut Fields) -> Result<Self, Error> {
        Ok(match name {
            "IdentifyReq" => Self::IdentifyReq,
            "IdentifyAck" => Self::IdentifyAck {
                instance_name: fields.attribute("InstanceName").unwrap_or_default(),
                addresses: fields.children("Address"),
            },
            "SessionInfoReq" => Self::SessionInfoReq,
            "SessionInfoAck" => Self::SessionInfoAck {
                session_name: fields.attribute("SessionName").unwrap_or_default(),
                recording_trial: fields.attribute("recordingTrial").unwrap_or_default(),
            },
            "SessionStatusReq" => Self::SessionStatusReq,
            "SessionStatusAck" => Self::SessionStatusAck {
                is_recording: fields.truth("isRecording")?.unwrap_or_default(),
                is_paused: fields.truth("isPaused")?.unwrap_or_default(),
                is_live: fields.truth("isLive")?.unwrap_or_default(),
            },
            "SetSessionNameReq" => Self::SetSessionNameReq {
                session_name: fields.attribute("SessionName"),
            },
            "TimeSync" => Self::TimeSync {
                time_code: fields.attribute("TimeCode"),
            },
            "AddMarkerReq" => Self::AddMarkerReq,
            _ => match Self::take_recording(name, fields)? {
                Some(content) => content,
                None => Self::take_playback(name, fields)?,
            },
        })
    }

    fn take_recording(name: &str, fields: &mut Fields) -> Result<Option<Self>, Error> {
        Ok(Some(match name {
            "StartRecordingReq" => Self::StartRecordingReq {
                session_name: fields.attribute("SessionName"),
                start_time: fields.attribute("StartTime"),
                description: fields.attribute("Description"),
            },
            "StopRecordingReq" => Self::StopRecordingReq,
            "CaptureName" => Self::CaptureName {
                name: fields.child("Name"),
                take: fields.child("Take"),
            },
            "CaptureNameAck" => Self::CaptureNameAck {
                success: fields.truth("Success")?.unwrap_or_default(),
            },
            "CaptureStart" => Self::CaptureStart {
                name: fields.child("Name"),
                time_code: fields.child("TimeCode"),
                notes: fields.child("Notes"),
            },
            "CaptureStop" => Self::CaptureStop {
                name: fields.child("Name"),
                time_code: fields.child("TimeCode"),
            },
            _ => return Ok(None),
        }))
    }

    fn take_playback(name: &str, fields: &mut Fields) -> Result<Self, Error> {
        Ok(match name {
            "PlayPauseReq" => Self::PlayPauseReq,
            "NavigateToStartReq" => Self::NavigateToStartReq,
            "JumpToFrameReq" => Self::JumpToFrameReq {
                frame: fields.number(&FRAMES),
            },
            "AddNetworkStreamingTargetReq" => Self::AddNetworkStreamingTargetReq {
                ip_address: fields.needed("IpAddress")?,
                port_number: fields.port("PortNumber")?,
            },
            "RemoveNetworkStreamingTargetReq" => Self::RemoveNetworkStreamingTargetReq {
                ip_address: fields.needed("IpAddress")?,
                port_number: fields.port("PortNumber")?,
            },
            _ => match (name.strip_suffix("Ack"), fields.truth("Result")) {
                (Some(request), Ok(Some(result))) => Self::Ack {
                    request: request.to_owned(),
                    result,
                    reason: fields.attribute("Reason"),
                },
                (Some(_), Err(error)) => return Err(error),
                _ => Self::Unknown { name: name.to_owned() },
            },
        })
    }

    fn to_element(&self) -> Element {
        match self {
            Self::IdentifyReq => Element::new("IdentifyReq"),
            Self::IdentifyAck {
                instance_name,
                addresses,
            } => Element {
                children: addresses.iter().map(|address| valued("Address", address)).collect(),
                ..Element::new("IdentifyAck").with("InstanceName", instance_name)
            },
            Self::SessionInfoReq => Element::new("SessionInfoReq"),
            Self::SessionInfoAck {
                session_name,
                recording_trial,
            } => Element::new("SessionInfoAck")
                .with("SessionName", session_name)
                .with("recordingTrial", recording_trial),
            Self::SessionStatusReq => Element::new("SessionStatusReq"),
            Self::SessionStatusAck {
                is_recording,
                is_paused,
                is_live,
            } => Element::new("SessionStatusAck")
                .with("isRecording", truth(*is_recording))
                .with("isPaused", truth(*is_paused))
                .with("isLive", truth(*is_live)),
            Self::SetSessionNameReq { session_name } => {
                Element::new("SetSessionNameReq").with_some("SessionName", session_name.as_ref())
            }
            Self::TimeSync { time_code } => Element::new("TimeSync").with_some("TimeCode", time_code.as_ref()),
            Self::Ack {
                request,
                result,
                reason,
            } => Element::new(format!("{request}Ack"))
                .with("Result", truth(*result))
                .with_some("Reason", reason.as_ref()),
            Self::Unknown { name } => Element::new(name),
            other => other.to_command(),
        }
    }

    fn to_command(&self) -> Element {
        match self {
            Self::StartRecordingReq {
                session_name,
                start_time,
                description,
            } => Element::new("StartRecordingReq")
                .with_some("SessionName", session_name.as_ref())
                .with_some("StartTime", start_time.as_ref())
                .with_some("Description", description.as_ref()),
            Self::CaptureName { name, take } => Element {
                children: given([("Name", name), ("Take", take)]),
                ..Element::new("CaptureName")
            },
            Self::CaptureNameAck { success } => Element::new("CaptureNameAck").with("Success", truth(*success)),
            Self::CaptureStart { name, time_code, notes } => {
                let mut children = given([("Name", name), ("TimeCode", time_code)]);
                children.extend(notes.iter().map(|notes| Element {
                    text: notes.clone(),
                    ..Element::new("Notes")
                }));
                Element {
                    children,
                    ..Element::new("CaptureStart")
                }
            }
            Self::CaptureStop { name, time_code } => Element {
                children: given([("Name", name), ("TimeCode", time_code)]),
                ..Element::new("CaptureStop")
            },
            Self::AddNetworkStreamingTargetReq {
                ip_address,
                port_number,
            } => target("AddNetworkStreamingTargetReq", ip_address, *port_number),
            Self::RemoveNetworkStreamingTargetReq {
                ip_address,
                port_number,
            } => target("RemoveNetworkStreamingTargetReq", ip_address, *port_number),
            Self::JumpToFrameReq { frame } => {
                let frame = frame.map(|frame| frame.to_string());
                Element::new("JumpToFrameReq").with_some(FRAMES[0], frame.as_ref())
            }
            Self::StopRecordingReq => Element::new("StopRecordingReq"),
            Self::NavigateToStartReq => Element::new("NavigateToStartReq"),
            Self::AddMarkerReq => Element::new("AddMarkerReq"),
            _ => Element::new("PlayPauseReq"),
        }
    }
}

impl Element {
    fn with_some(self, name: &str, value: Option<&String>) -> Self {
        match value {
            Some(value) => self.with(name, value),
            None => self,
        }
    }
}

fn given<const N: usize>(children: [(&str, &Option<String>); N]) -> Vec<Element> {
    let children = children.into_iter();
    children
        .filter_map(|(name, value)| Some(valued(name, value.as_ref()?)))
        .collect()
}

fn target(name: &str, ip_address: &str, port_number: u16) -> Element {
    Element::new(name)
        .with("IpAddress", ip_address)
        .with("PortNumber", port_number.to_string())
}

fn truth(value: bool) -> &'static str {
    if value { "TRUE" } else { "FALSE" }
}

/// What the number of a frame may be called; the first is written.
const FRAMES: [&str; 5] = ["Frame", "FrameNumber", "FrameIndex", "Index", "VALUE"];

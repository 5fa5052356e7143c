//! What is answered to what, without a socket.

use super::{Controlled, Status};
use crate::recording::TakeName;
use posewire_mxtp::Error;
use posewire_mxtp::remote::{Content, Element, Message};
use std::net::IpAddr;

/// Takes messages and answers them.
pub(super) struct Desk {
    name: String,
    controlled: Box<dyn Controlled>,
    /// What the next recording is called unless it is said.
    next: Option<TakeName>,
}

/// What became of a message.
pub(super) struct Handled {
    pub(super) answer: Option<Message>,
    /// What people are told: what was done, or what was refused.
    pub(super) said: Option<Result<String, String>>,
}

impl Desk {
    pub(super) fn new(name: &str, controlled: Box<dyn Controlled>) -> Self {
        Self {
            name: name.to_owned(),
            controlled,
            next: None,
        }
    }

    /// Takes a message. `own` is the address by which its sender knows this machine.
    pub(super) fn handle(&mut self, bytes: &[u8], own: impl FnOnce() -> Option<IpAddr>) -> Handled {
        let request = match understood(bytes) {
            Ok(request) => request,
            Err(unread) => return unread.handled(),
        };
        let status = self.controlled.status();
        let answer = match &request {
            Content::IdentifyReq => Content::IdentifyAck {
                instance_name: self.name.clone(),
                addresses: own().map(|address| address.to_string()).into_iter().collect(),
            },
            Content::SessionStatusReq => Content::SessionStatusAck {
                is_recording: status.recording.is_some(),
                is_paused: status.paused,
                is_live: status.live,
            },
            Content::SessionInfoReq => self.session(&status),
            _ => return self.carry_out(&request),
        };
        Handled {
            answer: Some(answer.into()),
            said: None,
        }
    }

    fn session(&self, status: &Status) -> Content {
        let next = self.next.as_ref().map(TakeName::to_string);
        Content::SessionInfoAck {
            session_name: status.recording.clone().or(next).unwrap_or_default(),
            recording_trial: format!("{:03}", status.recordings),
        }
    }

    fn carry_out(&mut self, request: &Content) -> Handled {
        // What wants no answer is none of ours, as the answers of others to a question that was sent to everybody.
        if request.answer(Ok(())).is_none() {
            return Handled {
                answer: None,
                said: None,
            };
        }
        let done = self.obey(request);
        let answer = request.answer(done.clone().map(drop)).map(Message::from);
        let refused = |reason| format!("refused {}: {reason}", verb(answer.as_ref()));
        let said = Some(done.map_err(refused));
        Handled { answer, said }
    }

    fn obey(&mut self, request: &Content) -> Result<String, String> {
        match request {
            Content::CaptureName { name, take } => {
                let name = named(name.as_deref(), take.as_deref())?;
                Ok(self.call(name.ok_or("there is no name")?))
            }
            Content::SetSessionNameReq { session_name } => {
                let name = named(session_name.as_deref(), None)?;
                Ok(self.call(name.ok_or("there is no name")?))
            }
            Content::StartRecordingReq { session_name: name, .. } | Content::CaptureStart { name, .. } => {
                let name = named(name.as_deref(), None)?;
                self.start(name)
            }
            Content::StopRecordingReq | Content::CaptureStop { .. } => self.controlled.stop_recording(),
            other => self.controlled.carry_out(other),
        }
    }

    fn call(&mut self, name: TakeName) -> String {
        let said = format!("the next take is called {name}");
        self.next = Some(name);
        said
    }

    fn start(&mut self, name: Option<TakeName>) -> Result<String, String> {
        if let Some(recording) = self.controlled.status().recording {
            return Err(format!("{recording} is being recorded"));
        }
        let unnamed = || "take".parse().ok();
        let name = name.or_else(|| self.next.clone()).or_else(unnamed);
        self.controlled.start_recording(&name.ok_or("there is no name")?)
    }
}

/// A message that is not understood.
struct Unread {
    /// What it asks for: `StartRecording`; `None` where it is no request, or no XML.
    request: Option<String>,
    reason: String,
}

fn understood(bytes: &[u8]) -> Result<Content, Unread> {
    let element = Element::decode(bytes).map_err(|error| Unread {
        request: None,
        reason: error.to_string(),
    })?;
    let request = element.name.strip_suffix("Req").map(str::to_owned);
    let message = Message::of(element).map_err(|error| Unread {
        request,
        reason: lack(&error),
    })?;
    Ok(message.content)
}

impl Unread {
    /// A request that lacks something is answered, as it may come from a program that waits.
    fn handled(self) -> Handled {
        let Self { request, reason } = self;
        let Some(request) = request else {
            return Handled {
                answer: None,
                said: Some(Err(reason)),
            };
        };
        let said = Some(Err(format!("refused {request}: {reason}")));
        let answer = Content::Ack {
            request,
            result: false,
            reason: Some(reason),
        };
        Handled {
            answer: Some(answer.into()),
            said,
        }
    }
}

/// What is wrong with a message, for who knows which it is.
fn lack(error: &Error) -> String {
    match error {
        Error::RemoteValue {
            field, expected, found, ..
        } => format!("expected {expected} as {field}, found {}", found.escape_debug()),
        other => other.to_string(),
    }
}

/// `walk`, or `walk-001` where the take has a number. An empty name is none.
fn named(name: Option<&str>, take: Option<&str>) -> Result<Option<TakeName>, String> {
    let name = name.map(str::trim).filter(|name| !name.is_empty());
    let take = take.map(str::trim).filter(|take| !take.is_empty());
    let whole = match (name, take) {
        (None, _) => return Ok(None),
        (Some(name), None) => name.to_owned(),
        (Some(name), Some(take)) => format!("{name}-{take}"),
    };
    let parsed = whole.parse::<TakeName>();
    parsed.map(Some).map_err(|error| error.to_string())
}

/// What was asked for, by its answer.
fn verb(answer: Option<&Message>) -> &str {
    match answer.map(|answer| &answer.content) {
        Some(Content::Ack { request, .. }) => request,
        _ => "CaptureName",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something that is told to record, and nothing else.
    #[derive(Default)]
    struct Tape {
        status: Status,
    }

    impl Controlled for Tape {
        fn status(&self) -> Status {
            self.status.clone()
        }

        fn start_recording(&mut self, name: &TakeName) -> Result<String, String> {
            self.status.recording = Some(name.to_string());
            self.status.recordings += 1;
            Ok(format!("recording {name}"))
        }

        fn stop_recording(&mut self) -> Result<String, String> {
            let name = self.status.recording.take();
            name.ok_or_else(|| "nothing is being recorded".to_owned())
        }
    }

    struct Caller(Desk);

    impl Caller {
        fn new() -> Self {
            Self(Desk::new("stage", Box::new(Tape::default())))
        }

        fn ask(&mut self, text: &str) -> String {
            let own = || Some([127, 0, 0, 1].into());
            let handled = self.0.handle(text.as_bytes(), own);
            handled.answer.map_or_else(String::new, |answer| answer.to_string())
        }
    }

    #[test]
    fn questions_are_answered() {
        let mut caller = Caller::new();
        assert_eq!(
            caller.ask("<IdentifyReq>"),
            "<IdentifyAck InstanceName=\"stage\"><Address VALUE=\"127.0.0.1\"/></IdentifyAck>"
        );
        assert_eq!(
            caller.ask("<SessionInfoReq/>"),
            "<SessionInfoAck SessionName=\"\" recordingTrial=\"000\"/>"
        );
        assert!(caller.ask("<SessionStatusReq/>").contains("isRecording=\"FALSE\""));
    }

    #[test]
    fn a_capture_is_named_begun_and_ended() {
        let mut caller = Caller::new();
        let named = caller.ask("<CaptureName><Name VALUE=\"walk\"/><Take VALUE=\"003\"/></CaptureName>");
        assert_eq!(named, "<CaptureNameAck Success=\"TRUE\"/>");
        assert_eq!(
            caller.ask("<CaptureStart><Notes>slow</Notes></CaptureStart>"),
            "<CaptureStartAck Result=\"TRUE\"/>"
        );
        assert_eq!(
            caller.ask("<SessionInfoReq/>"),
            "<SessionInfoAck SessionName=\"walk-003\" recordingTrial=\"001\"/>"
        );
        assert!(caller.ask("<SessionStatusReq/>").contains("isRecording=\"TRUE\""));
        assert_eq!(
            caller.ask("<StartRecordingReq SessionName=\"run\"/>"),
            "<StartRecordingAck Result=\"FALSE\" Reason=\"walk-003 is being recorded\"/>"
        );
        assert_eq!(caller.ask("<CaptureStop/>"), "<CaptureStopAck Result=\"TRUE\"/>");
        assert_eq!(
            caller.ask("<StopRecordingReq/>"),
            "<StopRecordingAck Result=\"FALSE\" Reason=\"nothing is being recorded\"/>"
        );
        assert_eq!(
            caller.ask("<StartRecordingReq SessionName=\"run\"/>"),
            "<StartRecordingAck Result=\"TRUE\"/>"
        );
    }

    #[test]
    fn names_that_lead_elsewhere_are_refused() {
        let mut caller = Caller::new();
        let refused = caller.ask("<CaptureName><Name VALUE=\"../../home\"/></CaptureName>");
        assert_eq!(refused, "<CaptureNameAck Success=\"FALSE\"/>");
        let refused = caller.ask("<StartRecordingReq SessionName=\"a/b\"/>");
        assert_eq!(
            refused,
            "<StartRecordingAck Result=\"FALSE\" Reason=\"a name cannot have the character &apos;/&apos;\"/>"
        );
        assert_eq!(caller.ask("<CaptureStart/>"), "<CaptureStartAck Result=\"TRUE\"/>");
        assert!(caller.ask("<SessionInfoReq/>").contains("SessionName=\"take\""));
    }

    #[test]
    fn a_request_that_lacks_what_it_needs_is_answered_and_told() {
        let mut caller = Caller::new();
        let port = "expected a number from 1 to 65535 as PortNumber, found 70000";
        for (rest, lacks) in [
            ("", "expected a value as IpAddress, found nothing"),
            ("IpAddress='10.0.0.5'", "expected a value as PortNumber, found nothing"),
            ("IpAddress='10.0.0.5' PortNumber='70000'", port),
        ] {
            let text = format!("<AddNetworkStreamingTargetReq {rest}/>");
            let answer = format!("<AddNetworkStreamingTargetAck Result=\"FALSE\" Reason=\"{lacks}\"/>");
            assert_eq!(caller.ask(&text), answer);
            let said = caller.0.handle(text.as_bytes(), || None).said;
            let told = format!("refused AddNetworkStreamingTarget: {lacks}");
            assert_eq!(said, Some(Err(told)));
        }
        let hostile = caller.ask("<AddNetworkStreamingTargetReq IpAddress='a' PortNumber='\u{1b}[2J'/>");
        assert!(!hostile.contains('\u{1b}'), "{hostile}");
        assert_eq!(caller.ask("<StartRecordingAck Result=\"perhaps\"/>"), "");
    }

    #[test]
    fn what_is_not_done_here_is_refused_and_what_is_no_request_is_not_answered() {
        let mut caller = Caller::new();
        for request in ["PlayPause", "MoveCharacterToOrigin"] {
            assert_eq!(
                caller.ask(&format!("<{request}Req/>")),
                format!("<{request}Ack Result=\"FALSE\" Reason=\"this cannot be done here\"/>")
            );
        }
        for silent in [
            "<TimeSync TimeCode=\"10 23 05\"/>",
            "<StartRecordingAck Result=\"TRUE\"/>",
            "<Hello/>",
            "<!",
            "",
        ] {
            assert_eq!(caller.ask(silent), "", "{silent}");
        }
    }
}

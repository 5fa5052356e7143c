//! Requests in text, and what they are answered with.

use super::ServerOptions;
use crate::Version;
use crate::command::Response;

/// What a request wants.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Wish {
    /// An answer, and that is all.
    Answer(Response),
    /// To know the version that the client gets.
    Version,
    /// Another version.
    NewVersion(Version),
    /// No more frames.
    Disconnect,
    /// What this server does not do.
    Unknown,
}

impl Wish {
    /// Reads a request: a name, and arguments after commas.
    pub(super) fn of(text: &str, options: &ServerOptions) -> Self {
        let (name, arguments) = text.split_once(',').unwrap_or((text, ""));
        match name.trim() {
            "FrameRate" => Self::Answer(Response::float(options.frame_rate)),
            "AnalogSamplesPerMocapFrame" => Self::Answer(Response::number(options.analog_samples_per_frame)),
            "UnitsToMillimeters" => Self::Answer(Response::float(1000.0)),
            // 0 is "live".
            "CurrentMode" => Self::Answer(Response::number(DONE)),
            "Bitstream" if arguments.is_empty() => Self::Version,
            "Bitstream" => match arguments.trim().parse() {
                Ok(version) => Self::NewVersion(version),
                Err(_) => Self::Answer(Response::number(INVALID_ARGUMENT)),
            },
            "Disconnect" => Self::Disconnect,
            name if TOLERATED.contains(&name) => Self::Answer(Response::number(DONE)),
            _ => Self::Unknown,
        }
    }
}

/// It worked.
pub(super) const DONE: i32 = 0;
/// It did not, because of what was asked for.
pub(super) const INVALID_ARGUMENT: i32 = 5;
/// It did not, because of how the server stands.
pub(super) const INVALID_OPERATION: i32 = 6;

/// Commands without an effect here that clients send and want to succeed: they make Motive send a frame, which
/// this server does by itself, or choose among its data, of which everybody gets everything.
const TOLERATED: [&str; 12] = [
    "TimelinePlay",
    "TimelineStop",
    "SetPlaybackTakeName",
    "SetPlaybackStartFrame",
    "SetPlaybackStopFrame",
    "SetPlaybackCurrentFrame",
    "SetPlaybackLooping",
    "LiveMode",
    "EditMode",
    "SubscribeToData",
    "SubscribeByID",
    "SubscribedDataOnly",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read_with_their_arguments() {
        let options = ServerOptions::default();
        let wish = |text| Wish::of(text, &options);
        assert_eq!(wish("FrameRate"), Wish::Answer(Response::float(120.0)));
        assert_eq!(wish("Bitstream"), Wish::Version);
        assert_eq!(wish("Bitstream,3.1"), Wish::NewVersion(Version::new(3, 1)));
        assert_eq!(wish("Bitstream,x"), Wish::Answer(Response::number(INVALID_ARGUMENT)));
        for text in [
            "SetPlaybackCurrentFrame,0",
            "SubscribeToData,Skeleton,All",
            "TimelinePlay",
        ] {
            assert_eq!(wish(text), Wish::Answer(Response::number(0)), "{text}");
        }
        for text in ["", "StartRecording", "service20,-1,bytes", "framerate"] {
            assert_eq!(wish(text), Wish::Unknown, "{text}");
        }
    }
}

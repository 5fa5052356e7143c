//! Which bitstream the packets of an input are of: no packet says it.

use super::has_layout;
use posewire_natnet::command::ServerInfo;
use posewire_natnet::{Message, MessageId, Packet, Version, explain};
use std::cmp::Reverse;

/// The version that packets are read as.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::command::explain) struct Bitstream {
    pub(in crate::command::explain) version: Version,
    pub(in crate::command::explain) origin: Origin,
}

/// Where a version comes from.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::command::explain) enum Origin {
    /// The user named it.
    Given,
    /// A server in the input says that it sends it, and the packets do not contradict.
    Stated,
    /// The packets fit it, newer layouts first.
    Fits {
        /// How many packets, frames and descriptions, that was.
        packets: usize,
        /// Others that fit and give the same fields, newest first.
        alike: Vec<Version>,
        /// Others that fit and give other fields, newest first.
        otherwise: Vec<Version>,
    },
    /// No layout fits without a deviation; this one goes furthest.
    FitsNone,
}

impl Bitstream {
    pub(in crate::command::explain) const fn given(version: Version) -> Self {
        let origin = Origin::Given;
        Self { version, origin }
    }

    /// Believes the server that introduces itself, if one does, and tries the layouts on the first packets that have one: a
    /// file is of one bitstream.
    pub(in crate::command::explain) fn guess<'a>(packets: impl Iterator<Item = &'a [u8]> + Clone) -> Self {
        let stated = stated(packets.clone());
        let packets: Vec<_> = packets.filter(|bytes| has_layout(bytes)).take(TRIED).collect();
        let newest_first = || Version::LAYOUTS.into_iter().rev();
        let scored = newest_first().map(|version| (version, Score::of(version, &packets)));
        // The first of equals wins: the newest.
        let best = scored.min_by_key(|(_, score)| Reverse(*score));
        let (version, score) = best.unwrap_or((Version::LATEST, Score::default()));
        if let Some(version) = stated.filter(|stated| Score::of(*stated, &packets) >= score) {
            let origin = Origin::Stated;
            return Self { version, origin };
        }
        if score.clean == 0 {
            let origin = Origin::FitsNone;
            return Self { version, origin };
        }
        let fit = newest_first().filter(|other| *other != version && Score::of(*other, &packets).clean == score.clean);
        let places = places(version, &packets);
        let (alike, otherwise) = fit.partition(|other| self::places(*other, &packets) == places);
        let origin = Origin::Fits {
            packets: packets.len(),
            alike,
            otherwise,
        };
        Self { version, origin }
    }

    /// How it is known, as a line for people; `None` when it was given.
    pub(in crate::command::explain) fn reason(&self) -> Option<String> {
        let version = self.version;
        Some(match &self.origin {
            Origin::Given => return None,
            Origin::Stated => format!("bitstream {version} as the SERVERINFO in this input says"),
            Origin::Fits {
                packets,
                alike,
                otherwise,
            } if alike.is_empty() && otherwise.is_empty() => match packets {
                1 => format!("bitstream {version} by the bytes: no other layout fits"),
                _ => format!("bitstream {version} by all {packets} frames and descriptions here: no other layout fits"),
            },
            Origin::Fits { alike, otherwise, .. } if otherwise.is_empty() => {
                format!("bitstream {version} is a guess: {} would read the same", words(alike))
            }
            Origin::Fits { otherwise, .. } => {
                format!(
                    "bitstream {version} is a guess: {} would fit and read otherwise; {TELL}",
                    words(otherwise)
                )
            }
            Origin::FitsNone => format!("bitstream {version} is a guess: no layout fits without quirks; {TELL}"),
        })
    }
}

/// The version that every server of the input says that it sends.
fn stated<'a>(packets: impl Iterator<Item = &'a [u8]>) -> Option<Version> {
    let mut stated = packets.filter_map(|bytes| {
        let packet = Packet::decode(bytes).ok()?;
        let info = (packet.id == MessageId::SERVER_INFO).then(|| ServerInfo::decode(packet.payload));
        let Version { major, minor, .. } = info?.ok()?.0.server.natnet_version;
        Some(Version::new(major, minor))
    });
    let first = stated.next()?;
    stated.all(|other| other == first).then_some(first)
}

/// How well packets fit a layout; more is better, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Score {
    /// Packets without a deviation.
    clean: usize,
    decoded: usize,
    quirks: Reverse<usize>,
    /// Bytes with a meaning.
    explained: usize,
}

impl Score {
    fn of(version: Version, packets: &[&[u8]]) -> Self {
        packets.iter().fold(Self::default(), |mut score, bytes| {
            match Message::decode(version, bytes) {
                Ok((_, quirks)) => {
                    score.clean += usize::from(quirks.is_empty());
                    score.decoded += 1;
                    score.quirks.0 += quirks.len();
                    score.explained += bytes.len();
                }
                Err(_) => score.explained += explained(version, bytes),
            }
            score
        })
    }
}

/// How far the explanation of a malformed packet goes.
fn explained(version: Version, bytes: &[u8]) -> usize {
    let fields = explain(version, bytes).fields;
    fields.last().map_or(0, |unread| unread.offset)
}

/// The names of the fields and where they begin.
fn places(version: Version, packets: &[&[u8]]) -> Vec<Vec<(usize, String)>> {
    let places = |bytes: &&[u8]| {
        let fields = explain(version, bytes).fields.into_iter();
        fields.map(|field| (field.offset, field.name)).collect()
    };
    packets.iter().map(places).collect()
}

fn words(versions: &[Version]) -> String {
    match versions {
        [] => String::new(),
        [one] => one.to_string(),
        [newest, oldest] => format!("{newest} and {oldest}"),
        [newest, .., oldest] => format!("{} others from {newest} to {oldest}", versions.len()),
    }
}

const TRIED: usize = 32;
const TELL: &str = "--version tells";

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_natnet::frame::{Frame, RigidBody};

    fn frame(version: Version) -> Vec<u8> {
        let frame = Frame {
            rigid_bodies: vec![RigidBody::default(); 2],
            ..Frame::default()
        };
        let mut bytes = Vec::new();
        Message::Frame(frame.into()).encode(version, &mut bytes).unwrap();
        bytes
    }

    fn guess(bytes: &[u8]) -> Bitstream {
        Bitstream::guess(std::iter::once(bytes))
    }

    #[test]
    fn the_newest_of_the_layouts_that_fit_is_taken() {
        let guess = guess(&frame(Version::new(3, 0)));
        let origin = Origin::Fits {
            packets: 1,
            alike: vec![Version::new(3, 0)],
            otherwise: Vec::new(),
        };
        let version = Version::new(4, 0);
        assert_eq!(guess, Bitstream { version, origin });
        let reason = "bitstream 4.0 is a guess: 3.0 would read the same";
        assert_eq!(guess.reason().as_deref(), Some(reason));
    }

    fn info(version: Version) -> Vec<u8> {
        let mut info = ServerInfo::default();
        info.server.natnet_version = version;
        let mut bytes = Vec::new();
        Message::ServerInfo(info).encode(version, &mut bytes).unwrap();
        bytes
    }

    #[test]
    fn a_server_in_the_input_says_which_bitstream_it_is_unless_the_bytes_contradict() {
        let [old, new] = [Version::new(3, 1), Version::new(4, 3)];
        for (packets, version, reason) in [
            (
                vec![info(new), frame(new)],
                new,
                "bitstream 4.3 as the SERVERINFO in this input says",
            ),
            (
                vec![info(new), frame(old)],
                Version::new(4, 0),
                "bitstream 4.0 is a guess: 3.0 would read the same",
            ),
            (
                vec![info(new), info(old), frame(new)],
                Version::new(4, 2),
                "bitstream 4.2 is a guess: 4.1 would read the same",
            ),
        ] {
            let guess = Bitstream::guess(packets.iter().map(Vec::as_slice));
            assert_eq!((guess.version, guess.reason().as_deref()), (version, Some(reason)));
        }
    }

    #[test]
    fn what_several_packets_tell_together_is_said_so() {
        let version = Version::new(2, 7);
        let packets = [frame(version), frame(version)];
        let guess = Bitstream::guess(packets.iter().map(Vec::as_slice));
        let reason = guess.reason().unwrap();
        let alone = Bitstream::guess(packets[..1].iter().map(Vec::as_slice))
            .reason()
            .unwrap();
        assert_eq!(alone, "bitstream 2.7 by the bytes: no other layout fits");
        assert_eq!(
            reason,
            "bitstream 2.7 by all 2 frames and descriptions here: no other layout fits"
        );
    }

    #[test]
    fn every_layout_fits_what_is_written_in_it() {
        for written in Version::LAYOUTS {
            let Bitstream { version, origin } = guess(&frame(written));
            let Origin::Fits { alike, otherwise, .. } = origin else {
                panic!("{written}")
            };
            assert!(version == written || alike.contains(&written) || otherwise.contains(&written));
        }
    }

    #[test]
    fn without_a_layout_that_fits_the_one_that_goes_furthest_is_taken() {
        let bytes = frame(Version::new(2, 7));
        let cut = guess(&bytes[..bytes.len() - 20]);
        assert_eq!(cut.origin, Origin::FitsNone);
        assert!(cut.reason().unwrap().ends_with("; --version tells"));
        assert_eq!(guess(b"").version, Version::LATEST);
    }
}

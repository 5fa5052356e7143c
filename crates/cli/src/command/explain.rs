//! `posewire explain`: the bytes of datagrams, field by field.

mod capture;
mod input;
mod json;
mod mxtp;
mod natnet;
mod part;
mod protocol;
mod text;

use super::End;
use crate::cli::Explain;
use crate::error::{Failure, Usage};
use part::Part;
use protocol::Reading;
use std::io::{self, BufWriter, Write};

pub(super) fn run(arguments: &Explain) -> anyhow::Result<End> {
    if capture::is_capture(&arguments.file) {
        return explain_capture(arguments);
    }
    refuse_of_captures(arguments)?;
    let bytes = input::read(&arguments.file)?;
    let name = input::name(&arguments.file);
    let reading = Reading::of(&bytes, arguments, &name)?;
    let mut out = BufWriter::new(io::stdout().lock());
    let tally = write_parts(&bytes, &reading, arguments.json, &mut out)?;
    out.flush()?;
    if tally.decoded > 0 {
        return Ok(End::Done);
    }
    Err(nothing_decoded(&name, &bytes, &tally, &reading).into())
}

/// Raw bytes have no times and no senders.
fn refuse_of_captures(arguments: &Explain) -> Result<(), Usage> {
    let mut given = [("--summary", arguments.summary)]
        .into_iter()
        .chain(arguments.part.given());
    match given.find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(Usage {
            problem: format!(
                "{option} is for recordings and captures, {} is neither",
                arguments.file.display()
            ),
            help: format!("leave {option} out"),
        }),
    }
}

fn explain_capture(arguments: &Explain) -> anyhow::Result<End> {
    let mut out = BufWriter::new(io::stdout().lock());
    let tally = capture::write_all(arguments, &mut out)?;
    out.flush()?;
    if tally.decoded > 0 {
        return Ok(End::Done);
    }
    let name = input::name(&arguments.file);
    Err(Failure {
        problem: match tally.malformed {
            0 if arguments.part.from.is_some() || arguments.part.until.is_some() => {
                format!("{name}: expected datagrams in that time, found none")
            }
            0 => format!("{name}: expected datagrams of MXTP or NatNet, found none"),
            count => format!("{name}: all {count} datagrams are malformed and were explained as far as they go"),
        },
        help: "--protocol says what the datagrams are when their content does not".to_owned(),
    }
    .into())
}

/// What the input held.
#[derive(Debug, Default, PartialEq, Eq)]
struct Tally {
    decoded: u64,
    malformed: u64,
    skipped: u64,
}

impl Tally {
    fn count(&mut self, part: &Part<'_>, decodes: bool) {
        match part {
            Part::Skipped { bytes, .. } => self.skipped += bytes.len() as u64,
            Part::Datagram { .. } if decodes => self.decoded += 1,
            Part::Datagram { .. } => self.malformed += 1,
        }
    }
}

fn write_parts(bytes: &[u8], reading: &Reading, json: bool, out: &mut impl Write) -> anyhow::Result<Tally> {
    let mut tally = Tally::default();
    for part in reading.parts(bytes) {
        let mut decodes = false;
        match part {
            Part::Datagram { offset, bytes } => {
                let explained = reading.explain(offset, bytes);
                decodes = explained.error.is_none();
                if json {
                    json::write_datagram(&explained, out)?;
                } else {
                    text::write_datagram(&explained, out)?;
                }
            }
            Part::Skipped { offset, bytes } if json => json::write_skipped(offset, bytes.len(), out)?,
            Part::Skipped { offset, bytes } => text::write_skipped(offset, bytes, out)?,
        }
        tally.count(&part, decodes);
    }
    if !json && tally.decoded + tally.malformed > 1 {
        text::write_tally(&tally, out)?;
    }
    Ok(tally)
}

fn nothing_decoded(name: &str, bytes: &[u8], tally: &Tally, reading: &Reading) -> Failure {
    let problem = match tally.malformed {
        0 => {
            let expected = reading.expected();
            let beginning = bytes[..bytes.len().min(8)].escape_ascii();
            format!("{name}: expected {expected}, found \"{beginning}\" and no datagram")
        }
        1 => format!("{name}: the datagram is malformed and was explained as far as it goes"),
        count => format!("{name}: all {count} datagrams are malformed and were explained as far as they go"),
    };
    let help = match tally.malformed {
        0 => reading.way_out(bytes),
        _ => "the error above names the place; check how the bytes were captured".to_owned(),
    };
    Failure { problem, help }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_mxtp::body::{Body, TimeCode};
    use posewire_mxtp::{Datagram, Header, MessageType};

    fn time_code() -> Vec<u8> {
        let mut bytes = Vec::new();
        let header = Header::rev_j(MessageType::TIME_CODE, 7, 1_500);
        let datagram = Datagram::new(header, Body::TimeCode(TimeCode::from_millis_of_day(45_296_789)));
        datagram.unwrap().encode(&mut bytes);
        bytes
    }

    fn told(bytes: &[u8], json: bool) -> (String, Tally) {
        let mut out = Vec::new();
        let tally = write_parts(bytes, &Reading::Mxtp, json, &mut out).unwrap();
        (String::from_utf8(out).unwrap(), tally)
    }

    #[test]
    fn datagrams_garbage_and_malformed_ones_are_counted() {
        let one = time_code();
        let stream = [b"noise", &one[..], &one, &one[..30]].concat();
        let expected = Tally {
            decoded: 2,
            malformed: 1,
            skipped: 5,
        };
        assert_eq!(told(&stream, true).1, expected);
        let (text, tally) = told(&stream, false);
        assert_eq!(tally, expected);
        assert!(
            text.ends_with("\n3 datagrams, 1 of them malformed, 5 bytes skipped\n"),
            "{text}"
        );
    }

    #[test]
    fn what_comes_off_the_wire_cannot_steer_the_terminal() {
        let mut bytes = Header::rev_j(MessageType::META, 0, 0).encode().to_vec();
        bytes.extend_from_slice(b"name\x1b[2J:\x1b[31mRed\r\xc2\x9b\n");
        for json in [false, true] {
            let (text, tally) = told(&bytes, json);
            assert_eq!(tally.decoded, 1);
            let steers = |c: char| c.is_control() && c != '\n';
            assert!(!text.contains(steers) || json && text.contains('\u{9b}'), "{text:?}");
            assert!(!text.contains('\x1b'), "{text:?}");
        }
    }
}

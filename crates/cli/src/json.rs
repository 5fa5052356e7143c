//! The JSON that verbs print: one object a line. The field names are an interface, described in docs/json.md. Statistics
//! and streams have theirs from [`posewire::json`].

mod capture;
mod doctor;
mod frame;
mod recording;
mod replay;
mod subject;

pub(crate) use capture::CaptureFileRecord;
pub(crate) use doctor::{DoctorRecord, FindingRecord};
pub(crate) use frame::{FrameRecord, marker_name};
pub(crate) use recording::{RecordingFileRecord, RecordingRecord};
pub(crate) use replay::ReplayRecord;
pub(crate) use subject::SubjectRecord;

use posewire::Error;
use posewire_motion::{DQuat, DVec3};
use serde::{Serialize, Serializer};
use std::io::Write;

/// What a record says, and which source of a capture it is of.
#[derive(Serialize)]
pub(crate) struct OfSource<'a, T> {
    #[serde(flatten)]
    pub(crate) record: &'a T,
    pub(crate) source: u16,
}

/// Prints one object on a line of its own.
pub(crate) fn print(value: &impl Serialize) -> Result<(), Error> {
    write(&mut std::io::stdout().lock(), value)
}

/// Writes one object on a line of its own to the standard output.
pub(crate) fn write(out: &mut impl Write, value: &impl Serialize) -> Result<(), Error> {
    let broken = |error: &std::io::Error| Error::write("the standard output", error);
    let mut serializer = serde_json::Serializer::with_formatter(&mut *out, Printable);
    value
        .serialize(&mut serializer)
        .map_err(|error| broken(&error.into()))?;
    out.write_all(b"\n").map_err(|error| broken(&error))
}

/// Compact JSON with every control character escaped: JSON itself asks for it only below U+0020, but those from U+007F to
/// U+009F steer a terminal too, and names come from the network.
struct Printable;

impl serde_json::ser::Formatter for Printable {
    fn write_string_fragment<W: ?Sized + Write>(&mut self, out: &mut W, fragment: &str) -> std::io::Result<()> {
        let mut rest = fragment;
        while let Some(place) = rest.find(char::is_control) {
            let (before, from) = rest.split_at(place);
            let mut characters = from.chars();
            let code = characters.next().map_or(0, u32::from);
            write!(out, "{before}\\u{code:04x}")?;
            rest = characters.as_str();
        }
        out.write_all(rest.as_bytes())
    }
}

/// `[x, y, z]`
struct Vector(DVec3);

/// `[w, x, y, z]`
struct Quaternion(DQuat);

/// What came as an `f32` is printed with the digits that tell it apart as one, as files have it.
struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let single = self.0 as f32;
        if f64::from(single).to_bits() == self.0.to_bits() {
            single.serialize(serializer)
        } else {
            self.0.serialize(serializer)
        }
    }
}

impl Serialize for Vector {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.to_array().map(Number).serialize(serializer)
    }
}

impl Serialize for Quaternion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let DQuat { w, x, y, z } = self.0;
        [w, x, y, z].map(Number).serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_name_says_cannot_steer_the_terminal() {
        let name = "Zo\u{eb}\u{1b}[2J\u{7f}\u{9b}2J\n\"";
        let mut line = Vec::new();
        write(&mut line, &name).unwrap();
        let line = String::from_utf8(line).unwrap();
        assert_eq!(line, "\"Zo\u{eb}\\u001b[2J\\u007f\\u009b2J\\n\\\"\"\n");
        assert_eq!(serde_json::from_str::<String>(&line).unwrap(), name);
    }
}

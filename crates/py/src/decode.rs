//! Datagrams as dicts.

use crate::error::{exception, usage};
use posewire_natnet::{MessageId, Packet, Quirk, Version};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyMemoryView};
use std::collections::HashSet;

/// What the bytes of one datagram of MXTP or NatNet say, field by field, as dicts and lists.
///
/// Fields have the names, the units and the axes of the wire, as `posewire explain` shows them; nothing is translated:
///
///     {"protocol": "mxtp",
///      "header": {"magic": "MXTP", "message_type": "02", "sample": 4242, "counter": 128, "items": 23, "time_ms": 17675, ...},
///      "segments": [{"id": 1, "position": {"x": 1.0, ...}, "orientation": {"w": 1.0, ...}}, ...],
///      "quirks": []}
///
///     {"protocol": "natnet", "message": 7, "message_name": "FRAMEOFDATA", "payload_size": 744, "frame_number": 4242,
///      "rigid_bodies_count": 1, "rigid_bodies": [{"id": 1, "position": {...}, "params": 1}], ..., "quirks": []}
///
/// Which other fields there are depends on the type of the datagram. A list is there even where it is empty, and NatNet's
/// count and size of it stand beside it. Bytes without a meaning are hexadecimal digits, which
/// `bytes.fromhex` takes: "reserved", "payload", "leftover", and "trailing" after the end. "quirks" names how the datagram deviates from the specification.
///
/// `data` is bytes or anything whose buffer has items of one byte: bytearray, memoryview, an array of numpy.uint8. `protocol`,
/// "mxtp" or "natnet", is told by the bytes if left out. NatNet's frames and descriptions do not say their `version`, from "1.4" to
/// "4.5", which is "4.1" if left out.
///
/// Raises DecodeError for what is no datagram, and UsageError for a version that there is not, or of MXTP, which says its own.
#[pyfunction]
#[pyo3(signature = (data, protocol = None, version = None))]
pub(crate) fn decode<'py>(
    py: Python<'py>,
    data: &Bound<'py, PyAny>,
    protocol: Option<&str>,
    version: Option<&str>,
) -> PyResult<Bound<'py, PyDict>> {
    let bytes = bytes_of(data)?;
    let data = bytes.as_bytes();
    let protocol = protocol.map_or_else(|| told_by(data), Ok)?;
    let decoded = PyDict::new(py);
    decoded.set_item("protocol", protocol)?;
    match protocol {
        "mxtp" if version.is_some() => {
            return Err(usage(
                "version= is of NatNet, and these bytes are read as MXTP",
                "leave it out: MXTP says its revision itself",
            ));
        }
        "mxtp" => mxtp(&decoded, data)?,
        "natnet" => natnet(&decoded, data, version.map_or(Ok(USUAL_VERSION), natnet_version)?)?,
        found => {
            return Err(usage(
                format!("there is no protocol {found:?}"),
                "use \"mxtp\" or \"natnet\"",
            ));
        }
    }
    Ok(decoded)
}

/// The bytes of anything that has some. The buffers themselves are out of reach of a package for Python 3.10, memoryview is not.
fn bytes_of<'py>(data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyBytes>> {
    if let Ok(bytes) = data.cast::<PyBytes>() {
        return Ok(bytes.clone());
    }
    let view = PyMemoryView::from(data)?;
    let item = view.getattr("itemsize")?.extract::<usize>()?;
    if item != 1 {
        let message = format!("expected bytes, found a buffer with items of {item} bytes");
        return Err(PyTypeError::new_err(message));
    }
    Ok(view.call_method0("tobytes")?.cast_into()?)
}

/// MXTP says so. A NatNet packet begins with its number and size, one of which is right if it is one.
fn told_by(data: &[u8]) -> PyResult<&'static str> {
    if data.starts_with(MXTP) {
        return Ok("mxtp");
    }
    let known = |packet: &Packet<'_>| packet.id.name() != "unknown" || !packet.quirks.contains(Quirk::PayloadSize);
    if Packet::decode(data).is_ok_and(|packet| known(&packet)) {
        return Ok("natnet");
    }
    let found: String = data
        .iter()
        .take(8)
        .flat_map(|byte| byte.escape_ascii())
        .map(char::from)
        .collect();
    let message =
        format!("expected a datagram of MXTP, which begins with \"MXTP\", or one of NatNet, found \"{found}\"");
    Err(exception("DecodeError", message, None))
}

fn mxtp(decoded: &Bound<'_, PyDict>, data: &[u8]) -> PyResult<()> {
    use posewire_mxtp::Value;
    let explanation = posewire_mxtp::explain(data);
    if let Some(error) = explanation.error {
        let help = "posewire explain shows the bytes as far as they make sense";
        return Err(refused("MXTP", &error, help));
    }
    let py = decoded.py();
    for field in &explanation.fields {
        let value = match &field.value {
            Value::Unsigned(number) => number.into_pyobject(py)?.into_any(),
            Value::Signed(number) => number.into_pyobject(py)?.into_any(),
            Value::Float(number) => number.into_pyobject(py)?.into_any(),
            Value::Text(text) => match field.name.strip_prefix("meta.") {
                // A line has a name of the sender's own choice, which is no path.
                Some(name) => {
                    put_line(decoded, name, text)?;
                    continue;
                }
                None => text.into_pyobject(py)?.into_any(),
            },
            Value::Bytes(_) => field.value.to_string().into_pyobject(py)?.into_any(),
        };
        put(decoded, &field.name, value)?;
    }
    let quirks: Vec<_> = explanation.quirks.iter().map(|quirk| quirk.to_string()).collect();
    decoded.set_item("quirks", quirks)
}

/// Puts a line of meta data, `name:Ada`, under its name.
fn put_line(decoded: &Bound<'_, PyDict>, name: &str, line: &str) -> PyResult<()> {
    let value = line
        .strip_prefix(name)
        .and_then(|line| line.strip_prefix(':'))
        .unwrap_or(line);
    let meta = within(decoded, Step::Name("meta"), false)?;
    meta.set_item(name, value.trim_end_matches('\n'))
}

fn natnet(decoded: &Bound<'_, PyDict>, data: &[u8], version: Version) -> PyResult<()> {
    use posewire_natnet::Value;
    let explanation = posewire_natnet::explain(version, data);
    if data.starts_with(MXTP) {
        return Err(refused("NatNet", &"it begins with \"MXTP\"", "leave protocol= out"));
    }
    if let Some(error) = explanation.error {
        return Err(refused("NatNet", &error, &help_with(data, version)));
    }
    let py = decoded.py();
    let counts = explanation
        .fields
        .iter()
        .filter(|field| matches!(field.value, Value::Signed(_)));
    let lists = Lists::of(counts.map(|field| field.name.as_str()));
    for field in &explanation.fields {
        let value = match &field.value {
            Value::Unsigned(number) => number.into_pyobject(py)?.into_any(),
            Value::Signed(number) => number.into_pyobject(py)?.into_any(),
            Value::Float(number) => number.into_pyobject(py)?.into_any(),
            Value::Double(number) => number.into_pyobject(py)?.into_any(),
            Value::Text(text) => text.into_pyobject(py)?.into_any(),
            Value::Bytes(_) => field.value.to_string().into_pyobject(py)?.into_any(),
        };
        lists.put(decoded, &field.name, value)?;
        if field.name == "message" {
            decoded.set_item(
                "message_name",
                Packet::decode(data).map_or("", |packet| packet.id.name()),
            )?;
        }
    }
    let quirks: Vec<_> = explanation.quirks.iter().map(|quirk| quirk.to_string()).collect();
    decoded.set_item("quirks", quirks)
}

fn natnet_version(text: &str) -> PyResult<Version> {
    let parts = text.split_once('.');
    let number = |part: &str| part.parse::<u8>().ok();
    let version = parts.and_then(|(major, minor)| Some(Version::new(number(major)?, number(minor)?)));
    version.filter(|version| version.is_known()).ok_or_else(|| {
        usage(
            format!("expected a version of NatNet from 1.4 to 4.5, found {text:?}"),
            "as in version=\"3.1\"",
        )
    })
}

/// What to do about a packet that was read as one of a version.
fn help_with(data: &[u8], version: Version) -> String {
    let whose = match Packet::decode(data).map(|packet| packet.id) {
        Ok(MessageId::FRAME) => "a frame does not say its version: this is not one",
        Ok(MessageId::MODEL) => "descriptions do not say their version: these are not",
        _ => return "posewire explain shows the bytes as far as they make sense".to_owned(),
    };
    format!("{whose} of {version}, or cut off")
}

fn refused(protocol: &str, error: &dyn std::fmt::Display, help: &str) -> PyErr {
    exception(
        "DecodeError",
        format!("no datagram of {protocol}: {error}"),
        Some(help.to_owned()),
    )
}

/// Which names of a packet's fields are those of counted lists.
struct Lists<'a> {
    names: HashSet<&'a str>,
}

impl<'a> Lists<'a> {
    /// Those that have a count, without those that have bytes instead of entries.
    fn of(paths: impl Iterator<Item = &'a str>) -> Self {
        let counted = paths.filter_map(|path| path.strip_suffix(".count"));
        let names = counted.filter(|name| !["imu", "gpio"].contains(name) && !name.starts_with("later_sections["));
        Self { names: names.collect() }
    }

    /// Puts a value where its path says. Beside the list `bodies` the count of its entries, `bodies.count`, is
    /// `bodies_count`; that of a list in a list is what Python says it is.
    fn put(&self, root: &Bound<'_, PyDict>, path: &str, value: Bound<'_, PyAny>) -> PyResult<()> {
        let Some((list, what)) = path.rsplit_once('.').filter(|(list, _)| self.names.contains(list)) else {
            return put(root, path, value);
        };
        if !list.ends_with(']') {
            put(root, &format!("{list}_{what}"), value)?;
        }
        if what == "count" {
            place(root, list, true)?;
        }
        Ok(())
    }
}

/// Puts a value where its dotted path says: `segments[0].position.x`.
fn put(root: &Bound<'_, PyDict>, path: &str, value: Bound<'_, PyAny>) -> PyResult<()> {
    let (last, above) = last_step(path);
    let place = place(root, above, matches!(last, Step::Number(_)))?;
    last.set(&place, value)
}

/// The dict or the list that a path leads to, made if it is not there.
fn place<'py>(root: &Bound<'py, PyDict>, path: &str, list: bool) -> PyResult<Bound<'py, PyAny>> {
    if path.is_empty() {
        return Ok(root.as_any().clone());
    }
    let (last, above) = last_step(path);
    let place = place(root, above, matches!(last, Step::Number(_)))?;
    within(&place, last, list)
}

/// What a place has at a step: a dict or a list, made if it is not there.
fn within<'py>(place: &Bound<'py, PyAny>, step: Step<'_>, list: bool) -> PyResult<Bound<'py, PyAny>> {
    let py = place.py();
    if let Some(there) = step.look(place)? {
        return Ok(there);
    }
    let made = if list {
        PyList::empty(py).into_any()
    } else {
        PyDict::new(py).into_any()
    };
    step.set(place, made.clone())?;
    Ok(made)
}

/// A part of a path.
#[derive(Clone, Copy)]
enum Step<'a> {
    Name(&'a str),
    Number(usize),
}

/// The last part of a path and what is before it: of `segments[3]`, number 3 and `segments`.
fn last_step(path: &str) -> (Step<'_>, &str) {
    let indexed = path.strip_suffix(']').and_then(|path| path.rsplit_once('['));
    if let Some((list, number)) = indexed
        && let Ok(number) = number.parse()
    {
        return (Step::Number(number), list);
    }
    let (above, name) = path.rsplit_once('.').unwrap_or(("", path));
    (Step::Name(name), above)
}

impl Step<'_> {
    fn look<'py>(self, place: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
        match self {
            Self::Name(name) => place.cast::<PyDict>()?.get_item(name),
            Self::Number(number) => Ok(place.cast::<PyList>()?.get_item(number).ok()),
        }
    }

    fn set(self, place: &Bound<'_, PyAny>, value: Bound<'_, PyAny>) -> PyResult<()> {
        match self {
            Self::Name(name) => place.cast::<PyDict>()?.set_item(name, value),
            Self::Number(_) => place.cast::<PyList>()?.append(value),
        }
    }
}

/// That of frames and descriptions of which no version is said.
const USUAL_VERSION: Version = Version::new(4, 1);
/// How MXTP begins.
const MXTP: &[u8] = b"MXTP";

//! Datagrams as dicts.

use crate::error::{exception, usage};
use posewire_natnet::Version;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use std::borrow::Cow;
use std::collections::HashSet;

/// What the bytes of one datagram of MXTP or NatNet say, field by field, as dicts and lists.
///
/// Fields have the names, the units and the axes of the wire, as `posewire explain` shows them; nothing is translated. Beside them
/// stand "protocol" ("mxtp" or "natnet") and "quirks", how it deviates from the specification. `protocol` is told by the bytes if
/// left out; a NatNet frame does not say its `version`.
///
/// Raises DecodeError for what is no datagram.
#[pyfunction]
#[pyo3(signature = (data, protocol = None, version = "4.1"))]
pub(crate) fn decode<'py>(
    py: Python<'py>,
    data: &[u8],
    protocol: Option<&str>,
    version: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let protocol = protocol.unwrap_or(if data.starts_with(b"MXTP") { "mxtp" } else { "natnet" });
    let decoded = PyDict::new(py);
    decoded.set_item("protocol", protocol)?;
    match protocol {
        "mxtp" => mxtp(&decoded, data)?,
        "natnet" => natnet(&decoded, data, version)?,
        found => {
            return Err(usage(
                format!("there is no protocol {found:?}"),
                "use \"mxtp\" or \"natnet\"",
            ));
        }
    }
    Ok(decoded)
}

fn mxtp(decoded: &Bound<'_, PyDict>, data: &[u8]) -> PyResult<()> {
    use posewire_mxtp::Value;
    let explanation = posewire_mxtp::explain(data);
    if let Some(error) = explanation.error {
        return Err(refused("MXTP", &error));
    }
    let py = decoded.py();
    let names = Names::of(explanation.fields.iter().map(|field| field.name.as_str()));
    for field in &explanation.fields {
        let value = match &field.value {
            Value::Unsigned(number) => number.into_pyobject(py)?.into_any(),
            Value::Signed(number) => number.into_pyobject(py)?.into_any(),
            Value::Float(number) => number.into_pyobject(py)?.into_any(),
            Value::Text(text) => text.into_pyobject(py)?.into_any(),
            Value::Bytes(bytes) => PyBytes::new(py, bytes).into_any(),
        };
        put(decoded, &names.apart(&field.name), value)?;
    }
    let quirks: Vec<_> = explanation.quirks.iter().map(|quirk| quirk.to_string()).collect();
    decoded.set_item("quirks", quirks)
}

fn natnet(decoded: &Bound<'_, PyDict>, data: &[u8], version: &str) -> PyResult<()> {
    use posewire_natnet::Value;
    let explanation = posewire_natnet::explain(natnet_version(version)?, data);
    if let Some(error) = explanation.error {
        return Err(refused("NatNet", &error));
    }
    let py = decoded.py();
    let names = Names::of(explanation.fields.iter().map(|field| field.name.as_str()));
    for field in &explanation.fields {
        let value = match &field.value {
            Value::Unsigned(number) => number.into_pyobject(py)?.into_any(),
            Value::Signed(number) => number.into_pyobject(py)?.into_any(),
            Value::Float(number) => number.into_pyobject(py)?.into_any(),
            Value::Double(number) => number.into_pyobject(py)?.into_any(),
            Value::Text(text) => text.into_pyobject(py)?.into_any(),
            Value::Bytes(bytes) => PyBytes::new(py, bytes).into_any(),
        };
        put(decoded, &names.apart(&field.name), value)?;
    }
    let quirks: Vec<_> = explanation.quirks.iter().map(|quirk| quirk.to_string()).collect();
    decoded.set_item("quirks", quirks)
}

fn natnet_version(text: &str) -> PyResult<Version> {
    let parts = text.split_once('.');
    let number = |part: &str| part.parse::<u8>().ok();
    let version = parts.and_then(|(major, minor)| Some(Version::new(number(major)?, number(minor)?)));
    version.ok_or_else(|| {
        usage(
            format!("expected a version of NatNet, found {text:?}"),
            "as in version=\"3.1\"",
        )
    })
}

fn refused(protocol: &str, error: &dyn std::fmt::Display) -> PyErr {
    let help = "posewire explain shows the bytes as far as they make sense";
    exception(
        "DecodeError",
        format!("no datagram of {protocol}: {error}"),
        Some(help.to_owned()),
    )
}

/// Which names of a datagram's fields are those of lists.
struct Names<'a> {
    lists: HashSet<&'a str>,
}

impl<'a> Names<'a> {
    fn of(paths: impl Iterator<Item = &'a str>) -> Self {
        let lists = paths.flat_map(|path| path.match_indices('[').map(move |(end, _)| &path[..end]));
        Self { lists: lists.collect() }
    }

    /// A path on which no name is that of a list and of something else: beside `rigid_bodies[0].id`, `rigid_bodies.count` is
    /// `rigid_bodies_count`.
    fn apart<'p>(&self, path: &'p str) -> Cow<'p, str> {
        let dots = path.match_indices('.').map(|(dot, _)| dot);
        let shared = dots.filter(|dot| self.lists.contains(&path[..*dot]));
        shared.fold(Cow::Borrowed(path), |mut path, dot| {
            path.to_mut().replace_range(dot..=dot, "_");
            path
        })
    }
}

/// Puts a value where its dotted path says: `segments[0].position.x`.
fn put(root: &Bound<'_, PyDict>, path: &str, value: Bound<'_, PyAny>) -> PyResult<()> {
    let mut place = root.clone();
    let mut rest = path;
    while let Some((part, after)) = rest.split_once('.') {
        place = entered(&place, part)?;
        rest = after;
    }
    match in_list(rest) {
        None => place.set_item(rest, value),
        Some((name, _)) => list(&place, name)?.append(value),
    }
}

/// The dict that a part of a path leads to, made if it is not there.
fn entered<'py>(place: &Bound<'py, PyDict>, part: &str) -> PyResult<Bound<'py, PyDict>> {
    let made = PyDict::new(place.py());
    let Some((name, number)) = in_list(part) else {
        if let Some(there) = place.get_item(part)? {
            return Ok(there.cast_into()?);
        }
        place.set_item(part, &made)?;
        return Ok(made);
    };
    let list = list(place, name)?;
    if let Ok(there) = list.get_item(number) {
        return Ok(there.cast_into()?);
    }
    list.append(&made)?;
    Ok(made)
}

/// `segments[3]` is number 3 of the list segments.
fn in_list(part: &str) -> Option<(&str, usize)> {
    let (name, number) = part.strip_suffix(']')?.split_once('[')?;
    Some((name, number.parse().ok()?))
}

fn list<'py>(place: &Bound<'py, PyDict>, name: &str) -> PyResult<Bound<'py, PyList>> {
    if let Some(there) = place.get_item(name)? {
        return Ok(there.cast_into()?);
    }
    let made = PyList::empty(place.py());
    place.set_item(name, &made)?;
    Ok(made)
}

//! glTF 2.0: a figure of bones that any viewer shows and animates, Y up, metres.
//!
//! | node | |
//! |---|---|
//! | one for each segment, with its name and below its parent | a bone of the skin, at rest in the null pose |
//! | one with the subject's name | stands over those that have no parent |
//! | `Figure` | the mesh, which the skin moves |
//!
//! There is one animation with the subject's name: for each segment a rotation against its parent and, because measured
//! segments are not rigidly linked, a translation. Where a segment is not tracked it has no keyframes, and viewers draw a
//! line between those before and after.

mod buffer;
mod figure;
mod motion;
mod rest;

use super::output::Output;
use super::problem::Problem;
use super::{Job, LeftOut};
use crate::endpoint::FileFormat;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use buffer::Buffer;
use posewire_motion::{Color, Section};
use rest::Rest;
use serde_json::{Value, json};
use std::io::{self, Write};

/// Writes the figure and its motion: in one binary file as [`FileFormat::Glb`], else as JSON with the numbers in it as Base64.
///
/// # Errors
/// When the take has no segments or its rate is not above 0, when a binary file would have 4 GiB or more, and when `out`
/// fails.
pub(super) fn write(job: &Job<'_>, format: FileFormat, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let take = job.take;
    if take.subject.skeleton.segments.is_empty() {
        return Err(Problem::lacks(format, "segments"));
    }
    job.rate(format)?;
    let mut buffer = Buffer::new();
    let mut document = document(job, &mut buffer)?;
    let (bytes, views, accessors) = buffer.finish();
    document["bufferViews"] = views;
    document["accessors"] = accessors;
    if format == FileFormat::Glb {
        write_binary(document, bytes, out)?;
    } else {
        write_json(document, &bytes, out)?;
    }
    Ok(left_out(job))
}

fn document(job: &Job<'_>, buffer: &mut Buffer) -> Result<Value, Problem> {
    let subject = &job.take.subject;
    let segments = &subject.skeleton.segments;
    let rest = Rest::of(job);
    let (root, figure) = (segments.len(), segments.len() + 1);
    let mut nodes: Vec<Value> = segments
        .iter()
        .enumerate()
        .map(|(place, segment)| node(&segment.name, &rest.children(Some(place)), Some(rest.offset(place))))
        .collect();
    nodes.push(node(&subject.name, &rest.children(None), None));
    nodes.push(json!({"name": "Figure", "mesh": 0, "skin": 0}));
    let mut document = json!({
        "asset": {"version": "2.0", "generator": concat!("posewire ", env!("CARGO_PKG_VERSION"))},
        "scene": 0,
        "scenes": [{"nodes": [root, figure]}],
        "nodes": nodes,
        "meshes": [figure::mesh(&subject.skeleton, &rest, buffer)],
        "skins": [{
            "joints": (0..segments.len()).collect::<Vec<_>>(),
            "skeleton": root,
            "inverseBindMatrices": figure::inverse_bind_matrices(&rest, segments.len(), buffer),
        }],
        "materials": [material(subject.color)],
    });
    // An animation must have a channel.
    if let Some(animation) = motion::animation(job, &rest, buffer)? {
        document["animations"] = json!([animation]);
    }
    Ok(document)
}

/// Lists may not be empty in glTF, nor names.
fn node(name: &str, children: &[usize], translation: Option<[f32; 3]>) -> Value {
    let mut node = json!({});
    if !name.is_empty() {
        node["name"] = json!(name);
    }
    if !children.is_empty() {
        node["children"] = json!(children);
    }
    if let Some(translation) = translation {
        node["translation"] = json!(translation);
    }
    node
}

fn material(color: Option<Color>) -> Value {
    let color = color.unwrap_or(Color([0x4c, 0x8b, 0xf5]));
    let [red, green, blue] = color.0.map(|part| (f64::from(part) / 255.0).powf(2.2));
    json!({
        "name": "Bones",
        "pbrMetallicRoughness": {"baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6},
    })
}

/// A header of 12 bytes, then two chunks: JSON filled with spaces, and the buffer filled with zeros.
fn write_binary(mut document: Value, mut bytes: Vec<u8>, out: &mut Output<'_>) -> io::Result<()> {
    document["buffers"] = json!([{"byteLength": bytes.len()}]);
    let mut text = serde_json::to_vec(&document)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let total = HEADER + 2 * CHUNK_HEADER + text.len() + bytes.len();
    let total = u32::try_from(total).map_err(|_| {
        let message = format!("a GLB file has less than 4 GiB, this take needs {total} bytes");
        io::Error::new(io::ErrorKind::InvalidInput, message)
    })?;
    out.write_all(b"glTF")?;
    for number in [2, total, text.len() as u32] {
        out.write_all(&number.to_le_bytes())?;
    }
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    out.write_all(&(bytes.len() as u32).to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    out.write_all(&bytes)
}

fn write_json(mut document: Value, bytes: &[u8], out: &mut Output<'_>) -> io::Result<()> {
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes));
    document["buffers"] = json!([{"byteLength": bytes.len(), "uri": uri}]);
    serde_json::to_writer(out, &document)?;
    Ok(())
}

fn left_out(job: &Job<'_>) -> LeftOut {
    let mut left_out = LeftOut::new();
    let has = |section| job.sections().any(|wanted| wanted == section);
    if !has(Section::Orientation) && has(Section::Position) {
        left_out.push("how segments are turned, which needs orientations");
    }
    if has(Section::Orientation) && !has(Section::Position) {
        left_out.push("where segments are, which needs positions");
    }
    left_out
}

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

//! Types 12 and 13: who is captured (MV0305 2.6).

use super::convert::vector_to_wire;
use super::lacks::{null_pose_lacks, null_pose_length};
use super::message::{MAX_DATAGRAM, write_body};
use super::{Datagrams, EncoderOptions};
use crate::body::{Body, Meta, SCALE_POINT_MIN, ScaleBuffer, ScalePoint, push_tag};
use crate::{DatagramCounter, Header};
use posewire_motion::{Color, Skeleton, Subject};

/// Memory that is used again for each description.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    text: String,
    scale: ScaleBuffer,
}

/// Appends the meta data: one datagram. A tag that does not fit any more is left out.
pub(super) fn write_meta(
    scratch: &mut Scratch,
    options: &EncoderOptions,
    header: Header,
    subject: &Subject,
    out: &mut Datagrams,
) {
    let text = &mut scratch.text;
    text.clear();
    push_tag(text, COLOR, &subject.color.unwrap_or(DEFAULT_COLOR).to_string());
    push_tag(text, COUNT, &options.characters.to_string());
    push_tag(text, NAME, clipped(&subject.name, MAX_NAME));
    push_tag(text, TIME_OFFSET, &options.time_offset_ms.to_string());
    let mut others: Vec<_> = subject.tags.iter().filter(|(tag, _)| is_sendable(tag)).collect();
    others.sort_by_key(|(tag, _)| tag);
    for (tag, value) in others {
        if text.len() + tag.len() + value.len() + SEPARATORS <= MAX_TEXT {
            push_tag(text, tag, value);
        }
    }
    write_body(out, header, Body::Meta(Meta::new(text)));
}

/// Appends the null pose, then the points in as many datagrams as they need; nothing when the null pose is not known.
///
/// The null pose always has counter 0, because a client ignores it otherwise, and something must end the sequence: where
/// there are no points, an empty datagram does.
pub(super) fn write_scale(
    scratch: &mut Scratch,
    limit: usize,
    header: Header,
    skeleton: &Skeleton,
    out: &mut Datagrams,
) {
    if null_pose_lacks(skeleton).is_some() {
        return;
    }
    write_null_pose(&mut scratch.scale, header, skeleton, out);
    let mut index = 1;
    let limit = limit.min(MAX_DATAGRAM);
    let buffer = &mut scratch.scale;
    buffer.clear();
    let most = per_datagram(skeleton);
    for point in points(skeleton) {
        let scale = buffer.as_scale();
        let full = scale.point_count() == most
            || Header::SIZE + scale.size() + SCALE_POINT_MIN + point.name.as_bytes().len() > limit;
        if full && scale.point_count() > 0 && index < LAST_INDEX {
            write_points(buffer, header, DatagramCounter::part(index, false), out);
            index += 1;
        }
        buffer.push_point(&point);
    }
    write_points(buffer, header, DatagramCounter::part(index, true), out);
}

fn write_null_pose(buffer: &mut ScaleBuffer, header: Header, skeleton: &Skeleton, out: &mut Datagrams) {
    buffer.clear();
    for segment in skeleton.segments.iter().take(null_pose_length(skeleton)) {
        let origin = segment.origin.unwrap_or_default();
        buffer.push_segment(&segment.name, vector_to_wire(origin));
    }
    let header = header.with_counter(DatagramCounter::part(0, false));
    write_body(out, header, Body::Scale(buffer.as_scale()));
}

fn write_points(buffer: &mut ScaleBuffer, header: Header, counter: DatagramCounter, out: &mut Datagrams) {
    write_body(out, header.with_counter(counter), Body::Scale(buffer.as_scale()));
    buffer.clear();
}

/// All points, segment by segment.
fn points(skeleton: &Skeleton) -> impl Iterator<Item = ScalePoint<'_>> {
    skeleton.segments.iter().zip(1..=u16::MAX).flat_map(|(segment, id)| {
        segment.points.iter().map(move |point| ScalePoint {
            segment: id,
            local: point.id,
            name: point.name.as_str().into(),
            flags: point.flags,
            position: vector_to_wire(point.offset),
        })
    })
}

/// Points in a datagram: a full body's come in five datagrams, which is what MVN sends, unless there are very many.
fn per_datagram(skeleton: &Skeleton) -> usize {
    points(skeleton)
        .count()
        .div_ceil(usize::from(LAST_INDEX))
        .max(POINTS_PER_DATAGRAM)
}

/// Whether a tag can stand on a line of its own and is not one of those that are always sent.
fn is_sendable(tag: &str) -> bool {
    let own = [COLOR, COUNT, NAME, TIME_OFFSET].contains(&tag);
    !own && !tag.is_empty() && !tag.contains([':', '\n', '\r'])
}

/// As much of the text as fits into so many bytes.
fn clipped(text: &str, most: usize) -> &str {
    &text[..text.floor_char_boundary(most)]
}

const COLOR: &str = "color";
const COUNT: &str = "count";
const NAME: &str = "name";
const TIME_OFFSET: &str = "timeOffset";

/// Sent for a subject without a colour, as clients expect one.
const DEFAULT_COLOR: Color = Color([0x80; 3]);
/// The colon and the line feed of a tag's line.
const SEPARATORS: usize = 2;
const MAX_NAME: usize = 1024;
/// The text of the meta data, after the header and the text's own length.
const MAX_TEXT: usize = MAX_DATAGRAM - Header::SIZE - 4;

const POINTS_PER_DATAGRAM: usize = 26;
/// The largest number of a datagram in a sequence.
const LAST_INDEX: u8 = 127;

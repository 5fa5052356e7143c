//! The binary messages that a page gets: records of subjects, and series of numbers.
//!
//! Little endian throughout, every record a multiple of 4 bytes long. Values are canonical (metres, X forward, Y left, Z
//! up, quaternions w, x, y, z) as `f32`, which is what the wires had; NaN is what was not tracked or not sent.
//!
//! A tick, kind 1:
//!
//! | bytes | is |
//! |---|---|
//! | 0 | 1 |
//! | 1 | version, 1 |
//! | 2-3 | records that follow, `u16` |
//! | 4-7 | number of the tick, `u32` |
//! | 8-15 | the server's clock, s, `f64` |
//!
//! A record of a subject:
//!
//! | bytes | is |
//! |---|---|
//! | 0-3 | length of the record with this, `u32` |
//! | 4-7 | the subject's number on the page, `u32` |
//! | 8-11 | sample, `u32` |
//! | 12-15 | contacts, a bit each, `u32` |
//! | 16-23 | the source's clock, s, `f64` |
//! | 24-27 | age, s since it arrived, `f32`; 0 in takes |
//! | 28-31 | timecode, ms of the day, `u32`; 4294967295 for none |
//! | 32 | 0 live, 1 stale, 2 lost |
//! | 33 | [`flags`] |
//! | 34-35 | segments S, `u16` |
//! | 36-37 | markers M, `u16` |
//! | 38-39 | 0 |
//! | 40- | `f32`: position 3S, orientation 4S, centre of mass 3, markers 3M |
//!
//! A series, kind 2:
//!
//! | bytes | is |
//! |---|---|
//! | 0 | 2 |
//! | 1 | version, 1 |
//! | 2-3 | the page's number of the channel, `u16` |
//! | 4-7 | values n, `u32` |
//! | 8- | the source's clock, s, `f64` x n, then the values, `f32` x n |

use posewire_motion::kinematics::{center_of_mass, segment_positions};
use posewire_motion::standard::MAX_PROPS;
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Timecode};
use std::borrow::Cow;
use std::sync::LazyLock;

/// What a record's flags say.
pub(crate) mod flags {
    /// Positions were sent.
    pub(crate) const POSITIONS: u8 = 1;
    /// Orientations were sent.
    pub(crate) const ORIENTATIONS: u8 = 2;
    /// Positions are computed from the orientations, with the root in place.
    pub(crate) const IN_PLACE: u8 = 4;
    /// The centre of mass is an estimate that was made here.
    pub(crate) const ESTIMATED_CENTER: u8 = 8;
    /// It is known which contacts touch the ground.
    pub(crate) const CONTACTS: u8 = 16;
}

/// Whether samples of a subject come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum State {
    /// They come.
    #[default]
    Live = 0,
    /// None has come for longer than its rate explains.
    Stale = 1,
    /// None has come for three seconds.
    Lost = 2,
}

/// The bytes before the records of a tick.
pub(crate) const TICK_HEAD: usize = 16;

/// Begins a tick in an empty buffer. The records follow; [`set_count`] says how many they are.
pub(crate) fn begin_tick(tick: u32, clock_s: f64, out: &mut Vec<u8>) {
    out.extend([1, VERSION, 0, 0]);
    out.extend(tick.to_le_bytes());
    out.extend(clock_s.to_le_bytes());
}

/// Says how many records a tick has.
pub(crate) fn set_count(message: &mut [u8], records: u16) {
    message[2..4].copy_from_slice(&records.to_le_bytes());
}

/// Appends the record of a frame, live and of age 0, of the subject that the page knows by `id`.
pub(crate) fn write_record(id: u32, frame: &Frame, out: &mut Vec<u8>) {
    let start = out.len();
    let body = Body::of(frame);
    let markers = frame.markers.len().min(usize::from(u16::MAX));
    out.extend([0; 4]);
    out.extend(id.to_le_bytes());
    out.extend(frame.sample.to_le_bytes());
    out.extend(contact_bits(&frame.contacts).to_le_bytes());
    out.extend(frame.time.as_secs_f64().to_le_bytes());
    out.extend(0_f32.to_le_bytes());
    let timecode = frame.timecode.map_or(NO_TIMECODE, Timecode::milliseconds);
    out.extend(timecode.to_le_bytes());
    out.extend([State::Live as u8, body.flags]);
    out.extend((body.segments as u16).to_le_bytes());
    out.extend((markers as u16).to_le_bytes());
    out.extend([0; 2]);
    let positions = body.computed.as_deref().unwrap_or(&frame.position);
    write_vectors(positions, body.segments, out);
    write_quaternions(&frame.orientation, body.segments, out);
    write_vector(body.center, out);
    for marker in &frame.markers[..markers] {
        write_vector(marker.position, out);
    }
    let length = (out.len() - start) as u32;
    out[start..start + 4].copy_from_slice(&length.to_le_bytes());
}

/// Gives a record its age, s, and its state.
pub(crate) fn set_age(record: &mut [u8], age_s: f32, state: State) {
    record[24..28].copy_from_slice(&age_s.to_le_bytes());
    record[32] = state as u8;
}

/// A series message of the page's channel `id`.
pub(crate) fn series(id: u16, times_s: &[f64], values: &[f32]) -> Vec<u8> {
    let count = times_s.len().min(values.len());
    let mut out = Vec::with_capacity(8 + count * 12);
    out.extend([2, VERSION]);
    out.extend(id.to_le_bytes());
    out.extend((count as u32).to_le_bytes());
    out.extend(times_s[..count].iter().flat_map(|time| time.to_le_bytes()));
    out.extend(values[..count].iter().flat_map(|value| value.to_le_bytes()));
    out
}

/// What a record has besides what stands in its frame.
struct Body {
    segments: usize,
    flags: u8,
    /// Positions of a frame that has none.
    computed: Option<Vec<Option<DVec3>>>,
    center: Option<DVec3>,
}

impl Body {
    fn of(frame: &Frame) -> Self {
        let skeleton = &frame.subject.skeleton;
        let has = |is_there: bool, flag: u8| if is_there { flag } else { 0 };
        let positions = !frame.position.is_empty();
        let orientations = !frame.orientation.is_empty();
        let mut flags = has(positions, flags::POSITIONS)
            | has(orientations, flags::ORIENTATIONS)
            | has(!frame.contacts.is_empty(), flags::CONTACTS);
        let computed = (orientations && !positions).then(|| in_place(frame));
        flags |= has(computed.is_some(), flags::IN_PLACE);
        let told = frame.center_of_mass.map(|center| center.position);
        let estimate = || center_of_mass(skeleton, &frame.position, &frame.orientation);
        let center = told.or_else(|| (positions && orientations).then(estimate).flatten());
        flags |= has(told.is_none() && center.is_some(), flags::ESTIMATED_CENTER);
        Self {
            segments: skeleton.segments.len().min(usize::from(u16::MAX)),
            flags,
            computed,
            center,
        }
    }
}

/// Where the segments are of a body whose root stays where it is in the null pose.
fn in_place(frame: &Frame) -> Vec<Option<DVec3>> {
    let skeleton = with_sizes(&frame.subject.skeleton);
    let root = skeleton.segments.first().and_then(|segment| segment.origin);
    let mut positions = Vec::new();
    segment_positions(&skeleton, root.unwrap_or_default(), &frame.orientation, &mut positions);
    positions
}

/// The skeleton, or one with the sizes of a nominal adult when nothing has told any.
fn with_sizes(skeleton: &Skeleton) -> Cow<'_, Skeleton> {
    static NOMINAL: LazyLock<Skeleton> = LazyLock::new(|| Skeleton::standard(MAX_PROPS, true));
    if skeleton.segments.iter().any(|segment| segment.origin.is_some()) {
        return Cow::Borrowed(skeleton);
    }
    let mut sized = skeleton.clone();
    for segment in &mut sized.segments {
        let nominal = NOMINAL.segment(&segment.name);
        segment.origin = nominal.and_then(|place| NOMINAL.segments[place].origin);
    }
    Cow::Owned(sized)
}

fn contact_bits(contacts: &[bool]) -> u32 {
    let set = contacts.iter().take(32).enumerate().filter(|(_, touches)| **touches);
    set.fold(0, |bits, (place, _)| bits | 1 << place)
}

/// As many vectors as there are segments, whatever the list has.
fn write_vectors(list: &[Option<DVec3>], count: usize, out: &mut Vec<u8>) {
    for place in 0..count {
        write_vector(list.get(place).copied().flatten(), out);
    }
}

fn write_vector(vector: Option<DVec3>, out: &mut Vec<u8>) {
    let vector = vector.unwrap_or(DVec3::NAN).as_vec3();
    out.extend(vector.to_array().into_iter().flat_map(f32::to_le_bytes));
}

fn write_quaternions(list: &[Option<DQuat>], count: usize, out: &mut Vec<u8>) {
    for place in 0..count {
        let quaternion = list.get(place).copied().flatten();
        let wxyz = quaternion.map_or([f64::NAN; 4], |q| [q.w, q.x, q.y, q.z]);
        out.extend(wxyz.into_iter().flat_map(|value| (value as f32).to_le_bytes()));
    }
}

const VERSION: u8 = 1;
const NO_TIMECODE: u32 = u32::MAX;

#[cfg(test)]
mod tests;

//! Type 23: motion trackers (MV0305 2.7.4).

use super::convert::{quaternion, quaternion_to_wire, vector, vector_to_wire};
use super::decode::slots;
use crate::body::{ShortTracker, Tracker};
use crate::ids::SegmentId;
use crate::{Quirk, Quirks};
use posewire_motion::{DQuat, DVec3, Frame};

/// Writes records of 68 bytes into the frame.
pub(super) fn fill(frame: &mut Frame, items: &[Tracker], first: Option<usize>) -> Quirks {
    let (places, quirks) = Places::new(frame, items, Tracker::id, first);
    places.write(&mut frame.sensor_orientation, |item| quaternion(item.orientation()));
    places.write(&mut frame.sensor_free_acceleration, |item| {
        vector(item.free_acceleration())
    });
    places.write(&mut frame.sensor_acceleration, |item| vector(item.acceleration()));
    places.write(&mut frame.sensor_angular_velocity, |item| {
        vector(item.angular_velocity())
    });
    places.write(&mut frame.sensor_magnetic_field, |item| vector(item.magnetic_field()));
    quirks
}

/// Writes records of 44 bytes into the frame.
pub(super) fn fill_short(frame: &mut Frame, items: &[ShortTracker], first: Option<usize>) -> Quirks {
    let (places, quirks) = Places::new(frame, items, ShortTracker::id, first);
    places.write(&mut frame.sensor_orientation, |item| quaternion(item.orientation()));
    places.write(&mut frame.sensor_free_acceleration, |item| {
        vector(item.free_acceleration())
    });
    places.write(&mut frame.sensor_magnetic_field, |item| vector(item.magnetic_field()));
    quirks
}

/// Whether a frame has all that the records of 68 bytes hold.
pub(super) fn has_inertial_data(frame: &Frame) -> bool {
    !frame.sensor_acceleration.is_empty() && !frame.sensor_angular_velocity.is_empty()
}

/// The records of 68 bytes of the sensors that are known in full.
pub(super) fn records(frame: &Frame) -> impl Iterator<Item = Tracker> {
    (0..frame.subject.skeleton.sensors.len()).filter_map(|sensor| {
        let (id, orientation, free_acceleration, magnetic_field) = common(frame, sensor)?;
        let acceleration = entry(&frame.sensor_acceleration, sensor)?;
        let angular_velocity = entry(&frame.sensor_angular_velocity, sensor)?;
        let tracker = Tracker::new(id, quaternion_to_wire(orientation))
            .with_free_acceleration(vector_to_wire(free_acceleration))
            .with_acceleration(vector_to_wire(acceleration))
            .with_angular_velocity(vector_to_wire(angular_velocity))
            .with_magnetic_field(vector_to_wire(magnetic_field));
        Some(tracker)
    })
}

/// The records of 44 bytes.
pub(super) fn short_records(frame: &Frame) -> impl Iterator<Item = ShortTracker> {
    (0..frame.subject.skeleton.sensors.len()).filter_map(|sensor| {
        let (id, orientation, free_acceleration, magnetic_field) = common(frame, sensor)?;
        let (free, magnetic) = (vector_to_wire(free_acceleration), vector_to_wire(magnetic_field));
        Some(ShortTracker::new(id, quaternion_to_wire(orientation), free, magnetic))
    })
}

/// What both forms hold: segment, orientation, free acceleration and magnetic field.
fn common(frame: &Frame, sensor: usize) -> Option<(SegmentId, DQuat, DVec3, DVec3)> {
    let segment = frame.subject.skeleton.sensors.get(sensor)?;
    Some((
        SegmentId(*segment as u32 + 1),
        entry(&frame.sensor_orientation, sensor)?,
        entry(&frame.sensor_free_acceleration, sensor)?,
        entry(&frame.sensor_magnetic_field, sensor)?,
    ))
}

fn entry<V: Copy>(section: &[Option<V>], sensor: usize) -> Option<V> {
    section.get(sensor).copied().flatten()
}

/// Where the records of a datagram belong among the sensors.
struct Places<'a, T> {
    items: &'a [T],
    /// For each record the place of its sensor, as far as there are records.
    sensors: [Option<u16>; MOST],
    count: usize,
}

/// More trackers than any datagram can hold items.
const MOST: usize = 255;

impl<'a, T> Places<'a, T> {
    /// By segment ID, counted from 1 or, when 0 is among them, from 0. Where these are unknown and there is a record for
    /// every sensor, by position.
    fn new(frame: &Frame, items: &'a [T], id: fn(&T) -> SegmentId, first: Option<usize>) -> (Self, Quirks) {
        let worn = &frame.subject.skeleton.sensors;
        let items = &items[..items.len().min(MOST)];
        let from_zero = items.iter().any(|item| id(item).0 == 0);
        let base = u32::from(!from_zero);
        let mut places = Self {
            items,
            sensors: [None; MOST],
            count: worn.len(),
        };
        for (position, item) in items.iter().enumerate() {
            let segment = id(item).0.wrapping_sub(base) as usize;
            places.sensors[position] = place_of(worn, segment, position);
        }
        let unknown = places.sensors[..items.len()].iter().any(Option::is_none);
        if unknown && first == Some(0) && items.len() == worn.len() {
            places.sensors = std::array::from_fn(|position| u16::try_from(position).ok());
        }
        let mut quirks = Quirks::NONE;
        quirks.insert_if(unknown, Quirk::TrackerId);
        quirks.insert_if(from_zero, Quirk::SegmentIdsFromZero);
        (places, quirks)
    }

    fn write<V: Copy>(&self, section: &mut Vec<Option<V>>, value: impl Fn(&T) -> V) {
        let slots = slots(section, self.count);
        for (item, sensor) in self.items.iter().zip(self.sensors) {
            if let Some(slot) = sensor.and_then(|sensor| slots.get_mut(usize::from(sensor))) {
                *slot = Some(value(item));
            }
        }
    }
}

/// The place of the sensor on a segment; mostly the record's position.
fn place_of(worn: &[usize], segment: usize, position: usize) -> Option<u16> {
    let found = match worn.get(position) {
        Some(expected) if *expected == segment => Some(position),
        _ => worn.iter().position(|worn| *worn == segment),
    };
    found.and_then(|place| u16::try_from(place).ok())
}

//! What lies between two samples.

use crate::kinematics::{ergonomic_angles, joint_angles};
use crate::rotation::{Sequence, slerp};
use crate::{CenterOfMass, Frame, Marker, Skeleton, Subject, Timecode};
use glam::{DQuat, DVec3};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The sample at `share` of the way from `a` (0) to `b` (1), without events.
///
/// Angles are those of the orientations between, interpolated where the orientations do not tell them.
pub(super) fn between(a: &Frame, b: &Frame, share: f64, subject: Arc<Subject>) -> Frame {
    let near = if share < 0.5 { a } else { b };
    let vectors = |a: &[Option<DVec3>], b: &[Option<DVec3>]| entries(a, b, |a, b| Some(a.lerp(b, share)));
    let angles = |a: &[Option<DVec3>], b: &[Option<DVec3>]| entries(a, b, |a, b| Some(between_angles(a, b, share)));
    let turns = |a: &[Option<DQuat>], b: &[Option<DQuat>]| {
        entries(a, b, |a, b| Some(slerp(a, b, share)).filter(|turn| turn.is_finite()))
    };
    let mut frame = Frame {
        subject,
        sample: near.sample,
        time: near.time,
        late: false,
        received: near.received,
        timecode: between_timecodes(a.timecode, b.timecode, share),
        position: vectors(&a.position, &b.position),
        orientation: turns(&a.orientation, &b.orientation),
        velocity: vectors(&a.velocity, &b.velocity),
        acceleration: vectors(&a.acceleration, &b.acceleration),
        angular_velocity: vectors(&a.angular_velocity, &b.angular_velocity),
        angular_acceleration: vectors(&a.angular_acceleration, &b.angular_acceleration),
        joint_angles: angles(&a.joint_angles, &b.joint_angles),
        joint_angles_xzy: angles(&a.joint_angles_xzy, &b.joint_angles_xzy),
        ergonomic_angles: angles(&a.ergonomic_angles, &b.ergonomic_angles),
        ergonomic_angles_xzy: angles(&a.ergonomic_angles_xzy, &b.ergonomic_angles_xzy),
        sensor_orientation: turns(&a.sensor_orientation, &b.sensor_orientation),
        sensor_free_acceleration: vectors(&a.sensor_free_acceleration, &b.sensor_free_acceleration),
        sensor_acceleration: vectors(&a.sensor_acceleration, &b.sensor_acceleration),
        sensor_angular_velocity: vectors(&a.sensor_angular_velocity, &b.sensor_angular_velocity),
        sensor_magnetic_field: vectors(&a.sensor_magnetic_field, &b.sensor_magnetic_field),
        center_of_mass: between_centers(a.center_of_mass, b.center_of_mass, share),
        contacts: near.contacts.clone(),
        markers: between_markers(&near.markers, &a.markers, &b.markers, share),
        events: Vec::new(),
    };
    renew_angles(&mut frame);
    frame
}

/// Works the tracked angles out again: on the way between two orientations, angles do not go on evenly.
fn renew_angles(frame: &mut Frame) {
    let (skeleton, orientation) = (&frame.subject.skeleton, &frame.orientation);
    let mut renewed = Vec::new();
    let mut renew = |angles: &mut Vec<Option<DVec3>>, sequence, compute: Compute| {
        if !angles.is_empty() {
            compute(skeleton, orientation, sequence, &mut renewed);
            for (angle, renewed) in angles.iter_mut().zip(&renewed) {
                *angle = angle.and(renewed.or(*angle));
            }
        }
    };
    renew(&mut frame.joint_angles, Sequence::Zxy, joint_angles);
    renew(&mut frame.joint_angles_xzy, Sequence::Xzy, joint_angles);
    renew(&mut frame.ergonomic_angles, Sequence::Zxy, ergonomic_angles);
    renew(&mut frame.ergonomic_angles_xzy, Sequence::Xzy, ergonomic_angles);
}

/// [`joint_angles`] or [`ergonomic_angles`].
type Compute = fn(&Skeleton, &[Option<DQuat>], Sequence, &mut Vec<Option<DVec3>>);

/// Entry by entry, where both are tracked; nothing when one of the samples lacks the section.
fn entries<T: Copy>(a: &[Option<T>], b: &[Option<T>], mix: impl Fn(T, T) -> Option<T>) -> Vec<Option<T>> {
    if a.len() != b.len() {
        return Vec::new();
    }
    a.iter().zip(b).map(|(a, b)| mix((*a)?, (*b)?)).collect()
}

/// Each angle the shorter way round, within half a turn of zero.
fn between_angles(a: DVec3, b: DVec3, share: f64) -> DVec3 {
    let way = (b - a).map(nearest_turn);
    (a + way * share).map(nearest_turn)
}

/// The angle without its whole turns.
fn nearest_turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

fn between_centers(a: Option<CenterOfMass>, b: Option<CenterOfMass>, share: f64) -> Option<CenterOfMass> {
    let (a, b) = (a?, b?);
    let mix = |a: Option<DVec3>, b: Option<DVec3>| Some(a?.lerp(b?, share));
    Some(CenterOfMass {
        position: a.position.lerp(b.position, share),
        velocity: mix(a.velocity, b.velocity),
        acceleration: mix(a.acceleration, b.acceleration),
    })
}

/// Times of day, which begin anew at midnight.
fn between_timecodes(a: Option<Timecode>, b: Option<Timecode>, share: f64) -> Option<Timecode> {
    let (a, b) = (i64::from(a?.milliseconds()), i64::from(b?.milliseconds()));
    let way = (b - a + DAY / 2).rem_euclid(DAY) - DAY / 2;
    let between = a + (way as f64 * share).round() as i64;
    Some(Timecode::from_milliseconds(between.rem_euclid(DAY) as u64))
}

/// The markers of the nearer sample, where both samples saw them.
fn between_markers(near: &[Marker], a: &[Marker], b: &[Marker], share: f64) -> Vec<Marker> {
    let seen = |markers: &[Marker]| -> HashMap<u32, DVec3> {
        let seen = markers.iter().filter_map(|marker| Some((marker.id, marker.position?)));
        seen.collect()
    };
    if near.is_empty() {
        return Vec::new();
    }
    let (a, b) = (seen(a), seen(b));
    let between = |id: u32| Some(a.get(&id)?.lerp(*b.get(&id)?, share));
    let markers = near.iter().map(|marker| Marker {
        id: marker.id,
        position: between(marker.id),
    });
    markers.collect()
}

const DAY: i64 = 86_400_000;

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn angles_go_the_shorter_way_round() {
        let (a, b) = (DVec3::new(3.0, -3.0, 0.5), DVec3::new(-3.0, 3.0, 0.7));
        let half = between_angles(a, b, 0.5);
        assert!(
            (half.x.abs() - PI).abs() < 1e-12 && (half.y.abs() - PI).abs() < 1e-12,
            "{half}"
        );
        assert!((half.z - 0.6).abs() < 1e-12);
        assert!((between_angles(a, b, 1.0) - b).length() < 1e-12);
    }

    #[test]
    fn a_timecode_goes_through_midnight() {
        let code = |text: &str| text.parse::<Timecode>().ok();
        let half = between_timecodes(code("23:59:59.990"), code("00:00:00.020"), 0.5);
        assert_eq!(half, code("00:00:00.005"));
        assert_eq!(between_timecodes(None, code("00:00:00.020"), 0.5), None);
    }

    #[test]
    fn markers_that_one_sample_saw_are_not_tracked_between() {
        let marker = |id, x: f64| Marker {
            id,
            position: Some(DVec3::X * x),
        };
        let (a, b) = ([marker(7, 1.0), marker(9, 1.0)], [marker(8, 0.0), marker(7, 2.0)]);
        let found = between_markers(&b, &a, &b, 0.75);
        assert_eq!(found, [Marker { id: 8, position: None }, marker(7, 1.75)]);
    }

    #[test]
    fn a_section_that_one_sample_lacks_is_lacking_between() {
        assert_eq!(entries(&[Some(1.0)], &[], |a, _| Some(a)), []);
        assert_eq!(
            entries(&[Some(1.0), None], &[None, Some(2.0)], |a, _| Some(a)),
            [None, None]
        );
    }
}

//! Properties of the walk as a whole: what a viewer would notice if it were wrong.

use super::*;
use posewire_motion::kinematics::LargestGaps;
use posewire_motion::rotation::angular_velocity;
use posewire_motion::{DQuat, DVec3};

const RATE: f64 = 100.0;
/// Two strides and more.
const SAMPLES: u32 = 260;

fn crowd(props: usize, fingers: bool) -> Walk {
    Walk::new(&WalkOptions {
        people: MAX_PEOPLE,
        rate: RATE,
        props,
        fingers,
        seed: 0,
    })
}

/// Contacts of heel and toe, with the foot's and the toe's place in the skeleton, left and right.
const FEET: [(usize, usize, usize); 2] = [(0, 21, 22), (2, 17, 18)];

/// Where a point of a segment is.
fn point(frame: &Frame, segment: usize, name: &str) -> DVec3 {
    let points = &frame.subject.skeleton.segments[segment].points;
    let point = points.iter().find(|point| point.name.ends_with(name)).unwrap();
    frame.pose(segment).unwrap().transform(point.offset)
}

/// The lowest point of a foot above the ground, m.
fn lowest(frame: &Frame, foot: usize, toe: usize) -> f64 {
    let soles = ["HeelFoot", "HeelCenter", "FirstMetatarsal", "FifthMetatarsal"].map(|name| point(frame, foot, name).z);
    soles.into_iter().fold(point(frame, toe, "Toe").z, f64::min)
}

#[test]
fn a_foot_stands_on_the_ground_and_never_sinks_in() {
    let walk = crowd(0, false);
    let (mut deepest, mut highest) = (0.0_f64, 0.0_f64);
    for person in 0..MAX_PEOPLE {
        for sample in 0..SAMPLES {
            let frame = walk.frame(person, sample);
            for (contact, foot, toe) in FEET {
                let height = lowest(&frame, foot, toe);
                deepest = deepest.min(height);
                if frame.contacts[contact] || frame.contacts[contact + 1] {
                    highest = highest.max(height);
                }
            }
        }
    }
    println!(
        "lowest point {:.1} mm, highest in stance {:.1} mm",
        deepest * 1e3,
        highest * 1e3
    );
    assert!(deepest > -0.01 && highest < 0.02, "{deepest} {highest}");
}

#[test]
fn what_touches_the_ground_does_not_slide() {
    let walk = crowd(0, false);
    let mut fastest = 0.0_f64;
    for person in 0..MAX_PEOPLE {
        for sample in 0..SAMPLES {
            let frame = walk.frame(person, sample);
            for (contact, foot, toe) in FEET {
                if frame.contacts[contact + 1] {
                    fastest = fastest.max(frame.velocity[toe].unwrap().length());
                }
                if frame.contacts[contact] && frame.contacts[contact + 1] {
                    fastest = fastest.max(frame.velocity[foot].unwrap().length());
                }
            }
        }
    }
    println!("fastest standing foot {:.1} mm/s", fastest * 1e3);
    assert!(fastest < 0.03, "{fastest}");
}

#[test]
fn one_foot_or_both_are_on_the_ground_in_turn() {
    let walk = crowd(0, false);
    let mut both = 0;
    for sample in 0..1000 {
        let contacts = walk.frame(0, sample).contacts;
        let standing = [contacts[0] || contacts[1], contacts[2] || contacts[3]];
        assert!(standing[0] || standing[1], "sample {sample}");
        both += u32::from(standing[0] && standing[1]);
    }
    assert!((200..300).contains(&both), "{both} of 1000 samples with both feet");
}

#[test]
fn the_motion_is_smooth() {
    let walk = crowd(2, true);
    let (mut hardest, mut hardest_turn) = (0.0_f64, 0.0_f64);
    for person in 0..MAX_PEOPLE {
        for sample in (0..SAMPLES).step_by(2) {
            let frame = walk.frame(person, sample);
            hardest = frame
                .acceleration
                .iter()
                .fold(hardest, |most, pull| most.max(pull.unwrap().length()));
            hardest_turn = frame
                .angular_acceleration
                .iter()
                .fold(hardest_turn, |most, turn| most.max(turn.unwrap().length()));
        }
    }
    println!("largest acceleration {hardest:.1} m/s2, angular {hardest_turn:.0} rad/s2");
    assert!(hardest < 80.0 && hardest_turn < 400.0, "{hardest} {hardest_turn}");
}

#[test]
fn sample_follows_sample_without_a_jump_even_of_a_sign() {
    let walk = crowd(1, true);
    for person in [0, 1, 17] {
        let mut before = walk.frame(person, 0);
        for sample in 1..4000 {
            let frame = walk.frame(person, sample);
            for segment in 0..frame.position.len() {
                let step = frame.position[segment]
                    .unwrap()
                    .distance(before.position[segment].unwrap());
                let cosine = frame.orientation[segment]
                    .unwrap()
                    .dot(before.orientation[segment].unwrap());
                assert!(
                    step < 0.09 && cosine > 0.98,
                    "person {person} sample {sample} segment {segment}"
                );
            }
            before = frame;
        }
    }
}

#[test]
fn velocities_are_those_between_the_samples() {
    let walk = Walk::new(&WalkOptions {
        rate: 1000.0,
        ..WalkOptions::default()
    });
    for sample in (1..3000).step_by(37) {
        let [before, now, after] = [sample - 1, sample, sample + 1].map(|sample| walk.frame(0, sample));
        for segment in 0..23 {
            let at = |frame: &Frame| frame.pose(segment).unwrap();
            let velocity = (at(&after).position - at(&before).position) * 500.0;
            assert!((velocity - now.velocity[segment].unwrap()).length() < 1e-9);
            let turn = angular_velocity(
                at(&before).orientation,
                at(&after).orientation,
                Duration::from_millis(2),
            );
            assert!((turn.unwrap() - now.angular_velocity[segment].unwrap()).length() < 1e-2);
        }
        let speed = now.center_of_mass.unwrap().velocity.unwrap().length();
        assert!((0.9..1.5).contains(&speed), "{speed}");
    }
}

#[test]
fn joints_hold_together_and_bend_the_way_they_can() {
    let walk = crowd(0, false);
    let mut gaps = LargestGaps::new();
    for person in 0..MAX_PEOPLE {
        for sample in (0..SAMPLES).step_by(3) {
            let frame = walk.frame(person, sample);
            gaps.add(&frame);
            for (joint, low, high) in [
                (15, 4.0, 75.0),
                (19, 4.0, 75.0),
                (9 - 1, 0.0, 60.0),
                (12, 0.0, 60.0),
                (14, -25.0, 45.0),
            ] {
                let flexion = frame.joint_angles[joint].unwrap().z.to_degrees();
                assert!(
                    (low..high).contains(&flexion),
                    "person {person} joint {joint}: {flexion}"
                );
            }
        }
    }
    assert!(gaps.worst().unwrap().1 < 1e-9);
}

#[test]
fn legs_stretch_under_the_body_and_behind_it() {
    let walk = crowd(0, false);
    for person in 0..MAX_PEOPLE {
        let standing = (0..SAMPLES).map(|sample| walk.frame(person, sample));
        let standing = standing.filter(|frame| frame.contacts[0] || frame.contacts[1]);
        let bends = standing.map(|frame| [18, 19].map(|joint| frame.joint_angles[joint].unwrap().z.to_degrees()));
        let [hip, knee] = bends.fold([f64::INFINITY; 2], |[hip, knee], bend| {
            [hip.min(bend[0]), knee.min(bend[1])]
        });
        assert!(hip < -3.0 && knee < 20.0, "person {person}: hip {hip}, knee {knee}");
    }
}

#[test]
fn trackers_feel_gravity_and_the_field() {
    let walk = crowd(0, false);
    for sample in (0..SAMPLES).step_by(7) {
        let frame = walk.frame(3, sample);
        assert_eq!(frame.check(), Ok(()));
        for sensor in 0..17 {
            let turn: DQuat = frame.sensor_orientation[sensor].unwrap();
            let felt = turn * frame.sensor_acceleration[sensor].unwrap();
            let free = frame.sensor_free_acceleration[sensor].unwrap();
            assert!((felt - free - DVec3::Z * 9.81).length() < 1e-9);
            let field = turn * frame.sensor_magnetic_field[sensor].unwrap();
            assert!((field.length() - 1.0).abs() < 1e-9 && field.y.abs() < 1e-9 && field.z < 0.0);
        }
    }
}

#[test]
fn a_lap_ends_where_it_began() {
    let walk = Walk::new(&WalkOptions::default());
    let person = &walk.people[0];
    let lap = person.lap_time();
    for seconds in [0.0, 0.4, 3.3] {
        let (now, later) = (person.posed(seconds), person.posed(seconds + lap));
        for segment in 0..23 {
            let apart = now.position[segment]
                .unwrap()
                .distance(later.position[segment].unwrap());
            let cosine = now.orientation[segment]
                .unwrap()
                .dot(later.orientation[segment].unwrap());
            assert!(apart < 1e-9 && (cosine.abs() - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn props_are_in_the_hands_and_every_section_fits() {
    let walk = crowd(4, true);
    let frame = walk.frame(9, 50);
    assert_eq!(frame.check(), Ok(()));
    for (prop, hand) in [(23, 10), (24, 14), (25, 10), (26, 14)] {
        let apart = frame.position[prop].unwrap().distance(frame.position[hand].unwrap());
        assert!((0.05..0.12).contains(&apart), "{apart}");
        assert_eq!(frame.orientation[prop], frame.orientation[hand]);
    }
    assert!(frame.position.iter().all(Option::is_some) && frame.orientation.iter().all(Option::is_some));
}

#[test]
fn people_have_ids_names_and_colours_of_their_own() {
    let walk = crowd(0, false);
    for (id, subject) in walk.subjects().iter().enumerate() {
        assert_eq!((subject.id as usize, subject.rate), (id, Some(RATE)));
        let same = |other: &&Arc<Subject>| other.name == subject.name || other.color == subject.color;
        assert_eq!(walk.subjects().iter().filter(same).count(), 1, "{}", subject.name);
    }
}

#[test]
fn a_sample_is_the_same_whenever_it_is_asked_for() {
    let options = WalkOptions {
        people: 3,
        props: 1,
        fingers: true,
        ..WalkOptions::default()
    };
    let (one, other) = (Walk::new(&options), Walk::new(&options));
    let late = one.frame(2, u32::MAX);
    assert_eq!(other.frame(2, u32::MAX), late);
    assert!(late.position.iter().flatten().all(|position| position.is_finite()));
}

#[test]
fn options_out_of_range_are_brought_into_it() {
    let wild = WalkOptions {
        people: 1000,
        rate: f64::NAN,
        props: 99,
        fingers: false,
        seed: 1,
    };
    let walk = Walk::new(&wild);
    assert_eq!(walk.subjects().len(), MAX_PEOPLE);
    assert_eq!(walk.rate().to_bits(), 240.0_f64.to_bits());
    assert_eq!(walk.subjects()[0].skeleton.segments.len(), 27);
    let none = Walk::new(&WalkOptions {
        people: 0,
        rate: 1e9,
        ..wild
    });
    assert_eq!((none.subjects().len(), none.rate().to_bits()), (1, MAX_RATE.to_bits()));
}

#[test]
fn takes_have_the_samples_of_their_time_and_can_be_stopped() {
    let walk = Walk::new(&WalkOptions {
        people: 2,
        rate: RATE,
        ..WalkOptions::default()
    });
    let takes = walk.takes(Duration::from_millis(255), &Stop::new()).unwrap();
    assert_eq!(takes.iter().map(Take::len).collect::<Vec<_>>(), [26, 26]);
    assert_eq!(takes[1].frame(25), walk.frame(1, 25));
    assert_eq!(walk.takes(Duration::ZERO, &Stop::new()).unwrap()[0].len(), 1);
    let stopped = Stop::new();
    stopped.stop();
    let refused = walk.takes(Duration::from_hours(1), &stopped);
    assert!(matches!(refused, Err(Error::Stopped { .. })));
}

//! Orientations of segments as `OpenSense` reads those of sensors: an STO file of quaternions.

use super::{NOT_TRACKED, TO_GROUND, label, times};
use crate::endpoint::FileFormat;
use crate::file::names::is_mvn;
use crate::file::problem::Problem;
use crate::file::text::Line;
use crate::file::{Job, LeftOut, Output};
use posewire_motion::{Column, DQuat, Section, Skeleton};
use std::io::Write;

/// A column for each body that the models of `OpenSim` have, under its name there: `femur_r_imu`, a quaternion as w, x, y, z
/// with commas between them. A skeleton that is not MVN's has a column for each segment.
pub(in crate::file) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let take = job.take;
    let orientation = job.column(Section::Orientation);
    let orientation = orientation.ok_or_else(|| Problem::lacks(FileFormat::Sto, "orientations of segments"))?;
    let rate = job.rate(FileFormat::Sto)?;
    let (bodies, left_out) = bodies(&take.subject.skeleton);
    write!(
        out,
        "DataRate={rate:.6}\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.5\nendheader\n"
    )?;
    let mut line = Line::new('\t');
    line.field("time");
    for (_, name) in &bodies {
        line.field(name);
    }
    line.end(out, "\n")?;
    for (frame, time) in times(take, rate).into_iter().enumerate() {
        line.number(time, super::DECIMALS);
        for (segment, _) in &bodies {
            add_body(orientation, frame, *segment, &mut line);
        }
        line.end(out, "\n")?;
        job.progress.advance(1)?;
    }
    Ok(left_out)
}

fn add_body(orientation: &Column, frame: usize, segment: usize, line: &mut Line) {
    match orientation.quaternion(frame, segment).filter(|turn| turn.is_finite()) {
        Some(turn) => {
            let DQuat { x, y, z, w } = TO_GROUND * turn;
            line.list(&[w, x, y, z], DECIMALS);
        }
        None => line.field(&[NOT_TRACKED; 4].join(",")),
    }
}

/// The places of the segments to write and the names of their columns, and which segments are none of `OpenSim`'s bodies.
fn bodies(skeleton: &Skeleton) -> (Vec<(usize, String)>, LeftOut) {
    let segments = &skeleton.segments;
    let is_mvn = is_mvn(skeleton);
    let body = |place: usize| {
        if !is_mvn {
            return Some(label(&segments[place].name));
        }
        let name = OPENSIM.get(place).filter(|name| !name.is_empty())?;
        Some((*name).to_owned())
    };
    let (mut bodies, mut others) = (Vec::new(), Vec::new());
    for (place, segment) in segments.iter().enumerate() {
        match body(place) {
            Some(name) => bodies.push((place, format!("{name}_imu"))),
            None => others.push(segment.name.as_str()),
        }
    }
    let mut left_out = LeftOut::new();
    if !others.is_empty() {
        left_out.push(format!(
            "segments for which OpenSim's models have no body ({})",
            others.join(", ")
        ));
    }
    (bodies, left_out)
}

/// Finer than what MVNX holds.
const DECIMALS: usize = 8;
/// The body of `OpenSim`'s models that each of MVN's segments is; empty where none is.
const OPENSIM: [&str; 23] = [
    "pelvis",
    "",
    "",
    "",
    "torso",
    "",
    "head",
    "",
    "humerus_r",
    "ulna_r",
    "hand_r",
    "",
    "humerus_l",
    "ulna_l",
    "hand_l",
    "femur_r",
    "tibia_r",
    "calcn_r",
    "toes_r",
    "femur_l",
    "tibia_l",
    "calcn_l",
    "toes_l",
];

#[cfg(test)]
mod tests {
    use crate::endpoint::FileFormat;
    use crate::file::tests::text_of;
    use crate::file::{Progress, WriteOptions, write};
    use posewire_motion::{DQuat, Frame, Segment, SegmentKind, Skeleton, Subject, Take};
    use std::io::Cursor;
    use std::sync::Arc;

    fn standing(skeleton: Skeleton) -> Take {
        let subject = Arc::new(Subject::new("Ada", skeleton));
        let mut take = Take::new(Arc::clone(&subject), 60.0);
        let mut frame = Frame::new(subject);
        frame.orientation = vec![Some(DQuat::IDENTITY); frame.subject.skeleton.segments.len()];
        frame.orientation[1] = None;
        take.push(&frame).unwrap();
        take
    }

    #[test]
    fn a_standing_person_is_turned_up_by_minus_ninety_degrees() {
        let skeleton = Skeleton {
            segments: ["Left Hand", "Bat"]
                .map(|name| Segment::new(name, SegmentKind::Body))
                .to_vec(),
            ..Skeleton::default()
        };
        let expected = "DataRate=60.000000\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.5\nendheader\n\
            time\tLeft_Hand_imu\tBat_imu\n\
            0.000000\t0.70710678,-0.70710678,0.00000000,0.00000000\tNaN,NaN,NaN,NaN\n";
        assert_eq!(
            text_of(FileFormat::Sto, standing(skeleton), &WriteOptions::default()),
            expected
        );
    }

    #[test]
    fn mvns_segments_are_opensims_bodies() {
        let recording = standing(Skeleton::standard(0, false)).into();
        let mut out = Cursor::new(Vec::new());
        let left_out = write(
            FileFormat::Sto,
            &recording,
            &WriteOptions::default(),
            &Progress::default(),
            &mut out,
        );
        let text = String::from_utf8(out.into_inner()).unwrap();
        let names: Vec<_> = text.lines().nth(5).unwrap().split('\t').collect();
        assert_eq!(names[..4], ["time", "pelvis_imu", "torso_imu", "head_imu"]);
        assert_eq!(names.len(), 1 + 17);
        let left_out = left_out.unwrap().to_string();
        assert!(
            left_out.contains("(L5, L3, T12, Neck, RightShoulder, LeftShoulder)"),
            "{left_out}"
        );
    }
}

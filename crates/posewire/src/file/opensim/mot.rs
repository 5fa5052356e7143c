//! Joint angles as `OpenSim` reads coordinates: a MOT file, in degrees.

use super::{DECIMALS, NOT_TRACKED, label, times};
use crate::endpoint::FileFormat;
use crate::file::problem::Problem;
use crate::file::text::Line;
use crate::file::{Job, LeftOut, Output};
use posewire_motion::{Section, Take};
use std::io::Write;

/// The angles by the ZXY sequence, three columns for each joint: `RightKnee_abduction`, `RightKnee_rotation` (inwards) and
/// `RightKnee_flexion`. Which coordinate of a model each of them is depends on the model.
pub(in crate::file) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let take = job.take;
    let angles = job.column(Section::JointAngles);
    let angles = angles.ok_or_else(|| Problem::lacks(FileFormat::Mot, "joint angles"))?;
    let [frames, joints, _] = angles.shape();
    write!(
        out,
        "Coordinates\nversion=1\nnRows={frames}\nnColumns={}\ninDegrees=yes\nendheader\n",
        1 + 3 * joints
    )?;
    let mut line = Line::new('\t');
    add_names(take, &mut line);
    line.end(out, "\n")?;
    for (row, time) in angles.rows().zip(times(take, job.rate(FileFormat::Mot)?)) {
        line.number(time, DECIMALS);
        for angle in row {
            if angle.is_finite() {
                line.number(angle.to_degrees(), DECIMALS);
            } else {
                line.field(NOT_TRACKED);
            }
        }
        line.end(out, "\n")?;
        job.progress.advance(1)?;
    }
    Ok(LeftOut::new())
}

fn add_names(take: &Take, line: &mut Line) {
    line.field("time");
    for joint in &take.subject.skeleton.joints {
        let joint = label(joint.name.strip_prefix('j').unwrap_or(&joint.name));
        for turn in ["abduction", "rotation", "flexion"] {
            line.field(&format!("{joint}_{turn}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Error;
    use crate::endpoint::FileFormat;
    use crate::file::tests::text_of;
    use crate::file::{Progress, WriteOptions, write};
    use posewire_motion::{DVec3, Frame, Skeleton, Subject, Take};
    use std::f64::consts::PI;
    use std::io::Cursor;
    use std::sync::Arc;

    #[test]
    fn angles_are_in_degrees_and_the_header_says_so() {
        let mut skeleton = Skeleton::standard(0, false);
        skeleton.joints.truncate(2);
        let subject = Arc::new(Subject::new("Ada", skeleton));
        let mut take = Take::new(Arc::clone(&subject), 60.0);
        let mut frame = Frame::new(subject);
        frame.joint_angles = vec![Some(DVec3::new(PI, -PI / 2.0, PI / 6.0)), None];
        take.push(&frame).unwrap();
        let expected = "Coordinates\nversion=1\nnRows=1\nnColumns=7\ninDegrees=yes\nendheader\n\
            time\tL5S1_abduction\tL5S1_rotation\tL5S1_flexion\tL4L3_abduction\tL4L3_rotation\tL4L3_flexion\n\
            0.000000\t180.000000\t-90.000000\t30.000000\tNaN\tNaN\tNaN\n";
        assert_eq!(text_of(FileFormat::Mot, take, &WriteOptions::default()), expected);
    }

    #[test]
    fn a_take_without_angles_is_refused() {
        let take = Take::new(Arc::new(Subject::new("Ada", Skeleton::default())), 60.0);
        let mut out = Cursor::new(Vec::new());
        let options = WriteOptions::default();
        let error = write(FileFormat::Mot, &take.into(), &options, &Progress::default(), &mut out).unwrap_err();
        assert!(matches!(error, Error::Lacks { format: "MOT", .. }), "{error}");
    }
}

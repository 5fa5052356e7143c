//! The poses of calibration as either version has them.

use super::numbers::{Found, Numbers, without_noise};
use super::{Printer, Style, Version, clock};
use crate::Error;
use crate::section::{Layout, Section};
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject, Timecode};
use std::io::Write;
use std::sync::Arc;

/// A pose of the body, per segment.
#[derive(Clone, Debug)]
pub(crate) struct BodyPose {
    /// From the segments' ISB axes to the world's.
    pub(crate) orientation: Vec<Option<DQuat>>,
    /// Where the segments' origins are, m.
    pub(crate) position: Vec<Option<DVec3>>,
}

/// What the frames of calibration tell.
#[derive(Clone, Debug)]
pub(crate) struct Poses {
    /// The T-pose in which no segment is turned.
    pub(crate) null: BodyPose,
    /// The T-pose as the body holds it.
    pub(crate) held: BodyPose,
}

impl Poses {
    /// The null pose, and as if the body held it so.
    pub(crate) fn of_null(skeleton: &Skeleton) -> Self {
        let segments = skeleton.segments.iter();
        let null = BodyPose {
            orientation: segments.clone().map(|segment| Some(segment.isb)).collect(),
            position: segments.map(|segment| segment.origin).collect(),
        };
        Self {
            held: null.clone(),
            null,
        }
    }
}

/// Writes the frames of calibration of a version: of 3 `npose` and `tpose`, of 4 `identity`, `tpose` and `tpose-isb`.
pub(crate) fn write_poses<W: Write>(
    printer: &mut Printer<W>,
    layout: Layout,
    version: Version,
    skeleton: &Skeleton,
    poses: &Poses,
    rate: Option<f64>,
) -> Result<(), Error> {
    let Poses { null, held } = poses;
    let poses = match version {
        Version::V3 => vec![
            (" index=\"-3\"", "npose", null.clone()),
            (" index=\"-2\"", "tpose", held.clone()),
        ],
        Version::V4 => vec![
            ("", "identity", in_own_axes(null, skeleton)),
            ("", "tpose", in_own_axes(held, skeleton)),
            ("", "tpose-isb", held.clone()),
        ],
    };
    let subject = Arc::new(Subject::new("", Skeleton::default()));
    let (clock, mut numbers) = (clock(Timecode::default(), rate), Numbers::new(layout, Vec::new()));
    for (index, kind, pose) in poses {
        let tag = format!("frame time=\"0\"{index} tc=\"{clock}\" ms=\"0\" type=\"{kind}\"");
        printer.start(&tag, Style::Lines);
        let pose = Frame {
            orientation: pose.orientation,
            position: pose.position,
            ..Frame::new(Arc::clone(&subject))
        };
        for section in Section::all() {
            // A pose of which not all is known is one without that section.
            if let Found::All(found) = numbers.of(&pose, section) {
                printer.numbers(section.name(), section, found)?;
            }
        }
        printer.end()?;
    }
    Ok(())
}

/// A pose with the orientations of the segments' own axes.
fn in_own_axes(pose: &BodyPose, skeleton: &Skeleton) -> BodyPose {
    let turn = |(q, isb): (&Option<DQuat>, DQuat)| match *q {
        // Six decimals are kept where there is nothing to turn.
        Some(q) if isb == DQuat::IDENTITY => Some(q),
        q => q.map(|q| DQuat::from_array((q * isb.conjugate()).to_array().map(without_noise))),
    };
    let axes = skeleton.segments.iter().map(|segment| segment.isb);
    BodyPose {
        orientation: pose.orientation.iter().zip(axes).map(turn).collect(),
        position: pose.position.clone(),
    }
}

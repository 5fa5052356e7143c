//! The poses of calibration as either version has them.

use super::numbers::{Found, Numbers};
use super::{Printer, Style, Version, clock};
use crate::Error;
use crate::section::{Layout, Section};
use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject, Timecode};
use std::io::Write;
use std::sync::Arc;

/// The T-pose as the body holds it, per segment.
#[derive(Clone, Debug)]
pub(crate) struct HeldPose {
    /// From the segments' ISB axes to the world's.
    pub(crate) orientation: Vec<Option<DQuat>>,
    /// Where the segments' origins are, m.
    pub(crate) position: Vec<Option<DVec3>>,
}

/// Writes the frames of calibration of a version: of 3 `npose` and `tpose`, of 4 `identity`, `tpose` and `tpose-isb`.
///
/// Without a held pose, the null pose is taken to be the held one.
pub(crate) fn write_poses<W: Write>(
    printer: &mut Printer<W>,
    layout: Layout,
    version: Version,
    skeleton: &Skeleton,
    held: Option<HeldPose>,
    rate: Option<f64>,
) -> Result<(), Error> {
    let isb = || skeleton.segments.iter().map(|segment| Some(segment.isb)).collect();
    let held = held.unwrap_or_else(|| HeldPose {
        orientation: isb(),
        position: origins(skeleton),
    });
    let subject = Arc::new(Subject::new("", Skeleton::default()));
    let pose = |orientation, position: &[Option<DVec3>]| Frame {
        orientation,
        position: position.to_vec(),
        ..Frame::new(Arc::clone(&subject))
    };
    let isb_held = || pose(held.orientation.clone(), &held.position);
    let poses = match version {
        Version::V3 => vec![
            (" index=\"-3\"", "npose", pose(isb(), &origins(skeleton))),
            (" index=\"-2\"", "tpose", isb_held()),
        ],
        Version::V4 => vec![
            ("", "identity", pose(identities(skeleton), &origins(skeleton))),
            (
                "",
                "tpose",
                pose(in_own_axes(&held.orientation, skeleton), &held.position),
            ),
            ("", "tpose-isb", isb_held()),
        ],
    };
    let (clock, mut numbers) = (clock(Timecode::default(), rate), Numbers::new(layout, Vec::new()));
    for (index, kind, pose) in poses {
        let tag = format!("frame time=\"0\"{index} tc=\"{clock}\" ms=\"0\" type=\"{kind}\"");
        printer.start(&tag, Style::Lines);
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

fn origins(skeleton: &Skeleton) -> Vec<Option<DVec3>> {
    skeleton.segments.iter().map(|segment| segment.origin).collect()
}

fn identities(skeleton: &Skeleton) -> Vec<Option<DQuat>> {
    vec![Some(DQuat::IDENTITY); skeleton.segments.len()]
}

/// Orientations in ISB axes, turned to the segments' own axes.
fn in_own_axes(isb: &[Option<DQuat>], skeleton: &Skeleton) -> Vec<Option<DQuat>> {
    let turn = |(q, isb): (&Option<DQuat>, DQuat)| match *q {
        // Six decimals are kept where there is nothing to turn.
        Some(q) if isb == DQuat::IDENTITY => Some(q),
        q => q.map(|q| without_noise(q * isb.conjugate())),
    };
    let axes = skeleton.segments.iter().map(|segment| segment.isb);
    isb.iter().zip(axes).map(turn).collect()
}

/// A turn leaves of a zero what `f64` rounds off, of either sign.
fn without_noise(q: DQuat) -> DQuat {
    DQuat::from_array(
        q.to_array()
            .map(|number| if number.abs() < 1e-12 { 0.0 } else { number }),
    )
}

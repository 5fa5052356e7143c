//! The frames before the first normal one: poses of calibration.

use crate::Error;
use crate::frame::{Sections, orientations, positions};
use crate::head::read_leaf_numbers;
use crate::section::{Layout, Section};
use crate::xml::Xml;
use posewire_motion::{DQuat, DVec3};
use std::io::BufRead;

/// A pose that is not of the recording but of the calibration of the suit.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Which pose it is.
    pub kind: CalibrationKind,
    /// Per segment of the skeleton: its orientation as the file says it, in version 3 with the arms in their ISB axes.
    pub orientation: Vec<Option<DQuat>>,
    /// Per segment of the skeleton: its origin, m.
    pub position: Vec<Option<DVec3>>,
}

/// Which pose a [`Calibration`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CalibrationKind {
    /// Version 4: the T-pose with every orientation the identity.
    Identity,
    /// Version 3: the T-pose with every segment in the axes that the file has its orientations in.
    NPose,
    /// The T-pose as the body holds it.
    TPose,
    /// Version 4: the T-pose as the body holds it, with every segment in its ISB axes.
    TPoseIsb,
}

impl CalibrationKind {
    /// The pose that a frame of this `type` holds.
    pub(crate) fn of(kind: &str) -> Option<Self> {
        match kind {
            "identity" => Some(Self::Identity),
            "npose" => Some(Self::NPose),
            "tpose" => Some(Self::TPose),
            "tpose-isb" => Some(Self::TPoseIsb),
            _ => None,
        }
    }
}

/// Reads the frame on whose start tag the reader stands; goes to its end tag.
pub(crate) fn read_calibration<R: BufRead>(
    xml: &mut Xml<R>,
    kind: CalibrationKind,
    layout: &Layout,
) -> Result<Calibration, Error> {
    let mut sections = Sections::default();
    let mut calibration = Calibration {
        kind,
        orientation: vec![None; layout.all_segments()],
        position: vec![None; layout.all_segments()],
    };
    let mut numbers = Vec::new();
    while xml.child()? {
        sections.count(xml)?;
        let Some((section, first)) = Section::of(xml.name()).and_then(|section| poses(section, layout)) else {
            xml.skip()?;
            continue;
        };
        let at = xml.place();
        sections.once(section, at)?;
        read_leaf_numbers(xml, section.name(), &mut numbers)?;
        layout.check(section, numbers.len(), at)?;
        if section.columns() == 4 {
            let entries = calibration.orientation[first..].iter_mut();
            entries.zip(orientations(&numbers)).for_each(|(to, q)| *to = Some(q));
        } else {
            let entries = calibration.position[first..].iter_mut();
            entries.zip(positions(&numbers)).for_each(|(to, v)| *to = Some(v));
        }
    }
    Ok(calibration)
}

/// The sections that make up a pose, when the file has such segments, and the place of their first segment.
fn poses(section: Section, layout: &Layout) -> Option<(Section, usize)> {
    let first = match section {
        Section::Orientation | Section::Position => 0,
        Section::OrientationFingersLeft | Section::PositionFingersLeft => layout.segments,
        Section::OrientationFingersRight | Section::PositionFingersRight => layout.segments + layout.left_fingers,
        _ => return None,
    };
    (layout.entries(section) > 0).then_some((section, first))
}

//! Numbers of a subject that can be plotted, by name.

use posewire_motion::{Frame, Section, Skeleton};
use serde::Serialize;

/// A group of channels: a section, its entries and their axes.
///
/// A channel's name is `section/entry/axis`: `joint_angles/jRightKnee/z`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Group {
    section: &'static str,
    entries: Vec<String>,
    axes: &'static [&'static str],
    unit: String,
}

/// The channels of the sections that a subject has; a bit of `present` for each place of [`Section::ALL`].
pub(crate) fn groups(skeleton: &Skeleton, present: u32) -> Vec<Group> {
    let sections = Section::ALL.iter().copied();
    let sections = sections.filter(|&section| present & bit(section) != 0);
    let group = |section: Section| Group {
        section: section.name(),
        entries: section.labels(skeleton).map(str::to_owned).collect(),
        axes: section.axes(),
        unit: section.unit().replace("rad", "deg"),
    };
    sections.map(group).filter(|group| !group.entries.is_empty()).collect()
}

/// The sections that a frame has, a bit for each place of [`Section::ALL`].
pub(crate) fn present(frame: &Frame) -> u32 {
    frame.sections().fold(0, |bits, section| bits | bit(section))
}

/// The sections of a live subject that has had these: they, and those that its poses tell of each frame.
pub(crate) fn with_told(present: u32) -> u32 {
    let angles = [
        Section::JointAngles,
        Section::JointAnglesXzy,
        Section::ErgonomicAngles,
        Section::ErgonomicAnglesXzy,
    ];
    let of_positions = [Section::Velocity, Section::Acceleration].as_slice();
    let told = [(Section::Position, of_positions), (Section::Orientation, &angles)];
    let told = told.into_iter().filter(|(of, _)| present & bit(*of) != 0);
    told.flat_map(|(_, told)| told)
        .fold(present, |bits, section| bits | bit(*section))
}

/// The bit of a section.
pub(crate) const fn bit(section: Section) -> u32 {
    1 << section as u32
}

/// One number of a subject's frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Channel {
    section: Section,
    entry: usize,
    axis: usize,
}

impl Channel {
    /// The channel of this name, if the skeleton has it.
    pub(crate) fn named(name: &str, skeleton: &Skeleton) -> Option<Self> {
        let (section, rest) = name.split_once('/')?;
        let (entry, axis) = rest.rsplit_once('/')?;
        let section: Section = section.parse().ok()?;
        Some(Self {
            section,
            entry: section.labels(skeleton).position(|label| label == entry)?,
            axis: section.axes().iter().position(|known| *known == axis)?,
        })
    }

    /// What it is in a frame, angles in degrees; NaN where it was not tracked or not sent.
    pub(crate) fn value(self, frame: &Frame) -> f32 {
        let entries = frame.entries(self.section);
        let value = match self.section.components() {
            4 => entries.quaternion(self.entry).map(|q| [q.w, q.x, q.y, q.z][self.axis]),
            _ => entries.vector(self.entry).map(|v| v[self.axis] * self.scale()),
        };
        value.unwrap_or(f64::NAN) as f32
    }

    /// The channel of the same entry and axis of another section that has as many of each.
    pub(crate) fn of(self, section: Section) -> Self {
        Self { section, ..self }
    }

    /// The section that it is of.
    pub(crate) fn section(self) -> Section {
        self.section
    }

    /// Its place in a row of its section's column.
    pub(crate) fn place(self) -> usize {
        self.entry * self.section.components() + self.axis
    }

    /// What the section's numbers are multiplied by: radians are shown as degrees.
    pub(crate) fn scale(self) -> f64 {
        if self.section.unit().starts_with("rad") {
            1_f64.to_degrees()
        } else {
            1.0
        }
    }
}

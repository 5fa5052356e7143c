//! What each format holds, and in which axes and unit.

use super::grid::keeps_time;
use super::{Axes, LeftOut};
use crate::endpoint::FileFormat;
use crate::{Error, Result};
use posewire_motion::{Section, Space, Take, Unit};

/// What of a take a format holds.
struct Holds {
    sections: &'static [Section],
    others: &'static [Other],
}

/// What a take has besides numbers in sections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Other {
    Contacts,
    Markers,
    Events,
    Timecodes,
}

impl FileFormat {
    /// The axes and the unit to write, where some may be asked for.
    ///
    /// # Errors
    /// [`Error::Fixed`] when the format has others.
    pub(super) fn space(self, axes: Option<Axes>, unit: Option<Unit>) -> Result<Space> {
        let (usual_axes, usual_unit) = self.usual();
        let allowed = self.allowed_axes();
        if let Some(found) = axes.filter(|axes| !allowed.contains(axes)) {
            let names: Vec<_> = allowed.iter().map(|axes| axes.name()).collect();
            let expected = if names.is_empty() {
                OPENSIM.to_owned()
            } else {
                names.join(" or ")
            };
            return Err(self.fixed("axes", expected, found.name()));
        }
        if let Some(found) = unit.filter(|unit| self.has_fixed_unit() && *unit != usual_unit) {
            return Err(self.fixed("unit", symbol(usual_unit).to_owned(), symbol(found)));
        }
        let of_engine = match axes {
            Some(Axes::Unity) => Unit::Metre,
            Some(Axes::Unreal) => Unit::Centimetre,
            _ => usual_unit,
        };
        let axes = axes.unwrap_or(usual_axes);
        Ok(axes.space(unit.unwrap_or(of_engine)))
    }

    /// What of a take it cannot hold. Sections that were not asked for are not missed.
    pub(super) fn leaves_out(self, take: &Take, asked: Option<&[Section]>) -> LeftOut {
        let holds = self.holds();
        let mut left_out = LeftOut::new();
        // First what shifts times.
        left_out.extend(self.missing(take));
        let missed = take.sections().filter(|section| {
            let wanted = asked.is_none_or(|asked| asked.contains(section));
            wanted && !holds.sections.contains(section)
        });
        for section in missed {
            left_out.push(section.name().replace('_', " "));
        }
        let others = [Other::Contacts, Other::Markers, Other::Events, Other::Timecodes];
        for other in others.iter().filter(|other| !holds.others.contains(other)) {
            if asked.is_none() {
                left_out.extend(other.found_in(take));
            }
        }
        left_out
    }

    /// What becomes of the samples that are missing in a file whose frames follow each other at the rate.
    fn missing(self, take: &Take) -> Option<String> {
        let missing = missing_samples(take);
        let samples = if missing == 1 { "sample" } else { "samples" };
        match self {
            Self::Bvh | Self::C3d if missing == 0 => None,
            Self::Bvh | Self::C3d if !keeps_time(take) => {
                Some(format!("{missing} missing {samples}, over which the frames close up"))
            }
            Self::Bvh => Some(format!("{missing} missing {samples}, at which the pose before stays")),
            _ => None,
        }
    }

    /// What its tools expect.
    const fn usual(self) -> (Axes, Unit) {
        match self {
            Self::Mvnx | Self::MvnxGz | Self::Csv | Self::Npz | Self::Parquet => (Axes::ZUp, Unit::Metre),
            Self::C3d => (Axes::ZUp, Unit::Millimetre),
            Self::Bvh => (Axes::YUp, Unit::Centimetre),
            Self::Trc => (Axes::YUp, Unit::Millimetre),
            Self::Mot | Self::Sto | Self::Gltf | Self::Glb => (Axes::YUp, Unit::Metre),
        }
    }

    const fn allowed_axes(self) -> &'static [Axes] {
        match self {
            Self::Mvnx | Self::MvnxGz => &[Axes::ZUp],
            Self::Csv | Self::Npz | Self::Parquet | Self::C3d => &[Axes::ZUp, Axes::YUp, Axes::Unity, Axes::Unreal],
            Self::Bvh | Self::Trc => &[Axes::YUp, Axes::ZUp],
            Self::Gltf | Self::Glb => &[Axes::YUp],
            // Their axes are OpenSim's own: X forward, Y up, Z to the right.
            Self::Mot | Self::Sto => &[],
        }
    }

    const fn has_fixed_unit(self) -> bool {
        matches!(
            self,
            Self::Mvnx | Self::MvnxGz | Self::Mot | Self::Sto | Self::Gltf | Self::Glb
        )
    }

    fn fixed(self, what: &'static str, expected: String, found: &str) -> Error {
        Error::Fixed {
            format: self.name(),
            what,
            expected,
            found: found.to_owned(),
        }
    }

    const fn holds(self) -> Holds {
        let poses = Holds {
            sections: &[Section::Position, Section::Orientation],
            others: &[],
        };
        match self {
            // Its writer tells what it has no place for.
            Self::Mvnx | Self::MvnxGz => Holds {
                sections: Section::ALL,
                others: &[Other::Contacts, Other::Markers, Other::Events, Other::Timecodes],
            },
            Self::Csv | Self::Npz | Self::Parquet => Holds {
                sections: Section::ALL,
                others: &[Other::Contacts, Other::Events, Other::Timecodes],
            },
            Self::C3d => Holds {
                sections: &[Section::Position, Section::JointAngles, Section::CenterOfMass],
                others: &[Other::Events],
            },
            Self::Mot => Holds {
                sections: &[Section::JointAngles],
                ..poses
            },
            Self::Sto => Holds {
                sections: &[Section::Orientation],
                ..poses
            },
            Self::Trc => Holds {
                sections: &[Section::Position],
                ..poses
            },
            Self::Bvh | Self::Gltf | Self::Glb => poses,
        }
    }
}

impl Other {
    /// What of this a take has, in words.
    fn found_in(self, take: &Take) -> Option<String> {
        let any = |is_there: &dyn Fn(usize) -> bool| (0..take.len()).any(is_there);
        let (is_there, what) = match self {
            Self::Contacts => (any(&|frame| !take.contacts(frame).is_empty()), "foot contacts"),
            Self::Markers => (any(&|frame| !take.markers(frame).is_empty()), "markers"),
            Self::Events => (!take.events().is_empty(), "events"),
            Self::Timecodes => (take.timecodes().iter().any(Option::is_some), "the time of day"),
        };
        is_there.then(|| what.to_owned())
    }
}

/// Sample numbers between the first and the last that have no frame. Numbers out of order tell none.
fn missing_samples(take: &Take) -> u64 {
    if !take.samples().is_sorted_by(|before, after| before < after) {
        return 0;
    }
    let steps = take.samples().windows(2).map(|pair| pair[1].saturating_sub(pair[0]));
    steps.map(|step| u64::from(step.saturating_sub(1))).sum()
}

const OPENSIM: &str = "OpenSim's (X forward, Y up, Z right)";

pub(super) const fn symbol(unit: Unit) -> &'static str {
    match unit {
        Unit::Metre => "m",
        Unit::Centimetre => "cm",
        Unit::Millimetre => "mm",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{DQuat, Frame, Skeleton, Subject, Timecode};
    use std::sync::Arc;

    #[test]
    fn the_usual_axes_and_unit_are_those_of_the_tools() {
        let space = |format: FileFormat| format.space(None, None).unwrap();
        assert_eq!(space(FileFormat::Bvh), Space::MOTION_BUILDER);
        assert_eq!(space(FileFormat::Csv), Space::CANONICAL);
        assert_eq!(space(FileFormat::C3d), Axes::ZUp.space(Unit::Millimetre));
        assert_eq!(space(FileFormat::Trc), Axes::YUp.space(Unit::Millimetre));
        assert_eq!(space(FileFormat::Glb), Axes::YUp.space(Unit::Metre));
    }

    #[test]
    fn an_engine_brings_its_unit_along() {
        let csv = |axes, unit| FileFormat::Csv.space(Some(axes), unit).unwrap();
        assert_eq!(csv(Axes::Unreal, None), Space::UNREAL);
        assert_eq!(csv(Axes::Unity, None), Space::UNITY);
        assert_eq!(csv(Axes::Unreal, Some(Unit::Metre)).unit, Unit::Metre);
    }

    #[test]
    fn what_a_format_fixes_cannot_be_asked_otherwise() {
        let error = FileFormat::Gltf.space(None, Some(Unit::Centimetre)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "glTF: expected m as the unit, which the format fixes, found cm"
        );
        let error = FileFormat::Trc.space(Some(Axes::Unity), None).unwrap_err();
        assert_eq!(
            error.to_string(),
            "TRC: expected y-up or z-up as the axes, which the format fixes, found unity"
        );
        assert!(FileFormat::Glb.space(Some(Axes::YUp), Some(Unit::Metre)).is_ok());
    }

    #[test]
    fn what_is_left_out_is_said_unless_it_was_not_asked_for() {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let mut take = Take::new(Arc::clone(&subject), 60.0);
        let mut frame = Frame::new(subject);
        frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        frame.angular_velocity = vec![None; 23];
        frame.contacts = vec![true; 4];
        frame.timecode = Some(Timecode::from_milliseconds(1));
        take.push(&frame).unwrap();
        frame.sample = 4;
        take.push(&frame).unwrap();
        let left_out = FileFormat::Bvh.leaves_out(&take, None);
        assert_eq!(
            left_out.to_string(),
            "3 missing samples, at which the pose before stays, angular velocity, foot contacts, the time of day"
        );
        let asked = FileFormat::Bvh.leaves_out(&take, Some(&[Section::Orientation]));
        assert_eq!(asked.iter().count(), 1);
        assert!(FileFormat::Npz.leaves_out(&take, None).is_empty());
    }
}

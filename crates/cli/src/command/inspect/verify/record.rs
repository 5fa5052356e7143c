//! What a verification found. As JSON the fields are an interface, documented in docs/json.md.

use super::super::contents::{RunsRecord, segment_name};
use super::super::survey::Survey;
use super::Verifier;
use super::checks::{Check, checks};
use posewire_motion::Skeleton;
use posewire_motion::kinematics::Largest;
use posewire_motion::kinematics::check::{ClockReport, Compared, Comparison};
use posewire_motion::rotation::Sequence;
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in super::super) struct Verification {
    pub(super) checks: Vec<Check>,
    pub(super) joint_angles: Vec<AngleRecord>,
    pub(super) ergonomic_angles: Vec<AngleRecord>,
    pub(super) quaternions: Vec<LengthRecord>,
    pub(super) untracked: Vec<UntrackedRecord>,
    pub(super) clock: Option<ClockRecord>,
    pub(super) velocities: Vec<VelocityRecord>,
}

/// The largest difference of a joint's angles, or of an ergonomic angle.
#[derive(Debug, Serialize)]
pub(super) struct AngleRecord {
    pub(super) name: String,
    pub(super) zxy: Option<DifferenceRecord>,
    pub(super) xzy: Option<DifferenceRecord>,
}

#[derive(Debug, Serialize)]
pub(super) struct DifferenceRecord {
    pub(super) difference_deg: Option<f64>,
    pub(super) sample: Option<u32>,
    pub(super) near_pole: u64,
}

#[derive(Debug, Serialize)]
pub(super) struct LengthRecord {
    pub(super) segment: String,
    pub(super) sensor: bool,
    pub(super) error: f64,
    pub(super) sample: u32,
}

#[derive(Debug, Serialize)]
pub(super) struct UntrackedRecord {
    pub(super) segment: String,
    #[serde(flatten)]
    pub(super) runs: RunsRecord,
}

#[derive(Debug, Serialize)]
pub(super) struct ClockRecord {
    pub(super) samples: u64,
    pub(super) p50_ms: f64,
    pub(super) p99_ms: f64,
    pub(super) max_ms: f64,
    pub(super) max_sample: u32,
    pub(super) drift_ppm: Option<f64>,
    pub(super) drift_error_ppm: Option<f64>,
}

#[derive(Debug, Serialize)]
pub(super) struct VelocityRecord {
    pub(super) segment: String,
    pub(super) difference_m_s: Option<f64>,
    pub(super) sample: Option<u32>,
    pub(super) angular_difference_rad_s: Option<f64>,
    pub(super) angular_sample: Option<u32>,
}

impl Verification {
    pub(in super::super) fn of(verifier: &Verifier, survey: &Survey, skeleton: &Skeleton) -> Self {
        let angles = &verifier.angles;
        let joints = skeleton.joints.iter().map(|joint| &joint.name);
        let ergonomic = skeleton.ergonomic_angles.iter().map(|angle| &angle.name);
        Self {
            checks: checks(verifier, survey, skeleton),
            joint_angles: angle_records(joints, |sequence| angles.joints(sequence)),
            ergonomic_angles: angle_records(ergonomic, |sequence| angles.ergonomic(sequence)),
            quaternions: quaternions(verifier, skeleton),
            untracked: untracked(survey, skeleton),
            clock: verifier.clock.report().map(|report| ClockRecord::of(&report)),
            velocities: velocities(verifier, skeleton),
        }
    }
}

impl DifferenceRecord {
    fn of(all: &Compared, place: usize) -> Option<Self> {
        let largest = *all.largest.get(place)?;
        let near_pole = all.near_pole.get(place).copied().unwrap_or(0);
        (largest.is_some() || near_pole > 0).then(|| Self {
            difference_deg: largest.map(|largest| largest.value.to_degrees()),
            sample: largest.map(|largest| largest.sample),
            near_pole,
        })
    }
}

impl ClockRecord {
    fn of(report: &ClockReport) -> Self {
        Self {
            samples: report.samples,
            p50_ms: report.p50_ms,
            p99_ms: report.p99_ms,
            max_ms: report.largest_ms.value,
            max_sample: report.largest_ms.sample,
            drift_ppm: report.drift_ppm,
            drift_error_ppm: report.drift_error_ppm,
        }
    }
}

fn angle_records<'a>(
    names: impl Iterator<Item = &'a String>,
    compared: impl Fn(Sequence) -> &'a Compared,
) -> Vec<AngleRecord> {
    let records = names.enumerate().map(|(place, name)| AngleRecord {
        name: name.clone(),
        zxy: DifferenceRecord::of(compared(Sequence::Zxy), place),
        xzy: DifferenceRecord::of(compared(Sequence::Xzy), place),
    });
    records.collect()
}

fn quaternions(verifier: &Verifier, skeleton: &Skeleton) -> Vec<LengthRecord> {
    let segments = verifier.lengths.segments().iter().enumerate();
    let segments = segments.map(|(segment, largest)| (segment, false, largest));
    let sensors = skeleton.sensors.iter().zip(verifier.lengths.sensors());
    let sensors = sensors.map(|(segment, largest)| (*segment, true, largest));
    let records = segments.chain(sensors).filter_map(|(segment, sensor, largest)| {
        let Largest { value, sample } = (*largest)?;
        Some(LengthRecord {
            segment: segment_name(skeleton, segment),
            sensor,
            error: value,
            sample,
        })
    });
    records.collect()
}

fn untracked(survey: &Survey, skeleton: &Skeleton) -> Vec<UntrackedRecord> {
    let segments = survey.dropouts.untracked().enumerate();
    let records = segments
        .filter(|(_, runs)| runs.count > 0)
        .map(|(segment, runs)| UntrackedRecord {
            segment: segment_name(skeleton, segment),
            runs: RunsRecord::of(runs),
        });
    records.collect()
}

fn velocities(verifier: &Verifier, skeleton: &Skeleton) -> Vec<VelocityRecord> {
    let (linear, angular) = (verifier.velocities.velocity(), verifier.velocities.angular_velocity());
    let largest = |of: &Comparison, place: usize| of.largest.get(place).copied().flatten();
    let records = (0..linear.largest.len().max(angular.largest.len())).map(|place| {
        let (linear, angular) = (largest(linear, place), largest(angular, place));
        VelocityRecord {
            segment: segment_name(skeleton, place),
            difference_m_s: linear.map(|largest| largest.value),
            sample: linear.map(|largest| largest.sample),
            angular_difference_rad_s: angular.map(|largest| largest.value),
            angular_sample: angular.map(|largest| largest.sample),
        }
    });
    records.collect()
}

//! What was checked, what was found, and whether that is usual.

use super::super::contents::segment_name;
use super::super::survey::Survey;
use super::Verifier;
use posewire_motion::Skeleton;
use posewire_motion::kinematics::Largest;
use posewire_motion::kinematics::check::{ClockReport, Compared, Comparison};
use posewire_motion::rotation::Sequence;
use serde::Serialize;

/// One check: the worst that was found, and the limit that it is held against.
#[derive(Debug, Serialize)]
pub(super) struct Check {
    pub(super) name: &'static str,
    pub(super) verdict: Verdict,
    pub(super) value: Option<f64>,
    pub(super) limit: f64,
    pub(super) unit: &'static str,
    /// The joint, the angle or the segment that has the value.
    pub(super) place: Option<String>,
    /// The first sample that has it.
    pub(super) sample: Option<u32>,
    /// What else there is to say.
    pub(super) note: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) enum Verdict {
    #[serde(rename = "ok")]
    Ok,
    #[serde(rename = "look at this")]
    Look,
    /// The take has nothing to check.
    #[serde(rename = "not there")]
    NotThere,
}

impl Check {
    /// Ok when the value is there and not above the limit.
    fn new(name: &'static str, value: Option<f64>, limit: f64, unit: &'static str) -> Self {
        let verdict = match value {
            None => Verdict::NotThere,
            Some(value) if value <= limit => Verdict::Ok,
            Some(_) => Verdict::Look,
        };
        Self {
            name,
            verdict,
            value,
            limit,
            unit,
            place: None,
            sample: None,
            note: None,
        }
    }

    fn at(self, place: Option<String>, sample: Option<u32>) -> Self {
        Self { place, sample, ..self }
    }

    fn note(self, note: Option<String>) -> Self {
        Self { note, ..self }
    }
}

pub(super) fn checks(verifier: &Verifier, survey: &Survey, skeleton: &Skeleton) -> Vec<Check> {
    let mut checks = angles(verifier, skeleton);
    checks.push(quaternions(verifier, skeleton));
    checks.push(gaps(survey, skeleton));
    checks.extend(dropouts(survey, skeleton));
    checks.extend(clock(verifier));
    let (linear, angular) = (verifier.velocities.velocity(), verifier.velocities.angular_velocity());
    checks.push(velocity("velocities", linear, "m/s", LEAST_SPEED, skeleton));
    checks.push(velocity(
        "angular velocities",
        angular,
        "rad/s",
        LEAST_TURNING,
        skeleton,
    ));
    checks
}

fn angles(verifier: &Verifier, skeleton: &Skeleton) -> Vec<Check> {
    let angles = &verifier.angles;
    let joint = |place: usize| Some(skeleton.joints.get(place)?.name.clone());
    let ergonomic = |place: usize| Some(skeleton.ergonomic_angles.get(place)?.name.clone());
    vec![
        angle("joint angles ZXY", angles.joints(Sequence::Zxy), joint),
        angle("joint angles XZY", angles.joints(Sequence::Xzy), joint),
        angle("ergonomic angles ZXY", angles.ergonomic(Sequence::Zxy), ergonomic),
        angle("ergonomic angles XZY", angles.ergonomic(Sequence::Xzy), ergonomic),
    ]
}

fn angle(name: &'static str, of: &Compared, entry: impl Fn(usize) -> Option<String>) -> Check {
    let worst = Largest::of_all(&of.largest);
    let value = worst.map(|(_, largest)| largest.value.to_degrees());
    let near_pole: u64 = of.near_pole.iter().sum();
    Check::new(name, value, LARGEST_ANGLE, "deg")
        .at(
            worst.and_then(|(place, _)| entry(place)),
            worst.map(|(_, largest)| largest.sample),
        )
        .note((near_pole > 0).then(|| format!("{near_pole} close to gimbal lock not compared")))
}

fn quaternions(verifier: &Verifier, skeleton: &Skeleton) -> Check {
    let lengths = &verifier.lengths;
    let segment = Largest::of_all(lengths.segments());
    let segment = segment.map(|(place, largest)| (largest, segment_name(skeleton, place)));
    let sensor = Largest::of_all(lengths.sensors()).map(|(place, largest)| {
        let wearer = skeleton
            .sensors
            .get(place)
            .map(|&segment| segment_name(skeleton, segment));
        (largest, format!("sensor {}", wearer.unwrap_or_default()))
    });
    let worst = match (segment, sensor) {
        (Some(segment), Some(sensor)) if sensor.0.value > segment.0.value => Some(sensor),
        (segment, sensor) => segment.or(sensor),
    };
    let value = worst.as_ref().map(|(largest, _)| largest.value);
    let sample = worst.as_ref().map(|(largest, _)| largest.sample);
    Check::new("quaternion lengths off 1", value, LARGEST_LENGTH_ERROR, "").at(worst.map(|(_, place)| place), sample)
}

fn gaps(survey: &Survey, skeleton: &Skeleton) -> Check {
    let worst = survey.gaps.worst();
    let joint = worst.and_then(|(joint, _)| Some(skeleton.joints.get(joint)?.name.clone()));
    let value = worst.map(|(_, gap)| gap * 1000.0);
    let sample = worst.and(survey.worst_sample);
    Check::new("connector gaps", value, LARGEST_GAP, "mm").at(joint, sample)
}

fn dropouts(survey: &Survey, skeleton: &Skeleton) -> [Check; 3] {
    let dropouts = &survey.dropouts;
    let count = |count: u64| (survey.frames > 0).then_some(count as f64);
    let missing = dropouts.missing();
    let first = |runs: &[[u32; 2]]| runs.first().map(|[first, _]| *first);
    let untracked: u64 = dropouts.untracked().map(|runs| runs.count).sum();
    let worst = dropouts.untracked().enumerate().max_by_key(|(_, runs)| runs.count);
    let worst = worst.filter(|(_, runs)| runs.count > 0);
    [
        Check::new("missing samples", count(missing.count), 0.0, "samples").at(None, first(&missing.runs)),
        Check::new("out of order", count(dropouts.out_of_order()), 0.0, "samples"),
        Check::new("untracked segments", count(untracked), 0.0, "samples").at(
            worst.map(|(segment, _)| segment_name(skeleton, segment)),
            worst.and_then(|(_, runs)| first(&runs.runs)),
        ),
    ]
}

fn clock(verifier: &Verifier) -> [Check; 2] {
    let report = verifier.clock.report();
    let half_a_sample = 500.0 / verifier.rate;
    let limit = if verifier.rate > 0.0 {
        half_a_sample.max(LEAST_JITTER)
    } else {
        LEAST_JITTER
    };
    let jitter = report.map(|report| report.p99_ms);
    [
        Check::new("clock jitter (p99)", jitter, limit, "ms").note(report.map(|report| spread(&report))),
        drift(report),
    ]
}

/// Whole milliseconds over a short take tell no drift.
fn drift(report: Option<ClockReport>) -> Check {
    let known = report.and_then(|report| Some((report.drift_ppm?, report.drift_error_ppm?)));
    let Some((drift, error)) = known.filter(|(_, error)| *error <= LARGEST_DRIFT) else {
        return Check::new("clock drift", None, LARGEST_DRIFT, "ppm")
            .note(report.map(|_| "the take is too short to tell".to_owned()));
    };
    let way = if drift < 0.0 { "slow" } else { "fast" };
    Check::new("clock drift", Some(drift.abs()), LARGEST_DRIFT + 3.0 * error, "ppm")
        .note(Some(format!("{way}, standard error {error:.1} ppm")))
}

fn spread(report: &ClockReport) -> String {
    let Largest { value, sample } = report.largest_ms;
    format!(
        "half within {:.1} ms, at most {value:.1} ms at sample {sample}",
        report.p50_ms
    )
}

/// Root mean squares, held against half of that of the velocities themselves, but of a body at rest.
fn velocity(name: &'static str, of: &Comparison, unit: &'static str, least: f64, skeleton: &Skeleton) -> Check {
    let worst = Largest::of_all(&of.largest).map(|(place, largest)| (segment_name(skeleton, place), largest));
    let note = worst.map(|(segment, largest)| {
        let Largest { value, sample } = largest;
        format!("at most {value:.3} {unit}, {segment}, sample {sample}")
    });
    let limit = of.given().map_or(least, |given| (given / 2.0).max(least));
    Check::new(name, of.difference(), limit, unit).note(note)
}

/// Six decimals of the quaternions explain 0.0023 degrees.
const LARGEST_ANGLE: f64 = 0.003;
const LARGEST_LENGTH_ERROR: f64 = 1e-5;
/// Usual are 2 mm in a walk to 36 mm in a tennis stroke.
const LARGEST_GAP: f64 = 50.0;
/// The clock is rounded to milliseconds.
const LEAST_JITTER: f64 = 2.0;
const LARGEST_DRIFT: f64 = 200.0;
/// Of a body that hardly moves, m/s and rad/s: MVN filters its velocities and pulls feet to the ground.
const LEAST_SPEED: f64 = 0.1;
const LEAST_TURNING: f64 = 0.3;

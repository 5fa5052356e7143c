//! What a take holds. As JSON the fields are an interface, documented in docs/json.md.

use super::input::TakeFile;
use super::sections;
use super::survey::{Event, Instants, Survey};
use super::verify::Verification;
use posewire_motion::kinematics::check::Runs;
use posewire_motion::{Segment, SegmentKind, Skeleton};
use posewire_mvnx::{CalibrationKind, FrameCounts, Header, SectionInfo};
use serde::Serialize;

/// What a take holds: distances in metres, times in seconds.
#[derive(Debug, Serialize)]
pub(super) struct Contents {
    pub(super) kind: &'static str,
    pub(super) file: String,
    pub(super) bytes: u64,
    pub(super) compressed: bool,
    pub(super) mvnx_version: u32,
    pub(super) mvn_version: Option<String>,
    pub(super) mvn_build: Option<String>,
    pub(super) subject: String,
    pub(super) color: Option<String>,
    pub(super) comment: Option<String>,
    pub(super) recorded: Option<String>,
    pub(super) original_file: Option<String>,
    pub(super) configuration: Option<String>,
    pub(super) scenario: Option<String>,
    pub(super) rate_hz: Option<f64>,
    pub(super) frames: u64,
    pub(super) first: Option<SampleRecord>,
    pub(super) last: Option<SampleRecord>,
    pub(super) duration_s: Option<f64>,
    pub(super) missing_samples: RunsRecord,
    pub(super) out_of_order: u64,
    pub(super) calibration: Vec<&'static str>,
    pub(super) segments: Vec<SegmentRecord>,
    pub(super) joints: Vec<JointRecord>,
    pub(super) worst_gap: Option<WorstGap>,
    pub(super) ergonomic_angles: Vec<String>,
    pub(super) sensors: Vec<String>,
    pub(super) contacts: Vec<String>,
    pub(super) sections: Vec<SectionRecord>,
    pub(super) events: Vec<Event>,
    pub(super) events_left_out: u64,
    pub(super) unknown_elements: Vec<UnknownRecord>,
    pub(super) unknown_elements_left_out: u64,
    pub(super) unknown_frames: Vec<UnknownFrames>,
    /// Whether the file was read to its end.
    pub(super) complete: bool,
    pub(super) damage: Option<String>,
    /// With `--verify` only.
    pub(super) verification: Option<Verification>,
}

/// Runs of samples.
#[derive(Clone, Debug, Serialize)]
pub(super) struct RunsRecord {
    pub(super) count: u64,
    /// The first and the last number of each run; the first runs only.
    pub(super) runs: Vec<[u32; 2]>,
    pub(super) runs_left_out: u64,
}

#[derive(Debug, Serialize)]
pub(super) struct SampleRecord {
    pub(super) sample: u32,
    pub(super) time_s: f64,
    pub(super) timecode: Option<String>,
}

#[derive(Debug, Serialize)]
pub(super) struct SegmentRecord {
    pub(super) name: String,
    pub(super) kind: &'static str,
    pub(super) parent: Option<String>,
    pub(super) points: usize,
}

#[derive(Debug, Serialize)]
pub(super) struct JointRecord {
    pub(super) name: String,
    pub(super) parent: String,
    pub(super) child: String,
    pub(super) largest_gap_m: Option<f64>,
}

#[derive(Debug, Serialize)]
pub(super) struct WorstGap {
    pub(super) joint: String,
    pub(super) gap_m: f64,
    pub(super) sample: Option<u32>,
}

#[derive(Debug, Serialize)]
pub(super) struct SectionRecord {
    pub(super) name: String,
    pub(super) columns: usize,
    pub(super) unit: Option<&'static str>,
    pub(super) frames: u64,
    pub(super) line: u64,
}

#[derive(Debug, PartialEq, Eq, Serialize)]
pub(super) struct UnknownRecord {
    pub(super) name: String,
    pub(super) line: u64,
    pub(super) count: u64,
}

#[derive(Debug, Serialize)]
pub(super) struct UnknownFrames {
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) count: u64,
}

impl Contents {
    pub(super) fn of(file: &TakeFile, survey: &Survey) -> Self {
        let (header, subject) = (file.reader.header(), file.reader.subject());
        let skeleton = &subject.skeleton;
        let text = |name| header.subject_attribute(name).and_then(stated);
        let sections = file.reader.sections();
        let damage = file.reader.damage();
        Self {
            kind: "take",
            file: file.path.display().to_string(),
            bytes: file.size,
            compressed: file.compressed,
            mvnx_version: header.version,
            mvn_version: header.mvn_version.as_deref().and_then(stated),
            mvn_build: header.mvn_build.as_deref().and_then(stated),
            subject: subject.name.clone(),
            color: subject.color.map(|color| color.to_string()),
            comment: comment(header),
            recorded: text("recDate"),
            original_file: text("originalFilename"),
            configuration: text("configuration"),
            scenario: text("userScenario"),
            rate_hz: subject.rate,
            frames: survey.frames,
            first: survey.first.map(SampleRecord::of),
            last: survey.last.map(SampleRecord::of),
            duration_s: subject.rate.and_then(|rate| survey.duration(rate)),
            missing_samples: RunsRecord::of(survey.dropouts.missing()),
            out_of_order: survey.dropouts.out_of_order(),
            calibration: calibration(file),
            segments: skeleton
                .segments
                .iter()
                .map(|segment| SegmentRecord::of(segment, skeleton))
                .collect(),
            joints: joints(skeleton, survey.gaps.joints()),
            worst_gap: worst_gap(skeleton, survey),
            ergonomic_angles: skeleton
                .ergonomic_angles
                .iter()
                .map(|angle| angle.name.clone())
                .collect(),
            sensors: skeleton
                .sensors
                .iter()
                .map(|&segment| segment_name(skeleton, segment))
                .collect(),
            contacts: skeleton.contacts.clone(),
            sections: sections
                .iter()
                .filter(|section| section.known)
                .map(SectionRecord::of)
                .collect(),
            events: survey.events.list.clone(),
            events_left_out: survey.events.left_out,
            unknown_elements: unknown_elements(header, sections),
            unknown_elements_left_out: header.unknown_left_out,
            unknown_frames: unknown_frames(file.reader.counts()),
            complete: survey.complete && damage.is_none(),
            damage: damage.map(ToString::to_string),
            verification: survey
                .verifier
                .as_ref()
                .map(|verifier| Verification::of(verifier, survey, skeleton)),
        }
    }
}

impl RunsRecord {
    pub(super) fn of(runs: &Runs) -> Self {
        Self {
            count: runs.count,
            runs: runs.runs.clone(),
            runs_left_out: runs.left_out,
        }
    }
}

impl SampleRecord {
    fn of(instants: Instants) -> Self {
        Self {
            sample: instants.sample,
            time_s: instants.time.as_secs_f64(),
            timecode: instants.timecode.map(|timecode| timecode.to_string()),
        }
    }
}

impl SegmentRecord {
    fn of(segment: &Segment, skeleton: &Skeleton) -> Self {
        Self {
            name: segment.name.clone(),
            kind: match segment.kind {
                SegmentKind::Body => "body",
                SegmentKind::Prop => "prop",
                SegmentKind::LeftFinger => "left finger",
                SegmentKind::RightFinger => "right finger",
            },
            parent: segment.parent.map(|parent| segment_name(skeleton, parent)),
            points: segment.points.len(),
        }
    }
}

impl SectionRecord {
    fn of(section: &SectionInfo) -> Self {
        let unit = sections::meaning(&section.name).map(|meaning| meaning.unit);
        Self {
            name: section.name.clone(),
            columns: section.columns,
            unit: unit.filter(|unit| !unit.is_empty()),
            frames: section.frames,
            line: section.line,
        }
    }
}

/// The text, if it says anything.
fn stated(text: &str) -> Option<String> {
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

fn comment(header: &Header) -> Option<String> {
    let comments = [&header.comment, &header.subject_comment];
    let mut texts: Vec<_> = comments.into_iter().flatten().filter_map(|text| stated(text)).collect();
    texts.dedup();
    (!texts.is_empty()).then(|| texts.join("\n"))
}

fn calibration(file: &TakeFile) -> Vec<&'static str> {
    let name = |kind| match kind {
        CalibrationKind::Identity => "identity",
        CalibrationKind::NPose => "npose",
        CalibrationKind::TPose => "tpose",
        CalibrationKind::TPoseIsb => "tpose-isb",
    };
    file.reader.calibration().iter().map(|pose| name(pose.kind)).collect()
}

fn joints(skeleton: &Skeleton, gaps: &[Option<f64>]) -> Vec<JointRecord> {
    let joints = skeleton.joints.iter().enumerate().map(|(place, joint)| JointRecord {
        name: joint.name.clone(),
        parent: segment_name(skeleton, joint.parent.segment),
        child: segment_name(skeleton, joint.child.segment),
        largest_gap_m: gaps.get(place).copied().flatten(),
    });
    joints.collect()
}

fn worst_gap(skeleton: &Skeleton, survey: &Survey) -> Option<WorstGap> {
    let (joint, gap_m) = survey.gaps.worst()?;
    let joint = skeleton.joints.get(joint)?.name.clone();
    Some(WorstGap {
        joint,
        gap_m,
        sample: survey.worst_sample,
    })
}

pub(super) fn segment_name(skeleton: &Skeleton, place: usize) -> String {
    skeleton
        .segments
        .get(place)
        .map_or_else(String::new, |segment| segment.name.clone())
}

/// Elements around the frames and within them, each name once with its first line.
fn unknown_elements(header: &Header, sections: &[SectionInfo]) -> Vec<UnknownRecord> {
    let around = header.unknown.iter().map(|element| (&element.name, element.line, 1));
    let within = sections.iter().filter(|section| !section.known);
    let within = within.map(|section| (&section.name, section.line, section.frames));
    let mut records: Vec<UnknownRecord> = Vec::new();
    for (name, line, count) in around.chain(within) {
        match records.iter_mut().find(|record| record.name == *name) {
            Some(record) => record.count += count,
            None => records.push(UnknownRecord {
                name: name.clone(),
                line,
                count,
            }),
        }
    }
    records.sort_by_key(|record| record.line);
    records
}

fn unknown_frames(counts: &FrameCounts) -> Vec<UnknownFrames> {
    let skipped = counts.skipped.iter();
    skipped
        .map(|(kind, count)| UnknownFrames {
            kind: kind.clone(),
            count: *count,
        })
        .collect()
}

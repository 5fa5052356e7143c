//! A take as text, read by searching for its tags.

use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
use std::path::Path;
use std::sync::Arc;

/// The text of a take, read by searching for its tags.
pub(crate) struct Take {
    text: String,
}

impl Take {
    pub(crate) fn read(name: &str) -> Option<Self> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/mvnx");
        let text = std::fs::read_to_string(folder.join(name)).ok();
        if text.is_none() {
            println!("skipped: reference data not here");
        }
        Some(Self { text: text? })
    }

    pub(crate) fn frames<'a>(&'a self, kind: &str) -> impl Iterator<Item = &'a str> {
        let mark = format!("type=\"{kind}\">");
        let frames = self.text.split("<frame ").skip(1);
        frames.filter(move |frame| frame.lines().next().is_some_and(|line| line.contains(&mark)))
    }

    pub(crate) fn calibration(&self, kind: &str) -> Vec<DQuat> {
        quaternions(self.frames(kind).next().unwrap(), "orientation")
    }

    /// The standard skeleton with the joints' names, the points and the calibration of this take.
    pub(crate) fn skeleton(&self, isb: &[DQuat]) -> Skeleton {
        let mut skeleton = Skeleton::standard(0, false);
        for (segment, isb) in skeleton.segments.iter_mut().zip(isb) {
            segment.isb = *isb;
        }
        let segments = self.text.split("<segment label=\"").skip(1);
        for (segment, text) in skeleton.segments.iter_mut().zip(segments) {
            for point in &mut segment.points {
                if let Some((_, rest)) = text.split_once(&format!("<point label=\"{}\">", point.name)) {
                    let offset = rest.split(['<', '>']).nth(2).unwrap().split_whitespace();
                    let offset: Vec<f64> = offset.map(|number| number.parse().unwrap()).collect();
                    point.offset = DVec3::from_slice(&offset);
                }
            }
        }
        let names = self.text.split("<joint label=\"").skip(1);
        for (joint, rest) in skeleton.joints.iter_mut().zip(names) {
            rest.split('"').next().unwrap().clone_into(&mut joint.name);
        }
        skeleton
    }

    /// The canonical poses of the take: orientations as they are in the file, signs and all, but for the arms of version 3.
    pub(crate) fn poses(&self) -> Vec<Frame> {
        let (null_pose, is_version_3) = match self.frames("identity").next() {
            Some(frame) => (frame, false),
            None => (self.frames("npose").next().unwrap(), true),
        };
        let mut skeleton = self.skeleton(&nominal());
        for (segment, origin) in skeleton.segments.iter_mut().zip(vectors(null_pose, "position")) {
            segment.origin = Some(origin);
        }
        let arms = quaternions(null_pose, "orientation").into_iter();
        let arms: Vec<_> = arms
            .map(|arm| if is_version_3 { arm.conjugate() } else { DQuat::IDENTITY })
            .collect();
        let subject = Arc::new(Subject::new("Ada", skeleton));
        let frames = self.frames("normal").zip(0..).map(|(text, sample)| {
            let mut frame = Frame::new(Arc::clone(&subject));
            frame.sample = sample;
            frame.position = vectors(text, "position").into_iter().map(Some).collect();
            let turns = quaternions(text, "orientation").into_iter().zip(&arms);
            frame.orientation = turns.map(|(turn, arm)| Some(turn * *arm)).collect();
            frame
        });
        frames.collect()
    }
}

pub(crate) fn numbers(frame: &str, element: &str) -> Option<Vec<f64>> {
    let (_, rest) = frame.split_once(&format!("<{element}>"))?;
    let (text, _) = rest.split_once('<')?;
    Some(text.split_whitespace().map(|number| number.parse().unwrap()).collect())
}

pub(crate) fn vectors(frame: &str, element: &str) -> Vec<DVec3> {
    let numbers = numbers(frame, element).unwrap();
    numbers.chunks_exact(3).map(DVec3::from_slice).collect()
}

pub(crate) fn quaternions(frame: &str, element: &str) -> Vec<DQuat> {
    let numbers = numbers(frame, element).unwrap();
    let turns = numbers.chunks_exact(4);
    turns
        .map(|q| DQuat::from_xyzw(q[1], q[2], q[3], q[0]).normalize())
        .collect()
}

pub(crate) fn nominal() -> Vec<DQuat> {
    let segments = Skeleton::standard(0, false).segments;
    segments.iter().map(|segment| segment.isb).collect()
}

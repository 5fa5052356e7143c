//! What a source has besides its take.

use super::{LeftOut, Recording};
use crate::endpoint::FileFormat;
use posewire_mvnx::Header;

/// What of the source a file made of the take does not have.
pub(super) fn leaves_out(format: FileFormat, recording: &Recording) -> LeftOut {
    let mut left_out = LeftOut::new();
    let is_mvnx = matches!(format, FileFormat::Mvnx | FileFormat::MvnxGz);
    let segments = &recording.take.subject.skeleton.segments;
    if !holds_points(format) && segments.iter().any(|segment| !segment.points.is_empty()) {
        left_out.push("the points of segments");
    }
    if let Some(document) = recording.document.as_ref().filter(|_| !is_mvnx) {
        if !document.calibration().is_empty() {
            left_out.push("the poses of calibration");
        }
        left_out.extend(around(document.header()));
    }
    if !recording.unread.is_empty() {
        left_out.push(format!(
            "{} of frames, which posewire does not know",
            recording.unread.join(", ")
        ));
    }
    left_out
}

/// Comments and unknown elements.
fn around(header: &Header) -> impl Iterator<Item = String> {
    let comments = [&header.comment, &header.subject_comment];
    let any = |comment: &&Option<String>| comment.as_ref().is_some_and(|text| !text.is_empty());
    let comment = comments.iter().any(any).then(|| "comments".to_owned());
    let mut names: Vec<_> = header.unknown.iter().map(|element| element.name.as_str()).collect();
    names.dedup();
    let unknown = (!names.is_empty()).then(|| format!("{}, which posewire does not know", names.join(", ")));
    comment.into_iter().chain(unknown)
}

/// Whether it has the points themselves, or where they are in each frame.
const fn holds_points(format: FileFormat) -> bool {
    matches!(
        format,
        FileFormat::Mvnx | FileFormat::MvnxGz | FileFormat::C3d | FileFormat::Trc | FileFormat::Parquet
    )
}

//! Biovision's hierarchy and motion.
//!
//! The hierarchy has the skeleton's segments under the names that MVN gives them in its own export, with the offsets of
//! the null pose. A joint turns by Y, X and Z in this order (`R = Ry * Rx * Rz`), in degrees, against its parent; the root
//! is placed too. Measured segments are not rigidly linked, as a BVH skeleton is: with
//! [`BvhOptions::translations`](super::BvhOptions::translations) every joint is placed in its parent, which keeps the
//! measured positions. Frames follow each other at the take's rate; at a sample that is missing the pose before stays, and so does
//! what is not tracked.

mod hierarchy;
mod pose;

use super::grid::grid;
use super::problem::Problem;
use super::text::Line;
use super::{Job, LeftOut, Output};
use crate::endpoint::FileFormat;
use hierarchy::Hierarchy;
use pose::{Poses, Turns};
use posewire_motion::kinematics::LargestGaps;
use posewire_motion::{DVec3, Frame, Section, Space};
use std::io::{self, Write};
use std::sync::Arc;

pub(super) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let take = job.take;
    if take.subject.skeleton.segments.is_empty() || job.column(Section::Orientation).is_none() {
        return Err(Problem::lacks(FileFormat::Bvh, "orientations of segments"));
    }
    let rate = job.rate(FileFormat::Bvh)?;
    let hierarchy = Hierarchy::of(take, job.options.bvh.translations);
    write_hierarchy(&hierarchy, job.space, out)?;
    let grid = grid(take);
    writeln!(out, "MOTION\nFrames: {}\nFrame Time: {:.10}", grid.len(), 1.0 / rate)?;
    let held = write_motion(job, &hierarchy, &grid, out)?;
    Ok(left_out(job, held))
}

/// Writes all frames, and gives in how many something was not tracked.
fn write_motion(
    job: &Job<'_>,
    hierarchy: &Hierarchy,
    grid: &[Option<usize>],
    out: &mut Output<'_>,
) -> io::Result<usize> {
    let mut poses = Poses::new(job, hierarchy);
    let standing = job.options.bvh.first_frame_is_t_pose.then(|| {
        let mut poses = Poses::new(job, hierarchy);
        poses.stand(hierarchy);
        poses
    });
    let mut turns = Turns::new(hierarchy.joints.len());
    let mut line = Line::new(' ');
    let mut held = 0;
    for (number, frame) in grid.iter().enumerate() {
        let standing = standing.as_ref().filter(|_| number == 0);
        let whole = frame.is_none_or(|frame| poses.read(frame));
        held += usize::from(!whole && standing.is_none());
        let shown = standing.unwrap_or(&poses);
        for (place, joint) in hierarchy.joints.iter().enumerate() {
            let (position, rotation) = shown.local(joint);
            if joint.is_placed {
                add_vector(&mut line, job.space.position_from_canonical(position));
            }
            let [y, x, z] = turns.next(place, job.space.orientation_from_canonical(rotation));
            add_vector(&mut line, DVec3::new(y, x, z));
        }
        line.end(out, "\n")?;
        job.progress.advance(u64::from(frame.is_some()))?;
    }
    Ok(held)
}

fn add_vector(line: &mut Line, vector: DVec3) {
    for component in vector.to_array() {
        line.number(component, DECIMALS);
    }
}

fn write_hierarchy(hierarchy: &Hierarchy, space: Space, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "HIERARCHY")?;
    let mut open = 0;
    for (place, joint) in hierarchy.joints.iter().enumerate() {
        close(&mut open, joint.depth, out)?;
        let kind = if place == 0 { "ROOT" } else { "JOINT" };
        let indent = "\t".repeat(open);
        writeln!(out, "{indent}{kind} {}\n{indent}{{", joint.name)?;
        open += 1;
        let offset = if place == 0 { DVec3::ZERO } else { joint.offset };
        writeln!(out, "{indent}\t{}", offset_line(offset, space))?;
        writeln!(out, "{indent}\tCHANNELS {}", if joint.is_placed { SIX } else { THREE })?;
        if let Some(end) = joint.end {
            writeln!(out, "{indent}\tEnd Site\n{indent}\t{{")?;
            writeln!(out, "{indent}\t\t{}\n{indent}\t}}", offset_line(end, space))?;
        }
    }
    close(&mut open, 0, out)
}

/// Ends the joints that are deeper than this.
fn close(open: &mut usize, depth: usize, out: &mut impl Write) -> io::Result<()> {
    while *open > depth {
        *open -= 1;
        writeln!(out, "{}}}", "\t".repeat(*open))?;
    }
    Ok(())
}

fn offset_line(offset: DVec3, space: Space) -> String {
    let mut line = Line::new(' ');
    line.field("OFFSET");
    add_vector(&mut line, space.position_from_canonical(offset));
    line.into_text()
}

fn left_out(job: &Job<'_>, held: usize) -> LeftOut {
    let mut left_out = LeftOut::new();
    if held > 0 {
        left_out.push(format!(
            "that something was not tracked in {held} of {} frames, where it stays as it was",
            job.take.len()
        ));
    }
    if !job.options.bvh.translations
        && let Some((joint, gap)) = largest_gap(job)
    {
        left_out.push(format!(
            "the gaps between segments, up to {:.1} mm at {joint}, which translations would keep",
            gap * 1000.0
        ));
    }
    left_out
}

fn largest_gap(job: &Job<'_>) -> Option<(String, f64)> {
    job.column(Section::Position)?;
    let take = job.take;
    let mut gaps = LargestGaps::new();
    let mut frame = Frame::new(Arc::clone(&take.subject));
    for place in 0..take.len() {
        take.read_frame(place, &mut frame);
        gaps.add(&frame);
    }
    let (joint, gap) = gaps.worst()?;
    (gap >= SMALLEST_GAP).then(|| (take.subject.skeleton.joints[joint].name.clone(), gap))
}

const DECIMALS: usize = 6;
/// What is told as 0.0 mm is no gap.
const SMALLEST_GAP: f64 = 0.000_05;
const THREE: &str = "3 Yrotation Xrotation Zrotation";
const SIX: &str = "6 Xposition Yposition Zposition Yrotation Xrotation Zrotation";

#[cfg(test)]
mod tests;

//! One line about a frame.

use std::fmt;

use super::{Frame, RigidBody};
use crate::line::count;

impl fmt::Display for Frame {
    /// `frame 162734: 1 of 1 bodies tracked, 6 labeled markers, time 1356.117s`. Empty sections are
    /// left out.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "frame {}:", self.number)?;
        let parts = [
            count(self.marker_sets.len(), "marker set"),
            count(self.other_markers.len(), "other marker"),
            self.bodies(),
            count(self.skeletons.len(), "skeleton"),
            count(self.assets.len(), "asset"),
            count(self.labeled_markers.len(), "labeled marker"),
            count(self.force_plates.len(), "force plate"),
            count(self.devices.len(), "device"),
            count(self.later_sections.len(), "opaque section"),
            self.time(),
        ];
        let parts: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        if parts.is_empty() {
            return f.write_str(" empty");
        }
        write!(f, " {}", parts.join(", "))
    }
}

impl Frame {
    fn bodies(&self) -> String {
        let all = self.rigid_bodies.len();
        let told = self.rigid_bodies.iter().filter_map(RigidBody::is_tracked);
        match told.clone().count() {
            0 => count(all, "rigid body"),
            _ => format!("{} of {all} bodies tracked", told.filter(|tracked| *tracked).count()),
        }
    }

    fn time(&self) -> String {
        let timecode = self.timecode.filter(|timecode| timecode.code != 0);
        let timecode = timecode.map(|timecode| format!("timecode {timecode}"));
        let timestamp = self.timestamp.map(|seconds| format!("time {seconds:.3}s"));
        let times: Vec<_> = timestamp.into_iter().chain(timecode).collect();
        times.join(", ")
    }
}

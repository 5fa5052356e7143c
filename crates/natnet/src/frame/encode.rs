//! Frames to bytes.

use super::{Frame, OpaqueSection};
use crate::Version;
use crate::record::{Record, write_list, write_section};
use crate::writer::Writer;

impl Frame {
    /// Appends the payload of the frame to `out`, laid out as `version` wants it.
    pub fn encode(&self, version: Version, out: &mut Vec<u8>) {
        let mut writer = Writer::new(out);
        writer.i32(self.number);
        self.write_sections(version, &mut writer);
        self.write_suffix(version, &mut writer);
        writer.i32(0);
    }

    /// Appends the payload of the frame to `out` as the draft of the 1.4 document has it when taken
    /// literally: everything inside the braces of the models. What belongs to no marker set goes into
    /// the first one; without a marker set it has no place.
    pub fn encode_draft(&self, out: &mut Vec<u8>) {
        let version = Version::new(1, 4);
        let mut writer = Writer::new(out);
        writer.i32(self.number);
        writer.count(self.marker_sets.len());
        for (n, set) in self.marker_sets.iter().enumerate() {
            let first = n == 0;
            set.write(&mut writer, version);
            write_list(if first { &self.other_markers } else { &[] }, &mut writer, version);
            write_list(if first { &self.rigid_bodies } else { &[] }, &mut writer, version);
            writer.f32(self.latency.unwrap_or_default());
            writer.i32(0);
        }
    }

    fn write_sections(&self, version: Version, writer: &mut Writer<'_>) {
        write_section(&self.marker_sets, writer, version);
        write_section(&self.other_markers, writer, version);
        write_section(&self.rigid_bodies, writer, version);
        if version.has_skeletons() {
            write_section(&self.skeletons, writer, version);
        }
        if version.has_assets() {
            write_section(&self.assets, writer, version);
        }
        if version.has_labeled_markers() {
            write_section(&self.labeled_markers, writer, version);
        }
        if version.has_force_plates() {
            write_section(&self.force_plates, writer, version);
        }
        if version.has_devices() {
            write_section(&self.devices, writer, version);
        }
        self.write_later(version, writer);
    }

    /// At least the sections that the version has, empty where the frame has none.
    fn write_later(&self, version: Version, writer: &mut Writer<'_>) {
        let expected = version.later_sections();
        if expected == 0 {
            return;
        }
        let empty = OpaqueSection::default();
        let missing = expected.saturating_sub(self.later_sections.len());
        let sections = self.later_sections.iter().chain(std::iter::repeat_n(&empty, missing));
        for section in sections {
            writer.i32(section.count);
            writer.part(true, |writer| writer.bytes(&section.bytes));
        }
    }

    fn write_suffix(&self, version: Version, writer: &mut Writer<'_>) {
        if version.has_latency() {
            writer.f32(self.latency.unwrap_or_default());
        }
        if version.has_timecode() {
            let timecode = self.timecode.unwrap_or_default();
            writer.u32(timecode.code);
            writer.u32(timecode.subframe);
        }
        self.write_timestamp(version, writer);
        if version.has_host_stamps() {
            let stamps = self.host_stamps.unwrap_or_default();
            writer.u64(stamps.mid_exposure);
            writer.u64(stamps.data_received);
            writer.u64(stamps.transmit);
        }
        if version.has_precision_time() {
            let time = self.precision_time.unwrap_or_default();
            writer.u32(time.seconds);
            writer.u32(time.fraction);
        }
        if version.has_params() {
            writer.i16(self.params.unwrap_or_default().0);
        }
    }

    fn write_timestamp(&self, version: Version, writer: &mut Writer<'_>) {
        let seconds = self.timestamp.unwrap_or_default();
        if version.has_wide_timestamp() {
            writer.f64(seconds);
        } else if version.has_timestamp() {
            writer.f32(seconds as f32);
        }
    }
}

//! Descriptions to bytes.

use super::{Description, MarkerSetDescription, Model};
use crate::reader::Reader;
use crate::record::{Record, read_list, write_list};
use crate::writer::Writer;
use crate::{Error, Version};

impl Model {
    /// Appends the payload of the descriptions to `out`, laid out as `version` wants it. Descriptions
    /// that the version [does not have](Description::is_in) are left out.
    pub fn encode(&self, version: Version, out: &mut Vec<u8>) {
        let there = self.descriptions.iter().filter(|one| one.is_in(version));
        let mut writer = Writer::new(out);
        writer.count(there.clone().count());
        for description in there {
            writer.i32(description.kind());
            writer.part(version.has_sized_sections(), |writer| {
                description.write(writer, version);
            });
        }
    }

    /// Appends the payload of the descriptions to `out` as the draft of the 1.4 document has it when
    /// taken literally: marker sets only, without types.
    pub fn encode_draft(&self, out: &mut Vec<u8>) {
        let sets = self.descriptions.iter().filter_map(|description| match description {
            Description::MarkerSet(set) => Some(set),
            _ => None,
        });
        let mut writer = Writer::new(out);
        writer.count(sets.clone().count());
        for set in sets {
            set.write(&mut writer, Version::new(1, 4));
        }
    }
}

impl Description {
    /// Whether `version` has descriptions of this type.
    pub const fn is_in(&self, version: Version) -> bool {
        match self {
            Self::MarkerSet(_) | Self::RigidBody(_) => true,
            Self::Skeleton(_) => version.has_skeletons(),
            Self::ForcePlate(_) => version.has_force_plates(),
            Self::Device(_) => version.has_devices(),
            Self::Camera(_) => version.describes_cameras(),
            Self::Asset(_) => version.has_assets(),
            Self::Unknown { .. } => version.has_sized_sections(),
        }
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        match self {
            Self::MarkerSet(body) => body.write(writer, version),
            Self::RigidBody(body) => body.write(writer, version),
            Self::Skeleton(body) => body.write(writer, version),
            Self::ForcePlate(body) => body.write(writer, version),
            Self::Device(body) => body.write(writer, version),
            Self::Camera(body) => body.write(writer, version),
            Self::Asset(body) => body.write(writer, version),
            Self::Unknown { bytes, .. } => writer.bytes(bytes),
        }
    }
}

impl Record for MarkerSetDescription {
    fn minimal_size(_: Version) -> usize {
        5
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.name.set(reader.name()?);
        read_list(&mut self.markers, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.name(&self.name);
        write_list(&self.markers, writer, version);
    }
}

//! Skeletons and assets of a frame.

use super::{LabeledMarker, RigidBody};
use crate::reader::Reader;
use crate::record::{Record, read_list, write_list};
use crate::writer::Writer;
use crate::{Error, Version};

/// A skeleton (2.1 and later).
///
/// | field | type |
/// |---|---|
/// | ID | i32 |
/// | count | i32 |
/// | bones | count x [`RigidBody`] |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    /// Streaming ID.
    pub id: i32,
    /// The bones, in the order of the description; the upper 16 bits of their IDs are the skeleton's.
    pub bones: Vec<RigidBody>,
}

impl Record for Skeleton {
    fn minimal_size(_: Version) -> usize {
        8
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.id = reader.i32()?;
        read_list(&mut self.bones, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.i32(self.id);
        write_list(&self.bones, writer, version);
    }
}

/// An asset, such as a trained marker set (4.1 and later).
///
/// | field | type |
/// |---|---|
/// | ID | i32 |
/// | count | i32 |
/// | rigid bodies | count x [`RigidBody`] |
/// | count | i32 |
/// | markers | count x [`LabeledMarker`] |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asset {
    /// Streaming ID.
    pub id: i32,
    /// The bones.
    pub rigid_bodies: Vec<RigidBody>,
    /// The markers.
    pub markers: Vec<LabeledMarker>,
}

impl Record for Asset {
    fn minimal_size(_: Version) -> usize {
        12
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.id = reader.i32()?;
        read_list(&mut self.rigid_bodies, reader, version)?;
        read_list(&mut self.markers, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.i32(self.id);
        write_list(&self.rigid_bodies, writer, version);
        write_list(&self.markers, writer, version);
    }
}

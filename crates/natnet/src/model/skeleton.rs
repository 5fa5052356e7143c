//! Descriptions of skeletons and assets.

use super::RigidBodyDescription;
use crate::frame::MarkerParams;
use crate::reader::Reader;
use crate::record::{Record, read_list, write_list};
use crate::writer::Writer;
use crate::{Error, Name, Version};

/// A skeleton (2.1 and later): name, ID, a count and as many bones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkeletonDescription {
    /// Name.
    pub name: Name,
    /// Streaming ID.
    pub id: i32,
    /// The bones; their parents are bones before them.
    pub bones: Vec<RigidBodyDescription>,
}

impl Record for SkeletonDescription {
    fn minimal_size(_: Version) -> usize {
        9
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.name.set(reader.name()?);
        self.id = reader.i32()?;
        read_list(&mut self.bones, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.name(&self.name);
        writer.i32(self.id);
        write_list(&self.bones, writer, version);
    }
}

/// An asset (4.1 and later).
///
/// | field | type |
/// |---|---|
/// | name | string |
/// | type | i32 |
/// | ID | i32 |
/// | count | i32 |
/// | rigid bodies | count x [`RigidBodyDescription`] |
/// | count | i32 |
/// | markers | count x [`AssetMarker`] |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AssetDescription {
    /// Name.
    pub name: Name,
    /// What kind of asset: 1 for a trained marker set.
    pub kind: i32,
    /// Streaming ID.
    pub id: i32,
    /// The bones.
    pub rigid_bodies: Vec<RigidBodyDescription>,
    /// The markers.
    pub markers: Vec<AssetMarker>,
}

impl Record for AssetDescription {
    fn minimal_size(_: Version) -> usize {
        17
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.name.set(reader.name()?);
        self.kind = reader.i32()?;
        self.id = reader.i32()?;
        read_list(&mut self.rigid_bodies, reader, version)?;
        read_list(&mut self.markers, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.name(&self.name);
        writer.i32(self.kind);
        writer.i32(self.id);
        write_list(&self.rigid_bodies, writer, version);
        write_list(&self.markers, writer, version);
    }
}

/// A marker of an asset: name, ID, position (3 f32), size (f32), params (i16).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AssetMarker {
    /// Name.
    pub name: Name,
    /// ID, as in the labeled markers of the frames.
    pub id: i32,
    /// Position at the time of the description, in metres.
    pub position: [f32; 3],
    /// Diameter in metres.
    pub size: f32,
    /// Bits, as in the frames.
    pub params: MarkerParams,
}

impl Record for AssetMarker {
    fn minimal_size(_: Version) -> usize {
        23
    }

    fn read(&mut self, reader: &mut Reader<'_>, _: Version) -> Result<(), Error> {
        self.name.set(reader.name()?);
        self.id = reader.i32()?;
        self.position = reader.floats()?;
        self.size = reader.f32()?;
        self.params = MarkerParams(reader.i16()?);
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, _: Version) {
        writer.name(&self.name);
        writer.i32(self.id);
        writer.floats(&self.position);
        writer.f32(self.size);
        writer.i16(self.params.0);
    }
}

//! Descriptions of rigid bodies and bones.

use crate::reader::Reader;
use crate::record::Record;
use crate::writer::Writer;
use crate::{Error, Name, Version};

/// A rigid body, or a bone of a skeleton or asset.
///
/// | field | type | in |
/// |---|---|---|
/// | name | string | 2.0 and later |
/// | ID | i32 | |
/// | parent ID | i32 | |
/// | offset | 3 f32 | |
/// | offset orientation | 4 f32 | 4.2 and later |
/// | marker count | i32 | 3.0 and later |
/// | marker offsets | count x 3 f32 | 3.0 and later |
/// | active labels | count x i32 | 3.0 and later |
/// | marker names | count strings | 4.0 and later |
///
/// Bones are left-handed before 3.0 and right-handed since.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidBodyDescription {
    /// Name; empty in 1.x, which has none.
    pub name: Name,
    /// Streaming ID; in a bone its number from 1, without the ID of the skeleton.
    pub id: i32,
    /// ID of the parent: -1 for a body of its own, 0 for the first bone of a skeleton.
    pub parent_id: i32,
    /// Offset from the parent in metres.
    pub offset: [f32; 3],
    /// Orientation against the parent, x, y, z, w (4.2 and later); the identity is sent for `None`.
    pub offset_orientation: Option<[f32; 4]>,
    /// The markers that the body is made of (3.0 and later).
    pub markers: Vec<BodyMarkerDescription>,
}

/// A marker of a rigid body (3.0 and later).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyMarkerDescription {
    /// Position in the body, in metres.
    pub offset: [f32; 3],
    /// Label of an active marker; 0 for a passive one.
    pub active_label: i32,
    /// Name (4.0 and later).
    pub name: Name,
}

impl Record for RigidBodyDescription {
    fn minimal_size(version: Version) -> usize {
        let fields = [
            (version.names_rigid_bodies(), 1),
            (version.has_offset_orientation(), 16),
            (version.describes_body_markers(), 4),
        ];
        fields
            .iter()
            .filter(|(there, _)| *there)
            .fold(20, |sum, (_, size)| sum + size)
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        if version.names_rigid_bodies() {
            self.name.set(reader.name()?);
        }
        self.id = reader.i32()?;
        self.parent_id = reader.i32()?;
        self.offset = reader.floats()?;
        let oriented = version.has_offset_orientation();
        self.offset_orientation = oriented.then(|| reader.floats()).transpose()?;
        if version.describes_body_markers() {
            read_markers(&mut self.markers, reader, version)?;
        }
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        if version.names_rigid_bodies() {
            writer.name(&self.name);
        }
        writer.i32(self.id);
        writer.i32(self.parent_id);
        writer.floats(&self.offset);
        if version.has_offset_orientation() {
            writer.floats(&self.offset_orientation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
        }
        if version.describes_body_markers() {
            write_markers(&self.markers, writer, version);
        }
    }
}

/// Offsets, then labels, then names.
fn read_markers(
    markers: &mut Vec<BodyMarkerDescription>,
    reader: &mut Reader<'_>,
    version: Version,
) -> Result<(), Error> {
    let named = version.names_body_markers();
    let count = reader.count(if named { 17 } else { 16 })?;
    markers.resize_with(count, BodyMarkerDescription::default);
    for marker in markers.iter_mut() {
        marker.offset = reader.floats()?;
    }
    for marker in markers.iter_mut() {
        marker.active_label = reader.i32()?;
    }
    if named {
        for marker in markers.iter_mut() {
            marker.name.set(reader.name()?);
        }
    }
    Ok(())
}

fn write_markers(markers: &[BodyMarkerDescription], writer: &mut Writer<'_>, version: Version) {
    writer.count(markers.len());
    for marker in markers {
        writer.floats(&marker.offset);
    }
    for marker in markers {
        writer.i32(marker.active_label);
    }
    if version.names_body_markers() {
        for marker in markers {
            writer.name(&marker.name);
        }
    }
}

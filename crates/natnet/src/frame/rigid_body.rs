//! Rigid bodies and bones of a frame.

use crate::reader::Reader;
use crate::record::Record;
use crate::writer::Writer;
use crate::{Error, Version};

/// A rigid body, or a bone of a skeleton or asset.
///
/// | field | type | in |
/// |---|---|---|
/// | ID | i32 | |
/// | position | 3 f32 | |
/// | orientation | 4 f32 | |
/// | marker count | i32 | before 3.0 |
/// | marker positions | count x 3 f32 | before 3.0 |
/// | marker IDs | count x i32 | 2.0 to 2.11 |
/// | marker sizes | count x f32 | 2.0 to 2.11 |
/// | mean error | f32 | 2.0 and later |
/// | params | i16 | 2.6 and later |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidBody {
    /// Streaming ID. In a bone the upper 16 bits are the ID of its skeleton.
    pub id: i32,
    /// Position in metres.
    pub position: [f32; 3],
    /// Unit quaternion x, y, z, w.
    pub orientation: [f32; 4],
    /// The markers of the body (before 3.0).
    pub markers: Vec<BodyMarker>,
    /// Mean distance of the markers to where the body wants them, in metres (2.0 and later).
    pub mean_error: Option<f32>,
    /// Whether the body was tracked (2.6 and later).
    pub params: Option<BodyParams>,
}

impl RigidBody {
    /// Whether the body was tracked in this frame; `None` where the version does not say. What is not
    /// tracked has a position all the same: zeros, or the last one.
    pub fn is_tracked(&self) -> Option<bool> {
        self.params.map(|params| params.contains(BodyParams::TRACKED))
    }

    /// The skeleton or asset that a bone belongs to; 0 for a body of its own.
    pub const fn owner_id(&self) -> i32 {
        self.id >> 16
    }

    /// The ID that the description of a bone has.
    pub const fn member_id(&self) -> i32 {
        self.id & 0xFFFF
    }
}

/// A marker of a rigid body (before 3.0).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyMarker {
    /// Position in metres.
    pub position: [f32; 3],
    /// ID of the marker (2.0 and later).
    pub id: Option<i32>,
    /// Diameter in metres (2.0 and later).
    pub size: Option<f32>,
}

/// Bits of a rigid body (2.6 and later).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct BodyParams(pub i16);

impl BodyParams {
    /// The body was tracked in this frame.
    pub const TRACKED: Self = Self(1);

    /// Whether all bits of `bits` are set.
    pub const fn contains(self, bits: Self) -> bool {
        self.0 & bits.0 == bits.0
    }
}

impl Record for RigidBody {
    fn minimal_size(version: Version) -> usize {
        let fields = [
            (version.has_body_markers(), 4),
            (version.has_mean_error(), 4),
            (version.has_params(), 2),
        ];
        fields
            .iter()
            .filter(|(there, _)| *there)
            .fold(32, |sum, (_, size)| sum + size)
    }

    #[inline]
    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.id = reader.i32()?;
        let [px, py, pz, x, y, z, w] = reader.floats()?;
        self.position = [px, py, pz];
        self.orientation = [x, y, z, w];
        self.markers.clear();
        if version.has_body_markers() {
            read_markers(&mut self.markers, reader, version)?;
        }
        self.mean_error = version.has_mean_error().then(|| reader.f32()).transpose()?;
        self.params = version.has_params().then(|| reader.i16()).transpose()?.map(BodyParams);
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.i32(self.id);
        writer.floats(&self.position);
        writer.floats(&self.orientation);
        if version.has_body_markers() {
            write_markers(&self.markers, writer, version);
        }
        if version.has_mean_error() {
            writer.f32(self.mean_error.unwrap_or_default());
        }
        if version.has_params() {
            writer.i16(self.params.unwrap_or_default().0);
        }
    }
}

/// Positions, then IDs, then sizes.
fn read_markers(markers: &mut Vec<BodyMarker>, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
    let with_ids = version.has_body_marker_ids();
    let count = reader.count(if with_ids { 20 } else { 12 })?;
    markers.resize(count, BodyMarker::default());
    for marker in markers.iter_mut() {
        marker.position = reader.floats()?;
    }
    if with_ids {
        for marker in markers.iter_mut() {
            marker.id = Some(reader.i32()?);
        }
        for marker in markers.iter_mut() {
            marker.size = Some(reader.f32()?);
        }
    }
    Ok(())
}

fn write_markers(markers: &[BodyMarker], writer: &mut Writer<'_>, version: Version) {
    writer.count(markers.len());
    for marker in markers {
        writer.floats(&marker.position);
    }
    if version.has_body_marker_ids() {
        for marker in markers {
            writer.i32(marker.id.unwrap_or_default());
        }
        for marker in markers {
            writer.f32(marker.size.unwrap_or_default());
        }
    }
}

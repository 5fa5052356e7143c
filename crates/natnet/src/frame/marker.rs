//! Markers of a frame.

use crate::reader::{Reader, floats};
use crate::record::{Record, read_list, write_list};
use crate::writer::Writer;
use crate::{Error, Name, Version};

/// The markers of one set.
///
/// | field | type |
/// |---|---|
/// | name | string |
/// | count | i32 |
/// | positions | count x 3 f32 |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerSet {
    /// Name of the set, as in its description.
    pub name: Name,
    /// Positions in metres, in the order of the description.
    pub markers: Vec<[f32; 3]>,
}

impl Record for MarkerSet {
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

/// A marker with an ID (2.3 and later).
///
/// | field | type | in |
/// |---|---|---|
/// | ID | i32 | |
/// | position | 3 f32 | |
/// | size | f32 | |
/// | params | i16 | 2.6 and later |
/// | residual | f32 | 3.0 and later |
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LabeledMarker {
    /// Motive 1.9 and later: asset ID in the upper, member in the lower 16 bits; before that, and for
    /// markers without a label, a running number.
    pub id: i32,
    /// Position in metres.
    pub position: [f32; 3],
    /// Diameter in metres.
    pub size: f32,
    /// How the marker was found (2.6 and later).
    pub params: Option<MarkerParams>,
    /// Mean distance to the rays of the cameras, in metres (3.0 and later).
    pub residual: Option<f32>,
}

impl LabeledMarker {
    /// The asset that the marker belongs to; 0 for a marker without a label.
    pub const fn asset_id(&self) -> i32 {
        self.id >> 16
    }

    /// Number of the marker within its asset, or of the marker without a label.
    pub const fn member_id(&self) -> i32 {
        self.id & 0xFFFF
    }
}

impl Record for LabeledMarker {
    fn minimal_size(version: Version) -> usize {
        match (version.has_params(), version.has_residual()) {
            (false, _) => 20,
            (true, false) => 22,
            (true, true) => 26,
        }
    }

    #[inline]
    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        if version.has_residual() {
            *self = with_residual(reader.take()?);
            return Ok(());
        }
        self.id = reader.i32()?;
        let [x, y, z, size] = reader.floats()?;
        (self.position, self.size) = ([x, y, z], size);
        self.params = version
            .has_params()
            .then(|| reader.i16())
            .transpose()?
            .map(MarkerParams);
        self.residual = None;
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        let [x, y, z] = self.position;
        writer.i32(self.id);
        writer.floats(&[x, y, z, self.size]);
        if version.has_params() {
            writer.i16(self.params.unwrap_or_default().0);
        }
        if version.has_residual() {
            writer.f32(self.residual.unwrap_or_default());
        }
    }
}

/// The whole record at once, for the versions that send hundreds of them.
#[inline]
fn with_residual(bytes: &[u8; 26]) -> LabeledMarker {
    let [a, b, c, d, .., p, q, _, _, _, _] = *bytes;
    let [x, y, z, size] = floats(&bytes[4..20]);
    let [residual] = floats(&bytes[22..]);
    LabeledMarker {
        id: i32::from_le_bytes([a, b, c, d]),
        position: [x, y, z],
        size,
        params: Some(MarkerParams(i16::from_le_bytes([p, q]))),
        residual: Some(residual),
    }
}

/// Bits of a labeled marker (2.6 and later).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MarkerParams(pub i16);

impl MarkerParams {
    /// The cameras did not see it. Not reliable: a solver may replace an occluded marker by leaving it
    /// out.
    pub const OCCLUDED: Self = Self(1);
    /// Position found by triangulation.
    pub const POINT_CLOUD_SOLVED: Self = Self(1 << 1);
    /// Position filled in from a model.
    pub const MODEL_FILLED: Self = Self(1 << 2);
    /// Belongs to an asset.
    pub const HAS_MODEL: Self = Self(1 << 3);
    /// Has no label.
    pub const UNLABELED: Self = Self(1 << 4);
    /// An active marker.
    pub const ACTIVE: Self = Self(1 << 5);
    /// Its label is established.
    pub const ESTABLISHED: Self = Self(1 << 6);
    /// A measurement, not a solution.
    pub const MEASUREMENT: Self = Self(1 << 7);

    /// Whether all bits of `bits` are set.
    pub const fn contains(self, bits: Self) -> bool {
        self.0 & bits.0 == bits.0
    }
}

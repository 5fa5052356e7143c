//! Type 24: centre of mass (MV0305 2.7.5).

use zerocopy::byteorder::big_endian::F32;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::{Body, floats, one_item_quirk, payload_size_error, wire};
use crate::{Error, Header, Quirk, Quirks};

/// Position, velocity and acceleration of the centre of mass, 36 bytes, as current software sends.
///
/// Global, right-handed, X forward, Y left, Z up; metres and seconds.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 12 | position x, y, z, m |
/// | 12 | 12 | velocity x, y, z, m/s |
/// | 24 | 12 | acceleration x, y, z, m/s² |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct CenterOfMass {
    position: [F32; 3],
    velocity: [F32; 3],
    acceleration: [F32; 3],
}

impl CenterOfMass {
    /// A centre of mass with its motion in m, m/s and m/s².
    #[inline]
    pub fn new(position: [f32; 3], velocity: [f32; 3], acceleration: [f32; 3]) -> Self {
        Self {
            position: wire(position),
            velocity: wire(velocity),
            acceleration: wire(acceleration),
        }
    }

    /// Position in metres, Z up.
    #[inline]
    pub fn position(&self) -> [f32; 3] {
        floats(self.position)
    }

    /// Global velocity in m/s.
    #[inline]
    pub fn velocity(&self) -> [f32; 3] {
        floats(self.velocity)
    }

    /// Global acceleration in m/s².
    #[inline]
    pub fn acceleration(&self) -> [f32; 3] {
        floats(self.acceleration)
    }
}

/// Position of the centre of mass alone, 12 bytes (MV0305 2.7.5), as older software sends.
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 0 | 12 | position x, y, z, m |
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, KnownLayout, Immutable, Unaligned)]
#[repr(C)]
pub struct CenterOfMassPosition {
    position: [F32; 3],
}

impl CenterOfMassPosition {
    /// A centre of mass at a position in metres.
    #[inline]
    pub fn new(position: [f32; 3]) -> Self {
        Self {
            position: wire(position),
        }
    }

    /// Position in metres, Z up.
    #[inline]
    pub fn position(&self) -> [f32; 3] {
        floats(self.position)
    }
}

pub(super) fn decode<'a>(header: &Header, bytes: &'a [u8], quirks: &mut Quirks) -> Result<(Body<'a>, &'a [u8]), Error> {
    const LONG: usize = size_of::<CenterOfMass>();
    const SHORT: usize = size_of::<CenterOfMassPosition>();
    one_item_quirk(header, quirks);
    let error = || payload_size_error(header, LONG, bytes.len());
    match item_size(header, bytes.len()) {
        LONG => {
            let (item, rest) = CenterOfMass::ref_from_prefix(bytes).map_err(|_| error())?;
            Ok((Body::CenterOfMass(item), rest))
        }
        SHORT => {
            let (item, rest) = CenterOfMassPosition::ref_from_prefix(bytes).map_err(|_| error())?;
            quirks.insert(Quirk::CenterOfMassShort);
            Ok((Body::CenterOfMassShort(item), rest))
        }
        _ => Err(error()),
    }
}

/// The stated size where more bytes came than that, else what came.
fn item_size(header: &Header, found: usize) -> usize {
    match usize::from(header.payload_size) {
        stated @ (12 | 36) if found != 12 && found != 36 => stated,
        _ => found,
    }
}

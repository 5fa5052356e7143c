//! Descriptions of force plates, other analog devices and cameras.

use crate::reader::Reader;
use crate::record::{Record, read_list, write_list};
use crate::writer::Writer;
use crate::{Error, Name, Version};

/// A force plate (2.9 and later).
///
/// | field | type |
/// |---|---|
/// | ID | i32 |
/// | serial number | string |
/// | width, length | 2 f32 |
/// | origin | 3 f32 |
/// | calibration | 144 f32 |
/// | corners | 12 f32 |
/// | type | i32 |
/// | type of the data | i32 |
/// | count | i32 |
/// | channel names | count strings |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForcePlate {
    /// ID, as in the frames.
    pub id: i32,
    /// Serial number.
    pub serial: Name,
    /// Size along its x axis, in the unit of the plate's maker.
    pub width: f32,
    /// Size along its y axis, in the unit of the plate's maker.
    pub length: f32,
    /// Offset of the electrical centre from the geometrical one.
    pub origin: [f32; 3],
    /// Calibration matrix, row by row.
    pub calibration: Box<[[f32; 12]; 12]>,
    /// The four corners in the space of the frames, in metres.
    pub corners: [[f32; 3]; 4],
    /// Kind of plate.
    pub kind: i32,
    /// Kind of data: 0 calibrated, 1 raw.
    pub channel_data: i32,
    /// Names of the channels.
    pub channels: Vec<Name>,
}

impl Record for ForcePlate {
    fn minimal_size(_: Version) -> usize {
        661
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.id = reader.i32()?;
        self.serial.set(reader.name()?);
        self.width = reader.f32()?;
        self.length = reader.f32()?;
        self.origin = reader.floats()?;
        for row in self.calibration.iter_mut() {
            *row = reader.floats()?;
        }
        for corner in &mut self.corners {
            *corner = reader.floats()?;
        }
        self.kind = reader.i32()?;
        self.channel_data = reader.i32()?;
        read_list(&mut self.channels, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.i32(self.id);
        writer.name(&self.serial);
        writer.f32(self.width);
        writer.f32(self.length);
        writer.floats(&self.origin);
        for row in self.calibration.iter() {
            writer.floats(row);
        }
        for corner in &self.corners {
            writer.floats(corner);
        }
        writer.i32(self.kind);
        writer.i32(self.channel_data);
        write_list(&self.channels, writer, version);
    }
}

/// An analog device (2.11 and later): ID, name, serial number, type, type of the data, a count and
/// as many channel names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Device {
    /// ID, as in the frames.
    pub id: i32,
    /// Name.
    pub name: Name,
    /// Serial number.
    pub serial: Name,
    /// Kind of device.
    pub kind: i32,
    /// Kind of data.
    pub channel_data: i32,
    /// Names of the channels.
    pub channels: Vec<Name>,
}

impl Record for Device {
    fn minimal_size(_: Version) -> usize {
        18
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.id = reader.i32()?;
        self.name.set(reader.name()?);
        self.serial.set(reader.name()?);
        self.kind = reader.i32()?;
        self.channel_data = reader.i32()?;
        read_list(&mut self.channels, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.i32(self.id);
        writer.name(&self.name);
        writer.name(&self.serial);
        writer.i32(self.kind);
        writer.i32(self.channel_data);
        write_list(&self.channels, writer, version);
    }
}

/// A camera (3.0 and later): name, position, orientation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Camera {
    /// Name.
    pub name: Name,
    /// Position in metres.
    pub position: [f32; 3],
    /// Unit quaternion x, y, z, w.
    pub orientation: [f32; 4],
}

impl Record for Camera {
    fn minimal_size(_: Version) -> usize {
        29
    }

    fn read(&mut self, reader: &mut Reader<'_>, _: Version) -> Result<(), Error> {
        self.name.set(reader.name()?);
        self.position = reader.floats()?;
        self.orientation = reader.floats()?;
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, _: Version) {
        writer.name(&self.name);
        writer.floats(&self.position);
        writer.floats(&self.orientation);
    }
}

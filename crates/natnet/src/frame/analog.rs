//! Force plates and other analog devices of a frame.

use crate::reader::Reader;
use crate::record::{Record, read_list, write_list};
use crate::writer::Writer;
use crate::{Error, Version};

/// What a force plate (2.9 and later) or another device (2.11 and later) measured since the last
/// frame.
///
/// | field | type |
/// |---|---|
/// | ID | i32 |
/// | count | i32 |
/// | channels | count x [`Channel`] |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnalogDevice {
    /// ID of the device, as in its description.
    pub id: i32,
    /// The channels, in the order of the description.
    pub channels: Vec<Channel>,
}

impl Record for AnalogDevice {
    fn minimal_size(_: Version) -> usize {
        8
    }

    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
        self.id = reader.i32()?;
        read_list(&mut self.channels, reader, version)
    }

    fn write(&self, writer: &mut Writer<'_>, version: Version) {
        writer.i32(self.id);
        write_list(&self.channels, writer, version);
    }
}

/// One channel: a count (i32) and as many f32.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    /// The samples, oldest first, in the unit of the device.
    pub samples: Vec<f32>,
}

impl Record for Channel {
    fn minimal_size(_: Version) -> usize {
        4
    }

    fn read(&mut self, reader: &mut Reader<'_>, _: Version) -> Result<(), Error> {
        let count = reader.count(4)?;
        let (words, _) = reader.bytes(4 * count)?.as_chunks();
        self.samples.clear();
        self.samples.extend(words.iter().map(|word| f32::from_le_bytes(*word)));
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, _: Version) {
        writer.count(self.samples.len());
        for sample in &self.samples {
            writer.f32(*sample);
        }
    }
}

//! Records that repeat: how lists and sections of them are read and written.

use crate::reader::Reader;
use crate::writer::Writer;
use crate::{Error, Quirk, Quirks, Version};

/// One record of a list.
pub(crate) trait Record: Default {
    /// The fewest bytes that one record has.
    fn minimal_size(version: Version) -> usize;

    /// Reads one record over an old one, whose memory is used again.
    fn read(&mut self, reader: &mut Reader<'_>, version: Version) -> Result<(), Error>;

    /// Appends one record.
    fn write(&self, writer: &mut Writer<'_>, version: Version);
}

/// Reads a count and as many records.
pub(crate) fn read_list<T: Record>(list: &mut Vec<T>, reader: &mut Reader<'_>, version: Version) -> Result<(), Error> {
    let count = reader.count(T::minimal_size(version))?;
    read_records(list, count, reader, version)
}

/// Appends a count and the records.
pub(crate) fn write_list<T: Record>(list: &[T], writer: &mut Writer<'_>, version: Version) {
    writer.count(list.len());
    write_records(list, writer, version);
}

/// Reads a section of a frame: a list that states its size in bytes since 4.1.
pub(crate) fn read_section<T: Record>(
    list: &mut Vec<T>,
    reader: &mut Reader<'_>,
    version: Version,
    quirks: &mut Quirks,
) -> Result<(), Error> {
    if !version.has_sized_sections() {
        return read_list(list, reader, version);
    }
    let offset = reader.offset();
    let count = reader.i32()?;
    let mut part = reader.sized_part(0)?;
    let count = part.fits(count, T::minimal_size(version), offset)?;
    read_records(list, count, &mut part, version)?;
    quirks.insert_if(part.left() > 0, Quirk::SectionLeftover);
    Ok(())
}

/// Appends a section of a frame.
pub(crate) fn write_section<T: Record>(list: &[T], writer: &mut Writer<'_>, version: Version) {
    writer.count(list.len());
    writer.part(version.has_sized_sections(), |writer| {
        write_records(list, writer, version);
    });
}

#[inline]
fn read_records<T: Record>(
    list: &mut Vec<T>,
    count: usize,
    reader: &mut Reader<'_>,
    version: Version,
) -> Result<(), Error> {
    list.resize_with(count, T::default);
    list.iter_mut().try_for_each(|record| record.read(reader, version))
}

fn write_records<T: Record>(list: &[T], writer: &mut Writer<'_>, version: Version) {
    for record in list {
        record.write(writer, version);
    }
}

/// A position: three numbers.
impl Record for [f32; 3] {
    fn minimal_size(_: Version) -> usize {
        12
    }

    #[inline]
    fn read(&mut self, reader: &mut Reader<'_>, _: Version) -> Result<(), Error> {
        *self = reader.floats()?;
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, _: Version) {
        writer.floats(self);
    }
}

impl Record for crate::Name {
    fn minimal_size(_: Version) -> usize {
        1
    }

    fn read(&mut self, reader: &mut Reader<'_>, _: Version) -> Result<(), Error> {
        self.set(reader.name()?);
        Ok(())
    }

    fn write(&self, writer: &mut Writer<'_>, _: Version) {
        writer.name(self);
    }
}

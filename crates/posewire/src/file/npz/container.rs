//! A zip file of entries that are stored as they are (PKWARE's APPNOTE 6.3, 4.3).
//!
//! Its own, because a writer of the `zip` crate that is dropped after its output has failed tries to write its directory, and
//! complains on the terminal that it cannot.

use super::super::output::Output;
use flate2::Crc;
use std::io::{self, Seek, SeekFrom, Write};

/// A zip file that is being written, one entry after the other.
pub(super) struct Container<'a, 'b> {
    out: &'a mut Output<'b>,
    /// Bytes written so far.
    length: u64,
    entries: Vec<Entry>,
    crc: Crc,
    /// From here on, sizes and offsets are in the long form.
    limit: u64,
}

struct Entry {
    name: String,
    offset: u64,
    size: u64,
    crc: u32,
}

impl<'a, 'b> Container<'a, 'b> {
    /// Without entries.
    pub(super) fn new(out: &'a mut Output<'b>) -> Self {
        Self {
            out,
            length: 0,
            entries: Vec::new(),
            crc: Crc::new(),
            limit: u64::from(u32::MAX),
        }
    }

    /// Begins an entry, of which exactly `size` bytes follow.
    pub(super) fn begin(&mut self, name: String, size: u64) -> io::Result<()> {
        self.end()?;
        let offset = self.length;
        let entry = Entry {
            name,
            offset,
            size,
            crc: 0,
        };
        let mut head = LOCAL.to_le_bytes().to_vec();
        let extra = self.common(&entry, false, &mut head);
        head.extend_from_slice(entry.name.as_bytes());
        head.extend_from_slice(&extra);
        self.entries.push(entry);
        self.put(&head)
    }

    /// Bytes of the entry that was begun.
    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.crc.update(bytes);
        self.put(bytes)
    }

    /// Writes the directory.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.end()?;
        let begin = self.length;
        for entry in &self.entries {
            let mut record = DIRECTORY.to_le_bytes().to_vec();
            record.extend_from_slice(&VERSION.to_le_bytes());
            let extra = self.common(entry, true, &mut record);
            // No comment, no disk, no attributes.
            record.extend_from_slice(&[0; 10]);
            record.extend_from_slice(&self.short(entry.offset, entry).to_le_bytes());
            record.extend_from_slice(entry.name.as_bytes());
            record.extend_from_slice(&extra);
            self.length += record.len() as u64;
            self.out.write_all(&record)?;
        }
        let end = self.end_of_directory(begin);
        self.put(&end)
    }

    /// Fills in the checksum of the last entry.
    fn end(&mut self) -> io::Result<()> {
        let Some(entry) = self.entries.last_mut() else {
            return Ok(());
        };
        entry.crc = self.crc.sum();
        self.crc.reset();
        self.out.seek(SeekFrom::Start(entry.offset + CRC_AT))?;
        self.out.write_all(&entry.crc.to_le_bytes())?;
        self.out.seek(SeekFrom::Start(self.length))?;
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.length += bytes.len() as u64;
        self.out.write_all(bytes)
    }

    /// What an entry's own record and the directory's have in common; gives the extra field that follows the name.
    fn common(&self, entry: &Entry, in_directory: bool, to: &mut Vec<u8>) -> Vec<u8> {
        let extra = self.extra(entry, in_directory);
        for word in [VERSION, UTF_8, STORED, MIDNIGHT, FIRST_OF_1980] {
            to.extend_from_slice(&word.to_le_bytes());
        }
        let size = self.short(entry.size, entry);
        for number in [entry.crc, size, size] {
            to.extend_from_slice(&number.to_le_bytes());
        }
        for length in [entry.name.len(), extra.len()] {
            to.extend_from_slice(&(length as u16).to_le_bytes());
        }
        extra
    }

    /// Sizes and, in the directory, the offset, of an entry for which 32 bits are too few.
    fn extra(&self, entry: &Entry, in_directory: bool) -> Vec<u8> {
        if !self.is_long(entry) {
            return Vec::new();
        }
        let numbers = [entry.size, entry.size, entry.offset];
        let numbers = &numbers[..if in_directory { 3 } else { 2 }];
        let mut extra = ZIP64.to_le_bytes().to_vec();
        extra.extend_from_slice(&(8 * numbers.len() as u16).to_le_bytes());
        extra.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        extra
    }

    fn end_of_directory(&self, begin: u64) -> Vec<u8> {
        let (count, size) = (self.entries.len() as u64, self.length - begin);
        let long = begin >= self.limit;
        let mut end = Vec::new();
        if long {
            end.extend_from_slice(&LONG_END.to_le_bytes());
            end.extend_from_slice(&44_u64.to_le_bytes());
            end.extend_from_slice(&[VERSION.to_le_bytes(), VERSION.to_le_bytes()].concat());
            end.extend_from_slice(&[0; 8]);
            for number in [count, count, size, begin] {
                end.extend_from_slice(&number.to_le_bytes());
            }
            end.extend_from_slice(&LOCATOR.to_le_bytes());
            end.extend_from_slice(&[0; 4]);
            end.extend_from_slice(&self.length.to_le_bytes());
            end.extend_from_slice(&1_u32.to_le_bytes());
        }
        end.extend_from_slice(&END.to_le_bytes());
        end.extend_from_slice(&[0; 4]);
        end.extend_from_slice(&[(count as u16).to_le_bytes(), (count as u16).to_le_bytes()].concat());
        end.extend_from_slice(&(size as u32).to_le_bytes());
        let begin = if long { u32::MAX } else { begin as u32 };
        end.extend_from_slice(&begin.to_le_bytes());
        end.extend_from_slice(&[0; 2]);
        end
    }

    fn is_long(&self, entry: &Entry) -> bool {
        entry.size >= self.limit || entry.offset >= self.limit
    }

    /// A number, or what says that it is in the extra field.
    fn short(&self, number: u64, entry: &Entry) -> u32 {
        if self.is_long(entry) { u32::MAX } else { number as u32 }
    }
}

const LOCAL: u32 = 0x0403_4b50;
const DIRECTORY: u32 = 0x0201_4b50;
const END: u32 = 0x0605_4b50;
const LONG_END: u32 = 0x0606_4b50;
const LOCATOR: u32 = 0x0706_4b50;
const ZIP64: u16 = 1;
/// The version of the specification that has the long form.
const VERSION: u16 = 45;
/// Names are UTF-8.
const UTF_8: u16 = 1 << 11;
const STORED: u16 = 0;
const MIDNIGHT: u16 = 0;
const FIRST_OF_1980: u16 = 1 << 5 | 1;
/// Where an entry's record has its checksum.
const CRC_AT: u64 = 14;

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Cursor, Read};
    use zip::ZipArchive;

    #[test]
    fn entries_come_back_in_the_short_and_in_the_long_form() {
        for limit in [u64::from(u32::MAX), 100, 0] {
            let mut file = Cursor::new(Vec::new());
            let mut out = Output::new(&mut file);
            let mut container = Container::new(&mut out);
            container.limit = limit;
            for (name, content) in CONTENT {
                container.begin(name.to_owned(), content.len() as u64).unwrap();
                for byte in content.bytes() {
                    container.write(&[byte]).unwrap();
                }
            }
            container.finish().unwrap();
            out.finish().unwrap();
            let mut archive = ZipArchive::new(file).unwrap();
            assert_eq!(archive.len(), CONTENT.len());
            for (name, content) in CONTENT {
                let mut found = String::new();
                archive.by_name(name).unwrap().read_to_string(&mut found).unwrap();
                assert_eq!(found, content, "limit {limit}");
            }
        }
    }

    const CONTENT: [(&str, &str); 3] = [
        ("a.npy", ""),
        (
            "größe.npy",
            "some hundred bytes, so that the next entry is behind the limit of the second try, which is at 100",
        ),
        ("c.npy", "0123456789"),
    ];
}

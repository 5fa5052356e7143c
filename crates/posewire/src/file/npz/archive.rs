//! Arrays of `NumPy` (NEP 1, version 1.0), side by side in an archive.

use super::super::output::Output;
use super::container::Container;
use std::io;

/// An archive that is being written, one array after the other.
pub(super) struct Archive<'a, 'b> {
    container: Container<'a, 'b>,
    bytes: Vec<u8>,
}

impl<'a, 'b> Archive<'a, 'b> {
    /// An archive without arrays.
    pub(super) fn new(out: &'a mut Output<'b>) -> Self {
        Self {
            container: Container::new(out),
            bytes: Vec::new(),
        }
    }

    /// Begins an array of `NumPy`'s type `descr`, whose values of `width` bytes follow row by row.
    pub(super) fn begin(&mut self, name: &str, descr: &str, shape: &[usize], width: usize) -> io::Result<()> {
        let head = header(descr, shape);
        let values = shape.iter().product::<usize>() as u64 * width as u64;
        self.container
            .begin(format!("{name}.npy"), head.len() as u64 + values)?;
        self.container.write(&head)
    }

    /// Values of the array that was begun.
    pub(super) fn values<const N: usize>(&mut self, values: impl Iterator<Item = [u8; N]>) -> io::Result<()> {
        for value in values {
            self.bytes.extend_from_slice(&value);
        }
        let written = self.container.write(&self.bytes);
        self.bytes.clear();
        written
    }

    /// A whole array; without a shape, one value.
    pub(super) fn array<const N: usize>(
        &mut self,
        name: &str,
        descr: &str,
        shape: &[usize],
        values: impl Iterator<Item = [u8; N]>,
    ) -> io::Result<()> {
        self.begin(name, descr, shape, N)?;
        self.values(values)
    }

    /// An array of texts.
    pub(super) fn texts<'t>(&mut self, name: &str, texts: impl Iterator<Item = &'t str>) -> io::Result<()> {
        let texts: Vec<_> = texts.collect();
        self.letters(name, &[texts.len()], &texts)
    }

    /// One text.
    pub(super) fn text(&mut self, name: &str, text: &str) -> io::Result<()> {
        self.letters(name, &[], &[text])
    }

    /// Writes the archive's directory.
    pub(super) fn finish(self) -> io::Result<()> {
        self.container.finish()
    }

    /// Texts are of one length, in four bytes a letter, with zeros behind.
    fn letters(&mut self, name: &str, shape: &[usize], texts: &[&str]) -> io::Result<()> {
        let length = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
        self.begin(name, &format!("<U{length}"), shape, 4 * length)?;
        for text in texts {
            let letters = text.chars().map(u32::from).chain(std::iter::repeat(0));
            self.values(letters.take(length).map(u32::to_le_bytes))?;
        }
        Ok(())
    }
}

/// The bytes before an array's values: a Python dictionary, with spaces up to a multiple of 64 bytes.
fn header(descr: &str, shape: &[usize]) -> Vec<u8> {
    let lengths: Vec<_> = shape.iter().map(ToString::to_string).collect();
    // Python takes one number in parentheses for a number.
    let comma = if shape.len() == 1 { "," } else { "" };
    let shape = lengths.join(", ");
    let text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({shape}{comma}), }}");
    let before = MAGIC.len() + 2;
    let length = (before + text.len() + 1).next_multiple_of(64) - before;
    let mut bytes = MAGIC.to_vec();
    bytes.extend_from_slice(&(length as u16).to_le_bytes());
    bytes.extend_from_slice(format!("{text:<width$}\n", width = length - 1).as_bytes());
    bytes
}

const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_says_type_and_shape_and_ends_at_64_bytes() {
        for (shape, expected) in [
            (&[][..], "'shape': (), }"),
            (&[3][..], "'shape': (3,), }"),
            (&[0, 23, 3][..], "'shape': (0, 23, 3), }"),
        ] {
            let header = header("<f8", shape);
            assert_eq!(header.len() % 64, 0);
            assert_eq!(
                usize::from(u16::from_le_bytes([header[8], header[9]])),
                header.len() - 10
            );
            let text = String::from_utf8(header[10..].to_vec()).unwrap();
            assert!(text.starts_with("{'descr': '<f8', 'fortran_order': False, ") && text.ends_with('\n'));
            assert!(text.trim_end().ends_with(expected), "{text}");
        }
    }
}

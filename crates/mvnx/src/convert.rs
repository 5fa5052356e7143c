//! Whole files and takes, written at once.

use crate::{Document, Error, LeftOut, Reader, Remainder, Version, Writer};
use posewire_motion::{Frame, Take};
use std::io::{BufRead, Write};
use std::sync::Arc;

/// Writes the rest of a file in a version of the format, frame by frame, and tells what is left out.
///
/// In the file's own version everything comes out as it stands there, in MVN's layout: a file that MVN wrote comes out byte
/// for byte.
///
/// ```
/// # let file = &br#"<mvnx version="4"><subject label="Ada" frameRate="240"><segments><segment label="Pelvis" id="1"/>
/// # </segments><frames><frame time="0" index="0" type="normal"><orientation>1 0 0 0</orientation>
/// # <position>0 0 0.95</position></frame></frames></subject></mvnx>"#[..];
/// use posewire_mvnx::{Reader, Version, rewrite};
///
/// let mut converted = Vec::new();
/// let left_out = rewrite(&mut Reader::new(file)?, Version::V3, &mut converted)?;
/// for line in &left_out {
///     println!("left out: {line}");
/// }
/// assert_eq!(Reader::new(&converted[..])?.header().version, 3);
/// # Ok::<(), posewire_mvnx::Error>(())
/// ```
///
/// # Errors
/// What ends the reader's iteration, unless it salvages; [`Error::Write`] when the destination fails.
pub fn rewrite<R: BufRead, W: Write>(reader: &mut Reader<R>, version: Version, to: W) -> Result<Vec<LeftOut>, Error> {
    let mut writer = Writer::new(to, &reader.document(), version)?;
    let mut remainder = Remainder::default();
    while let Some(frame) = reader.read_whole(&mut remainder) {
        writer.write_whole(&frame?, &remainder)?;
    }
    let (_, left_out) = writer.finish(&reader.document())?;
    Ok(left_out)
}

/// Writes a take in a version of the format and tells what is left out.
///
/// The document is that of the file which the take was read from, read to its end, or one that
/// [describes](Document::describe) the take's subject. The frames' attributes follow from their samples and times, and
/// unknown elements within them are gone with the reading: [`rewrite`] keeps them.
///
/// # Errors
/// [`Error::Misfit`] when the take does not fit the document; [`Error::Write`] when the destination fails.
pub fn write_take<W: Write>(document: &Document, take: &Take, version: Version, to: W) -> Result<Vec<LeftOut>, Error> {
    let mut writer = Writer::new(to, document, version)?;
    let mut frame = Frame::new(Arc::clone(&take.subject));
    for place in 0..take.len() {
        take.read_frame(place, &mut frame);
        writer.write(&frame)?;
    }
    let (_, left_out) = writer.finish(document)?;
    Ok(left_out)
}

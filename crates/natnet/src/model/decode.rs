//! Bytes to descriptions.

use super::{Description, MarkerSetDescription, Model, section};
use crate::reader::Reader;
use crate::record::{Record, read_list};
use crate::{Error, Quirk, Quirks, Version};

/// The layout that servers fall back to which say 4.1 or later and send no sizes.
const UNSIZED: Version = Version::new(4, 0);

impl Model {
    /// Reads the payload of the descriptions, and what was unusual about it.
    ///
    /// Two other layouts are tried where the one of the version fails, and accepted when every byte
    /// has its place in them: the one without sizes in 4.1 and later, and the draft without types in
    /// 1.x. When that fails too, descriptions of 4.1 and later that cannot be read are kept as
    /// [`Description::Unknown`], so that one of them does not cost the names of all others.
    ///
    /// # Errors
    /// A payload that is cut short, counts what it cannot hold, does not end where it should, or has
    /// a description of an unknown type without a size.
    pub fn decode(version: Version, payload: &[u8]) -> Result<(Self, Quirks), Error> {
        let mut quirks = Quirks::NONE;
        match read(version, payload, Faults::Fail, &mut quirks) {
            Ok(descriptions) => Ok((Self { descriptions }, quirks)),
            Err(error) => read_otherwise(version, payload).ok_or(error),
        }
    }
}

fn read_otherwise(version: Version, payload: &[u8]) -> Option<(Model, Quirks)> {
    if version.has_sized_sections() {
        return read_unsized(payload).or_else(|| read_tolerant(version, payload));
    }
    if version.has_draft() {
        let descriptions = read_draft(version, payload).ok()?;
        return Some((Model { descriptions }, Quirk::DraftLayout.into()));
    }
    None
}

fn read_unsized(payload: &[u8]) -> Option<(Model, Quirks)> {
    let mut quirks = Quirk::UnsizedSections.into();
    let descriptions = read(UNSIZED, payload, Faults::Fail, &mut quirks).ok()?;
    Some((Model { descriptions }, quirks))
}

fn read_tolerant(version: Version, payload: &[u8]) -> Option<(Model, Quirks)> {
    let mut quirks = Quirks::NONE;
    let descriptions = read(version, payload, Faults::Keep, &mut quirks).ok()?;
    Some((Model { descriptions }, quirks))
}

/// What becomes of a description with a size whose body cannot be read.
#[derive(Clone, Copy, PartialEq)]
enum Faults {
    Fail,
    Keep,
}

fn read(version: Version, payload: &[u8], faults: Faults, quirks: &mut Quirks) -> Result<Vec<Description>, Error> {
    let mut reader = Reader::new(section::PREFIX, payload);
    // The shortest: a type and, since 4.1, a size; a name and a count before.
    let count = reader.count(if version.has_sized_sections() { 8 } else { 9 })?;
    let mut descriptions = Vec::with_capacity(count);
    for _ in 0..count {
        reader.enter(section::PREFIX);
        let description = if version.has_sized_sections() {
            read_sized(version, &mut reader, faults, quirks)?
        } else {
            read_unsized_one(version, &mut reader, quirks)?
        };
        descriptions.push(description);
    }
    reader.enter(section::PREFIX);
    reader.finish()?;
    Ok(descriptions)
}

fn read_unsized_one(version: Version, reader: &mut Reader<'_>, quirks: &mut Quirks) -> Result<Description, Error> {
    let offset = reader.offset();
    let kind = reader.i32()?;
    reader.enter(section::of(kind));
    let unknown = Error::DescriptionType { found: kind, offset };
    let description = read_known(kind, version, reader)?.ok_or(unknown)?;
    quirks.insert_if(!description.is_in(version), Quirk::ExtraSections);
    Ok(description)
}

fn read_sized(
    version: Version,
    reader: &mut Reader<'_>,
    faults: Faults,
    quirks: &mut Quirks,
) -> Result<Description, Error> {
    let kind = reader.i32()?;
    reader.enter(section::of(kind));
    let mut part = reader.sized_part(0)?;
    let bytes = part.clone().rest();
    match read_known(kind, version, &mut part) {
        Ok(Some(description)) => {
            quirks.insert_if(part.left() > 0, Quirk::SectionLeftover);
            return Ok(description);
        }
        Ok(None) => {}
        Err(error) if faults == Faults::Fail => return Err(error),
        Err(_) => quirks.insert(Quirk::UnreadableDescription),
    }
    let bytes = bytes.to_vec();
    Ok(Description::Unknown { kind, bytes })
}

fn read_known(kind: i32, version: Version, reader: &mut Reader<'_>) -> Result<Option<Description>, Error> {
    Ok(Some(match kind {
        0 => Description::MarkerSet(body(version, reader)?),
        1 => Description::RigidBody(body(version, reader)?),
        2 => Description::Skeleton(body(version, reader)?),
        3 => Description::ForcePlate(body(version, reader)?),
        4 => Description::Device(body(version, reader)?),
        5 => Description::Camera(body(version, reader)?),
        6 => Description::Asset(body(version, reader)?),
        _ => return Ok(None),
    }))
}

fn body<T: Record>(version: Version, reader: &mut Reader<'_>) -> Result<T, Error> {
    let mut body = T::default();
    body.read(reader, version)?;
    Ok(body)
}

/// Marker sets only, without types.
fn read_draft(version: Version, payload: &[u8]) -> Result<Vec<Description>, Error> {
    let mut reader = Reader::new(section::of(0), payload);
    let mut sets = Vec::<MarkerSetDescription>::new();
    read_list(&mut sets, &mut reader, version)?;
    reader.finish()?;
    Ok(sets.into_iter().map(Description::MarkerSet).collect())
}

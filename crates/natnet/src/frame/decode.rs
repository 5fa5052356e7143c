//! Bytes to frames.

use super::{Frame, FrameParams, HostStamps, MarkerSet, OpaqueSection, PrecisionTime, RigidBody, Timecode, section};
use crate::reader::Reader;
use crate::record::{Record, read_list, read_section};
use crate::{Error, Quirk, Quirks, Version};

/// The layout that servers fall back to which say 4.1 or later and send no sizes.
const UNSIZED: Version = Version::new(4, 0);

impl Frame {
    /// Reads the payload of a frame, and what was unusual about it.
    ///
    /// # Errors
    /// As [`decode_into`](Self::decode_into).
    pub fn decode(version: Version, payload: &[u8]) -> Result<(Self, Quirks), Error> {
        let mut frame = Self::default();
        let quirks = frame.decode_into(version, payload)?;
        Ok((frame, quirks))
    }

    /// Reads the payload of a frame over this one, whose memory is used again: a stream whose frames
    /// do not grow allocates nothing. After an error the frame holds parts of both.
    ///
    /// Two other layouts are tried where the one of the version fails, and accepted when every byte
    /// has its place in them: the one without sizes in 4.1 and later, and the draft in 1.x.
    ///
    /// # Errors
    /// A payload that is cut short, counts what it cannot hold, or does not end where it should.
    pub fn decode_into(&mut self, version: Version, payload: &[u8]) -> Result<Quirks, Error> {
        let mut quirks = Quirks::NONE;
        let Err(error) = self.read(version, payload, &mut quirks) else {
            return Ok(quirks);
        };
        self.read_otherwise(version, payload).ok_or(error)
    }

    #[cold]
    fn read_otherwise(&mut self, version: Version, payload: &[u8]) -> Option<Quirks> {
        if version.has_sized_sections() {
            let mut quirks = Quirk::UnsizedSections.into();
            self.read(UNSIZED, payload, &mut quirks).ok()?;
            return Some(quirks);
        }
        if version.has_draft() {
            self.read_draft(version, payload).ok()?;
            return Some(Quirk::DraftLayout.into());
        }
        None
    }

    fn read(&mut self, version: Version, payload: &[u8], quirks: &mut Quirks) -> Result<(), Error> {
        let mut sections = Sections {
            reader: Reader::new(section::PREFIX, payload),
            version,
            quirks,
        };
        self.number = sections.reader.i32()?;
        self.read_sections(&mut sections)?;
        let Sections { mut reader, quirks, .. } = sections;
        self.read_suffix(version, &mut reader, quirks)?;
        end_of_frame(&mut reader)?;
        reader.finish()
    }

    fn read_sections(&mut self, sections: &mut Sections<'_>) -> Result<(), Error> {
        let version = sections.version;
        sections.list(true, section::MARKER_SETS, &mut self.marker_sets)?;
        sections.list(true, section::OTHER_MARKERS, &mut self.other_markers)?;
        sections.list(true, section::RIGID_BODIES, &mut self.rigid_bodies)?;
        sections.list(version.has_skeletons(), section::SKELETONS, &mut self.skeletons)?;
        sections.list(version.has_assets(), section::ASSETS, &mut self.assets)?;
        let labeled = version.has_labeled_markers();
        sections.list(labeled, section::LABELED_MARKERS, &mut self.labeled_markers)?;
        sections.list(
            version.has_force_plates(),
            section::FORCE_PLATES,
            &mut self.force_plates,
        )?;
        sections.list(version.has_devices(), section::DEVICES, &mut self.devices)?;
        sections.later(&mut self.later_sections)
    }

    fn read_suffix(&mut self, version: Version, reader: &mut Reader<'_>, quirks: &mut Quirks) -> Result<(), Error> {
        reader.enter(section::SUFFIX);
        let precise = section::has_precision_time(version, reader.left());
        quirks.insert_if(precise && !version.has_precision_time(), Quirk::ExtraPrecisionTime);
        self.latency = when(version.has_latency(), || reader.f32())?;
        self.timecode = when(version.has_timecode(), || timecode(reader))?;
        self.timestamp = when(version.has_timestamp(), || timestamp(version, reader))?;
        self.host_stamps = when(version.has_host_stamps(), || host_stamps(reader))?;
        self.precision_time = when(precise, || precision_time(reader))?;
        self.params = when(version.has_params(), || reader.i16().map(FrameParams))?;
        Ok(())
    }

    /// The draft of the 1.4 document encloses everything in the braces of the models. What the models
    /// bring is joined.
    fn read_draft(&mut self, version: Version, payload: &[u8]) -> Result<(), Error> {
        let mut reader = Reader::new(section::PREFIX, payload);
        *self = Self::default();
        self.number = reader.i32()?;
        let count = reader.count(21)?;
        for _ in 0..count {
            self.read_draft_model(version, &mut reader)?;
        }
        reader.finish()
    }

    fn read_draft_model(&mut self, version: Version, reader: &mut Reader<'_>) -> Result<(), Error> {
        reader.enter(section::MARKER_SETS);
        let mut set = MarkerSet::default();
        set.read(reader, version)?;
        self.marker_sets.push(set);
        reader.enter(section::OTHER_MARKERS);
        let mut markers = Vec::new();
        read_list(&mut markers, reader, version)?;
        self.other_markers.append(&mut markers);
        reader.enter(section::RIGID_BODIES);
        let mut bodies = Vec::<RigidBody>::new();
        read_list(&mut bodies, reader, version)?;
        self.rigid_bodies.append(&mut bodies);
        reader.enter(section::SUFFIX);
        self.latency = Some(reader.f32()?);
        end_of_frame(reader)
    }
}

/// The sections between frame number and suffix, in their order.
struct Sections<'a> {
    reader: Reader<'a>,
    version: Version,
    quirks: &'a mut Quirks,
}

impl Sections<'_> {
    /// The next section, when the version has it.
    #[inline]
    fn list<T: Record>(&mut self, there: bool, name: &'static str, list: &mut Vec<T>) -> Result<(), Error> {
        if !there {
            list.clear();
            return Ok(());
        }
        self.reader.enter(name);
        read_section(list, &mut self.reader, self.version, self.quirks)
    }

    /// All sections before the suffix, however many there are.
    fn later(&mut self, list: &mut Vec<OpaqueSection>) -> Result<(), Error> {
        let mut count = 0;
        if self.version.has_sized_sections() {
            self.reader.enter(section::LATER);
            while self.reader.left() > section::SUFFIX_SIZE {
                if count == list.len() {
                    list.push(OpaqueSection::default());
                }
                read_opaque(&mut list[count], &mut self.reader)?;
                count += 1;
            }
        }
        list.truncate(count);
        let expected = self.version.later_sections();
        self.quirks.insert_if(count > expected, Quirk::ExtraSections);
        self.quirks.insert_if(count < expected, Quirk::MissingSections);
        Ok(())
    }
}

fn read_opaque(opaque: &mut OpaqueSection, reader: &mut Reader<'_>) -> Result<(), Error> {
    opaque.count = reader.i32()?;
    let mut part = reader.sized_part(section::SUFFIX_SIZE)?;
    opaque.bytes.clear();
    opaque.bytes.extend_from_slice(part.rest());
    Ok(())
}

fn when<T>(there: bool, read: impl FnOnce() -> Result<T, Error>) -> Result<Option<T>, Error> {
    there.then(read).transpose()
}

fn timecode(reader: &mut Reader<'_>) -> Result<Timecode, Error> {
    Ok(Timecode {
        code: reader.u32()?,
        subframe: reader.u32()?,
    })
}

fn timestamp(version: Version, reader: &mut Reader<'_>) -> Result<f64, Error> {
    if version.has_wide_timestamp() {
        reader.f64()
    } else {
        reader.f32().map(f64::from)
    }
}

fn host_stamps(reader: &mut Reader<'_>) -> Result<HostStamps, Error> {
    Ok(HostStamps {
        mid_exposure: reader.u64()?,
        data_received: reader.u64()?,
        transmit: reader.u64()?,
    })
}

fn precision_time(reader: &mut Reader<'_>) -> Result<PrecisionTime, Error> {
    Ok(PrecisionTime {
        seconds: reader.u32()?,
        fraction: reader.u32()?,
    })
}

fn end_of_frame(reader: &mut Reader<'_>) -> Result<(), Error> {
    let offset = reader.offset();
    match reader.i32()? {
        0 => Ok(()),
        found => Err(Error::EndOfFrame { found, offset }),
    }
}

//! How a client says who it is.

use std::fmt;

use crate::name::before_zero;
use crate::reader::Reader;
use crate::writer::Writer;
use crate::{Error, Name, Version};

const SECTION: &str = "sender";

/// Who sends: 264 bytes.
///
/// | bytes | field |
/// |---|---|
/// | 0-255 | name; what follows its zero is not initialised in real packets |
/// | 256-259 | version of the application |
/// | 260-263 | version of NatNet |
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sender {
    /// Name of the application, at most 255 bytes.
    pub name: Name,
    /// Version of the application.
    pub app_version: Version,
    /// Version of the bitstream that it speaks.
    pub natnet_version: Version,
}

impl Sender {
    /// Bytes of a sender.
    pub const SIZE: usize = 264;

    const NAME_SIZE: usize = 256;

    pub(crate) fn read(reader: &mut Reader<'_>) -> Result<Self, Error> {
        reader.enter(SECTION);
        if reader.left() < Self::SIZE {
            // The name alone would not say how much is missing.
            reader.bytes(Self::SIZE)?;
        }
        Ok(Self {
            name: Name::new(before_zero(reader.take::<{ Self::NAME_SIZE }>()?)),
            app_version: Version::from(*reader.take()?),
            natnet_version: Version::from(*reader.take()?),
        })
    }

    pub(crate) fn write(&self, writer: &mut Writer<'_>) {
        let mut field = [0; Self::NAME_SIZE];
        let space = Self::NAME_SIZE - 1;
        for (place, byte) in field.iter_mut().take(space).zip(self.name.as_bytes()) {
            *place = *byte;
        }
        writer.bytes(&field);
        writer.bytes(&self.app_version.to_bytes());
        writer.bytes(&self.natnet_version.to_bytes());
    }
}

impl fmt::Display for Sender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:?} {}, NatNet {}",
            self.name, self.app_version, self.natnet_version
        )
    }
}

/// What a client asks for when it connects: 5 bytes after the sender (4.0 and later).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConnectOptions {
    /// Only what the client subscribes to.
    pub subscribed_only: bool,
    /// The version of the bitstream that it wants; [`Version::UNSPECIFIED`] for no wish.
    pub bitstream_version: Version,
}

/// A client's first message (message 0), in every form that there is.
///
/// | bytes | sent by |
/// |---|---|
/// | 0 | many that read frames only |
/// | 5 | some: the text `Ping` |
/// | 264 | the SDK before 4.0: a [`Sender`] |
/// | 269 | the SDK since 4.0: a sender and [`ConnectOptions`] |
/// | 271, 273 | samples of the SDK: the same and 2 or 4 more bytes |
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Connect {
    /// Who connects.
    pub sender: Option<Sender>,
    /// What it wants; needs a sender.
    pub options: Option<ConnectOptions>,
    /// Bytes after that, or in its place.
    pub rest: Vec<u8>,
}

impl Connect {
    /// Without payload.
    pub fn empty() -> Self {
        Self::default()
    }

    /// The text `Ping`.
    pub fn ping() -> Self {
        Self {
            rest: b"Ping\0".to_vec(),
            ..Self::default()
        }
    }

    /// With a sender, and options where the client has wishes.
    pub fn new(sender: Sender, options: Option<ConnectOptions>) -> Self {
        Self {
            sender: Some(sender),
            options,
            rest: Vec::new(),
        }
    }

    /// The version of the bitstream that the client wants; `None` for no wish.
    pub fn requested_version(&self) -> Option<Version> {
        let version = self.options?.bitstream_version;
        (version != Version::UNSPECIFIED).then_some(version)
    }

    /// Reads the payload. None is malformed: what is no sender is the [`rest`](Self::rest).
    pub fn decode(payload: &[u8]) -> Self {
        let mut reader = Reader::new(SECTION, payload);
        let sender = Sender::read(&mut reader).ok();
        let options = sender.as_ref().and_then(|_| read_options(&mut reader));
        Self {
            sender,
            options,
            rest: reader.rest().to_vec(),
        }
    }

    /// Appends the payload to `out`.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let mut writer = Writer::new(out);
        if let Some(sender) = &self.sender {
            sender.write(&mut writer);
            if let Some(options) = self.options {
                writer.u8(options.subscribed_only.into());
                writer.bytes(&options.bitstream_version.to_bytes());
            }
        }
        writer.bytes(&self.rest);
    }
}

fn read_options(reader: &mut Reader<'_>) -> Option<ConnectOptions> {
    let [subscribed, version @ ..] = *reader.take::<5>().ok()?;
    Some(ConnectOptions {
        subscribed_only: subscribed != 0,
        bitstream_version: version.into(),
    })
}

impl fmt::Display for Connect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.sender {
            Some(sender) => write!(f, "{sender}")?,
            None if self.rest.is_empty() => f.write_str("no payload")?,
            None => write!(f, "\"{}\"", self.rest.escape_ascii())?,
        }
        match self.requested_version() {
            Some(version) => write!(f, ", wants {version}"),
            None => Ok(()),
        }
    }
}

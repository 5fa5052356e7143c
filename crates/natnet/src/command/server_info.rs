//! How a server says who it is.

use std::fmt;
use std::net::Ipv4Addr;

use super::Sender;
use crate::reader::Reader;
use crate::writer::Writer;
use crate::{Error, Quirk, Quirks};

/// A server's answer to connect and discovery (message 1): 264 bytes, and 15 more since 3.0.
///
/// Clients read frames as the NatNet version in here says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ServerInfo {
    /// Name and versions.
    pub server: Sender,
    /// Clock, port and group (3.0 and later).
    pub connection: Option<ConnectionInfo>,
}

/// Where the frames come from (3.0 and later): 15 bytes after the sender.
///
/// | bytes | field |
/// |---|---|
/// | 264-271 | ticks of the server's clock in a second |
/// | 272-273 | data port |
/// | 274 | whether frames are multicast |
/// | 275-278 | multicast group |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectionInfo {
    /// Ticks a second of the clock that echoes and host stamps are read from.
    pub clock_frequency: u64,
    /// Port that frames are sent to (multicast) or from (unicast).
    pub data_port: u16,
    /// Whether frames go to the group; otherwise to each client.
    pub is_multicast: bool,
    /// The group.
    pub group: Ipv4Addr,
}

impl ServerInfo {
    /// Reads the payload. Its size decides whether there is connection information.
    ///
    /// # Errors
    /// [`Error::Truncated`] for fewer than 264 bytes.
    pub fn decode(payload: &[u8]) -> Result<(Self, Quirks), Error> {
        let mut reader = Reader::new("server info", payload);
        let server = Sender::read(&mut reader)?;
        reader.enter("server info");
        let connection = if reader.left() >= 15 {
            Some(read_connection(&mut reader)?)
        } else {
            None
        };
        let mut quirks = Quirks::NONE;
        let expected = server.natnet_version.has_connection_info();
        quirks.insert_if(connection.is_some() != expected, Quirk::ServerInfoSize);
        quirks.insert_if(reader.left() > 0, Quirk::UnexpectedPayload);
        Ok((Self { server, connection }, quirks))
    }

    /// Appends the payload to `out`: 279 bytes with connection information, 264 without.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let mut writer = Writer::new(out);
        self.server.write(&mut writer);
        if let Some(connection) = &self.connection {
            writer.u64(connection.clock_frequency);
            writer.u16(connection.data_port);
            writer.u8(connection.is_multicast.into());
            writer.bytes(&connection.group.octets());
        }
    }
}

fn read_connection(reader: &mut Reader<'_>) -> Result<ConnectionInfo, Error> {
    Ok(ConnectionInfo {
        clock_frequency: reader.u64()?,
        data_port: reader.u16()?,
        is_multicast: reader.u8()? != 0,
        group: Ipv4Addr::from(*reader.take::<4>()?),
    })
}

impl fmt::Display for ServerInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.server)?;
        match &self.connection {
            Some(connection) => write!(f, ", {connection}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for ConnectionInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_multicast {
            write!(f, "multicast {}:{}", self.group, self.data_port)?;
        } else {
            write!(f, "unicast from port {}", self.data_port)?;
        }
        write!(f, ", clock {} Hz", self.clock_frequency)
    }
}

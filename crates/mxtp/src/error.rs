//! What can be wrong with the bytes of a datagram, or with what a sender asks for.

use crate::MessageType;

/// Why bytes are not an MXTP datagram, or why a datagram cannot be written.
///
/// Every variant says what was expected, what was found and where; offsets count from the first
/// byte of the datagram.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// Fewer bytes than a header has.
    #[error("expected a {expected}-byte header, found {found} bytes")]
    ShortHeader {
        /// Size of a header.
        expected: usize,
        /// Bytes present.
        found: usize,
    },
    /// The first four bytes are not `MXTP`.
    #[error("expected \"MXTP\" at offset 0, found \"{}\"", found.escape_ascii())]
    Magic {
        /// The four bytes found instead.
        found: [u8; 4],
    },
    /// The message type is not two decimal digits.
    #[error("expected two decimal digits at offset 4, found \"{}\"", found.escape_ascii())]
    TypeDigits {
        /// The two bytes found instead.
        found: [u8; 2],
    },
    /// A text is not a message type.
    #[error("expected a message type of two decimal digits such as \"02\", found {found:?}")]
    TypeText {
        /// The text that was given.
        found: String,
    },
    /// A payload of equal items is not a whole number of them.
    #[error("MXTP{message_type}: expected {items} items of {item_size} bytes at offset {offset}, found {found} bytes")]
    PayloadSize {
        /// Type of the datagram.
        message_type: MessageType,
        /// Item count the header states.
        items: u8,
        /// Size of one item in bytes; the usual one where a type has two.
        item_size: usize,
        /// Bytes present.
        found: usize,
        /// Where the items begin.
        offset: usize,
    },
    /// A field runs past the end of the datagram.
    #[error("MXTP{message_type}: expected {expected} bytes of {field} at offset {offset}, found {found}")]
    Truncated {
        /// Type of the datagram.
        message_type: MessageType,
        /// The field that is cut short.
        field: &'static str,
        /// Bytes the field needs.
        expected: usize,
        /// Bytes left.
        found: usize,
        /// Where the field begins.
        offset: usize,
    },
    /// A count or a string length that the bytes left cannot hold.
    #[error("MXTP{message_type}: expected {field} of at most {limit} at offset {offset}, found {found}")]
    Count {
        /// Type of the datagram.
        message_type: MessageType,
        /// Which count.
        field: &'static str,
        /// The most that the bytes left could hold.
        limit: usize,
        /// The count found; negative string lengths are possible.
        found: i64,
        /// Where the count stands.
        offset: usize,
    },
    /// A sender asked for more than a header field can state.
    #[error("MXTP{message_type}: expected at most {limit} {field}, found {found}")]
    TooLarge {
        /// Type of the datagram.
        message_type: MessageType,
        /// What there is too much of.
        field: &'static str,
        /// The most a datagram can carry.
        limit: usize,
        /// How many were given.
        found: usize,
    },
    /// A message of the remote control that is no XML, or XML that only an attacker sends.
    #[error("remote control: expected {expected} at offset {offset}, found {found:?}")]
    RemoteXml {
        /// What must be there.
        expected: &'static str,
        /// What is.
        found: String,
        /// Where, in bytes, behind what is passed over at the beginning.
        offset: usize,
    },
    /// A value that an attribute of a remote control's message cannot have.
    #[error("remote control: {message}: expected {expected} as {field}, found {found:?}")]
    RemoteValue {
        /// The message's name.
        message: String,
        /// The attribute.
        field: &'static str,
        /// What it must be.
        expected: &'static str,
        /// What it is.
        found: String,
    },
}

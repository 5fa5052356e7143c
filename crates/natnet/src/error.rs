//! What can be wrong with the bytes of a packet, or with what a sender asks for.

use crate::MessageId;

/// Why bytes are not a NatNet packet, or why a packet cannot be written.
///
/// Every variant says what was expected, what was found and where; offsets count from the first byte
/// of the packet, so that the payload begins at 4.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// Fewer bytes than a header has.
    #[error("expected a 4-byte header, found {found} bytes")]
    ShortHeader {
        /// Bytes present.
        found: usize,
    },
    /// A field runs past the end of the bytes that can hold it.
    #[error("{section}: expected {expected} bytes at offset {offset}, found {found}")]
    Truncated {
        /// The section that is cut short.
        section: &'static str,
        /// Bytes the field needs.
        expected: usize,
        /// Bytes left.
        found: usize,
        /// Where the field begins.
        offset: usize,
    },
    /// A string without the zero that ends it.
    #[error("{section}: expected a string that ends with a zero at offset {offset}, found {found} bytes without one")]
    UnendedString {
        /// The section that holds the string.
        section: &'static str,
        /// Bytes left.
        found: usize,
        /// Where the string begins.
        offset: usize,
    },
    /// A count that the bytes left cannot hold.
    #[error("{section}: expected a count from 0 to {limit} at offset {offset}, found {found}")]
    Count {
        /// The section whose records are counted.
        section: &'static str,
        /// The most that the bytes left could hold.
        limit: usize,
        /// The count found.
        found: i32,
        /// Where the count stands.
        offset: usize,
    },
    /// A section or description states more bytes than are left (4.1 and later).
    #[error("{section}: expected a size from 0 to {limit} bytes at offset {offset}, found {found}")]
    SectionSize {
        /// The section with the size.
        section: &'static str,
        /// The most that can be left for it.
        limit: usize,
        /// The size found.
        found: i32,
        /// Where the size stands.
        offset: usize,
    },
    /// A description of a type that is not known, in a version that states no sizes to skip it by.
    #[error("expected a description of type 0 to 6 at offset {offset}, found {found}")]
    DescriptionType {
        /// The type found.
        found: i32,
        /// Where it stands.
        offset: usize,
    },
    /// The last number of a frame is not 0.
    #[error("expected the frame to end with 0 at offset {offset}, found {found}")]
    EndOfFrame {
        /// The number found.
        found: i32,
        /// Where it stands.
        offset: usize,
    },
    /// Bytes follow what should be the end.
    #[error("{section}: expected the end at offset {offset}, found {found} more bytes")]
    TrailingBytes {
        /// What should end there.
        section: &'static str,
        /// Bytes that follow.
        found: usize,
        /// Where the end should be.
        offset: usize,
    },
    /// A sender asked for a packet that no datagram can carry.
    #[error("{message}: expected a payload of at most {limit} bytes, found {found}")]
    TooLarge {
        /// The message.
        message: MessageId,
        /// The largest payload.
        limit: usize,
        /// The size of this one.
        found: usize,
    },
    /// A text is not a version.
    #[error("expected a version such as \"3.1\", found {found:?}")]
    VersionText {
        /// The text that was given.
        found: String,
    },
}

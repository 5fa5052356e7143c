//! Datagrams in a TCP stream, back to back (MV0305 2.2).

use crate::body::{SCALE_POINT_MIN, SCALE_SEGMENT_MIN};
use crate::{Datagram, Header, MessageType};

/// Finds the datagrams in a stream of bytes.
///
/// A datagram ends where its header's payload size says. Software before 2019 states no payload
/// size (0): then the end follows from the item count, or from the lengths inside types 12, 13 and
/// 25. Where even that does not tell (unknown types, meta data without a length), it is where the
/// next datagram begins. After bytes that begin no datagram the framer goes on at the next `MXTP`
/// with two digits, and counts what it skipped.
///
/// How the stream is cut into chunks makes no difference. After [`next_datagram`] has answered
/// `None` the framer holds less than one datagram ([`Datagram::MAX_SIZE`] and a few bytes of the
/// next), whatever the stream claims.
///
/// ```
/// use posewire_mxtp::{Datagram, Framer};
///
/// let stream = b"noise MXTP25\0\0\0\x01\x80\x01\0\0\0\0\0\x17\0\0\0\0\0\x10\0\0\0\x0c12:34:56.789";
/// let mut framer = Framer::new();
/// for chunk in stream.chunks(7) {
///     framer.push(chunk);
///     while let Some(bytes) = framer.next_datagram() {
///         println!("{}", Datagram::decode(bytes)?);
///     }
/// }
/// assert_eq!(framer.skipped(), 6);
/// # Ok::<(), posewire_mxtp::Error>(())
/// ```
///
/// [`next_datagram`]: Self::next_datagram
#[derive(Clone, Debug, Default)]
pub struct Framer {
    buffer: Vec<u8>,
    start: usize,
    /// Bytes from `start` below which looking again is of no use.
    wanted: usize,
    /// Bytes from `start` that are known to hold no beginning of a datagram but the first.
    searched: usize,
    skipped: u64,
    ended: bool,
}

/// Where a datagram ends, counted from its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    At(usize),
    /// Unknown until there are so many bytes.
    Needs(usize),
    /// Where the next datagram begins.
    AtNext,
    /// The bytes are no datagram.
    Never,
}

impl Framer {
    /// A framer at the beginning of a stream.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the next bytes of the stream. Ask for datagrams until there are none before pushing
    /// again: the buffer holds all that has not been asked for.
    pub fn push(&mut self, bytes: &[u8]) {
        self.buffer.drain(..self.start);
        self.start = 0;
        self.buffer.extend_from_slice(bytes);
    }

    /// Says that the stream has ended, so that no further bytes decide where the last datagram
    /// ends. [`next_datagram`](Self::next_datagram) then gives what is left.
    pub fn finish(&mut self) {
        self.ended = true;
        self.wanted = 0;
    }

    /// The bytes of the next datagram, for [`Datagram::decode`]; `None` when more are needed.
    pub fn next_datagram(&mut self) -> Option<&[u8]> {
        loop {
            if self.left().len() < self.wanted || !self.seek() {
                return None;
            }
            match self.find_end() {
                Some(length) => {
                    let from = self.start;
                    self.advance(length);
                    return self.buffer.get(from..from + length);
                }
                None if self.wanted > 0 => return None,
                None => self.skip(1),
            }
        }
    }

    /// Bytes skipped because they were part of no datagram.
    pub const fn skipped(&self) -> u64 {
        self.skipped
    }

    /// Bytes held back: the beginning of a datagram, or what has not been asked for.
    pub const fn buffered(&self) -> usize {
        self.buffer.len() - self.start
    }

    fn left(&self) -> &[u8] {
        &self.buffer[self.start..]
    }

    fn advance(&mut self, length: usize) {
        self.start += length;
        self.wanted = 0;
        self.searched = 0;
    }

    fn skip(&mut self, length: usize) {
        self.advance(length);
        self.skipped += length as u64;
    }

    /// Skips to the next beginning of a datagram; `false` when it is not all there.
    fn seek(&mut self) -> bool {
        let (garbage, found) = match find_start(self.left(), 0) {
            Found::At(at) => (at, true),
            Found::MaybeAt(at) if !self.ended => (at, false),
            Found::MaybeAt(_) => (self.left().len(), false),
        };
        if garbage > 0 {
            self.skip(garbage);
        }
        found
    }

    /// Length of the datagram that begins here. `None` with `wanted` set waits for more bytes,
    /// `None` without begins no datagram.
    fn find_end(&mut self) -> Option<usize> {
        self.wanted = 0;
        let left = &self.buffer[self.start..];
        let available = left.len();
        let end = match end_of(left, self.ended) {
            End::AtNext => self.next_start(),
            other => other,
        };
        match end {
            End::At(length) if length > Datagram::MAX_SIZE => return None,
            End::At(length) if length <= available => return Some(length),
            End::At(length) => self.wanted = length,
            End::Needs(length) if length <= Datagram::MAX_SIZE + START => self.wanted = length,
            End::Needs(_) | End::AtNext | End::Never => {}
        }
        if self.ended {
            self.wanted = 0;
        }
        None
    }

    /// Where the next datagram begins, for one that does not tell its own end.
    fn next_start(&mut self) -> End {
        let left = &self.buffer[self.start..];
        match find_start(left, self.searched.max(Header::SIZE)) {
            Found::At(at) => End::At(at),
            Found::MaybeAt(_) if self.ended => End::At(left.len()),
            Found::MaybeAt(at) => {
                self.searched = at;
                End::Needs(left.len() + 1)
            }
        }
    }
}

/// The end of a datagram as its own bytes tell.
fn end_of(bytes: &[u8], ended: bool) -> End {
    let Ok(header) = Header::decode(bytes) else {
        return End::Needs(Header::SIZE);
    };
    if header.payload_size != 0 {
        return End::At(Header::SIZE + usize::from(header.payload_size));
    }
    match header.message_type {
        MessageType::META => end_of_meta(bytes),
        MessageType::SCALE => end_of_scale(bytes),
        MessageType::TIME_CODE => end_of_time_code(bytes),
        MessageType::CENTER_OF_MASS => end_of_center_of_mass(bytes, ended),
        other => other.item_size().map_or(End::AtNext, |size| {
            End::At(Header::SIZE + usize::from(header.items) * size)
        }),
    }
}

/// A text with its length in front; two zero bytes begin a length and never a text.
fn end_of_meta(bytes: &[u8]) -> End {
    let text = Header::SIZE + 4;
    match number_at(bytes, Header::SIZE) {
        None => End::Needs(text),
        Some(length) if length <= 0xFFFF => End::At(text + length),
        Some(_) => End::AtNext,
    }
}

fn end_of_time_code(bytes: &[u8]) -> End {
    match number_at(bytes, Header::SIZE) {
        None => End::Needs(Header::SIZE + 4),
        Some(12) => End::At(Header::SIZE + 16),
        Some(_) => End::At(Header::SIZE + 12),
    }
}

/// 12 bytes when the next datagram or nothing follows them, else 36.
fn end_of_center_of_mass(bytes: &[u8], ended: bool) -> End {
    const SHORT: usize = Header::SIZE + 12;
    let after = bytes.get(SHORT..).unwrap_or_default();
    match after.first_chunk() {
        Some(magic) if *magic == Header::MAGIC => End::At(SHORT),
        None if ended => End::At(SHORT),
        None if Header::MAGIC.starts_with(after) => End::Needs(SHORT + after.len() + 1),
        _ => End::At(Header::SIZE + 36),
    }
}

/// Follows the lengths inside a scale datagram.
fn end_of_scale(bytes: &[u8]) -> End {
    let mut at = Header::SIZE;
    for (name_at, minimum) in [(0, SCALE_SEGMENT_MIN), (4, SCALE_POINT_MIN)] {
        let Some(count) = number_at(bytes, at) else {
            return End::Needs(at + 4);
        };
        at += 4;
        if count > (Datagram::MAX_SIZE - at.min(Datagram::MAX_SIZE)) / minimum {
            return End::Never;
        }
        for _ in 0..count {
            let Some(length) = number_at(bytes, at + name_at) else {
                return End::Needs(at + name_at + 4);
            };
            at = (at + minimum).saturating_add(length);
            if at > Datagram::MAX_SIZE {
                return End::Never;
            }
        }
    }
    End::At(at)
}

fn number_at(bytes: &[u8], at: usize) -> Option<usize> {
    let number = bytes.get(at..)?.first_chunk()?;
    Some(u32::from_be_bytes(*number) as usize)
}

/// Bytes that tell that a datagram begins: the magic and two digits.
const START: usize = 6;

/// Where a datagram begins.
enum Found {
    At(usize),
    /// Nowhere before this place, where the bytes end or too few are left to tell.
    MaybeAt(usize),
}

/// Finds `MXTP` and two digits.
fn find_start(bytes: &[u8], from: usize) -> Found {
    let mut at = from;
    while let Some(step) = bytes
        .get(at..)
        .and_then(|left| left.iter().position(|byte| *byte == Header::MAGIC[0]))
    {
        at += step;
        let here = &bytes[at..bytes.len().min(at + START)];
        match begins_datagram(here) {
            true if here.len() == START => return Found::At(at),
            true => return Found::MaybeAt(at),
            false => at += 1,
        }
    }
    Found::MaybeAt(bytes.len())
}

/// Whether up to six bytes are the beginning of a datagram as far as they go.
fn begins_datagram(bytes: &[u8]) -> bool {
    let (magic, digits) = bytes.split_at(bytes.len().min(Header::MAGIC.len()));
    Header::MAGIC.starts_with(magic) && digits.iter().all(u8::is_ascii_digit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, CenterOfMassPosition, Meta, TimeCode};

    fn old(body: Body<'_>) -> Vec<u8> {
        let header = Header::rev_j(MessageType::META, 1, 2);
        let mut bytes = Vec::new();
        Datagram::new(header, body).unwrap().encode(&mut bytes);
        bytes
    }

    fn datagrams(stream: &[u8], chunk: usize) -> (Vec<Vec<u8>>, u64) {
        let mut framer = Framer::new();
        let mut found = Vec::new();
        let mut take = |framer: &mut Framer| {
            while let Some(bytes) = framer.next_datagram() {
                found.push(bytes.to_vec());
            }
            assert!(framer.buffered() <= Datagram::MAX_SIZE + START);
        };
        for part in stream.chunks(chunk) {
            framer.push(part);
            take(&mut framer);
        }
        framer.finish();
        take(&mut framer);
        (found, framer.skipped())
    }

    #[test]
    fn old_datagrams_end_where_their_content_ends() {
        let sent = [
            old(Body::CenterOfMassShort(&CenterOfMassPosition::new([1.0, 2.0, 3.0]))),
            old(Body::TimeCode(TimeCode::from_millis_of_day(7).without_length())),
            old(Body::TimeCode(TimeCode::from_millis_of_day(7))),
            old(Body::Meta(Meta::new("name:Ann\n"))),
            old(Body::Meta(Meta::new("name:Ann\n").without_length())),
            old(Body::CenterOfMassShort(&CenterOfMassPosition::new([1.0, 2.0, 3.0]))),
        ];
        for chunk in [1, 2, 5, 36, 1000] {
            let (found, skipped) = datagrams(&sent.concat(), chunk);
            assert_eq!(found, sent);
            assert_eq!(skipped, 0);
        }
    }

    #[test]
    fn garbage_is_skipped_and_counted() {
        let one = old(Body::TimeCode(TimeCode::from_millis_of_day(7)));
        let stream = [b"MXTMXTP0x", &one[..], b"MXT", &one, b"MXTP02\0"].concat();
        for chunk in [1, 3, 1000] {
            let (found, skipped) = datagrams(&stream, chunk);
            assert_eq!(found, [one.clone(), one.clone()]);
            assert_eq!(skipped, 9 + 3 + 7);
        }
    }

    #[test]
    fn a_lying_scale_count_is_skipped_without_being_held() {
        let mut header = Header::rev_j(MessageType::SCALE, 0, 0).encode().to_vec();
        header.extend_from_slice(&u32::MAX.to_be_bytes());
        let one = old(Body::TimeCode(TimeCode::from_millis_of_day(7)));
        let lied = header.len() as u64;
        header.extend_from_slice(&one);
        assert_eq!(datagrams(&header, 1), (vec![one], lied));
    }

    #[test]
    fn a_datagram_without_end_is_given_up_at_the_largest_size() {
        let mut stream = Header::rev_j(MessageType::TAGS, 0, 0).encode().to_vec();
        stream.resize(Datagram::MAX_SIZE + 100, b'x');
        let all = stream.len() as u64;
        assert_eq!(datagrams(&stream, 1000), (vec![], all));
    }
}

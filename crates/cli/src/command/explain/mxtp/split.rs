//! Cuts a file into datagrams and what is between them.

use crate::command::explain::part::Part;
use posewire_mxtp::{Datagram, Framer, Header};

/// The parts of an input, which together are all of it.
pub(in crate::command::explain) struct Parts<'a> {
    bytes: &'a [u8],
    framer: Framer,
    fed: usize,
    finished: bool,
    /// Where the next part begins.
    at: usize,
    /// Where the bytes end that the framer skipped.
    garbage_end: usize,
    /// The length of the datagram after the skipped bytes.
    datagram: Option<usize>,
}

impl<'a> Parts<'a> {
    /// The parts of a file: a single datagram when its bytes make one, whatever size its header states, else the
    /// datagrams of a TCP stream.
    pub(in crate::command::explain) fn of(bytes: &'a [u8]) -> Self {
        let mut parts = Self::of_stream(bytes);
        if is_one_datagram(bytes) {
            parts.datagram = Some(bytes.len());
            parts.fed = bytes.len();
            parts.finished = true;
        }
        parts
    }

    fn of_stream(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            framer: Framer::new(),
            fed: 0,
            finished: false,
            at: 0,
            garbage_end: 0,
            datagram: None,
        }
    }

    /// Lets the framer find the next datagram; `false` when there is nothing after this.
    fn find_next(&mut self) -> bool {
        let skipped = self.framer.skipped();
        let found = self.framer.next_datagram().map(<[u8]>::len);
        self.garbage_end += (self.framer.skipped() - skipped) as usize;
        if let Some(length) = found {
            self.datagram = Some(length);
        } else if self.fed < self.bytes.len() {
            let chunk = &self.bytes[self.fed..self.bytes.len().min(self.fed + CHUNK)];
            self.framer.push(chunk);
            self.fed += chunk.len();
        } else if !self.finished {
            self.framer.finish();
            self.finished = true;
        } else {
            self.garbage_end = self.bytes.len();
            return self.at < self.garbage_end;
        }
        true
    }

    /// The next part of the skipped bytes. What begins as a datagram is told as a malformed one.
    fn next_garbage(&mut self) -> Part<'a> {
        let offset = self.at;
        let garbage = &self.bytes[offset..self.garbage_end];
        let datagram = begins_datagram(garbage);
        let length = match find_start(garbage, usize::from(datagram)) {
            Some(next) => next,
            None => garbage.len(),
        };
        let length = if datagram {
            length.min(Datagram::MAX_SIZE)
        } else {
            length
        };
        self.at += length;
        let bytes = &garbage[..length];
        if datagram {
            Part::Datagram { offset, bytes }
        } else {
            Part::Skipped { offset, bytes }
        }
    }
}

impl<'a> Iterator for Parts<'a> {
    type Item = Part<'a>;

    fn next(&mut self) -> Option<Part<'a>> {
        loop {
            // Skipped bytes may be the first of more, until the datagram after them or the end is known.
            let known = self.datagram.is_some() || self.finished;
            if known && self.at < self.garbage_end {
                return Some(self.next_garbage());
            }
            if let Some(length) = self.datagram.take() {
                let offset = self.at;
                self.at += length;
                self.garbage_end = self.at;
                return Some(Part::Datagram {
                    offset,
                    bytes: &self.bytes[offset..self.at],
                });
            }
            if !self.find_next() {
                return None;
            }
        }
    }
}

/// Whether all bytes are one datagram although, by what its header states, it would end elsewhere.
fn is_one_datagram(bytes: &[u8]) -> bool {
    if bytes.len() > Datagram::MAX_SIZE || Datagram::decode(bytes).is_err() {
        return false;
    }
    let (mut datagrams, mut clean) = (0, true);
    for part in Parts::of_stream(bytes) {
        match part {
            Part::Datagram { bytes, .. } => {
                datagrams += 1;
                clean &= Datagram::decode(bytes).is_ok();
            }
            Part::Skipped { .. } => clean = false,
        }
    }
    !clean && datagrams <= 1
}

/// Where a datagram may begin, at `from` or after it.
fn find_start(bytes: &[u8], from: usize) -> Option<usize> {
    let windows = bytes.get(from..)?.windows(START);
    Some(from + windows.into_iter().position(begins_datagram)?)
}

/// Whether it is the magic and two digits.
fn begins_datagram(bytes: &[u8]) -> bool {
    let Some((magic, rest)) = bytes.split_first_chunk() else {
        return false;
    };
    *magic == Header::MAGIC && matches!(rest, [a, b, ..] if a.is_ascii_digit() && b.is_ascii_digit())
}

const START: usize = 6;
const CHUNK: usize = 64 << 10;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::explain::part;
    use posewire_mxtp::MessageType;
    use posewire_mxtp::body::{Body, QuaternionSegment};
    use posewire_mxtp::ids::{SegmentCounts, SegmentId};

    fn pose() -> Vec<u8> {
        let segment = |id| QuaternionSegment::new(SegmentId(id), [0.0; 3], [1.0, 0.0, 0.0, 0.0]);
        let segments: Vec<_> = (1..=23).map(segment).collect();
        let header = Header::rev_n(MessageType::QUATERNION, 1, 2, SegmentCounts::BODY);
        let mut bytes = Vec::new();
        Datagram::new(header, Body::Quaternion(&segments))
            .unwrap()
            .encode(&mut bytes);
        bytes
    }

    fn with_payload_size(size: u16) -> Vec<u8> {
        let mut bytes = pose();
        bytes[22..24].copy_from_slice(&size.to_be_bytes());
        bytes
    }

    fn lengths(bytes: &[u8]) -> Vec<isize> {
        part::lengths(Parts::of(bytes), bytes.len())
    }

    #[test]
    fn a_single_datagram_may_state_any_payload_size() {
        for size in [736, 0, 700, 12, 740, u16::MAX] {
            assert_eq!(lengths(&with_payload_size(size)), [760], "payload size {size}");
        }
    }

    #[test]
    fn datagrams_back_to_back_are_split_and_garbage_is_told() {
        let pose = pose();
        assert_eq!(lengths(&[&pose[..], &pose].concat()), [760, 760]);
        assert_eq!(
            lengths(&[b"abc", &pose[..], b"MXT", &pose, b"x"].concat()),
            [-3, 760, -3, 760, -1]
        );
        let many = pose.repeat(1000);
        assert_eq!(lengths(&many).len(), 1000);
    }

    #[test]
    fn a_cut_datagram_is_a_part_of_its_own() {
        let pose = pose();
        assert_eq!(lengths(&[&pose[..], &pose[..100]].concat()), [760, 100]);
        assert_eq!(lengths(&pose[..10]), [10]);
        assert_eq!(lengths(&[b"zz", &pose[..12], &pose].concat()), [-2, 12, 760]);
    }

    #[test]
    fn the_bytes_of_a_malformed_datagram_are_bounded() {
        let mut bytes = Header::rev_j(MessageType::TAGS, 0, 0).encode().to_vec();
        bytes.resize(Datagram::MAX_SIZE + 7, b'x');
        assert_eq!(lengths(&bytes), [Datagram::MAX_SIZE as isize, -7]);
        assert_eq!(lengths(b""), [0; 0]);
        assert_eq!(lengths(b"garbage"), [-7]);
    }
}

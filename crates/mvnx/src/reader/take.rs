//! Reads a whole take.

use super::{Reader, parallel};
use crate::Error;
use posewire_motion::Take;
use std::io::BufRead;
use std::sync::Arc;

/// Reads the rest of a file into memory: the frames of the reader's iteration, in columns.
///
/// It uses as many threads as [`Reader::threads`] says; reading the bytes and decompressing them is done on the caller's.
/// Besides the columns some ten to twenty MiB are in use.
///
/// # Errors
/// What ends the reader's iteration, unless it salvages; [`Error::MissingAttribute`] when the subject has no `frameRate`.
pub fn read_take<R: BufRead>(reader: &mut Reader<R>) -> Result<Take, Error> {
    let rate = reader.subject.rate.ok_or(Error::MissingAttribute {
        at: reader.place(),
        element: "subject",
        attribute: "frameRate",
    })?;
    read_frames(reader, rate, thread_count(reader.threads), BLOCK)
}

fn read_frames<R: BufRead>(reader: &mut Reader<R>, rate: f64, threads: usize, block: usize) -> Result<Take, Error> {
    let mut take = Take::new(Arc::clone(&reader.subject), rate);
    loop {
        if reader.can_take_blocks() {
            parallel::read_blocks(reader, &mut take, threads, block);
        }
        // What the blocks left is read one by one: the first frame, what is around damage, and the end of the file.
        match reader.next() {
            // Every section was checked against the same definitions that the skeleton is made of.
            Some(frame) => _ = take.push(&frame?),
            None => return Ok(take),
        }
    }
}

fn thread_count(asked: usize) -> usize {
    let count = if asked == 0 {
        std::thread::available_parallelism().map_or(1, usize::from)
    } else {
        asked
    };
    count.min(MAX_THREADS)
}

/// More would wait for the one that reads the bytes.
const MAX_THREADS: usize = 8;
/// Bytes of a block: few enough for its text and its numbers to stay in a core's own cache, enough to be worth handing over.
const BLOCK: usize = 1 << 18;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Calibration, FrameCounts, Header, SectionInfo};
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use proptest::prelude::*;
    use std::fmt::Write as _;
    use std::io::Write as _;

    /// All that can be asked of a reader behind a take.
    type Outcome = (Header, Vec<Calibration>, Vec<SectionInfo>, FrameCounts, Option<Error>);

    fn outcome(
        bytes: &[u8],
        salvage: bool,
        read: impl Fn(&mut Reader<&[u8]>) -> Result<Take, Error>,
    ) -> Result<(Result<Take, Error>, Outcome), Error> {
        let mut reader = Reader::new(bytes)?.salvage(salvage);
        let take = read(&mut reader);
        let header = reader.header().clone();
        let (sections, counts) = (reader.sections().to_vec(), reader.counts().clone());
        let damage = reader.damage().cloned();
        Ok((take, (header, reader.calibration().to_vec(), sections, counts, damage)))
    }

    /// Compares with the reader's own iteration.
    fn check(bytes: &[u8], threads: usize, block: usize) -> Result<(), TestCaseError> {
        for salvage in [false, true] {
            let whole = outcome(bytes, salvage, |reader| read_frames(reader, 240.0, threads, block));
            prop_assert_eq!(whole, outcome(bytes, salvage, one_by_one));
        }
        Ok(())
    }

    fn one_by_one(reader: &mut Reader<&[u8]>) -> Result<Take, Error> {
        let mut take = Take::new(Arc::clone(reader.subject()), 240.0);
        for frame in reader {
            take.push(&frame?).unwrap();
        }
        Ok(take)
    }

    fn frame(number: usize) -> String {
        let odd = if number % 7 == 3 {
            "<odd a=\"b\">1 2 3</odd>"
        } else {
            ""
        };
        let event = if number % 5 == 2 { "<marker>step</marker>" } else { "" };
        let velocity = if number % 4 == 1 {
            "<velocity>1.5 2.5 -3.5</velocity>"
        } else {
            ""
        };
        format!(
            "<frame time=\"{}\" index=\"{number}\" ms=\"{}\" type=\"normal\">\n<orientation>1 0.5 -0.5 0.25</orientation>\n\
             <position>0.{number} 1 2</position>{velocity}{odd}{event}\n</frame>\n",
            number * 4,
            number * 4 + 1
        )
    }

    fn parts() -> Vec<String> {
        let mut parts = vec![HEAD.to_owned()];
        parts.extend((0..30).map(frame));
        parts.push(TAIL.to_owned());
        parts
    }

    fn gzip(text: &[u8]) -> Vec<u8> {
        let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
        gzip.write_all(text).unwrap();
        gzip.finish().unwrap()
    }

    #[test]
    fn a_take_is_the_same_in_blocks_as_frame_by_frame() {
        let text = parts().concat();
        let (take, _) = outcome(text.as_bytes(), false, |reader| read_frames(reader, 240.0, 3, 500)).unwrap();
        assert_eq!(take.map(|take| (take.len(), take.events().len())), Ok((30, 6)));
        for block in [1, 100, 200, 1000, 1 << 20] {
            check(text.as_bytes(), 3, block).unwrap();
            check(&gzip(text.as_bytes()), 2, block).unwrap();
        }
    }

    #[test]
    fn many_unknown_sections_are_kept_in_blocks_as_frame_by_frame() {
        let mut parts = parts();
        for (number, part) in parts[1..31].iter_mut().enumerate() {
            let mut odd = String::new();
            (0..10).for_each(|place| _ = write!(odd, "<odd{}/>", number * 7 + place));
            *part = part.replacen("<orientation>", &format!("{odd}<orientation>"), 1);
        }
        check(parts.concat().as_bytes(), 3, 500).unwrap();
    }

    #[test]
    fn a_block_may_be_nested_as_deep_as_the_file() {
        for depth in 58..64 {
            let mut parts = parts();
            parts[7] = parts[7].replace(
                "</frame>",
                &format!("{}{}</frame>", "<a>".repeat(depth), "</a>".repeat(depth)),
            );
            check(parts.concat().as_bytes(), 2, 100).unwrap();
        }
    }

    proptest! {
        #[test]
        fn damage_is_the_same_in_blocks_as_frame_by_frame(
            inserted in proptest::collection::vec((0..10_000_usize, 0..SNIPPETS.len()), 0..4),
            cut in proptest::option::of(0..10_000_usize),
            block in 1..2000_usize,
            threads in 1..4_usize,
            compressed: bool,
        ) {
            let mut bytes = parts().concat().into_bytes();
            for (place, snippet) in inserted {
                let place = place % bytes.len();
                bytes.splice(place..place, SNIPPETS[snippet].bytes());
            }
            if compressed {
                bytes = gzip(&bytes);
            }
            if let Some(cut) = cut {
                bytes.truncate(cut % bytes.len());
            }
            check(&bytes, threads, block)?;
        }

        #[test]
        fn one_flipped_bit_is_the_same_in_blocks_as_frame_by_frame(place in 0..10_000_usize, bit in 0..8, block in 1..2000_usize) {
            let mut bytes = parts().concat().into_bytes();
            let place = place % bytes.len();
            bytes[place] ^= 1_u8 << bit;
            check(&bytes, 2, block)?;
        }

        #[test]
        fn parts_in_any_order_are_the_same_in_blocks_as_frame_by_frame(
            moved in proptest::collection::vec((0..32_usize, 0..SNIPPETS.len() + 4), 1..5),
            block in 1..2000_usize,
        ) {
            let mut parts = parts();
            for (place, snippet) in moved {
                if let Some(text) = SNIPPETS.get(snippet) {
                    parts.insert(place % parts.len(), (*text).to_owned());
                } else {
                    let to = place * 7 % parts.len();
                    parts.swap(place, to);
                }
            }
            check(parts.concat().as_bytes(), 3, block)?;
        }
    }

    const SNIPPETS: [&str; 22] = [
        "<!--",
        "-->",
        "<!-- </frame> -->",
        "<![CDATA[",
        "]]>",
        "</frame>",
        "</frames>",
        "<frame>",
        "<odd>",
        "</odd>",
        "<odd/>",
        "<odd></frame></odd>",
        "&",
        "&lt;",
        "x",
        "\"",
        ">",
        "\u{feff}",
        "<?x </frame>?>",
        "<frame type=\"normal\">",
        "<frame type=\"tpose\"><orientation>1 0 0 0</orientation></frame>",
        "<frame type=\"ghost\"></frame >\n",
    ];
    const HEAD: &str = "<mvnx version=\"4\"><subject label=\"Ada\" frameRate=\"240\"><segments>\n\
        <segment label=\"Pelvis\" id=\"1\"/></segments><frames>\n";
    const TAIL: &str = "</frames></subject><securityCode code=\"1\"/></mvnx>\n";
}

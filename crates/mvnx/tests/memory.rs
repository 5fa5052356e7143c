//! Memory does not grow with the length of a file, read or written.

use posewire_mvnx::{Reader, Remainder, Version, Writer};
use std::io::{self, BufReader, Read};

const HEAD: &str = r#"<mvnx version="4"><subject label="Ada" frameRate="240"><segments><segment label="Pelvis" id="1"/>
</segments><frames>"#;
const FRAME: &str = r#"<frame time="0" type="normal"><orientation>1.000000 0.000000 0.000000 0.000000</orientation>
<position>0.100000 0.200000 0.950000</position><odd>1 2 3</odd><marker>step</marker></frame>"#;
const TAIL: &str = "</frames></subject></mvnx>";

/// So many frames one after the other, which are nowhere as a whole.
struct Frames {
    left: usize,
    rest: &'static [u8],
}

impl Read for Frames {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.rest.is_empty() && self.left > 0 {
            self.left -= 1;
            self.rest = FRAME.as_bytes();
        }
        self.rest.read(to)
    }
}

/// The most bytes that are in use at once while a take of so many frames is read.
fn most_bytes(frames: usize) -> u64 {
    let body = Frames {
        left: frames,
        rest: &[],
    };
    let file = HEAD.as_bytes().chain(body).chain(TAIL.as_bytes());
    let mut found = 0;
    let counts = allocation_counter::measure(|| {
        let reader = Reader::new(BufReader::new(file)).unwrap();
        found = reader.map(Result::unwrap).count();
    });
    assert_eq!(found, frames);
    counts.bytes_max
}

#[test]
fn a_long_take_takes_no_more_memory_than_a_short_one() {
    assert_eq!(most_bytes(20_000), most_bytes(200));
}

/// The most bytes that are in use at once while a take of so many frames is read and written.
fn most_bytes_rewritten(frames: usize) -> u64 {
    let body = Frames {
        left: frames,
        rest: &[],
    };
    let file = HEAD.as_bytes().chain(body).chain(TAIL.as_bytes());
    let counts = allocation_counter::measure(|| {
        let mut reader = Reader::new(BufReader::new(file)).unwrap();
        let mut writer = Writer::new(io::sink(), &reader.document(), Version::V3).unwrap();
        let mut remainder = Remainder::default();
        while let Some(frame) = reader.read_whole(&mut remainder) {
            writer.write_whole(&frame.unwrap(), &remainder).unwrap();
        }
        writer.finish(&reader.document()).unwrap();
    });
    counts.bytes_max
}

#[test]
fn a_long_take_that_is_rewritten_takes_no_more_memory_than_a_short_one() {
    assert_eq!(most_bytes_rewritten(20_000), most_bytes_rewritten(2_000));
}

//! Numbers with six decimals, as MVN writes them.

use std::io::Write;

/// Adds a number with six decimals. Zero keeps its sign, and what rounds to zero its own, as C's `printf` has it.
pub(crate) fn push_fixed(to: &mut Vec<u8>, value: f64) {
    let millionths = value.abs() * 1e6 + 0.5;
    if millionths < EXACT {
        push_millionths(to, value.is_sign_negative(), millionths as u64);
    } else {
        // Writing to memory does not fail.
        let _ = write!(to, "{value:.6}");
    }
}

fn push_millionths(to: &mut Vec<u8>, negative: bool, millionths: u64) {
    // A sign, up to ten digits before the point, the point and six digits.
    let mut text = [b'-'; 18];
    let (whole, mut decimals) = (millionths / 1_000_000, (millionths % 1_000_000) as usize);
    for place in [16, 14, 12] {
        let pair = 2 * (decimals % 100);
        decimals /= 100;
        text[place..place + 2].copy_from_slice(&PAIRS[pair..pair + 2]);
    }
    text[11] = b'.';
    let begin = push_whole(&mut text[..11], whole) - usize::from(negative);
    to.extend_from_slice(&text[begin..]);
}

/// Writes digits up to the end of `text` and tells where they begin.
fn push_whole(text: &mut [u8], mut whole: u64) -> usize {
    let mut begin = text.len();
    loop {
        begin -= 1;
        text[begin] = b'0' + (whole % 10) as u8;
        whole /= 10;
        if whole == 0 {
            return begin;
        }
    }
}

/// 2^49: below, what `f64` rounds off of a product is a small part of one.
const EXACT: f64 = 562_949_953_421_312.0;

/// The numbers from 00 to 99.
const PAIRS: [u8; 200] = {
    let mut pairs = [0; 200];
    let mut number = 0;
    while number < 100 {
        pairs[2 * number] = b'0' + (number / 10) as u8;
        pairs[2 * number + 1] = b'0' + (number % 10) as u8;
        number += 1;
    }
    pairs
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fixed(value: f64) -> String {
        let mut to = Vec::new();
        push_fixed(&mut to, value);
        String::from_utf8(to).unwrap()
    }

    #[test]
    fn six_decimals_stand_behind_the_point() {
        for (value, text) in [
            (0.0, "0.000000"),
            (-0.0, "-0.000000"),
            (-1e-9, "-0.000000"),
            (0.000_001, "0.000001"),
            (-1.5, "-1.500000"),
            (0.999_999_6, "1.000000"),
            (-123.456_789, "-123.456789"),
            (-562_949_953.0, "-562949953.000000"),
            (562_949_954.0, "562949954.000000"),
            (1e20, "100000000000000000000.000000"),
        ] {
            assert_eq!(fixed(value), text);
        }
    }

    proptest! {
        #[test]
        fn millionths_are_written_as_the_standard_library_writes_them(millionths in -(1_i64 << 51)..1 << 51, shift in 0..51_u32) {
            let value = (millionths >> shift) as f64 / 1e6;
            prop_assert_eq!(fixed(value), format!("{value:.6}"));
        }

        #[test]
        fn any_number_reads_back_within_half_a_millionth(value in -1e6..1e6_f64) {
            let back: f64 = fixed(value).parse().unwrap();
            prop_assert!((back - value).abs() <= 5.001e-7);
        }
    }
}

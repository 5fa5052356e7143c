//! Decimal numbers from bytes.

/// Reads numbers between white space to the end of `to`.
///
/// Every value is the `f64` nearest to the text.
pub(crate) fn read_numbers<'a>(text: &'a [u8], to: &mut Vec<f64>) -> Result<(), BadNumber<'a>> {
    let mut rest = text;
    loop {
        rest = rest[read_millionths(rest, to)..].trim_ascii_start();
        if rest.is_empty() {
            return Ok(());
        }
        let (value, length) = fixed_point(rest).or_else(|| any(rest)).ok_or_else(|| BadNumber {
            before: text.len() - rest.len(),
            word: word(rest),
        })?;
        to.push(value);
        rest = &rest[length..];
    }
}

/// A piece of text that is no finite decimal number.
#[derive(Debug)]
pub(crate) struct BadNumber<'a> {
    /// Bytes of text before it.
    pub(crate) before: usize,
    /// The piece.
    pub(crate) word: &'a [u8],
}

/// How many pieces of text there are between white space.
pub(crate) fn count_words(text: &[u8]) -> usize {
    text.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
        .count()
}

/// Reads up to 128 numbers at the beginning that stand as MVN writes them, with six decimals and one space between two; how
/// many bytes they take.
///
/// The divisions come last, so that they are done two at a time.
fn read_millionths(text: &[u8], to: &mut Vec<f64>) -> usize {
    let (mut numbers, mut count, mut at) = ([0; 128], 0, 0);
    for number in &mut numbers {
        let Some((millionths, length)) = text.get(at..).and_then(six_decimals) else {
            break;
        };
        if text.get(at + length).is_some_and(|&byte| byte != b' ') {
            break;
        }
        *number = millionths;
        (at, count) = (at + length + 1, count + 1);
    }
    to.extend(numbers[..count].iter().map(|number| {
        let millionths = f64::from_bits(TWO_TO_52.to_bits() | number & !SIGN) - TWO_TO_52;
        f64::from_bits((millionths / 1e6).to_bits() | number & SIGN)
    }));
    at.min(text.len())
}

/// A number as MVN writes it, and its length: up to four digits or a sign and three, a point, six digits. Others are left
/// to the next way. It is in millionths, its sign the highest bit.
///
/// Signs and lengths come in any order, so that the way through here does not depend on them. Where the next number begins
/// depends on the point alone, so that the processor converts several at once. The digits are looked at together, and
/// added in pairs, the pairs in fours, the fours in eights.
fn six_decimals(text: &[u8]) -> Option<(u64, usize)> {
    let first = u64::from_le_bytes(*text.first_chunk()?);
    let points = first ^ POINTS;
    let point = (points.wrapping_sub(ONES) & !points & HIGHEST_BITS).trailing_zeros() as usize / 8;
    if !(1..=4).contains(&point) {
        return None;
    }
    let last = u64::from_le_bytes(*text.get(point - 1..)?.first_chunk()?);
    let negative = first as u8 == b'-';
    let minus = if negative { u32::from(b'-' ^ b'0') } else { 0 };
    let whole = (first as u32 ^ ZEROS as u32 ^ minus) << (32 - 8 * point);
    let decimals = (last ^ ZEROS) >> 16;
    let (eight, two) = (decimals << 32 | u64::from(whole), decimals >> 32);
    if (eight | eight.wrapping_add(SIXES) | two | two.wrapping_add(SIXES)) & HIGH_HALVES != 0 {
        return None;
    }
    let pairs = (eight * 10 + (eight >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    let eight = (fours * 10_000 + (fours >> 32)) & 0xffff_ffff;
    let two = (two * 10 + (two >> 8)) & 0xff;
    Some(((eight * 100 + two) | (u64::from(negative) << 63), point + 7))
}

/// A number of at most 15 digits without an exponent, and its length: MVN writes no others.
///
/// Such digits and the power of ten below them are exact in `f64`, so that one division rounds correctly.
fn fixed_point(text: &[u8]) -> Option<(f64, usize)> {
    let negative = text[0] == b'-';
    let start = usize::from(negative);
    let (mut mantissa, mut at, mut point) = (0_u64, start, None);
    while let Some(&byte) = text.get(at) {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        } else if byte == b'.' && point.is_none() {
            point = Some(at);
        } else if byte.is_ascii_whitespace() {
            break;
        } else {
            return None;
        }
        at += 1;
    }
    let digits = at - start - usize::from(point.is_some());
    if digits == 0 || digits > 15 {
        return None;
    }
    let decimals = point.map_or(0, |point| at - point - 1);
    let value = mantissa as f64 / POWERS_OF_TEN[decimals];
    Some((if negative { -value } else { value }, at))
}

/// A number in any notation, and its length.
fn any(text: &[u8]) -> Option<(f64, usize)> {
    let word = word(text);
    // The words that the standard library also reads, `inf` and `nan`, are no numbers here.
    let decimal = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let value: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    (word.iter().all(decimal) && value.is_finite()).then_some((value, word.len()))
}

fn word(text: &[u8]) -> &[u8] {
    let end = text.iter().position(u8::is_ascii_whitespace);
    &text[..end.unwrap_or(text.len())]
}

/// The digit 0 in each byte.
const ZEROS: u64 = u64::from_le_bytes([b'0'; 8]);
const POINTS: u64 = u64::from_le_bytes([b'.'; 8]);
const ONES: u64 = u64::from_le_bytes([1; 8]);
/// What makes the high half of a byte other than zero when the low half is more than 9.
const SIXES: u64 = u64::from_le_bytes([6; 8]);
const HIGH_HALVES: u64 = u64::from_le_bytes([0xf0; 8]);
const SIGN: u64 = 1 << 63;
/// Its lowest bits are a whole number, which it is the sum with.
const TWO_TO_52: f64 = 4_503_599_627_370_496.0;
const HIGHEST_BITS: u64 = u64::from_le_bytes([0x80; 8]);
const POWERS_OF_TEN: [f64; 16] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn numbers(text: &str) -> Result<Vec<f64>, String> {
        let mut to = Vec::new();
        read_numbers(text.as_bytes(), &mut to)
            .map(|()| to)
            .map_err(|bad| String::from_utf8_lossy(bad.word).into_owned())
    }

    #[test]
    fn numbers_stand_between_white_space_of_any_kind() {
        assert_eq!(numbers(" 1.500000\n\t-2 \r\n.25 3. "), Ok(vec![1.5, -2.0, 0.25, 3.0]));
        assert_eq!(numbers(""), Ok(Vec::new()));
        assert_eq!(
            numbers("+1e-3 12345678901234567890"),
            Ok(vec![0.001, 12_345_678_901_234_567_890.0])
        );
    }

    #[test]
    fn the_sign_of_zero_stays() {
        let found = numbers("-0.000000").unwrap();
        assert!(found[0] == 0.0 && found[0].is_sign_negative());
    }

    #[test]
    fn what_is_no_finite_decimal_number_is_named() {
        for word in [
            "nan",
            "NaN",
            "inf",
            "-infinity",
            "1e999",
            "1,5",
            "1.2.3",
            "--1",
            "-",
            ".",
            "0x10",
            "1-",
            "é",
        ] {
            assert_eq!(numbers(&format!("1.0 {word} 2.0")), Err(word.to_owned()));
        }
    }

    proptest! {
        #[test]
        fn every_value_is_that_of_the_standard_library(mantissa: i64, decimals in 0..18_usize, shift in 0..63_u32) {
            let digits = format!("{:019}", (mantissa >> shift).unsigned_abs());
            let (whole, fraction) = digits.split_at(digits.len() - decimals);
            let sign = if mantissa < 0 { "-" } else { "" };
            for text in [format!("{sign}{whole}.{fraction}"), format!("{sign}{}.{fraction}", whole.trim_start_matches('0'))] {
                if text.trim_start_matches('-') == "." {
                    continue;
                }
                let expected: f64 = text.parse().unwrap();
                let found = numbers(&text).unwrap();
                prop_assert_eq!(found[0].to_bits(), expected.to_bits(), "{}", text);
            }
        }

        #[test]
        fn six_decimals_are_those_of_the_standard_library(millionths in -1_200_000_000..1_200_000_000_i64, byte: u8, place in 0..12_usize) {
            let sign = if millionths < 0 { "-" } else { "" };
            let text = format!("{sign}{}.{:06}", millionths.abs() / 1_000_000, millionths.abs() % 1_000_000);
            let expected: f64 = text.parse().unwrap();
            prop_assert_eq!(numbers(&text).map(|found| found[0].to_bits()), Ok(expected.to_bits()));
            // With any byte in it, it is what the other ways say.
            let mut bytes = text.into_bytes();
            let place = place % bytes.len();
            bytes[place] = byte;
            let mut found = Vec::new();
            let length = read_millionths(&bytes, &mut found);
            if let Some(value) = found.first() {
                let other = fixed_point(&bytes).map(|(value, length)| (value.to_bits(), length));
                prop_assert_eq!(other, Some((value.to_bits(), length)));
            }
        }

        #[test]
        fn any_bytes_do_no_harm(bytes: Vec<u8>) {
            let mut to = Vec::new();
            let _ = read_numbers(&bytes, &mut to);
            prop_assert!(to.len() <= bytes.len() && to.iter().all(|value| value.is_finite()));
        }
    }
}

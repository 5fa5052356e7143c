//! Text and numbers as people read them.

use std::fmt::Write;

/// The text with its control characters escaped: what a file or a stream says must not steer the terminal.
pub(crate) fn printable(text: &str) -> String {
    let mut printed = String::with_capacity(text.len());
    for character in text.chars() {
        if character.is_control() {
            _ = write!(printed, "{}", character.escape_debug());
        } else {
            printed.push(character);
        }
    }
    printed
}

/// The text, its end cut off when it has more than so many characters.
pub(crate) fn cut(text: &str, limit: usize) -> String {
    match text.char_indices().nth(limit) {
        None => text.to_owned(),
        Some(_) => text.chars().take(limit - 1).chain(['…']).collect(),
    }
}

/// A count and its word: `1 byte`, `1,024 bytes`.
pub(crate) fn plural(count: u64, word: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{} {word}{ending}", grouped(count))
}

/// A number with a comma before every three digits: `1,048,576`.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped_and_words_follow_their_count() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_048_576), "1,048,576");
        assert_eq!(plural(1, "byte"), "1 byte");
        assert_eq!(plural(1000, "byte"), "1,000 bytes");
    }

    #[test]
    fn control_characters_are_escaped_and_letters_are_not() {
        assert_eq!(printable("Zoë\x1b[2J\n\u{9b}"), "Zoë\\u{1b}[2J\\n\\u{9b}");
        assert_eq!(cut("four", 4), "four");
        assert_eq!(cut("éèàùê", 4), "éèà…");
    }
}

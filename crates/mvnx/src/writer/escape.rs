//! Text in which markup means itself.

/// Adds text as the content of an element.
pub(crate) fn text(to: &mut Vec<u8>, text: &str) {
    for character in text.chars().filter(|&character| is_allowed(character)) {
        push(to, character);
    }
}

/// Text as the value of an attribute between double quotes.
pub(crate) fn attribute(text: &str) -> String {
    let mut to = Vec::with_capacity(text.len());
    for character in text.chars().filter(|&character| is_allowed(character)) {
        match character {
            // As they are, a reader makes spaces of them.
            '\n' => to.extend_from_slice(b"&#10;"),
            '\t' => to.extend_from_slice(b"&#9;"),
            _ => push(&mut to, character),
        }
    }
    String::from_utf8_lossy(&to).into_owned()
}

fn push(to: &mut Vec<u8>, character: char) {
    match character {
        '&' => to.extend_from_slice(b"&amp;"),
        '<' => to.extend_from_slice(b"&lt;"),
        '>' => to.extend_from_slice(b"&gt;"),
        '"' => to.extend_from_slice(b"&quot;"),
        '\r' => to.extend_from_slice(b"&#13;"),
        _ => to.extend_from_slice(character.encode_utf8(&mut [0; 4]).as_bytes()),
    }
}

/// Whether XML 1.0 has the character at all.
fn is_allowed(character: char) -> bool {
    !matches!(character, '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_text_means_itself() {
        let mut to = Vec::new();
        text(&mut to, "a<b> & \"c\"\n\u{1}é");
        assert_eq!(to, "a&lt;b&gt; &amp; &quot;c&quot;\né".as_bytes());
        assert_eq!(attribute("1\n2\t\"3\""), "1&#10;2&#9;&quot;3&quot;");
    }
}

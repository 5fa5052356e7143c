//! Parts of the lines that packets print.

/// `1 marker`, `2 markers`; nothing for none.
pub(crate) fn count(count: usize, what: &str) -> String {
    match (count, what.strip_suffix("body")) {
        (0, _) => String::new(),
        (1, _) => format!("1 {what}"),
        (_, Some(start)) => format!("{count} {start}bodies"),
        (_, None) => format!("{count} {what}s"),
    }
}

//! The bytes to explain, and what to say when they are something else.

use crate::error::Usage;
use posewire::endpoint::Endpoint;
use posewire_mxtp::Header;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Reads the file, or the standard input for `-`.
pub(super) fn read(path: &Path) -> anyhow::Result<Vec<u8>> {
    refuse_url(path)?;
    let bytes = if is_standard_input(path) {
        read_bounded(io::stdin().lock())
    } else {
        File::open(path).and_then(read_bounded)
    };
    let bytes = bytes.map_err(|error| posewire::Error::read(path, &error))?;
    if bytes.len() > LIMIT {
        return Err(too_much(path).into());
    }
    refuse_other_content(path, &bytes)?;
    Ok(bytes)
}

/// What to call the input.
pub(super) fn name(path: &Path) -> String {
    if is_standard_input(path) {
        "the standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

/// Whether it begins as MXTP does.
pub(super) fn is_mxtp(bytes: &[u8]) -> bool {
    bytes.starts_with(&Header::MAGIC)
}

fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn read_bounded(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(LIMIT as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn too_much(path: &Path) -> Usage {
    let name = name(path);
    let from = if is_standard_input(path) {
        String::new()
    } else {
        format!(" {name}")
    };
    Usage {
        problem: format!("{name}: expected at most {} MiB, found more", LIMIT >> 20),
        help: format!("explain a part of it: head -c 1000000{from} | posewire explain -"),
    }
}

fn refuse_url(path: &Path) -> Result<(), Usage> {
    let text = path.to_string_lossy();
    match text.parse() {
        Ok(Endpoint::MxtpUdp(_) | Endpoint::MxtpTcp(_) | Endpoint::NatNet(_)) => Err(Usage {
            problem: format!("{text} is a live stream, explain reads a file"),
            help: format!("posewire monitor {text}"),
        }),
        Ok(Endpoint::Synthetic(_)) => Err(Usage {
            problem: format!("{text} is not a file"),
            help: "posewire demo shows the walker".to_owned(),
        }),
        _ => Ok(()),
    }
}

/// Files that are likely to be given by mistake.
fn refuse_other_content(path: &Path, bytes: &[u8]) -> Result<(), Usage> {
    let name = name(path);
    let beginning = &bytes[..bytes.len().min(4096)];
    let (problem, help) = if bytes.is_empty() {
        ("is empty", "give a file with the raw bytes of a datagram".to_owned())
    } else if is_mxtp(beginning) {
        return Ok(());
    } else if beginning.windows(5).any(|word| word == b"<mvnx") || beginning.starts_with(&GZIP) {
        ("is a take, explain reads datagrams", format!("posewire inspect {name}"))
    } else if is_hex_text(beginning) {
        let from = if is_standard_input(path) {
            String::new()
        } else {
            format!(" {name}")
        };
        (
            "holds the bytes as hexadecimal text",
            format!("xxd -r -p{from} | posewire explain -"),
        )
    } else {
        return Ok(());
    };
    Err(Usage {
        problem: format!("{name} {problem}"),
        help,
    })
}

/// Whether it is hexadecimal digits, as many as a header has at least, with any spacing.
fn is_hex_text(bytes: &[u8]) -> bool {
    let mut digits = bytes.iter().filter(|byte| !byte.is_ascii_whitespace());
    digits.clone().count() >= 8 && digits.all(u8::is_ascii_hexdigit)
}

const LIMIT: usize = 64 << 20;
const GZIP: [u8; 2] = [0x1f, 0x8b];

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(bytes: &[u8]) -> Option<String> {
        let error = refuse_other_content(Path::new("x"), bytes).err()?;
        Some(format!("{}; {}", error.problem, error.help))
    }

    #[test]
    fn a_file_given_by_mistake_is_recognised() {
        assert_eq!(problem(b"MXTP"), None);
        assert_eq!(problem(b"garbage MXTP02"), None);
        let take = "x is a take, explain reads datagrams; posewire inspect x";
        assert_eq!(
            problem(b"<?xml version=\"1.0\"?>\n<mvnx version=\"4\">").as_deref(),
            Some(take)
        );
        assert_eq!(problem(b"\x1f\x8b\x08").as_deref(), Some(take));
        let hex = "x holds the bytes as hexadecimal text; xxd -r -p x | posewire explain -";
        assert_eq!(problem(b"4D 58 54 50 30 32").as_deref(), Some(hex));
        assert_eq!(problem(b"0a00 0000\n").as_deref(), Some(hex));
        assert_eq!(problem(b"\x0a\0\0\0"), None);
        assert!(problem(b"").is_some());
    }
}

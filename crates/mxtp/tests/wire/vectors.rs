//! The vectors in `testdata/mxtp`: what each datagram decodes to, and that it encodes back.
//!
//! `POSEWIRE_UPDATE_VECTORS=1 cargo test -p posewire-mxtp --test wire the_samples` writes the files
//! anew.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use posewire_mxtp::{Datagram, explain};

use crate::{json, samples};

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/mxtp")
}

fn encoded(datagram: &Datagram<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    datagram.encode(&mut bytes);
    bytes
}

#[test]
fn the_samples_are_the_vectors() {
    let update = env::var_os("POSEWIRE_UPDATE_VECTORS").is_some();
    for (name, bytes) in samples::all() {
        let path = directory().join(name);
        if update {
            write(&path, &bytes);
        }
        let stored = fs::read(path.with_extension("bin")).unwrap_or_default();
        assert_eq!(stored, bytes, "{}: set POSEWIRE_UPDATE_VECTORS", path.display());
    }
}

#[test]
fn every_vector_decodes_to_its_json_and_encodes_to_its_bytes() {
    for path in stored("bin") {
        let bytes = fs::read(&path).unwrap();
        let datagram = Datagram::decode(&bytes).unwrap();
        let text = fs::read_to_string(path.with_extension("json")).unwrap();
        let expected: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(json::datagram(&datagram), expected, "{}", path.display());
        assert_eq!(encoded(&datagram), bytes, "{}", path.display());
    }
}

#[test]
fn every_vector_is_one_of_the_samples() {
    let names: BTreeSet<_> = samples::all().into_iter().map(|(name, _)| name).collect();
    let files: BTreeSet<_> = stored("bin")
        .chain(stored("json"))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    assert_eq!(files, names);
}

#[test]
fn every_byte_of_every_vector_is_explained() {
    for (name, bytes) in samples::all() {
        let explanation = explain(&bytes);
        let end = explanation.fields.iter().fold(0, |end, field| {
            assert_eq!(field.offset, end, "{name}: {field}");
            end + field.length
        });
        assert_eq!(end, bytes.len(), "{name}");
        assert_eq!(explanation.error, None, "{name}");
        let unread = explanation.fields.iter().any(|field| field.name == "unread");
        assert!(!unread, "{name}");
    }
}

fn stored(extension: &'static str) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(directory())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(move |path| path.extension().is_some_and(|found| found == extension))
}

fn write(path: &Path, bytes: &[u8]) {
    let datagram = Datagram::decode(bytes).unwrap();
    let mut text = serde_json::to_string(&json::datagram(&datagram)).unwrap();
    text.push('\n');
    fs::write(path.with_extension("bin"), bytes).unwrap();
    fs::write(path.with_extension("json"), text).unwrap();
}

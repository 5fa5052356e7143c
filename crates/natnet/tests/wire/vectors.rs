//! The vectors in `testdata/natnet`: what each packet decodes to, and that it encodes back.
//!
//! `POSEWIRE_UPDATE_VECTORS=1 cargo test -p posewire-natnet --test wire the_samples` writes the files
//! anew.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use posewire_natnet::{Message, Version, explain};

use crate::samples::Sample;
use crate::{json, samples};

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/natnet")
}

#[test]
fn the_samples_are_the_vectors() {
    let update = env::var_os("POSEWIRE_UPDATE_VECTORS").is_some();
    for sample in samples::all() {
        let path = directory().join(&sample.name);
        if update {
            write(&path, &sample);
        }
        let stored = fs::read(path.with_extension("bin")).unwrap_or_default();
        assert_eq!(stored, sample.bytes, "{}: set POSEWIRE_UPDATE_VECTORS", path.display());
    }
}

#[test]
fn every_vector_decodes_to_its_json_and_encodes_to_its_bytes() {
    for path in stored("bin") {
        let bytes = fs::read(&path).unwrap();
        let text = fs::read_to_string(path.with_extension("json")).unwrap();
        let expected: serde_json::Value = serde_json::from_str(&text).unwrap();
        let version: Version = expected["version"].as_str().unwrap().parse().unwrap();
        let (message, quirks) = Message::decode(version, &bytes).unwrap();
        assert_eq!(json::packet(version, &message, quirks), expected, "{}", path.display());
        let mut encoded = Vec::new();
        message.encode(version, &mut encoded).unwrap();
        assert!(encoded == bytes || !quirks.is_empty(), "{}", path.display());
    }
}

#[test]
fn every_vector_is_one_of_the_samples() {
    let names: BTreeSet<_> = samples::all().into_iter().map(|sample| sample.name).collect();
    let files: BTreeSet<_> = stored("bin")
        .chain(stored("json"))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    assert_eq!(files, names);
}

#[test]
fn every_byte_of_every_vector_is_explained() {
    for Sample { name, version, bytes } in samples::all() {
        let explanation = explain(version, &bytes);
        let end = explanation.fields.iter().fold(0, |end, field| {
            assert_eq!(field.offset, end, "{name}: {field}");
            end + field.length
        });
        assert_eq!(end, bytes.len(), "{name}");
        assert_eq!(explanation.error, None, "{name}");
        let unread = explanation.fields.iter().find(|field| field.name == "unread");
        assert_eq!(unread, None, "{name}");
    }
}

#[test]
fn a_cut_packet_is_explained_up_to_the_cut() {
    for Sample { name, version, bytes } in samples::all() {
        for length in 0..bytes.len() {
            let explanation = explain(version, &bytes[..length]);
            let end = explanation.fields.iter().fold(0, |end, field| {
                assert_eq!(field.offset, end, "{name}: {field}");
                end + field.length
            });
            assert_eq!(end, length, "{name}");
        }
    }
}

fn stored(extension: &'static str) -> impl Iterator<Item = PathBuf> {
    fs::read_dir(directory())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(move |path| path.extension().is_some_and(|found| found == extension))
}

fn write(path: &Path, sample: &Sample) {
    let (message, quirks) = Message::decode(sample.version, &sample.bytes).unwrap();
    let mut text = serde_json::to_string(&json::packet(sample.version, &message, quirks)).unwrap();
    text.push('\n');
    fs::write(path.with_extension("bin"), &sample.bytes).unwrap();
    fs::write(path.with_extension("json"), text).unwrap();
}

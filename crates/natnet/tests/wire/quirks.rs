//! What real senders do against the documents is accepted and counted by name.

use posewire_natnet::frame::Frame;
use posewire_natnet::model::Description;
use posewire_natnet::{Message, Quirk, Quirks, Version};

use crate::samples;

const V1_4: Version = Version::new(1, 4);

fn decoded(name: &str) -> (Message, Quirks) {
    let sample = samples::all().into_iter().find(|sample| sample.name == name).unwrap();
    Message::decode(sample.version, &sample.bytes).unwrap()
}

fn frame(name: &str) -> (Frame, Quirks) {
    match decoded(name) {
        (Message::Frame(frame), quirks) => (*frame, quirks),
        (other, _) => panic!("not a frame: {other}"),
    }
}

#[test]
fn each_deviation_has_its_quirk() {
    let expected = [
        ("frame_1_4_draft", Quirk::DraftLayout),
        ("model_1_4_draft", Quirk::DraftLayout),
        ("quirk_unsized_frame", Quirk::UnsizedSections),
        ("quirk_precision_time", Quirk::ExtraPrecisionTime),
        ("quirk_unsized_model", Quirk::UnsizedSections),
        ("quirk_missing_sections", Quirk::MissingSections),
        ("quirk_extra_sections", Quirk::ExtraSections),
        ("quirk_keep_alive", Quirk::PayloadSize),
        ("quirk_keep_alive_stated", Quirk::UnexpectedPayload),
        ("quirk_request_unended", Quirk::TextUnended),
        ("quirk_server_info_size", Quirk::ServerInfoSize),
    ];
    for (name, quirk) in expected {
        assert_eq!(decoded(name).1, quirk.into(), "{name}");
    }
}

#[test]
fn the_draft_of_1_4_holds_what_the_flat_form_holds() {
    let (draft, _) = frame("frame_1_4_draft");
    let (flat, quirks) = frame("frame_1_4");
    assert_eq!(draft, flat);
    assert_eq!(quirks, Quirks::NONE);
    let mut again = Vec::new();
    draft.encode_draft(&mut again);
    let mut original = Vec::new();
    samples::frame().encode_draft(&mut original);
    assert_eq!(again, original);
}

#[test]
fn a_draft_of_one_model_is_the_flat_form() {
    let mut one = samples::frame();
    one.marker_sets.truncate(1);
    let (mut draft, mut flat) = (Vec::new(), Vec::new());
    one.encode_draft(&mut draft);
    one.encode(V1_4, &mut flat);
    assert_eq!(draft, flat);
}

#[test]
fn a_draft_without_models_is_a_frame_number() {
    let mut payload = Vec::new();
    Frame {
        number: 7,
        ..Frame::default()
    }
    .encode_draft(&mut payload);
    let (frame, quirks) = Frame::decode(V1_4, &payload).unwrap();
    assert_eq!((frame.number, quirks), (7, Quirk::DraftLayout.into()));
}

#[test]
fn a_server_of_4_5_without_sizes_is_understood() {
    let (plain, _) = frame("quirk_unsized_frame");
    let (precise, quirks) = frame("quirk_unsized_frame_precise");
    let (v4_0, _) = frame("frame_4_0");
    assert_eq!(plain, v4_0);
    assert!(quirks.iter().eq([Quirk::UnsizedSections, Quirk::ExtraPrecisionTime]));
    assert_eq!(precise.labeled_markers, v4_0.labeled_markers);
    assert_eq!(precise.precision_time.unwrap().fraction, 9);
}

#[test]
fn a_larger_description_than_known_is_read_as_far_as_it_is_known() {
    let (Message::Model(model), quirks) = decoded("quirk_leftover") else {
        panic!("no model");
    };
    assert_eq!(quirks, Quirk::SectionLeftover.into());
    assert_eq!(model.descriptions.len(), 1);
    assert!(samples::model().descriptions.contains(&model.descriptions[0]));
}

#[test]
fn a_description_that_cannot_be_read_does_not_cost_the_others() {
    let (Message::Model(model), quirks) = decoded("quirk_unreadable_description") else {
        panic!("no model");
    };
    assert!(quirks.contains(Quirk::UnreadableDescription));
    let sent = samples::model().descriptions;
    assert_eq!(model.descriptions.len(), sent.len());
    assert!(matches!(model.descriptions[2], Description::Unknown { kind: 2, .. }));
    for n in [0, 3, 4, 5, 7] {
        assert_eq!(model.descriptions[n], sent[n]);
    }
}

#[test]
fn unknown_descriptions_are_kept_and_sent_on() {
    let (Message::Model(model), _) = decoded("model_4_1") else {
        panic!("no model");
    };
    let bytes = b"anchors".to_vec();
    assert_eq!(
        model.descriptions.last(),
        Some(&Description::Unknown { kind: 7, bytes })
    );
}

//! What holds for any bytes, any frame and any description.

use posewire_natnet::command::{Connect, ConnectOptions, Sender, Text};
use posewire_natnet::frame::Frame;
use posewire_natnet::model::Model;
use posewire_natnet::{Message, MessageId, Quirks, Version, explain};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

use crate::samples::{self, Sample};
use crate::strategies;

/// Decodes, and when that works encodes, prints and explains everything.
fn exercise(version: Version, bytes: &[u8]) {
    let explanation = explain(version, bytes);
    let end = explanation.fields.iter().map(|field| field.length).sum::<usize>();
    assert_eq!(end, bytes.len());
    let Ok((message, quirks)) = Message::decode(version, bytes) else {
        assert!(explanation.error.is_some());
        return;
    };
    assert_eq!(explanation.quirks, quirks);
    assert!(!message.to_string().is_empty());
    let mut encoded = Vec::new();
    message.encode(version, &mut encoded).unwrap();
    if quirks.is_empty() && keeps_its_bytes(&message) {
        assert_eq!(encoded, bytes);
    }
}

/// Whether every bit of the message has a place in its value. Flags and what follows the zero of a
/// name have none; a timestamp that is not a number may change on its way through 64 bits.
fn keeps_its_bytes(message: &Message) -> bool {
    match message {
        Message::Frame(frame) => !frame.timestamp.is_some_and(f64::is_nan),
        Message::Model(_) | Message::EchoRequest(_) | Message::EchoResponse(_) | Message::Response(_) => true,
        _ => false,
    }
}

fn sample() -> impl Strategy<Value = (Version, Vec<u8>)> {
    let pairs = samples::all()
        .into_iter()
        .map(|Sample { version, bytes, .. }| (version, bytes));
    select(pairs.collect::<Vec<_>>())
}

fn sender() -> impl Strategy<Value = Sender> {
    (strategies::name(), any::<[u8; 4]>(), any::<[u8; 4]>()).prop_map(|(name, app, natnet)| Sender {
        name,
        app_version: app.into(),
        natnet_version: natnet.into(),
    })
}

fn connect() -> impl Strategy<Value = Connect> {
    let options = any::<(bool, [u8; 4])>().prop_map(|(subscribed_only, version)| ConnectOptions {
        subscribed_only,
        bitstream_version: version.into(),
    });
    (sender(), proptest::option::of(options), vec(any::<u8>(), 0..5)).prop_map(|(sender, options, rest)| Connect {
        sender: Some(sender),
        options,
        rest,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_decode_or_fail(
        version in strategies::version(),
        id in 0..16_u16,
        payload in vec(any::<u8>(), 0..300),
    ) {
        let size = payload.len() as u16;
        exercise(version, &[&id.to_le_bytes()[..], &size.to_le_bytes(), &payload].concat());
        exercise(version, &payload);
    }

    #[test]
    fn small_numbers_decode_or_fail(
        version in strategies::version(),
        id in select(vec![MessageId::FRAME, MessageId::MODEL]),
        payload in vec(prop_oneof![8 => Just(0_u8), 1 => 0..4_u8, 1 => any::<u8>()], 0..300),
    ) {
        let size = payload.len() as u16;
        exercise(version, &[&id.0.to_le_bytes()[..], &size.to_le_bytes(), &payload].concat());
    }

    #[test]
    fn one_flipped_bit_decodes_or_fails((version, mut bytes) in sample(), at in any::<Index>(), bit in 0..8) {
        let at = at.index(bytes.len());
        bytes[at] ^= 1_u8 << bit;
        exercise(version, &bytes);
    }

    #[test]
    fn any_version_reads_any_packet_or_fails((_, bytes) in sample(), version in strategies::version()) {
        exercise(version, &bytes);
    }

    #[test]
    fn a_cut_packet_decodes_or_fails((version, bytes) in sample(), length in any::<Index>()) {
        exercise(version, &bytes[..length.index(bytes.len())]);
    }

    #[test]
    fn frames_come_back((version, sent) in strategies::frame()) {
        let mut payload = Vec::new();
        sent.encode(version, &mut payload);
        prop_assert_eq!(Frame::decode(version, &payload), Ok((sent.clone(), Quirks::NONE)));
        let mut used = samples::frame();
        prop_assert_eq!(used.decode_into(version, &payload), Ok(Quirks::NONE));
        prop_assert_eq!(used, sent);
    }

    #[test]
    fn descriptions_come_back((version, sent) in strategies::model()) {
        let mut payload = Vec::new();
        sent.encode(version, &mut payload);
        prop_assert_eq!(Model::decode(version, &payload), Ok((sent, Quirks::NONE)));
    }

    #[test]
    fn connects_come_back(sent in connect()) {
        // Five bytes after a sender are options, whatever they were meant to be.
        prop_assume!(sent.options.is_some() || sent.rest.len() < 5);
        let mut payload = Vec::new();
        sent.encode(&mut payload);
        prop_assert_eq!(Connect::decode(&payload), sent);
    }

    #[test]
    fn texts_come_back(name in strategies::name()) {
        let mut payload = Vec::new();
        Text(name.clone()).encode(&mut payload);
        prop_assert_eq!(Text::decode(&payload).0, Text(name));
    }
}

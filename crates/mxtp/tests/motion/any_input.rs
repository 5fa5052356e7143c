//! Any frame, any records, any bytes.

use crate::frames::{encode, full_frame, object, options, receive, subject};
use posewire_motion::{DQuat, DVec3, Frame, Subject};
use posewire_mxtp::motion::{Datagrams, Encoder, EncoderOptions, Filler, MessageTypes};
use posewire_mxtp::{Datagram, Header, MessageType, Revision};
use proptest::prelude::*;
use proptest::sample::select;
use std::sync::Arc;

const SAMPLE_TYPES: [u8; 10] = [1, 2, 3, 5, 20, 21, 22, 23, 24, 25];

/// The types whose values come back bit by bit.
const PLAIN_TYPES: [u8; 7] = [2, 3, 20, 21, 22, 23, 24];

fn any_subject() -> impl Strategy<Value = Arc<Subject>> {
    let body = (0..=4_usize, any::<bool>()).prop_map(|(props, fingers)| subject(props, fingers));
    prop_oneof![body, (0..80_usize).prop_map(object)]
}

fn any_frame() -> impl Strategy<Value = Frame> {
    (any_subject(), any::<u64>(), any::<u32>(), any::<u64>()).prop_map(|(subject, seed, sample, lost)| {
        let mut frame = full_frame(&subject, seed);
        frame.sample = sample;
        for place in (0..subject.skeleton.segments.len()).filter(|place| lost >> (place % 64) & 7 == 7) {
            frame.position[place] = None;
            frame.angular_velocity[place] = None;
        }
        frame
    })
}

/// Bytes that are a datagram of a sample type as far as their size goes.
fn any_datagram() -> impl Strategy<Value = Vec<u8>> {
    let bytes = proptest::collection::vec(any::<u8>(), 0..80 * 44);
    let small_id = proptest::collection::vec(0..70_u8, 80);
    (select(&SAMPLE_TYPES[..]), bytes, small_id, any::<bool>(), any::<u8>()).prop_map(
        |(number, mut payload, ids, small, items)| {
            let message_type = MessageType::new(number).unwrap();
            let size = message_type.item_size().unwrap();
            payload.truncate(payload.len() / size * size);
            for (record, id) in payload.chunks_exact_mut(size).zip(ids).filter(|_| small) {
                record[..4].copy_from_slice(&u32::from(id).to_be_bytes());
            }
            let header = Header {
                items,
                ..Header::rev_j(message_type, 1, 2)
            };
            [header.encode().to_vec(), payload].concat()
        },
    )
}

fn quiet(bytes: [u8; 4]) -> [u8; 4] {
    let value = f32::from_be_bytes(bytes);
    if value.is_nan() { [0x7F, 0xC0, 0, 0] } else { bytes }
}

proptest! {
    #[test]
    fn a_frame_that_came_from_the_wire_goes_back_as_it_came(
        frame in any_frame(),
        split in proptest::option::of(0..3000_usize),
        old in any::<bool>(),
    ) {
        for number in SAMPLE_TYPES.into_iter().filter(|number| ![1, 5].contains(number)) {
            let options = EncoderOptions {
                split,
                revision: if old { Revision::J } else { Revision::N },
                ..options(&[MessageType::new(number).unwrap()])
            };
            let first = encode(options.clone(), &frame);
            let (received, _) = receive(&frame.subject, first.iter());
            if !first.is_empty() {
                prop_assert_eq!(encode(options, &received), first, "{}", number);
            }
        }
    }

    #[test]
    fn any_values_come_back_bit_by_bit(
        number in select(&PLAIN_TYPES[..]),
        values in proptest::collection::vec(any::<[u8; 4]>(), 23 * 16),
    ) {
        // A frame gives the shape: IDs and counts; then every value is replaced.
        let message_type = MessageType::new(number).unwrap();
        let options = options(&[message_type]);
        let body = subject(0, false);
        let mut bytes = encode(options.clone(), &full_frame(&body, 1)).as_bytes().to_vec();
        let (ids, size) = match number {
            20 => (8, 20),
            24 => (0, 36),
            _ => (4, message_type.item_size().unwrap()),
        };
        let mut values = values.into_iter().map(quiet);
        for record in bytes[Header::SIZE..].chunks_exact_mut(size) {
            for (field, value) in record[ids..].chunks_exact_mut(4).zip(&mut values) {
                field.copy_from_slice(&value);
            }
        }
        let (received, _) = receive(&body, [&bytes[..]]);
        let again = encode(options, &received);
        prop_assert_eq!(again.as_bytes(), &bytes[..]);
    }

    #[test]
    fn any_records_fill_a_frame_that_fits(
        subject in any_subject(),
        datagrams in proptest::collection::vec((any_datagram(), proptest::option::of(0..300_usize)), 1..8),
    ) {
        let mut frame = Frame::new(subject);
        let mut filler = Filler::new();
        for (bytes, first) in &datagrams {
            if let Ok(datagram) = Datagram::decode(bytes) {
                filler.fill_part(&mut frame, &datagram.header, &datagram.body, *first);
                prop_assert_eq!(frame.check(), Ok(()));
            }
        }
    }

    #[test]
    fn any_values_can_be_encoded(numbers in proptest::array::uniform7(any::<f64>()), split in any::<usize>()) {
        let body = subject(1, true);
        let mut frame = full_frame(&body, 1);
        let [x, y, z, a, b, c, d] = numbers;
        frame.position = vec![Some(DVec3::new(x, y, z)); 64];
        frame.orientation = vec![Some(DQuat::from_xyzw(a, b, c, d)); 64];
        let options = EncoderOptions {
            types: MessageTypes::ALL,
            split: Some(split),
            ..EncoderOptions::default()
        };
        let mut encoder = Encoder::new(options);
        let mut out = Datagrams::new();
        encoder.encode_frame(&frame, &mut out);
        encoder.encode_subject(&body, &mut out);
        for bytes in out.iter() {
            prop_assert!(Datagram::decode(bytes).is_ok());
        }
    }
}

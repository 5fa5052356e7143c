//! Poses as ROS 2 has them: `tf2_msgs/msg/TFMessage` in CDR.

use posewire_motion::{DQuat, DVec3, Frame, Pose, Stamp};

/// The name of the schema.
pub(super) const SCHEMA_NAME: &str = "tf2_msgs/msg/TFMessage";
/// The encoding of the schema.
pub(super) const SCHEMA_ENCODING: &str = "ros2msg";
/// The encoding of the messages.
pub(super) const MESSAGE_ENCODING: &str = "cdr";

/// The schema: the message and every message in it, by their definitions.
pub(super) const SCHEMA: &str = "\
geometry_msgs/TransformStamped[] transforms
================================================================================
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
";

/// Writes one sample as a message: a transform from the world to each tracked segment. `names` are the segments' frame
/// ids, in the skeleton's order.
pub(super) fn encode(frame: &Frame, names: &[String], at: Stamp, out: &mut Vec<u8>) {
    out.clear();
    // Little-endian CDR without options; alignment counts from behind these four bytes.
    out.extend_from_slice(&[0, 1, 0, 0, 0, 0, 0, 0]);
    let mut count = 0_u32;
    for (segment, name) in names.iter().enumerate() {
        if let Some(pose) = frame.pose(segment) {
            push_transform(out, at, name, &pose);
            count += 1;
        }
    }
    if let Some(place) = out.get_mut(HEADER..HEADER + 4) {
        place.copy_from_slice(&count.to_le_bytes());
    }
}

/// The transforms of a message as [`encode`] writes it, from the world to each frame id; `None` of other bytes.
pub(super) fn decode(message: &[u8]) -> Option<Vec<(&str, Pose)>> {
    let mut reader = Reader::new(message)?;
    let count = reader.u32()?;
    // Each takes more than a byte, so that there are no more of them than bytes.
    (0..count).map(|_| read_transform(&mut reader)).collect()
}

fn read_transform<'a>(reader: &mut Reader<'a>) -> Option<(&'a str, Pose)> {
    reader.align(4);
    reader.bytes(8)?;
    reader.text()?;
    let name = reader.text()?;
    reader.align(8);
    let [x, y, z] = [reader.f64()?, reader.f64()?, reader.f64()?];
    let position = DVec3::new(x, y, z);
    let [x, y, z, w] = [reader.f64()?, reader.f64()?, reader.f64()?, reader.f64()?];
    Some((name, Pose::new(position, DQuat::from_xyzw(x, y, z, w))))
}

/// Little-endian CDR, behind its header.
struct Reader<'a> {
    body: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn new(message: &'a [u8]) -> Option<Self> {
        let body = message.strip_prefix(&[0, 1])?.get(2..)?;
        Some(Self { body, at: 0 })
    }

    fn align(&mut self, to: usize) {
        self.at = self.at.next_multiple_of(to);
    }

    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let bytes = self.body.get(self.at..)?.get(..count)?;
        self.at += count;
        Some(bytes)
    }

    fn u32(&mut self) -> Option<u32> {
        self.bytes(4)?.try_into().map(u32::from_le_bytes).ok()
    }

    fn f64(&mut self) -> Option<f64> {
        self.bytes(8)?.try_into().map(f64::from_le_bytes).ok()
    }

    fn text(&mut self) -> Option<&'a str> {
        self.align(4);
        let length = self.u32()? as usize;
        let text = self.bytes(length)?.strip_suffix(&[0])?;
        std::str::from_utf8(text).ok()
    }
}

fn push_transform(out: &mut Vec<u8>, at: Stamp, name: &str, pose: &Pose) {
    let nanoseconds = at.nanoseconds();
    align(out, 4);
    out.extend_from_slice(&(nanoseconds.div_euclid(SECOND) as i32).to_le_bytes());
    out.extend_from_slice(&(nanoseconds.rem_euclid(SECOND) as u32).to_le_bytes());
    push_text(out, "world");
    push_text(out, name);
    align(out, 8);
    let (position, rotation) = (pose.position, pose.orientation);
    let numbers = [
        position.x, position.y, position.z, rotation.x, rotation.y, rotation.z, rotation.w,
    ];
    for number in numbers {
        out.extend_from_slice(&number.to_le_bytes());
    }
}

/// A length that counts the zero at the end, the text, and that zero.
fn push_text(out: &mut Vec<u8>, text: &str) {
    align(out, 4);
    out.extend_from_slice(&(text.len() as u32 + 1).to_le_bytes());
    out.extend_from_slice(text.as_bytes());
    out.push(0);
}

fn align(out: &mut Vec<u8>, to: usize) {
    let length = out.len() - HEADER;
    out.resize(HEADER + length.next_multiple_of(to), 0);
}

const HEADER: usize = 4;
const SECOND: i64 = 1_000_000_000;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{Skeleton, Subject};
    use proptest::prelude::*;
    use std::sync::Arc;

    fn message(poses: &[Option<(String, [f64; 7])>]) -> Vec<u8> {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::default())));
        let numbers = poses.iter().map(|pose| pose.as_ref().map(|(_, numbers)| *numbers));
        let numbers: Vec<_> = numbers.collect();
        frame.position = numbers.iter().map(|n| n.map(|n| DVec3::from_slice(&n))).collect();
        frame.orientation = numbers.iter().map(|n| n.map(|n| DQuat::from_slice(&n[3..]))).collect();
        let names = poses
            .iter()
            .map(|pose| pose.as_ref().map_or_else(String::new, |(name, _)| name.clone()));
        let mut out = Vec::new();
        encode(&frame, &names.collect::<Vec<_>>(), Stamp(7), &mut out);
        out
    }

    fn poses() -> impl Strategy<Value = Vec<Option<(String, [f64; 7])>>> {
        let pose = ("[^\0]{0,9}", prop::array::uniform7(-9.0..9.0));
        prop::collection::vec(proptest::option::of(pose), 0..9)
    }

    proptest! {
        #[test]
        fn what_was_encoded_is_decoded(poses in poses()) {
            let message = message(&poses);
            let decoded = decode(&message).unwrap();
            let decoded: Vec<_> = decoded.into_iter().map(|(name, pose)| {
                let (p, q) = (pose.position, pose.orientation);
                (name.to_owned(), [p.x, p.y, p.z, q.x, q.y, q.z, q.w])
            }).collect();
            prop_assert_eq!(decoded, poses.into_iter().flatten().collect::<Vec<_>>());
        }

        #[test]
        fn any_bytes_are_decoded_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = decode(&[&[0, 1, 0, 0], bytes.as_slice()].concat());
            let _ = decode(&bytes);
        }

        #[test]
        fn a_flipped_bit_is_decoded_or_refused(poses in poses(), bit in any::<prop::sample::Index>()) {
            let mut message = message(&poses);
            let bit = bit.index(message.len() * 8);
            message[bit / 8] ^= 1 << (bit % 8);
            let _ = decode(&message);
        }
    }

    #[test]
    fn an_untracked_segment_is_left_out_and_numbers_are_aligned() {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        frame.position = vec![None; 23];
        frame.orientation = vec![Some(DQuat::from_xyzw(0.5, -0.5, 0.5, 0.75)); 23];
        frame.position[1] = Some(DVec3::new(1.0, 2.0, 3.0));
        let names: Vec<_> = ["Ada/Pelvis", "Ada/L5"].map(str::to_owned).into();
        let mut out = vec![9; 3];
        encode(&frame, &names, Stamp(1_700_000_001_000_000_002), &mut out);

        let mut expected = vec![0, 1, 0, 0, 1, 0, 0, 0];
        expected.extend_from_slice(&1_700_000_001_i32.to_le_bytes());
        expected.extend_from_slice(&[2, 0, 0, 0]);
        expected.extend_from_slice(b"\x06\0\0\0world\0\0\0\x07\0\0\0Ada/L5\0");
        // 4 + 8 + 12 + 11 bytes: 5 more to a multiple of 8.
        expected.extend_from_slice(&[0; 5]);
        for number in [1.0_f64, 2.0, 3.0, 0.5, -0.5, 0.5, 0.75] {
            expected.extend_from_slice(&number.to_le_bytes());
        }
        assert_eq!(out, expected);
    }
}

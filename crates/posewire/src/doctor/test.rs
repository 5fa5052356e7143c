//! Values to examine.

use crate::endpoint::Endpoint;
use crate::{Datagram, Wire};
use posewire_motion::{DQuat, DVec3, Frame, Pose, Skeleton, Stamp, Subject};
use posewire_mxtp::{Header, MessageType};
use std::sync::Arc;

pub(super) fn endpoint(url: &str) -> Endpoint {
    url.parse().unwrap()
}

pub(super) fn datagram(from: &str, bytes: &[u8]) -> Datagram {
    Datagram {
        wire: Wire::MxtpUdp,
        from: from.parse().unwrap(),
        to: ([0, 0, 0, 0], 9763).into(),
        received: Stamp(0),
        bytes: bytes.into(),
    }
}

/// A header of this character and type.
pub(super) fn mxtp(character: u8, number: u8) -> Vec<u8> {
    let header = Header::rev_j(MessageType::new(number).unwrap(), 0, 0);
    header.with_character(character).encode().to_vec()
}

pub(super) fn subject() -> Arc<Subject> {
    Arc::new(Subject::new("Ada", Skeleton::standard(0, false)))
}

/// Ada upright in the T-pose, then turned and moved as a whole.
pub(super) fn standing(whole: Pose) -> Frame {
    let mut frame = Frame::new(subject());
    let origins: Vec<_> = frame.subject.skeleton.segments.iter().map(|one| one.origin).collect();
    frame.position = origins
        .iter()
        .map(|origin| origin.map(|origin| whole.position + whole.orientation * origin))
        .collect();
    frame.orientation = vec![Some(whole.orientation); origins.len()];
    frame
}

/// Ada upright, facing somewhere.
pub(super) fn upright() -> Frame {
    standing(Pose::new(DVec3::new(2.0, -1.0, 0.0), DQuat::from_rotation_z(2.0)))
}

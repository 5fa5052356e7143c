//! Which types of MXTP arrive.

use super::Check;
use super::finding::Finding;
use crate::{Datagram, Wire};
use posewire_mxtp::{Header, MessageType};
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// The types that each character has.
#[derive(Debug, Default)]
pub(super) struct Contents {
    characters: BTreeMap<u8, BTreeSet<MessageType>>,
}

impl Contents {
    pub(super) fn datagram(&mut self, datagram: &Datagram) {
        let is_mxtp = matches!(datagram.wire, Wire::MxtpUdp | Wire::MxtpTcp);
        if let Some(header) = Header::decode(&datagram.bytes).ok().filter(|_| is_mxtp) {
            let types = self.characters.entry(header.character).or_default();
            types.insert(header.message_type);
        }
    }

    /// What is missing or unknown, after listening for `elapsed`.
    pub(super) fn findings(&self, elapsed: Duration) -> Vec<Finding> {
        let mut findings = Vec::new();
        for (character, types) in &self.characters {
            let at = |check, what: String| Finding::new(check, what).at(format_args!("character {character}"));
            let has_pose = POSES.iter().any(|pose| types.contains(pose));
            if !has_pose {
                let what = format!(
                    "Only {} of it come, and none of these has a pose.",
                    listed(types.iter())
                );
                findings.push(at(Check::NoPose, what));
            }
            let lacks = DESCRIPTIONS.iter().filter(|description| !types.contains(description));
            let lacks: Vec<_> = lacks.collect();
            if has_pose && !lacks.is_empty() && elapsed >= DESCRIBED_AFTER {
                let what = format!("Of its description {} did not come.", listed(lacks.into_iter()));
                findings.push(at(Check::NoDescription, what));
            }
            let is_unknown = |of: &&MessageType| of.name() == "unknown";
            let unknown: Vec<_> = types.iter().filter(is_unknown).collect();
            if !unknown.is_empty() {
                let what = format!("The specification does not have its {}.", listed(unknown.into_iter()));
                findings.push(at(Check::UnknownType, what));
            }
        }
        findings
    }
}

/// `types 12 (meta data) and 13 (scale)`.
fn listed<'a>(types: impl Iterator<Item = &'a MessageType>) -> String {
    let all: Vec<_> = types.map(|of| format!("{of} ({})", of.name())).collect();
    match all.as_slice() {
        [only] => format!("type {only}"),
        [first @ .., last] => format!("types {} and {last}", first.join(", ")),
        [] => "nothing".to_owned(),
    }
}

const POSES: [MessageType; 5] = [
    MessageType::EULER,
    MessageType::QUATERNION,
    MessageType::POINTS,
    MessageType::UNITY,
    MessageType::LINEAR,
];
const DESCRIPTIONS: [MessageType; 2] = [MessageType::META, MessageType::SCALE];
/// They come about once a second.
const DESCRIBED_AFTER: Duration = Duration::from_secs(2);

#[cfg(test)]
mod tests {
    use super::super::test::{datagram, mxtp};
    use super::*;

    fn found(types: &[u8]) -> Vec<(Check, String)> {
        let mut contents = Contents::default();
        for number in types {
            contents.datagram(&datagram("10.0.0.1:5000", &mxtp(3, *number)));
        }
        let findings = contents.findings(Duration::from_secs(5)).into_iter();
        findings.map(|finding| (finding.check, finding.what)).collect()
    }

    #[test]
    fn a_stream_without_a_pose_is_named_by_what_it_has() {
        let found = found(&[20, 25, 12, 13]);
        assert_eq!(found[0].0, Check::NoPose);
        assert!(found[0].1.contains("20 (joint angles)") && found[0].1.contains("25 (time code)"));
        assert_eq!(found.len(), 1);
    }

    #[test]
    fn what_describes_a_character_is_missed() {
        let found = found(&[2]);
        assert_eq!(
            found,
            [(
                Check::NoDescription,
                "Of its description types 12 (meta data) and 13 (scale) did not come.".to_owned()
            )]
        );
    }

    #[test]
    fn types_that_nobody_knows_are_noted() {
        let found = found(&[2, 12, 13, 77]);
        assert_eq!(found[0].0, Check::UnknownType);
    }

    #[test]
    fn a_stream_that_has_all_is_fine() {
        assert_eq!(found(&[1, 12, 13]), []);
        assert_eq!(found(&[21, 22, 12, 13, 20, 25]), []);
    }
}

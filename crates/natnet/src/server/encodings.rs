//! One packet for all clients whose versions have the same layout.

use std::sync::Arc;

use crate::{Error, Version};

/// A packet, or why it cannot be one.
pub(super) type Encoded = Result<Arc<[u8]>, Error>;

/// Packets of the same content by layout; there are no more of them than layouts.
#[derive(Debug, Default)]
pub(super) struct Encodings {
    packets: Vec<(Version, Encoded)>,
}

impl Encodings {
    pub(super) const fn new() -> Self {
        Self { packets: Vec::new() }
    }

    pub(super) fn clear(&mut self) {
        self.packets.clear();
    }

    /// The packet for `version`, encoded when it is the first of its layout.
    pub(super) fn of(&mut self, version: Version, encode: impl FnOnce(Version) -> Encoded) -> Encoded {
        let layout = layout(version);
        if let Some((_, packet)) = self.packets.iter().find(|(known, _)| *known == layout) {
            return packet.clone();
        }
        let packet = encode(layout);
        self.packets.push((layout, packet.clone()));
        packet
    }
}

/// The first version that is laid out as `version`.
fn layout(version: Version) -> Version {
    let [oldest, ..] = Version::LAYOUTS;
    let not_later = |first: &Version| *first <= version;
    Version::LAYOUTS.into_iter().rev().find(not_later).unwrap_or(oldest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_one_layout_share_a_packet() {
        let mut encodings = Encodings::default();
        let mut encoded = Vec::new();
        for (major, minor) in [(3, 1), (3, 0), (4, 4), (4, 3), (2, 8), (9, 9), (0, 0)] {
            let packet = encodings.of(Version::new(major, minor), |layout| {
                encoded.push(layout.to_string());
                Ok(Arc::from([layout.major]))
            });
            assert!(packet.is_ok());
        }
        assert_eq!(encoded, ["3.0", "4.2", "2.7", "4.5", "1.4"]);
    }
}

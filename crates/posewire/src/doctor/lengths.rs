//! In which unit a body is measured.

use super::Check;
use super::finding::Finding;
use super::landmarks::{Placed, finite};
use posewire_motion::{DVec3, Frame};

/// How large a body is, or how far away a thing is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lengths {
    count: f64,
    /// From the feet to the head, added up.
    body: f64,
    /// The farthest that the first segment was from the origin.
    farthest: f64,
}

impl Lengths {
    pub(super) fn sample(&mut self, frame: &Frame, placed: Option<&Placed>) {
        if let Some(placed) = placed {
            self.body += placed.upward.length();
            self.count += 1.0;
        }
        let away = finite(&frame.position, 0).map_or(0.0, DVec3::length);
        self.farthest = self.farthest.max(away);
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        if self.count == 0.0 {
            return self.finding_of_a_thing();
        }
        let length = self.body / self.count;
        let unit = match length {
            0.4..=3.5 => return None,
            25.0..400.0 => "It seems to be in centimetres.",
            400.0..4000.0 => "It seems to be in millimetres.",
            0.003..0.04 => "It seems to be in metres where centimetres are expected.",
            _ => "No usual unit explains it.",
        };
        let what = format!("The head is {} m from the feet. {unit}", short(length));
        Some(Finding::new(Check::WrongUnit, what))
    }

    /// Of a thing only its distance can be strange.
    fn finding_of_a_thing(&self) -> Option<Finding> {
        let what = format!(
            "It is {} m from the origin, farther than any capture volume reaches: is that another unit?",
            short(self.farthest)
        );
        (self.farthest > FAR).then(|| Finding::new(Check::WrongUnit, what))
    }
}

/// With as many digits as are worth reading.
fn short(metres: f64) -> String {
    if metres < 0.1 {
        format!("{metres:.3}")
    } else {
        format!("{metres:.1}")
    }
}

/// Nothing is captured at such a distance, metres.
const FAR: f64 = 80.0;

#[cfg(test)]
mod tests {
    use super::super::landmarks::Landmarks;
    use super::super::test::upright;
    use super::*;
    use posewire_motion::{Skeleton, Subject};
    use std::sync::Arc;

    fn found(factor: f64) -> Option<String> {
        let mut frame = upright();
        for position in frame.position.iter_mut().flatten() {
            *position *= factor;
        }
        let mut lengths = Lengths::default();
        let placed = Landmarks::of(&frame.subject).unwrap().placed(&frame);
        lengths.sample(&frame, placed.as_ref());
        lengths.finding().map(|finding| finding.what)
    }

    #[test]
    fn a_body_of_143_metres_is_in_centimetres() {
        assert_eq!(found(1.0), None);
        assert!(found(100.0).unwrap().contains("143.0 m") && found(100.0).unwrap().contains("in centimetres"));
        assert!(found(1000.0).unwrap().contains("millimetres"));
        assert!(found(0.01).unwrap().contains("in metres where centimetres"));
        assert!(found(1e6).unwrap().contains("No usual unit"));
    }

    #[test]
    fn a_thing_at_105_metres_is_in_another_unit() {
        let mut frame = Frame::new(Arc::new(Subject::new("Box", Skeleton::default())));
        let mut lengths = Lengths::default();
        frame.position = vec![Some(DVec3::new(3.0, 1.0, 0.5))];
        lengths.sample(&frame, None);
        assert_eq!(lengths.finding(), None);
        frame.position = vec![Some(DVec3::new(3.0, 1.0, 105.0))];
        lengths.sample(&frame, None);
        assert_eq!(lengths.finding().unwrap().check, Check::WrongUnit);
    }
}

//! The 20 segments of a hand: MV0305 3.1 table 2.

/// One of the 20 segments of a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerSegment {
    /// Its name without the side: `FirstMetacarpal`.
    pub name: &'static str,
    /// Its parent's place in the hand; `None` for the carpus, which hangs on the body's hand.
    pub parent: Option<usize>,
    /// Its origin in the null pose, from the wrist: metres forward (to the thumb) and outward (to the fingertips).
    pub offset: [f64; 2],
}

const fn segment(name: &'static str, parent: usize, forward: f64, outward: f64) -> FingerSegment {
    FingerSegment {
        name,
        parent: Some(parent),
        offset: [forward, outward],
    }
}

/// A hand's segments in their order on the wire; the first finger is the thumb.
pub const FINGER_SEGMENTS: [FingerSegment; 20] = [
    FingerSegment {
        name: "Carpus",
        parent: None,
        offset: [0.0, 0.0],
    },
    segment("FirstMetacarpal", 0, 0.025, 0.02),
    segment("FirstProximalPhalange", 1, 0.045, 0.055),
    segment("FirstDistalPhalange", 2, 0.055, 0.085),
    segment("SecondMetacarpal", 0, 0.02, 0.025),
    segment("SecondProximalPhalange", 4, 0.025, 0.09),
    segment("SecondMiddlePhalange", 5, 0.025, 0.13),
    segment("SecondDistalPhalange", 6, 0.025, 0.155),
    segment("ThirdMetacarpal", 0, 0.005, 0.025),
    segment("ThirdProximalPhalange", 8, 0.005, 0.09),
    segment("ThirdMiddlePhalange", 9, 0.005, 0.135),
    segment("ThirdDistalPhalange", 10, 0.005, 0.163),
    segment("FourthMetacarpal", 0, -0.01, 0.025),
    segment("FourthProximalPhalange", 12, -0.014, 0.085),
    segment("FourthMiddlePhalange", 13, -0.014, 0.125),
    segment("FourthDistalPhalange", 14, -0.014, 0.15),
    segment("FifthMetacarpal", 0, -0.022, 0.022),
    segment("FifthProximalPhalange", 16, -0.032, 0.078),
    segment("FifthMiddlePhalange", 17, -0.032, 0.11),
    segment("FifthDistalPhalange", 18, -0.032, 0.128),
];

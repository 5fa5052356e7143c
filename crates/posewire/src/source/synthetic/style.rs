//! What makes one walker walk differently from another.

use super::path::Circle;
use posewire_motion::DVec3;
use std::f64::consts::TAU;

/// Strides once round the circle, so that a lap ends as it began.
pub(super) const STRIDES_PER_LAP: u32 = 8;

/// How one person is built and walks. Lengths are in metres, times in seconds, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Style {
    /// How tall the person is beside the nominal adult, and how broad besides.
    pub(super) height: f64,
    pub(super) breadth: f64,
    /// How long a stride (two steps) is and takes.
    pub(super) stride: f64,
    pub(super) stride_time: f64,
    /// How far in the stride the right foot is at time 0, in strides.
    pub(super) start: f64,
    /// Between the feet.
    pub(super) step_width: f64,
    pub(super) toe_out: f64,
    /// Shares of the usual swing of arms and pelvis, and bend of elbows.
    pub(super) arm_swing: f64,
    pub(super) pelvis_swing: f64,
    pub(super) elbow_bend: f64,
    /// How far the chest leans forward.
    pub(super) lean: f64,
    pub(super) path: Circle,
}

impl Style {
    /// The style of a person: the same seed and number make the same one. Person 0 of seed 0 walks about the origin.
    pub(super) fn new(seed: u64, person: usize) -> Self {
        let mut chance = Chance::new(seed, person);
        let height = chance.between(0.92, 1.08);
        let stride = 1.26 * height * chance.between(0.96, 1.0);
        let radius = f64::from(STRIDES_PER_LAP) * stride / TAU;
        Self {
            height,
            breadth: chance.between(0.97, 1.03),
            stride,
            // A longer leg swings more slowly, as a pendulum does.
            stride_time: 1.1 * height.sqrt() * chance.between(0.95, 1.05),
            start: chance.between(0.0, 1.0),
            step_width: 0.1 * height * chance.between(0.85, 1.15),
            toe_out: chance.between(0.06, 0.14),
            arm_swing: chance.between(0.8, 1.25),
            pelvis_swing: chance.between(0.8, 1.2),
            elbow_bend: chance.between(0.8, 1.3),
            lean: chance.between(0.03, 0.07),
            path: Circle {
                center: middle(person),
                radius,
                direction: if person.is_multiple_of(2) { 1.0 } else { -1.0 },
                heading: chance.between(0.0, TAU),
            },
        }
    }
}

/// The middle of a person's circle: the places of a square grid, outward from the origin, so that nobody meets.
fn middle(person: usize) -> DVec3 {
    let (mut column, mut row, mut ahead) = (0_i32, 0_i32, (1_i32, 0_i32));
    for _ in 0..person {
        let corner = column == row || (column < 0 && column == -row) || (column > 0 && column == 1 - row);
        if corner {
            ahead = (-ahead.1, ahead.0);
        }
        (column, row) = (column + ahead.0, row + ahead.1);
    }
    DVec3::new(f64::from(column), f64::from(row), 0.0) * APART
}

/// A row of numbers that look random and are always the same (`SplitMix64`).
struct Chance(u64);

impl Chance {
    fn new(seed: u64, person: usize) -> Self {
        let mut chance = Self(seed ^ (person as u64).wrapping_mul(GOLDEN));
        chance.next();
        chance
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * share
    }
}

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
/// Between the middles of two circles: more than two of the largest radii and two arms' lengths.
const APART: f64 = 4.4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_shares_a_circle() {
        let styles: Vec<_> = (0..64).map(|person| Style::new(7, person)).collect();
        for (place, one) in styles.iter().enumerate() {
            for other in &styles[..place] {
                let apart = one.path.center.distance(other.path.center);
                assert!(apart > one.path.radius + other.path.radius + 0.8);
            }
        }
    }

    #[test]
    fn the_same_seed_makes_the_same_people_and_another_makes_others() {
        assert_eq!(Style::new(3, 5), Style::new(3, 5));
        assert_ne!(Style::new(3, 5), Style::new(4, 5));
        assert_ne!(Style::new(3, 5), Style::new(3, 6));
    }
}

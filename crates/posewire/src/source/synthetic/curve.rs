//! Smooth curves through given points.

/// Value, slope and curvature of a curve at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot {
    pub(super) at: f64,
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) curvature: f64,
}

impl Knot {
    pub(super) const fn new(at: f64, value: f64, slope: f64, curvature: f64) -> Self {
        Self {
            at,
            value,
            slope,
            curvature,
        }
    }

    /// What `function` is at `at`, its derivatives taken from values close by.
    pub(super) fn of(at: f64, function: impl Fn(f64) -> f64) -> Self {
        let [before, value, after] = [function(at - NEAR), function(at), function(at + NEAR)];
        Self {
            at,
            value,
            slope: (after - before) / (2.0 * NEAR),
            curvature: (after - 2.0 * value + before) / (NEAR * NEAR),
        }
    }

    /// The same curve moved along and up.
    pub(super) fn moved(self, along: f64, up: f64) -> Self {
        Self {
            at: self.at + along,
            value: self.value + up,
            ..self
        }
    }
}

/// The polynomial of degree five that leaves `from` and reaches `to` with their slopes and curvatures.
pub(super) fn between(from: Knot, to: Knot, at: f64) -> f64 {
    let span = to.at - from.at;
    let u = (at - from.at) / span;
    let (slope, curvature) = (from.slope * span, from.curvature * span * span);
    // What is left to gain at the end after leaving with that slope and curvature.
    let rise = to.value - from.value - slope - 0.5 * curvature;
    let turn = to.slope * span - slope - curvature;
    let bend = to.curvature * span * span - curvature;
    let cubic = 10.0 * rise - 4.0 * turn + 0.5 * bend;
    let quartic = -15.0 * rise + 7.0 * turn - bend;
    let quintic = 6.0 * rise - 3.0 * turn + 0.5 * bend;
    from.value + u * (slope + u * (0.5 * curvature + u * (cubic + u * (quartic + u * quintic))))
}

/// A curve of period one through knots in rising order, the first at 0; its first two derivatives are continuous.
pub(super) fn periodic(knots: &[Knot], at: f64) -> f64 {
    let at = at.rem_euclid(1.0);
    let next = knots.partition_point(|knot| knot.at <= at);
    let from = knots[next.saturating_sub(1)];
    let to = knots.get(next).copied().unwrap_or(knots[0].moved(1.0, 0.0));
    between(from, to, at)
}

/// From 0 to 1 as `u` goes from 0 to 1, at rest at both ends.
pub(super) fn ease(u: f64) -> f64 {
    between(Knot::new(0.0, 0.0, 0.0, 0.0), Knot::new(1.0, 1.0, 0.0, 0.0), u)
}

/// A hill over 0 to 1 with its top, 1, in the middle, flat at both ends.
pub(super) fn hill(u: f64) -> f64 {
    (4.0 * u * (1.0 - u)).powi(3)
}

const NEAR: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_same(found: Knot, expected: Knot) {
        assert!((found.value - expected.value).abs() < 1e-9, "{found:?} {expected:?}");
        assert!((found.slope - expected.slope).abs() < 1e-4, "{found:?} {expected:?}");
        assert!(
            (found.curvature - expected.curvature).abs() < 0.1,
            "{found:?} {expected:?}"
        );
    }

    #[test]
    fn a_piece_has_the_values_slopes_and_curvatures_of_its_ends() {
        let (from, to) = (Knot::new(0.2, 1.0, -2.0, 3.0), Knot::new(0.7, -1.0, 0.5, -4.0));
        let curve = |at: f64| between(from, to, at);
        assert_same(Knot::of(0.2, curve), from);
        assert_same(Knot::of(0.7, curve), to);
    }

    #[test]
    fn a_periodic_curve_goes_through_its_knots_and_round() {
        let knots = [Knot::new(0.0, 1.0, 2.0, 0.0), Knot::new(0.4, 0.0, 0.0, 5.0)];
        for knot in knots {
            for turns in [-3.0, 0.0, 2.0] {
                let found = Knot::of(knot.at + turns, |at| periodic(&knots, at));
                assert_same(found.moved(-turns, 0.0), knot);
            }
        }
    }

    #[test]
    fn ease_and_hill_are_flat_at_their_ends() {
        for (at, eased) in [(0.0, 0.0), (1.0, 1.0)] {
            assert_same(Knot::of(at, ease), Knot::new(at, eased, 0.0, 0.0));
            assert!(Knot::of(at, hill).slope.abs() < 1e-6);
        }
        assert!((hill(0.5) - 1.0).abs() < 1e-12);
    }
}

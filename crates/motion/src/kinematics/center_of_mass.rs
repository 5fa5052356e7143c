//! An estimate of the body's centre of mass.

use crate::{Skeleton, standard};
use glam::{DQuat, DVec3};

/// An estimate of where the body's centre of mass is, m.
///
/// Shares of the body's mass and centres of the parts are those of P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's
/// segment inertia parameters", Journal of Biomechanics 29 (1996), table 4, the mean of women and men. That paper divides
/// the body into 16 parts, this skeleton into 23 segments: the lower trunk is taken as pelvis and L5, the middle one as L3
/// and T12, the upper one as T8 with the shoulders, the head with the neck, the foot with the toe. It is an estimate: nobody's
/// mass is spread as the mean is, and in two takes MVN's own centre of mass is 23 to 25 mm lower.
///
/// Segments are found by their names; props and fingers weigh nothing. `None` when one of the segments is missing or
/// not tracked.
pub fn center_of_mass(skeleton: &Skeleton, position: &[Option<DVec3>], orientation: &[Option<DQuat>]) -> Option<DVec3> {
    let body = Body {
        skeleton,
        position,
        orientation,
    };
    let weighted = |part: &Part| body.center(part).map(|center| center * part.mass);
    let sum = PARTS
        .iter()
        .try_fold(DVec3::ZERO, |sum, part| Some(sum + weighted(part)?))?;
    Some(sum / PARTS.iter().map(|part| part.mass).sum::<f64>())
}

/// A part of the body that is weighed as one.
struct Part {
    /// Its share of the body's mass, per cent.
    mass: f64,
    /// The place of the body segment at whose origin it begins.
    from: usize,
    center: Center,
}

/// Where a part's centre of mass is.
enum Center {
    /// This share of the way to the origin of the body segment at that place.
    Toward(usize, f64),
    /// At this offset in the axes of the segment where it begins, for a nominal adult, m.
    Offset([f64; 3]),
}

struct Body<'a> {
    skeleton: &'a Skeleton,
    position: &'a [Option<DVec3>],
    orientation: &'a [Option<DQuat>],
}

impl Body<'_> {
    fn center(&self, part: &Part) -> Option<DVec3> {
        let from = self.place(part.from)?;
        let origin = self.position.get(from).copied().flatten()?;
        match part.center {
            Center::Toward(to, share) => {
                let end = self.position.get(self.place(to)?).copied().flatten()?;
                Some(origin.lerp(end, share))
            }
            Center::Offset(offset) => {
                let turn = self.orientation.get(from).copied().flatten()?;
                Some(origin + turn * DVec3::from_array(offset))
            }
        }
    }

    /// Where this skeleton keeps the body segment at a place of the standard one: mostly at the same place.
    fn place(&self, standard: usize) -> Option<usize> {
        let name = standard::BODY_SEGMENTS[standard].name;
        let here = self.skeleton.segments.get(standard);
        if here.is_some_and(|segment| segment.name == name) {
            return Some(standard);
        }
        self.skeleton.segment(name)
    }
}

const fn toward(mass: f64, from: usize, to: usize, share: f64) -> Part {
    Part {
        mass,
        from,
        center: Center::Toward(to, share),
    }
}

const fn offset(mass: f64, from: usize, offset: [f64; 3]) -> Part {
    Part {
        mass,
        from,
        center: Center::Offset(offset),
    }
}

const PARTS: [Part; 16] = [
    toward(11.82, 0, 2, 0.448),
    toward(15.49, 2, 4, 0.549),
    toward(15.705, 4, 5, 0.494),
    offset(6.81, 6, [0.01, 0.0, 0.1]),
    toward(2.63, 8, 9, 0.576),
    toward(1.5, 9, 10, 0.457),
    offset(0.585, 10, [0.0, -0.066, 0.0]),
    toward(2.63, 12, 13, 0.576),
    toward(1.5, 13, 14, 0.457),
    offset(0.585, 14, [0.0, 0.066, 0.0]),
    toward(14.47, 15, 16, 0.385),
    toward(4.57, 16, 17, 0.437),
    offset(1.33, 17, [0.06, 0.0, -0.055]),
    toward(14.47, 19, 20, 0.385),
    toward(4.57, 20, 21, 0.437),
    offset(1.33, 21, [0.06, 0.0, -0.055]),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn t_pose(skeleton: &Skeleton) -> Vec<Option<DVec3>> {
        skeleton.segments.iter().map(|segment| segment.origin).collect()
    }

    fn upright(skeleton: &Skeleton) -> Vec<Option<DQuat>> {
        vec![Some(DQuat::IDENTITY); skeleton.segments.len()]
    }

    #[test]
    fn the_shares_make_up_the_body() {
        let sum: f64 = PARTS.iter().map(|part| part.mass).sum();
        assert!((sum - 100.0).abs() < 0.01, "{sum}");
    }

    #[test]
    fn a_standing_body_has_it_in_the_middle_a_little_above_the_hips() {
        let skeleton = Skeleton::standard(0, false);
        let center = center_of_mass(&skeleton, &t_pose(&skeleton), &upright(&skeleton)).unwrap();
        assert!(center.y.abs() < 1e-12 && center.x.abs() < 0.03, "{center}");
        assert!((0.55..0.60).contains(&(center.z / 1.75)), "{center}");
    }

    #[test]
    fn it_turns_and_moves_with_the_body() {
        let skeleton = Skeleton::standard(0, false);
        let before = center_of_mass(&skeleton, &t_pose(&skeleton), &upright(&skeleton)).unwrap();
        let (turn, shift) = (DQuat::from_rotation_x(0.7), DVec3::new(3.0, -2.0, 1.0));
        let position: Vec<_> = t_pose(&skeleton)
            .iter()
            .map(|origin| origin.map(|origin| turn * origin + shift))
            .collect();
        let after = center_of_mass(&skeleton, &position, &vec![Some(turn); 23]).unwrap();
        assert!((after - (turn * before + shift)).length() < 1e-12);
    }

    #[test]
    fn props_and_fingers_weigh_nothing_and_order_does_not_matter() {
        let (bare, mut full) = (Skeleton::standard(0, false), Skeleton::standard(4, true));
        full.segments.reverse();
        let expected = center_of_mass(&bare, &t_pose(&bare), &upright(&bare));
        let found = center_of_mass(&full, &t_pose(&full), &upright(&full));
        assert_eq!(found, expected);
    }

    #[test]
    fn an_untracked_thigh_leaves_it_unknown() {
        let skeleton = Skeleton::standard(0, false);
        let mut position = t_pose(&skeleton);
        position[15] = None;
        assert_eq!(center_of_mass(&skeleton, &position, &upright(&skeleton)), None);
        assert_eq!(center_of_mass(&Skeleton::default(), &[], &[]), None);
    }
}

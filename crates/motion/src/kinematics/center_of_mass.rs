//! An estimate of the body's centre of mass.

use crate::{Skeleton, standard};
use glam::{DQuat, DVec3};

/// An estimate of where the body's centre of mass is, m.
///
/// Shares of the body's mass and centres of the parts are those of P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's
/// segment inertia parameters", Journal of Biomechanics 29 (1996), table 4, the mean of women and men. That paper divides
/// the body into 16 parts, this skeleton into 23 segments: the lower trunk is taken as pelvis and L5, the middle one as L3
/// and T12, the upper one as T8 with the shoulders, the head with the neck, the foot with the toe. It is an estimate: nobody's
/// mass is spread as the mean is, and in two takes MVN's own centre of mass is 20 mm lower.
///
/// Segments are found by their names; props and fingers weigh nothing. Head, hands and feet end at landmarks, of which
/// those of a nominal adult serve where the skeleton has none. `None` when one of the segments is missing or
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
    from: End,
    to: End,
    /// Where its centre of mass is on the way from one end to the other.
    share: f64,
}

/// An end of a part.
#[derive(Clone, Copy)]
enum End {
    /// The origin of the body segment at this place of the standard skeleton.
    Origin(usize),
    /// A landmark on that segment: its name, and its offset on a nominal adult, m, for skeletons that do not have it.
    Landmark(usize, &'static str, [f64; 3]),
}

struct Body<'a> {
    skeleton: &'a Skeleton,
    position: &'a [Option<DVec3>],
    orientation: &'a [Option<DQuat>],
}

impl Body<'_> {
    fn center(&self, part: &Part) -> Option<DVec3> {
        Some(self.end(part.from)?.lerp(self.end(part.to)?, part.share))
    }

    fn end(&self, end: End) -> Option<DVec3> {
        let (End::Origin(standard) | End::Landmark(standard, ..)) = end;
        let place = self.place(standard)?;
        let origin = self.position.get(place).copied().flatten()?;
        let End::Landmark(_, name, nominal) = end else {
            return Some(origin);
        };
        let points = &self.skeleton.segments.get(place)?.points;
        let point = points.iter().find(|point| point.name == name);
        let offset = point.map_or(DVec3::from_array(nominal), |point| point.offset);
        Some(origin + self.orientation.get(place).copied().flatten()? * offset)
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

const fn limb(mass: f64, from: usize, to: usize, share: f64) -> Part {
    part(mass, End::Origin(from), End::Origin(to), share)
}

const fn part(mass: f64, from: End, to: End, share: f64) -> Part {
    Part { mass, from, to, share }
}

const TOP_OF_HEAD: End = End::Landmark(6, "pTopOfHead", [0.01, 0.0, 0.23]);
const RIGHT_FINGERTIP: End = End::Landmark(10, "pRightTopOfHand", [0.0, -0.19, 0.0]);
const LEFT_FINGERTIP: End = End::Landmark(14, "pLeftTopOfHand", [0.0, 0.19, 0.0]);
const RIGHT_HEEL: End = End::Landmark(17, "pRightHeelFoot", [-0.05, 0.0, -0.08]);
const LEFT_HEEL: End = End::Landmark(21, "pLeftHeelFoot", [-0.05, 0.0, -0.08]);
const RIGHT_TOE: End = End::Landmark(18, "pRightToe", [0.07, 0.0, -0.01]);
const LEFT_TOE: End = End::Landmark(22, "pLeftToe", [0.07, 0.0, -0.01]);

const PARTS: [Part; 16] = [
    limb(11.82, 0, 2, 0.448),
    limb(15.49, 2, 4, 0.549),
    limb(15.705, 4, 5, 0.494),
    part(6.81, End::Origin(5), TOP_OF_HEAD, 0.508),
    limb(2.63, 8, 9, 0.576),
    limb(1.5, 9, 10, 0.457),
    part(0.585, End::Origin(10), RIGHT_FINGERTIP, 0.353),
    limb(2.63, 12, 13, 0.576),
    limb(1.5, 13, 14, 0.457),
    part(0.585, End::Origin(14), LEFT_FINGERTIP, 0.353),
    limb(14.47, 15, 16, 0.385),
    limb(4.57, 16, 17, 0.437),
    part(1.33, RIGHT_HEEL, RIGHT_TOE, 0.421),
    limb(14.47, 19, 20, 0.385),
    limb(4.57, 20, 21, 0.437),
    part(1.33, LEFT_HEEL, LEFT_TOE, 0.421),
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
    fn landmarks_are_those_of_a_nominal_adult() {
        for end in PARTS.iter().flat_map(|part| [part.from, part.to]) {
            if let End::Landmark(place, name, nominal) = end {
                let points = standard::body_points(place);
                let point = points.iter().find(|point| point.name == name).unwrap();
                assert_eq!(point.offset, DVec3::from_array(nominal), "{name}");
            }
        }
    }

    #[test]
    fn landmarks_of_the_skeleton_count() {
        let mut skeleton = Skeleton::standard(0, false);
        let center = |skeleton: &Skeleton| center_of_mass(skeleton, &t_pose(skeleton), &upright(skeleton)).unwrap();
        let nominal = center(&skeleton);
        let top = skeleton.segments[6]
            .points
            .iter_mut()
            .find(|point| point.name == "pTopOfHead");
        top.unwrap().offset.z += 0.1;
        let taller = center(&skeleton) - nominal;
        assert!((taller.z - 0.1 * 0.508 * 0.0681).abs() < 1e-6, "{taller}");
        for segment in &mut skeleton.segments {
            segment.points.clear();
        }
        assert_eq!(center(&skeleton), nominal);
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

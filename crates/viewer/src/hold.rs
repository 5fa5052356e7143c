//! What is shown of a sample of which a part was lost: that part of the newest sample that had it.
//!
//! A sample comes in several datagrams, of which a network loses single ones. What a performer sends does not change from
//! sample to sample, so that neither the pose nor what is said of it should come and go with them.

use posewire_motion::{CenterOfMass, Frame, Section, Take, Timecode};
use std::sync::Arc;

/// The newest of each part of a live subject.
#[derive(Debug, Default)]
pub(crate) struct Hold {
    pose: Held<Arc<Frame>>,
    timecode: Held<Timecode>,
    center: Held<CenterOfMass>,
    contacts: Held<Vec<bool>>,
}

impl Hold {
    /// Takes a frame that has arrived, and gives the one to show: the same, with what it lacks and those before had.
    pub(crate) fn take(&mut self, frame: &Arc<Frame>) -> Arc<Frame> {
        let before = self.pose.value.as_deref();
        let has_pose = has_pose(frame) && !before.is_some_and(|before| lacks_of(frame, before));
        let pose = self.pose.newest(has_pose.then(|| Arc::clone(frame)));
        let pose = pose.filter(|pose| !Arc::ptr_eq(pose, frame));
        let timecode = self.timecode.newest(frame.timecode);
        let center = self.center.newest(frame.center_of_mass);
        let contacts = (!frame.contacts.is_empty()).then(|| frame.contacts.clone());
        let contacts = self.contacts.newest(contacts).unwrap_or_default();
        let is_whole = pose.is_none()
            && (timecode, center) == (frame.timecode, frame.center_of_mass)
            && contacts.len() == frame.contacts.len();
        if is_whole {
            return Arc::clone(frame);
        }
        let mut shown = Frame::clone(frame);
        if let Some(pose) = pose {
            shown.position.clone_from(&pose.position);
            shown.orientation.clone_from(&pose.orientation);
        }
        (shown.timecode, shown.center_of_mass, shown.contacts) = (timecode, center, contacts);
        Arc::new(shown)
    }
}

/// The newest of something, for a few samples that lack it.
#[derive(Debug)]
struct Held<T> {
    value: Option<T>,
    lacking: usize,
}

impl<T> Default for Held<T> {
    fn default() -> Self {
        Self {
            value: None,
            lacking: 0,
        }
    }
}

impl<T: Clone> Held<T> {
    fn newest(&mut self, found: Option<T>) -> Option<T> {
        if found.is_some() {
            (self.value, self.lacking) = (found, 0);
        } else {
            self.lacking += 1;
            self.value.take_if(|_| self.lacking > MOST_HELD);
        }
        self.value.clone()
    }
}

fn has_pose(frame: &Frame) -> bool {
    !frame.position.is_empty() || !frame.orientation.is_empty()
}

/// Whether a frame lacks what another has of a pose.
fn lacks_of(frame: &Frame, other: &Frame) -> bool {
    (frame.position.is_empty() && !other.position.is_empty())
        || (frame.orientation.is_empty() && !other.orientation.is_empty())
}

/// Per frame of a take the place of the frame whose pose it shows: its own, that of the last one that had a pose, and before
/// the first pose that one. Of a take without poses every frame shows itself.
pub(crate) fn poses(take: &Take) -> Vec<usize> {
    let has_pose = |place: usize| POSE.iter().any(|section| take.has(place, *section));
    let lacks_of = |place: usize, held: usize| {
        POSE.iter()
            .any(|section| take.has(held, *section) && !take.has(place, *section))
    };
    let mut held = (0..take.len()).find(|place| has_pose(*place));
    let shown = (0..take.len()).map(|place| {
        let Some(last) = held else { return place };
        let is_held = !has_pose(place) || (place > last && place - last <= MOST_HELD && lacks_of(place, last));
        if !is_held {
            held = Some(place);
        }
        if is_held { last } else { place }
    });
    shown.collect()
}

/// The frames that show another's pose: where each stretch of them begins, and how many they are.
pub(crate) fn lost(poses: &[usize]) -> Vec<(usize, usize)> {
    let mut stretches: Vec<(usize, usize)> = Vec::new();
    let lost = poses.iter().enumerate().filter(|(place, pose)| place != *pose);
    for (place, _) in lost {
        match stretches.last_mut() {
            Some((first, count)) if *first + *count == place => *count += 1,
            _ => stretches.push((place, 1)),
        }
    }
    stretches
}

/// The frame at a place of a take with what it lacks: the pose of another, and what those shortly before say of it.
pub(crate) fn read_whole(take: &Take, place: usize, pose: usize, frame: &mut Frame) {
    take.read_frame(place, frame);
    if pose != place {
        let posed = take.frame(pose);
        (frame.position, frame.orientation) = (posed.position, posed.orientation);
    }
    let newest = || (place.saturating_sub(MOST_HELD)..=place).rev();
    frame.timecode = newest().find_map(|place| take.timecodes()[place]);
    if frame.center_of_mass.is_none() {
        frame.center_of_mass = newest().find_map(|place| center(take, place));
    }
    if frame.contacts.is_empty() {
        let told = newest()
            .map(|place| take.contacts(place))
            .find(|contacts| !contacts.is_empty());
        frame.contacts = told.unwrap_or_default().to_vec();
    }
}

fn center(take: &Take, place: usize) -> Option<CenterOfMass> {
    let position = take.column(Section::CenterOfMass)?.vector(place, 0)?;
    Some(CenterOfMass {
        position,
        velocity: None,
        acceleration: None,
    })
}

/// What a pose is.
const POSE: [Section; 2] = [Section::Position, Section::Orientation];
/// For how many samples what they lack is held: chance takes no more, and who stops to send it is seen to within half a
/// second.
const MOST_HELD: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use posewire_motion::{DQuat, DVec3, Skeleton, Subject};

    fn frame(sample: u32, has_pose: bool, timecode: Option<u64>) -> Frame {
        let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
        frame.sample = sample;
        frame.timecode = timecode.map(Timecode::from_milliseconds);
        if has_pose {
            frame.position = vec![Some(DVec3::X * f64::from(sample)); 23];
            frame.orientation = vec![Some(DQuat::IDENTITY); 23];
        } else {
            frame.joint_angles = vec![Some(DVec3::ZERO); 22];
        }
        frame
    }

    #[test]
    fn a_sample_without_a_pose_or_a_timecode_shows_the_newest_for_a_while() {
        let mut hold = Hold::default();
        hold.take(&Arc::new(frame(1, true, Some(1000))));
        for sample in 2..18 {
            let shown = hold.take(&Arc::new(frame(sample, false, None)));
            assert_eq!((shown.sample, shown.position[0]), (sample, Some(DVec3::X)));
            assert_eq!(shown.timecode, frame(0, false, Some(1000)).timecode);
        }
        let alone = Arc::new(frame(18, false, None));
        assert_eq!(hold.take(&alone), alone, "it has stopped to send them");
    }

    #[test]
    fn half_a_pose_is_not_mixed_with_another() {
        let mut hold = Hold::default();
        hold.take(&Arc::new(frame(1, true, None)));
        let mut half = frame(2, true, None);
        half.position.clear();
        assert_eq!(hold.take(&Arc::new(half)).position[0], Some(DVec3::X));
        let whole = Arc::new(frame(3, true, None));
        assert!(Arc::ptr_eq(&hold.take(&whole), &whole));
    }

    #[test]
    fn frames_of_a_take_show_the_last_pose() {
        let mut take = Take::new(Arc::clone(&frame(0, true, None).subject), 60.0);
        let has_pose = [false, true, true, false, false, true, false];
        for (sample, has_pose) in (0..).zip(has_pose) {
            let mut frame = frame(sample, has_pose, None);
            frame.subject = Arc::clone(&take.subject);
            take.push(&frame).unwrap();
        }
        let poses = poses(&take);
        assert_eq!(poses, [1, 1, 2, 2, 2, 5, 5]);
        assert_eq!(lost(&poses), [(0, 1), (3, 2), (6, 1)]);
    }
}

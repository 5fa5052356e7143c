//! Sensors and contacts that a skeleton lists and no sample tells of.

use super::Take;
use crate::{Column, Per, Section};
use std::sync::Arc;

impl Take {
    /// Takes those sensors out of the skeleton, and out of every section, of which no sample tracks anything; and the foot
    /// contacts when no sample tells of any.
    ///
    /// A live stream tells what it has only by sending it: its skeleton lists all 17 sensors, also where a subject wears 11.
    pub fn remove_unused(&mut self) {
        if self.contacts.width().is_none() && !self.subject.skeleton.contacts.is_empty() {
            Arc::make_mut(&mut self.subject).skeleton.contacts.clear();
        }
        let used = self.used_sensors();
        let fits = sensor_sections().all(|section| self.entries(section) == used.len());
        if !fits || used.iter().all(|used| *used) {
            return;
        }
        for section in sensor_sections() {
            let kept = self.column(section).and_then(|column| with_entries(column, &used));
            match kept {
                Some(_) => self.columns[section as usize] = kept,
                None => drop(self.remove_column(section)),
            }
        }
        let sensors = &mut Arc::make_mut(&mut self.subject).skeleton.sensors;
        let mut used = used.into_iter();
        sensors.retain(|_| used.next().unwrap_or(true));
    }

    /// Per sensor of the skeleton: whether any sample tracks anything of it.
    fn used_sensors(&self) -> Vec<bool> {
        let mut used = vec![false; self.subject.skeleton.sensors.len()];
        for column in sensor_sections().filter_map(|section| self.column(section)) {
            for row in column.rows() {
                let entries = row.chunks_exact(column.section().components());
                for (used, entry) in used.iter_mut().zip(entries) {
                    *used |= entry.iter().any(|number| !number.is_nan());
                }
            }
        }
        used
    }
}

fn sensor_sections() -> impl Iterator<Item = Section> {
    let sections = Section::ALL.iter().copied();
    sections.filter(|section| section.per() == Per::Sensor)
}

/// The column with those entries alone that are used; `None` when none is.
fn with_entries(column: &Column, used: &[bool]) -> Option<Column> {
    let count = used.iter().filter(|used| **used).count();
    let mut kept = Column::new(column.section(), count.max(1));
    let components = column.section().components();
    let entries = column.rows().flat_map(|row| row.chunks_exact(components).zip(used));
    for (entry, _) in entries.filter(|(_, used)| **used) {
        kept.values_mut().extend_from_slice(entry);
    }
    (count > 0).then_some(kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DQuat, DVec3, Frame, Skeleton, Subject};

    fn take(sensors: &[usize], contacts: usize) -> Take {
        let subject = Arc::new(Subject::new("Ada", Skeleton::standard(0, false)));
        let mut take = Take::new(Arc::clone(&subject), 60.0);
        for sample in 0..3_u32 {
            let mut frame = Frame::new(Arc::clone(&subject));
            frame.sample = sample;
            frame.sensor_orientation = vec![None; 17];
            frame.sensor_acceleration = vec![None; 17];
            for &sensor in sensors {
                frame.sensor_orientation[sensor] = Some(DQuat::IDENTITY);
                // One that comes late is there all the same.
                frame.sensor_acceleration[sensor] = (sample > 1).then_some(DVec3::X * sensor as f64);
            }
            frame.contacts = vec![true; contacts];
            take.push(&frame).unwrap();
        }
        take
    }

    #[test]
    fn sensors_that_were_never_tracked_are_not_listed() {
        let mut take = take(&[0, 3, 16], 4);
        let worn = [0, 3, 16].map(|sensor| take.subject.skeleton.sensors[sensor]);
        take.remove_unused();
        assert_eq!(take.subject.skeleton.sensors, worn);
        assert_eq!(take.subject.skeleton.contacts.len(), 4);
        assert_eq!(take.column(Section::SensorOrientation).unwrap().shape(), [3, 3, 4]);
        let last = take.frame(2);
        assert_eq!(last.check(), Ok(()));
        assert_eq!(last.sensor_acceleration[2], Some(DVec3::X * 16.0));
        assert_eq!(take.frame(0).sensor_acceleration, [None; 3]);
    }

    #[test]
    fn a_take_without_sensors_and_contacts_lists_none() {
        let mut take = take(&[], 0);
        take.remove_unused();
        let skeleton = &take.subject.skeleton;
        assert!(skeleton.sensors.is_empty() && skeleton.contacts.is_empty());
        assert_eq!(take.sections().count(), 0);
        assert!(take.frame(1).sensor_orientation.is_empty());
    }
}

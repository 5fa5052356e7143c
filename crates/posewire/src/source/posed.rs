//! A recording that holds poses alone, as that of the walker: its samples are played.

use super::playback::{Frames, PlaybackOptions};
use crate::capture::{self, files_of};
use crate::recording::{Posed, SubjectSurvey, Survey};
use crate::{Error, Result};
use posewire_motion::kinematics::complete;
use posewire_motion::{Frame, Stamp, Timecode};
use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The poses of the one source that is meant.
///
/// # Errors
/// [`Error::CapturedSources`] when none or several are meant.
pub(super) fn open_one(path: &Path, options: &PlaybackOptions) -> Result<Poses> {
    let held = Held::of(path)?;
    match held.meant(options.only.as_deref()).as_slice() {
        [source] => held.open(*source, options),
        _ => Err(held.not_one(path, options)),
    }
}

/// The poses of the one source that is named; of all of them if none is.
///
/// # Errors
/// [`Error::CapturedSources`] when a name means none or several of them.
pub(super) fn open_all(path: &Path, options: &PlaybackOptions) -> Result<Vec<Poses>> {
    let held = Held::of(path)?;
    let meant = held.meant(options.only.as_deref());
    if options.only.is_some() && meant.len() != 1 {
        return Err(held.not_one(path, options));
    }
    meant.into_iter().map(|source| held.open(source, options)).collect()
}

/// The names of the sources of which a recording has poses and no datagrams, by number; none of other captures.
///
/// # Errors
/// Those of reading it.
pub(super) fn unheard(path: &Path, survey: &capture::Survey) -> Result<Vec<String>> {
    if survey.format != capture::Format::Mcap {
        return Ok(Vec::new());
    }
    let mut sources = Held::of(path)?.sources;
    sources.retain(|number, _| survey.heard().all(|source| source.number != *number));
    Ok(sources
        .iter()
        .map(|(number, name)| format!("{number} {name}"))
        .collect())
}

/// What a recording holds, all of its files together.
struct Held {
    files: Vec<PathBuf>,
    /// The endpoints of the sources whose poses there are.
    sources: BTreeMap<u16, String>,
    subjects: Vec<SubjectSurvey>,
}

impl Held {
    fn of(path: &Path) -> Result<Self> {
        let mut held = Self {
            files: files_of(path)?,
            sources: BTreeMap::new(),
            subjects: Vec::new(),
        };
        for file in &held.files {
            let survey = Survey::of(file)?;
            for subject in survey.subjects.into_iter().filter(|subject| subject.frames > 0) {
                let source = survey.sources.get(usize::from(subject.source));
                let name = source.map_or_else(String::new, |source| source.endpoint.clone());
                held.sources.insert(subject.source, name);
                held.subjects.push(subject);
            }
        }
        Ok(held)
    }

    /// The sources of a number, or with a text in their names.
    fn meant(&self, wanted: Option<&str>) -> Vec<u16> {
        let number: Option<u16> = wanted.and_then(|wanted| wanted.parse().ok());
        let is_meant = |source: u16, name: &str| match (number, wanted) {
            (Some(number), _) => source == number,
            (None, Some(wanted)) => name.contains(wanted),
            (None, None) => true,
        };
        let meant = self.sources.iter().filter(|(source, name)| is_meant(**source, name));
        meant.map(|(source, _)| *source).collect()
    }

    fn open(&self, source: u16, options: &PlaybackOptions) -> Result<Poses> {
        let subjects = self.subjects.iter().filter(|subject| subject.source == source);
        Poses::open(&self.files, source, measured_rate(subjects), options)
    }

    fn not_one(&self, path: &Path, options: &PlaybackOptions) -> Error {
        let label = |(source, name): (&u16, &String)| format!("{source} {name}");
        Error::CapturedSources {
            path: path.to_owned(),
            wanted: options.only.clone(),
            found: self.sources.iter().map(label).collect(),
        }
    }
}

/// The poses of one source of a recording, the samples of one number together.
#[derive(Debug)]
pub(super) struct Poses {
    files: Vec<PathBuf>,
    source: u16,
    from: Duration,
    until: Option<Duration>,
    computes: bool,
    /// What the first sample was given.
    computed: Vec<&'static str>,
    rate_hz: f64,
    states_rate: bool,
    posed: Posed,
    /// When the first sample was received.
    began: Option<Stamp>,
    /// Samples that were read already.
    ahead: VecDeque<Frame>,
}

impl Poses {
    /// Those of a source, which came so many times a second, of a recording in these files.
    fn open(files: &[PathBuf], source: u16, measured_hz: f64, options: &PlaybackOptions) -> Result<Self> {
        let mut poses = Self {
            files: files.to_vec(),
            source,
            from: options.from,
            until: options.until,
            computes: options.computes,
            computed: Vec::new(),
            rate_hz: measured_hz,
            states_rate: false,
            posed: Posed::open(files, source)?,
            began: None,
            ahead: VecDeque::new(),
        };
        if let Some(frame) = poses.read()? {
            (poses.rate_hz, poses.states_rate) = match frame.subject.rate {
                Some(rate) => (rate, true),
                None => (poses.rate_hz, false),
            };
            poses.computed = computed(&frame);
            poses.ahead.push_back(frame);
        }
        Ok(poses)
    }

    /// The next sample in the time that is played.
    fn read(&mut self) -> Result<Option<Frame>> {
        while let Some(mut frame) = self.posed.next()? {
            let at = frame.received.unwrap_or_default();
            let offset = at.since(*self.began.get_or_insert(at));
            if self.until.is_some_and(|until| offset >= until) {
                return Ok(None);
            }
            if offset >= self.from {
                if self.computes {
                    complete(&mut frame);
                    frame.timecode = Some(Timecode::of_day(at));
                }
                return Ok(Some(frame));
            }
        }
        Ok(None)
    }

    fn next_ahead(&mut self) -> Result<Option<Frame>> {
        match self.ahead.pop_front() {
            Some(frame) => Ok(Some(frame)),
            None => self.read(),
        }
    }
}

impl Frames for Poses {
    fn name(&self) -> String {
        self.files
            .first()
            .map_or_else(String::new, |path| path.display().to_string())
    }

    fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    fn states_rate(&self) -> bool {
        self.states_rate
    }

    fn next_sample(&mut self, frames: &mut Vec<Frame>) -> Result<bool> {
        let before = frames.len();
        while let Some(frame) = self.next_ahead()? {
            let of_sample = &frames[before..];
            let is_next = of_sample
                .iter()
                .any(|known| known.sample != frame.sample || known.subject.id == frame.subject.id);
            if is_next {
                self.ahead.push_back(frame);
                break;
            }
            frames.push(frame);
        }
        Ok(frames.len() > before)
    }

    fn rewind(&mut self) -> Result<()> {
        self.posed = Posed::open(&self.files, self.source)?;
        self.ahead.clear();
        Ok(())
    }

    fn computed(&self) -> Vec<&'static str> {
        self.computed.clone()
    }

    fn damage(&self) -> Option<String> {
        self.posed.damage().map(str::to_owned)
    }
}

/// What a sample has besides its poses. Velocities, which take several samples, are not computed.
fn computed(frame: &Frame) -> Vec<&'static str> {
    let sections = [
        (!frame.joint_angles.is_empty(), "joint angles"),
        (!frame.ergonomic_angles.is_empty(), "ergonomic angles"),
        (frame.center_of_mass.is_some(), "centre of mass"),
        (frame.timecode.is_some(), "the time of day, at which they came"),
    ];
    let has = sections.into_iter().filter(|(has, _)| *has);
    has.map(|(_, what)| what).collect()
}

/// Samples a second of the subject that has most of them, by when they were received.
fn measured_rate<'a>(subjects: impl Iterator<Item = &'a SubjectSurvey>) -> f64 {
    let most = subjects.max_by_key(|subject| subject.frames);
    let rate = most.and_then(|subject| {
        let (first, last) = subject.span?;
        Some(subject.frames.saturating_sub(1) as f64 / last.since(first).as_secs_f64())
    });
    rate.filter(|rate| rate.is_finite() && *rate > 0.0)
        .unwrap_or(USUAL_RATE)
}

/// Of a recording of one sample: what MVN records with Awinda.
const USUAL_RATE: f64 = 60.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SourceId;
    use crate::recording::{Writer, WriterOptions};
    use crate::source::synthetic::{Walk, WalkOptions};
    use std::fs;

    fn walk() -> Walk {
        Walk::new(&WalkOptions {
            people: 2,
            ..WalkOptions::default()
        })
    }

    /// Two people who walk for so many samples, in a source each of its own.
    fn recorded(folder: &Path, samples: u32, options: WriterOptions) -> PathBuf {
        let (path, walk) = (folder.join("walk.mcap"), walk());
        let sources = ["synthetic:walk", "synthetic:run"].map(str::to_owned);
        let mut writer = Writer::create(&path, &sources, options).unwrap();
        for sample in 0..samples {
            for person in 0..2 {
                let mut frame = walk.frame(person, sample);
                frame.received = Some(Stamp(1_700_000_000_000_000_000 + i64::from(sample) * 10_000_000));
                writer.frame(SourceId(person as u16), &frame).unwrap();
            }
            if sample % 4 == 3 {
                writer.flush().unwrap();
            }
        }
        writer.finish().unwrap();
        path
    }

    fn only(source: &str) -> PlaybackOptions {
        PlaybackOptions {
            only: Some(source.to_owned()),
            ..PlaybackOptions::default()
        }
    }

    fn all_of(poses: &mut Poses) -> Vec<Frame> {
        let mut frames = Vec::new();
        while poses.next_sample(&mut frames).unwrap() {}
        frames
    }

    fn assert_walks(frames: &[Frame], person: usize, samples: impl Iterator<Item = u32>) {
        let walk = walk();
        assert!(frames.iter().map(|frame| frame.sample).eq(samples));
        for frame in frames {
            let expected = walk.frame(person, frame.sample);
            assert_eq!(frame.position, expected.position);
            assert_eq!(frame.orientation, expected.orientation);
            assert_eq!(
                (frame.time, &frame.subject.name),
                (expected.time, &expected.subject.name)
            );
            assert_eq!(frame.subject.skeleton.joints, expected.subject.skeleton.joints);
        }
    }

    #[test]
    fn poses_are_played_as_they_were_recorded() {
        let folder = tempfile::tempdir().unwrap();
        let path = recorded(folder.path(), 10, WriterOptions::default());
        let mut sources = open_all(&path, &PlaybackOptions::default()).unwrap();
        assert_eq!(sources.len(), 2);
        for (person, poses) in sources.iter_mut().enumerate() {
            assert_eq!((poses.rate_hz(), poses.states_rate()), (240.0, true));
            for _ in 0..2 {
                assert_walks(&all_of(poses), person, 0..10);
                poses.rewind().unwrap();
            }
            assert_eq!(poses.damage(), None);
        }
    }

    #[test]
    fn samples_of_one_number_come_together() {
        let folder = tempfile::tempdir().unwrap();
        let (path, walk) = (folder.path().join("walk.mcap"), walk());
        let mut writer = Writer::create(&path, &["walk".to_owned()], WriterOptions::default()).unwrap();
        for sample in 0..3 {
            (0..2).for_each(|person| writer.frame(SourceId(0), &walk.frame(person, sample)).unwrap());
        }
        writer.finish().unwrap();
        let mut poses = open_one(&path, &PlaybackOptions::default()).unwrap();
        for sample in 0..3 {
            let mut frames = Vec::new();
            assert!(poses.next_sample(&mut frames).unwrap());
            let found = frames.iter().map(|frame| (frame.subject.id, frame.sample));
            assert!(found.eq([(0, sample), (1, sample)]));
        }
    }

    #[test]
    fn angles_are_computed_where_they_are_wanted() {
        let folder = tempfile::tempdir().unwrap();
        let path = recorded(folder.path(), 2, WriterOptions::default());
        let plain = PlaybackOptions {
            computes: false,
            ..only("0")
        };
        let (mut completed, mut plain) = (open_one(&path, &only("0")).unwrap(), open_one(&path, &plain).unwrap());
        assert_eq!(
            completed.computed(),
            [
                "joint angles",
                "ergonomic angles",
                "centre of mass",
                "the time of day, at which they came"
            ]
        );
        assert_eq!(plain.computed(), [""; 0]);
        assert!(
            all_of(&mut completed)
                .iter()
                .all(|frame| frame.joint_angles.len() == 22)
        );
        assert!(all_of(&mut plain).iter().all(|frame| frame.joint_angles.is_empty()));
    }

    #[test]
    fn one_source_is_chosen_by_number_or_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = recorded(folder.path(), 2, WriterOptions::default());
        for name in ["1", "run"] {
            assert_walks(&all_of(&mut open_one(&path, &only(name)).unwrap()), 1, 0..2);
            assert_eq!(open_all(&path, &only(name)).unwrap().len(), 1);
        }
        let refused = [
            open_one(&path, &PlaybackOptions::default()).unwrap_err(),
            open_all(&path, &only("synthetic")).unwrap_err(),
            open_all(&path, &only("7")).unwrap_err(),
        ];
        for error in refused {
            let Error::CapturedSources { found, .. } = error else {
                panic!("{error}")
            };
            assert_eq!(found, ["0 synthetic:walk", "1 synthetic:run"]);
        }
    }

    #[test]
    fn a_part_is_played_by_when_it_came() {
        let folder = tempfile::tempdir().unwrap();
        let path = recorded(folder.path(), 10, WriterOptions::default());
        let options = PlaybackOptions {
            from: Duration::from_millis(20),
            until: Some(Duration::from_millis(50)),
            ..only("0")
        };
        assert_walks(&all_of(&mut open_one(&path, &options).unwrap()), 0, 2..5);
    }

    #[test]
    fn files_of_a_split_recording_are_read_as_one() {
        let folder = tempfile::tempdir().unwrap();
        let options = WriterOptions {
            split: Some(1),
            ..WriterOptions::default()
        };
        let path = recorded(folder.path(), 12, options);
        let mut poses = open_one(&path, &only("1")).unwrap();
        assert!(poses.files.len() > 1);
        assert_walks(&all_of(&mut poses), 1, 0..12);
        assert_eq!(poses.damage(), None);
    }

    #[test]
    fn poses_end_at_the_damage() {
        let folder = tempfile::tempdir().unwrap();
        let path = recorded(folder.path(), 40, WriterOptions::default());
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        let mut poses = open_one(&path, &only("0")).unwrap();
        let frames = all_of(&mut poses);
        assert!((4..36).contains(&frames.len()), "{}", frames.len());
        assert_walks(&frames, 0, 0..frames.len() as u32);
        assert_eq!(poses.damage().as_deref(), Some("the recording was cut off"));
    }
}

//! A program as a suit or a camera system.

use crate::error::{exception, raised, usage};
use crate::process::Opened;
use crate::section::named;
use crate::skeleton::Skeleton;
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2};
use posewire::endpoint::Endpoint;
use posewire::sink::{MxtpSink, MxtpSinkOptions, NatNetSink, NatNetSinkOptions};
use posewire::stop::Stop;
use posewire::{Feed, Item, Session, Sink};
use posewire_motion::{CenterOfMass, DQuat, DVec3, Frame, Section, Subject};
use posewire_mxtp::motion::MessageTypes;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Opens targets that samples of the program's own are sent to: "mxtp://HOST:PORT", "mxtp+tcp://HOST:PORT", and
/// "natnet://0.0.0.0", which is a server.
///
/// `names` are the subjects, all of one `skeleton`; MVN's own if it is left out. `rate` is in samples a second and makes the
/// clock of samples that come without a time. `types` are the MXTP datagram types, as "02,12,13,20" or "all".
///
/// Raises NetworkError and UsageError as the command line does.
#[pyfunction]
#[pyo3(signature = (*urls, skeleton = None, rate = 240.0, names = None, types = None))]
pub(crate) fn streamer(
    py: Python<'_>,
    urls: &Bound<'_, PyTuple>,
    skeleton: Option<PyRef<'_, Skeleton>>,
    rate: f64,
    names: Option<Vec<String>>,
    types: Option<&str>,
) -> PyResult<Streamer> {
    if !(rate.is_finite() && rate > 0.0) {
        return Err(usage(
            format!("expected samples a second as the rate, found {rate}"),
            "use a number above 0",
        ));
    }
    let skeleton = skeleton.map_or_else(
        || posewire_motion::Skeleton::standard(0, false),
        |skeleton| skeleton.subject.skeleton.clone(),
    );
    let names = names.unwrap_or_else(|| vec!["posewire".to_owned()]);
    let subjects: Vec<_> = (0..)
        .zip(&names)
        .map(|(id, name)| subject(id, name, &skeleton, rate))
        .collect();
    let urls = urls.extract::<Vec<String>>()?;
    let mut options = MxtpSinkOptions::default();
    if let Some(types) = types {
        options.types = message_types(types)?;
    }
    let opened = py.detach(|| open(&urls, &subjects, options, rate));
    let (sinks, urls) = opened.map_err(|error| raised(&error))?;
    if sinks.is_empty() {
        return Err(usage(
            "expected where to send to, found nothing",
            "as in posewire.streamer(\"mxtp://127.0.0.1:9763\")",
        ));
    }
    let (session, mut feed) = Session::fed(sinks, Stop::new());
    feed.push(subjects.iter().cloned().map(Item::Subject));
    Ok(Streamer {
        urls,
        rate,
        next: Mutex::new(vec![0; subjects.len()]),
        subjects,
        running: Opened::new("the streamer", Mutex::new(Some(Running { session, feed }))),
    })
}

fn message_types(text: &str) -> PyResult<MessageTypes> {
    let types = text.parse().unwrap_or(MessageTypes::NONE);
    if types.is_empty() || types.iter().any(|one| !MessageTypes::ALL.contains(one)) {
        let message = format!("expected datagram types with two digits and commas, found {text:?}");
        return Err(usage(message, format!("use all, or some of {}", MessageTypes::ALL)));
    }
    Ok(types)
}

fn subject(id: u32, name: &str, skeleton: &posewire_motion::Skeleton, rate: f64) -> Arc<Subject> {
    Arc::new(Subject {
        id,
        rate: Some(rate),
        ..Subject::new(name, skeleton.clone())
    })
}

type Sinks = Vec<Box<dyn Sink>>;

/// Opens the sinks, and tells where they send to.
fn open(
    urls: &[String],
    subjects: &[Arc<Subject>],
    options: MxtpSinkOptions,
    rate: f64,
) -> posewire::Result<(Sinks, Vec<String>)> {
    let mut mxtp = Vec::new();
    let mut sinks = Sinks::new();
    let mut progress = Vec::new();
    for url in urls {
        let target = url.parse::<Endpoint>()?;
        let Endpoint::NatNet(address) = target else {
            mxtp.push(target);
            continue;
        };
        let options = NatNetSinkOptions {
            rate: Some(rate),
            ..NatNetSinkOptions::default()
        };
        let mut sink = NatNetSink::open(&address, options)?;
        subjects.iter().try_for_each(|subject| sink.describe(subject))?;
        progress.push(sink.progress());
        sinks.push(Box::new(sink));
    }
    if !mxtp.is_empty() {
        let sink = MxtpSink::open(&mxtp, options)?;
        progress.push(sink.progress());
        sinks.push(Box::new(sink));
    }
    let targets = progress.iter().flat_map(|progress| {
        let progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
        let endpoints = progress.targets.iter().map(|target| target.endpoint.clone());
        endpoints.collect::<Vec<_>>()
    });
    let targets = targets.collect();
    Ok((sinks, targets))
}

/// Sends samples as a suit does. Use it as a context manager, or close it.
#[pyclass(frozen, module = "posewire")]
pub(crate) struct Streamer {
    urls: Vec<String>,
    rate: f64,
    subjects: Vec<Arc<Subject>>,
    /// Per subject: the number of its next sample.
    next: Mutex<Vec<u32>>,
    running: Opened<Mutex<Option<Running>>>,
}

struct Running {
    session: Session,
    feed: Feed,
}

impl Streamer {
    /// The number of the next sample of a subject, after the one that is sent now.
    fn number(&self, subject: usize, sample: Option<u32>) -> u32 {
        let mut next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
        let sample = sample.unwrap_or(next[subject]);
        next[subject] = sample.wrapping_add(1);
        sample
    }

    fn push(running: &Mutex<Option<Running>>, frame: Frame) -> Result<(), Ended> {
        let mut running = lock(running);
        let Some(Running { feed, .. }) = running.as_mut() else {
            return Err(Ended::Closed);
        };
        let item = Item::Frame {
            frame: Arc::new(frame),
            due: Some(Instant::now()),
        };
        if feed.push([item]) {
            return Ok(());
        }
        let failed = running.take().and_then(|running| finish(running).err());
        failed.map_or(Err(Ended::Closed), |error| Err(Ended::Failed(error)))
    }
}

fn lock(running: &Mutex<Option<Running>>) -> MutexGuard<'_, Option<Running>> {
    running.lock().unwrap_or_else(PoisonError::into_inner)
}

enum Ended {
    Closed,
    Failed(posewire::Error),
}

fn finish(Running { session, feed }: Running) -> posewire::Result<()> {
    drop(feed);
    session.wait().map(drop)
}

#[pymethods]
impl Streamer {
    /// Where it sends to.
    #[getter]
    fn urls(&self) -> Vec<String> {
        self.urls.clone()
    }

    /// The segments that positions and orientations are for.
    #[getter]
    fn skeleton(&self) -> Option<Skeleton> {
        let subject = self.subjects.first().map(Arc::clone);
        subject.map(|subject| Skeleton { subject })
    }

    /// Sends a sample of the subject at a place of `names`.
    ///
    /// `position` is (segments, 3) in metres, `orientation` (segments, 4), w first; NaN is not tracked. `sample` is its number, one
    /// more than the last if left out; `time` is in seconds, the number by the rate if left out. Other sections come by their names:
    /// velocity=, joint_angles=, center_of_mass= ...
    ///
    /// Raises UsageError for arrays that do not fit the skeleton, ClosedError after the end, and what ended the sending.
    #[pyo3(signature = (position, orientation, *, subject = 0, sample = None, time = None, **sections))]
    #[expect(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn send(
        &self,
        py: Python<'_>,
        position: &Bound<'_, PyAny>,
        orientation: &Bound<'_, PyAny>,
        subject: usize,
        sample: Option<u32>,
        time: Option<f64>,
        sections: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let running = self.running.here()?;
        let Some(of) = self.subjects.get(subject) else {
            let message = format!("there are {} subjects, found number {subject}", self.subjects.len());
            return Err(usage(message, "they are counted from 0, in the order of names="));
        };
        let mut frame = Frame::new(Arc::clone(of));
        set(&mut frame, Section::Position, position)?;
        set(&mut frame, Section::Orientation, orientation)?;
        for (name, numbers) in sections.into_iter().flatten() {
            let section = named(&[name.extract::<String>()?])?[0];
            set(&mut frame, section, &numbers)?;
        }
        frame.sample = self.number(subject, sample);
        let time = time.unwrap_or(f64::from(frame.sample) / self.rate);
        frame.time = Duration::try_from_secs_f64(time).map_err(|_| {
            usage(
                format!("expected seconds as the time, found {time}"),
                "leave it out to go by the rate",
            )
        })?;
        py.detach(|| Self::push(running, frame)).map_err(|ended| match ended {
            Ended::Closed => exception("ClosedError", "the streamer is closed".to_owned(), None),
            Ended::Failed(error) => raised(&error),
        })
    }

    /// Sends what is on its way and ends it.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        let Some(running) = self.running.if_here() else {
            return Ok(());
        };
        let finished = py.detach(|| {
            let running = lock(running).take();
            running.map_or(Ok(()), finish)
        });
        finished.map_err(|error| raised(&error))
    }

    fn __enter__(this: Py<Self>) -> Py<Self> {
        this
    }

    #[pyo3(signature = (*_raised))]
    fn __exit__(&self, py: Python<'_>, _raised: &Bound<'_, PyTuple>) -> PyResult<()> {
        self.close(py)
    }

    fn __repr__(&self) -> String {
        format!("<posewire.Streamer to {}>", self.urls.join(", "))
    }
}

/// Gives a frame the numbers of a section.
fn set(frame: &mut Frame, section: Section, numbers: &Bound<'_, PyAny>) -> PyResult<()> {
    let components = section.components();
    let entries = section.entries(&frame.subject.skeleton);
    let rows = rows(section, entries, components, numbers)?;
    let vectors = || rows.iter().map(|row| vector(row)).collect::<Vec<_>>();
    let quaternions = || rows.iter().map(|row| quaternion(row)).collect::<Vec<_>>();
    match section {
        Section::Position => frame.position = vectors(),
        Section::Orientation => frame.orientation = quaternions(),
        Section::Velocity => frame.velocity = vectors(),
        Section::Acceleration => frame.acceleration = vectors(),
        Section::AngularVelocity => frame.angular_velocity = vectors(),
        Section::AngularAcceleration => frame.angular_acceleration = vectors(),
        Section::JointAngles => frame.joint_angles = vectors(),
        Section::JointAnglesXzy => frame.joint_angles_xzy = vectors(),
        Section::ErgonomicAngles => frame.ergonomic_angles = vectors(),
        Section::ErgonomicAnglesXzy => frame.ergonomic_angles_xzy = vectors(),
        Section::SensorOrientation => frame.sensor_orientation = quaternions(),
        Section::SensorFreeAcceleration => frame.sensor_free_acceleration = vectors(),
        Section::SensorAcceleration => frame.sensor_acceleration = vectors(),
        Section::SensorAngularVelocity => frame.sensor_angular_velocity = vectors(),
        Section::SensorMagneticField => frame.sensor_magnetic_field = vectors(),
        section => set_center_of_mass(frame, section, rows.first().and_then(|row| vector(row)))?,
    }
    Ok(())
}

/// Velocity and acceleration follow the position, which is what makes a centre of mass.
fn set_center_of_mass(frame: &mut Frame, section: Section, value: Option<DVec3>) -> PyResult<()> {
    if section == Section::CenterOfMass {
        frame.center_of_mass = value.map(|position| CenterOfMass {
            position,
            velocity: None,
            acceleration: None,
        });
        return Ok(());
    }
    let Some(whole) = &mut frame.center_of_mass else {
        let help = "give center_of_mass= before it";
        return Err(usage(
            format!("{section} needs the position of the centre of mass"),
            help,
        ));
    };
    match section {
        Section::CenterOfMassVelocity => whole.velocity = value,
        _ => whole.acceleration = value,
    }
    Ok(())
}

/// The numbers of each entry. Anything that numpy makes an array of will do.
fn rows(section: Section, entries: usize, components: usize, numbers: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<f64>>> {
    if entries == 1
        && let Ok(row) = numbers.extract::<PyArrayLike1<'_, f64, AllowTypeChange>>()
        && row.as_array().len() == components
    {
        return Ok(vec![row.as_array().to_vec()]);
    }
    let rows = numbers.extract::<PyArrayLike2<'_, f64, AllowTypeChange>>();
    let wrong = |found: String| {
        usage(
            format!("expected an array of ({entries}, {components}) as {section}, found {found}"),
            "streamer.skeleton says which entries there are",
        )
    };
    let rows = rows.map_err(|_| wrong(shape(numbers)))?;
    let array = rows.as_array();
    if array.dim() != (entries, components) {
        return Err(wrong(shape(numbers)));
    }
    Ok(array.outer_iter().map(|row| row.to_vec()).collect())
}

fn shape(numbers: &Bound<'_, PyAny>) -> String {
    let kind = || numbers.get_type().name().map(|name| name.to_string());
    let shape = numbers.getattr("shape").map(|shape| format!("one of {shape}"));
    shape.or_else(|_| kind()).unwrap_or_default()
}

fn vector(row: &[f64]) -> Option<DVec3> {
    let vector = DVec3::from_array(row.try_into().ok()?);
    (!vector.is_nan()).then_some(vector)
}

fn quaternion(row: &[f64]) -> Option<DQuat> {
    let [w, x, y, z] = row.try_into().ok()?;
    let turn = DQuat::from_xyzw(x, y, z, w);
    (!turn.is_nan()).then_some(turn)
}

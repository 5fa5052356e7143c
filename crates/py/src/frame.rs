//! One sample as Python has it.

use crate::array;
use crate::section::{self, missing};
use crate::skeleton::Skeleton;
use posewire_motion::{Per, Section};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// One sample of one subject. Units, axes and shapes are those of Take, without the samples.
#[pyclass(frozen, module = "posewire")]
#[derive(Clone)]
pub(crate) struct Frame {
    pub(crate) frame: Arc<posewire_motion::Frame>,
    /// Of one that came live: when, and for how long it counts.
    pub(crate) arrival: Option<Arrival>,
}

/// When a sample arrived, and for how long it is worth something.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub(crate) at: Instant,
    pub(crate) stale_after: Duration,
    pub(crate) lost_after: Duration,
}

impl Arrival {
    fn state(self) -> &'static str {
        let age = self.at.elapsed();
        if age < self.stale_after {
            "LIVE"
        } else if age < self.lost_after {
            "STALE"
        } else {
            "LOST"
        }
    }
}

impl Frame {
    pub(crate) fn recorded(frame: posewire_motion::Frame) -> Self {
        Self {
            frame: Arc::new(frame),
            arrival: None,
        }
    }

    fn array<'py>(&self, py: Python<'py>, section: Section) -> PyResult<Bound<'py, PyAny>> {
        let entries = self.frame.entries(section);
        if entries.is_empty() {
            let help = "the source decides what it sends";
            return Err(missing("the sample", section, self.frame.sections(), help));
        }
        let components = section.components();
        let shape = match section.per() {
            Per::Body => vec![components],
            _ => vec![entries.len(), components],
        };
        array::owned(py, shape, entries.numbers())
    }
}

#[pymethods]
impl Frame {
    /// The subject's name.
    #[getter]
    fn subject(&self) -> &str {
        &self.frame.subject.name
    }

    /// The subject's number at its source: the MXTP character, counted from 0.
    #[getter]
    fn character(&self) -> u32 {
        self.frame.subject.id
    }

    /// The segments, joints and sensors that the arrays have entries for.
    #[getter]
    fn skeleton(&self) -> Skeleton {
        Skeleton {
            subject: Arc::clone(&self.frame.subject),
        }
    }

    /// Names of the segments.
    #[getter]
    fn segments(&self) -> Vec<String> {
        let segments = self.frame.subject.skeleton.segments.iter();
        segments.map(|segment| segment.name.clone()).collect()
    }

    /// Names of the joints.
    #[getter]
    fn joints(&self) -> Vec<String> {
        let joints = self.frame.subject.skeleton.joints.iter();
        joints.map(|joint| joint.name.clone()).collect()
    }

    /// Samples a second; None where the source does not say.
    #[getter]
    fn rate(&self) -> Option<f64> {
        self.frame.subject.rate
    }

    /// Names of the sections that the sample has.
    #[getter]
    fn sections(&self) -> Vec<&'static str> {
        self.frame.sections().map(Section::name).collect()
    }

    /// The source's number of the sample.
    #[getter]
    fn sample(&self) -> u32 {
        self.frame.sample
    }

    /// The source's clock, seconds since its recording began.
    #[getter]
    fn time(&self) -> f64 {
        self.frame.seconds()
    }

    /// The time of day, UTC, in seconds since midnight; None where the source does not say.
    #[getter]
    fn timecode(&self) -> Option<f64> {
        self.frame.timecode.map(posewire_motion::Timecode::seconds)
    }

    /// When it arrived at this machine, UTC in nanoseconds since 1970; None for one that did not.
    #[getter]
    fn received(&self) -> Option<i64> {
        self.frame.received.map(posewire_motion::Stamp::nanoseconds)
    }

    /// Whether a newer sample of its subject had arrived before it.
    #[getter]
    fn late(&self) -> bool {
        self.frame.late
    }

    /// Seconds since its first datagram arrived at this machine, or since it was played; None for one that did not come live.
    #[getter]
    fn age(&self) -> Option<f64> {
        self.arrival.map(|arrival| arrival.at.elapsed().as_secs_f64())
    }

    /// By its age: "LIVE", "STALE" or "LOST"; None for one that did not come live.
    #[getter]
    fn state(&self) -> Option<&'static str> {
        self.arrival.map(Arrival::state)
    }

    /// Names of the events that the operator set at this sample.
    #[getter]
    fn events(&self) -> Vec<String> {
        self.frame.events.clone()
    }

    /// Points that the source sends on their own: the number of each and its position (3,), m, NaN where it was not seen.
    #[getter]
    fn markers<'py>(&self, py: Python<'py>) -> PyResult<Vec<(u32, Bound<'py, PyAny>)>> {
        let markers = self.frame.markers.iter().map(|marker| {
            let position = marker.position.map_or([f64::NAN; 3], |position| position.to_array());
            Ok((marker.id, array::owned(py, [3], position.to_vec())?))
        });
        markers.collect()
    }

    /// Whether the feet touch the ground: (contacts,), bool; empty where the source does not say.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array::owned(py, [self.frame.contacts.len()], self.frame.contacts.clone())
    }

    /// Origins of the segments, m: (segments, 3).
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Position)
    }

    /// From the segments' axes to the world's: (segments, 4), w first.
    #[getter]
    fn orientation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Orientation)
    }

    /// Of the segments' origins, m/s: (segments, 3).
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Velocity)
    }

    /// Of the segments' origins, m/s2: (segments, 3).
    #[getter]
    fn acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Acceleration)
    }

    /// Of the segments, rad/s: (segments, 3).
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::AngularVelocity)
    }

    /// Of the segments, rad/s2: (segments, 3).
    #[getter]
    fn angular_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::AngularAcceleration)
    }

    /// Abduction, rotation and flexion of the joints, rad: (joints, 3); by the sequence "zxy" or "xzy".
    #[pyo3(signature = (sequence = "zxy"))]
    fn joint_angles<'py>(&self, py: Python<'py>, sequence: &str) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, section::joint_angles(sequence)?)
    }

    /// Ergonomic angles, rad: (angles, 3); by the sequence "zxy" or "xzy".
    #[pyo3(signature = (sequence = "zxy"))]
    fn ergonomic_angles<'py>(&self, py: Python<'py>, sequence: &str) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, section::ergonomic_angles(sequence)?)
    }

    /// From the sensors' axes to the world's: (sensors, 4), w first.
    #[getter]
    fn sensor_orientation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorOrientation)
    }

    /// Acceleration of the sensors without gravity, in the world, m/s2: (sensors, 3).
    #[getter]
    fn sensor_free_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorFreeAcceleration)
    }

    /// Acceleration of the sensors with gravity, in the sensor's axes, m/s2: (sensors, 3).
    #[getter]
    fn sensor_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorAcceleration)
    }

    /// Angular velocity of the sensors, in the sensor's axes, rad/s: (sensors, 3).
    #[getter]
    fn sensor_angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorAngularVelocity)
    }

    /// Magnetic field in the sensor's axes, in units of the field at calibration: (sensors, 3).
    #[getter]
    fn sensor_magnetic_field<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorMagneticField)
    }

    /// The body's centre of mass, m: (3,).
    #[getter]
    fn center_of_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::CenterOfMass)
    }

    /// Its velocity, m/s: (3,).
    #[getter]
    fn center_of_mass_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::CenterOfMassVelocity)
    }

    /// Its acceleration, m/s2: (3,).
    #[getter]
    fn center_of_mass_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::CenterOfMassAcceleration)
    }

    /// A section by its name, as `sections` lists them.
    fn __getitem__<'py>(&self, py: Python<'py>, section: String) -> PyResult<Bound<'py, PyAny>> {
        let section = section::named(&[section])?[0];
        self.array(py, section)
    }

    fn __repr__(&self) -> String {
        let (name, sample) = (&self.frame.subject.name, self.frame.sample);
        format!("<posewire.Frame {name:?} sample {sample}>")
    }

    fn __copy__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __deepcopy__(this: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        this
    }

    #[staticmethod]
    fn __reduce__() -> PyResult<()> {
        let message = "a frame cannot be pickled: its arrays can";
        Err(PyTypeError::new_err(message))
    }
}

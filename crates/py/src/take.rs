//! A take as Python has it.

use crate::array;
use crate::arrow::{self, Table};
use crate::frame::Frame;
use crate::number::{Names, Whole};
use crate::read::FilePath;
use crate::section::{self, missing};
use crate::skeleton::Skeleton;
use crate::write::{self, Saved};
use posewire::file::Recording;
use posewire_motion::Section;
use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// A recorded take of one subject. Nothing changes it.
///
/// Metres, radians, seconds; right-handed, X forward, Y left, Z up; quaternions w, x, y, z; NaN where nothing was tracked.
#[pyclass(frozen, weakref, module = "posewire")]
#[derive(Clone)]
pub(crate) struct Take {
    pub(crate) recording: Arc<Recording>,
    /// Whether it was received rather than read from a file of a take.
    pub(crate) received: bool,
}

impl Take {
    pub(crate) fn new(recording: Recording, received: bool) -> Self {
        Self {
            recording: Arc::new(recording),
            received,
        }
    }

    fn take(&self) -> &posewire_motion::Take {
        &self.recording.take
    }

    /// What is raised that says that the take lacks a section.
    pub(crate) fn lacks(&self, section: Section) -> PyErr {
        let help = "take.complete() computes what the poses tell";
        missing("the take", section, self.take().sections(), help)
    }

    fn array<'py>(&self, py: Python<'py>, section: Section) -> PyResult<Bound<'py, PyAny>> {
        let Some(column) = self.take().column(section) else {
            return Err(self.lacks(section));
        };
        let [frames, entries, components] = column.shape();
        let whole = [frames, entries, components];
        let shape = if section.per() == posewire_motion::Per::Body {
            &[frames, components][..]
        } else {
            &whole
        };
        array::shared(py, &self.recording, shape, column.values())
    }
}

#[pymethods]
impl Take {
    /// The subject's name.
    #[getter]
    fn subject(&self) -> &str {
        &self.take().subject.name
    }

    /// The segments, joints and sensors that the arrays have entries for.
    #[getter]
    fn skeleton(&self) -> Skeleton {
        Skeleton {
            subject: Arc::clone(&self.take().subject),
        }
    }

    /// Names of the segments.
    #[getter]
    fn segments(&self) -> Vec<String> {
        let segments = self.take().subject.skeleton.segments.iter();
        segments.map(|segment| segment.name.clone()).collect()
    }

    /// Names of the joints.
    #[getter]
    fn joints(&self) -> Vec<String> {
        let joints = self.take().subject.skeleton.joints.iter();
        joints.map(|joint| joint.name.clone()).collect()
    }

    /// Samples a second.
    #[getter]
    fn rate(&self) -> f64 {
        self.take().rate
    }

    /// Names of the sections that the take has.
    #[getter]
    fn sections(&self) -> Vec<&'static str> {
        self.take().sections().map(Section::name).collect()
    }

    /// What ended the file before its end, where it was read with salvage and something did; None of a whole file.
    #[getter]
    fn damage(&self) -> Option<&str> {
        self.recording.damage.as_deref()
    }

    /// Events that the operator set: the place of the sample, and the name.
    #[getter]
    fn events(&self) -> Vec<(usize, String)> {
        self.take().events().to_vec()
    }

    /// The source's numbers of the samples: (samples,), uint32.
    #[getter]
    fn sample<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array::shared(py, &self.recording, &[self.take().len()], self.take().samples())
    }

    /// The source's clock, seconds since its recording began: (samples,).
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array::owned(py, [self.take().len()], self.take().seconds().collect())
    }

    /// The time of day, UTC, in seconds since midnight: (samples,), NaN where the source does not say.
    #[getter]
    fn timecode<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let codes = self.take().timecodes().iter();
        let seconds = codes.map(|code| code.map_or(f64::NAN, posewire_motion::Timecode::seconds));
        array::owned(py, [self.take().len()], seconds.collect())
    }

    /// Whether the feet touch the ground: (samples, contacts), bool; False where the source does not say.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let width = self.take().subject.skeleton.contacts.len();
        let mut values = vec![false; self.take().len() * width];
        for (frame, row) in values.chunks_exact_mut(width.max(1)).enumerate() {
            for (value, contact) in row.iter_mut().zip(self.take().contacts(frame)) {
                *value = *contact;
            }
        }
        array::owned(py, [self.take().len(), width], values)
    }

    /// Origins of the segments, m: (samples, segments, 3).
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Position)
    }

    /// From the segments' axes to the world's: (samples, segments, 4), w first. All the identity in the T-pose.
    #[getter]
    fn orientation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Orientation)
    }

    /// Of the segments' origins, m/s: (samples, segments, 3).
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Velocity)
    }

    /// Of the segments' origins, m/s2: (samples, segments, 3).
    #[getter]
    fn acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::Acceleration)
    }

    /// Of the segments, rad/s: (samples, segments, 3).
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::AngularVelocity)
    }

    /// Of the segments, rad/s2: (samples, segments, 3).
    #[getter]
    fn angular_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::AngularAcceleration)
    }

    /// Abduction, rotation and flexion of the joints, rad: (samples, joints, 3); by the sequence "zxy" or "xzy".
    #[pyo3(signature = (sequence = "zxy"))]
    fn joint_angles<'py>(&self, py: Python<'py>, sequence: &str) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, section::joint_angles(sequence)?)
    }

    /// Ergonomic angles, rad: (samples, angles, 3); by the sequence "zxy" or "xzy".
    #[pyo3(signature = (sequence = "zxy"))]
    fn ergonomic_angles<'py>(&self, py: Python<'py>, sequence: &str) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, section::ergonomic_angles(sequence)?)
    }

    /// From the sensors' axes to the world's: (samples, sensors, 4), w first.
    #[getter]
    fn sensor_orientation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorOrientation)
    }

    /// Acceleration of the sensors without gravity, in the world, m/s2: (samples, sensors, 3).
    #[getter]
    fn sensor_free_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorFreeAcceleration)
    }

    /// Acceleration of the sensors with gravity, in the sensor's axes, m/s2: (samples, sensors, 3).
    #[getter]
    fn sensor_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorAcceleration)
    }

    /// Angular velocity of the sensors, in the sensor's axes, rad/s: (samples, sensors, 3).
    #[getter]
    fn sensor_angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorAngularVelocity)
    }

    /// Magnetic field in the sensor's axes, in units of the field at calibration: (samples, sensors, 3).
    #[getter]
    fn sensor_magnetic_field<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::SensorMagneticField)
    }

    /// The body's centre of mass, m: (samples, 3).
    #[getter]
    fn center_of_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::CenterOfMass)
    }

    /// Its velocity, m/s: (samples, 3).
    #[getter]
    fn center_of_mass_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::CenterOfMassVelocity)
    }

    /// Its acceleration, m/s2: (samples, 3).
    #[getter]
    fn center_of_mass_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.array(py, Section::CenterOfMassAcceleration)
    }

    /// A section by its name, as `sections` lists them.
    fn __getitem__<'py>(&self, py: Python<'py>, section: String) -> PyResult<Bound<'py, PyAny>> {
        let section = section::named(&[section])?[0];
        self.array(py, section)
    }

    /// The sample at a place; negative places count from the end.
    fn frame(&self, place: Whole) -> PyResult<Frame> {
        let length = self.take().len();
        let from_start = match place.within("place", isize::MIN..=isize::MAX) {
            Ok(place @ ..0) => length.checked_add_signed(place),
            Ok(place) => usize::try_from(place).ok(),
            Err(_) => None,
        };
        let Some(place) = from_start.filter(|place| *place < length) else {
            let message = format!("the take has {length} samples, found {place}");
            return Err(PyIndexError::new_err(message));
        };
        Ok(Frame::recorded(self.take().frame(place)))
    }

    /// A take that also has those of the sections that this one lacks and its poses tell; all of them without names.
    #[pyo3(signature = (*sections))]
    fn complete(&self, py: Python<'_>, sections: Names) -> PyResult<Self> {
        let sections = section::named(&sections.0)?;
        let completed = py.detach(|| {
            let mut recording = Recording::clone(&self.recording);
            recording.complete(if sections.is_empty() { Section::ALL } else { &sections });
            recording
        });
        Ok(Self::new(completed, self.received))
    }

    /// The take as a table for polars, pyarrow, DuckDB and others: polars.DataFrame(take.to_arrow()).
    ///
    /// A row for each sample: subject, sample, time, the timecode as a time of day (UTC), and a column for each number, as
    /// position_Pelvis_x or joint_angles_jLeftKnee_z, the flexion; units are those of the arrays, so angles are radians; null is
    /// not tracked.
    ///
    /// `sections` are names of sections; all of them if left out, and then `event`, with the names of those set at a sample,
    /// and contact_LeftFoot_Heel and the like too. What no sample has is no column.
    #[pyo3(signature = (sections = None))]
    fn to_arrow(&self, py: Python<'_>, sections: Option<Names>) -> PyResult<Py<Table>> {
        let sections = sections.map(|Names(sections)| sections);
        arrow::table(py, self, sections.as_deref())
    }

    /// Writes a file in the format that its name ends in, or that `format` names: mvnx, mvnx.gz, csv, bvh, c3d, trc, mot, sto,
    /// gltf, glb, npz, parquet.
    ///
    /// `axes` ("z-up", "y-up", "unity", "unreal") and `unit` ("m", "cm", "mm") are those that the format's tools expect if left
    /// out; `sections` are names of sections, computed where the take lacks them; `first` and `last` are sample numbers, both
    /// included; `rate` resamples. For one format alone are mvnx_version (3 or 4), csv_sheets, bvh_translations, bvh_t_pose and
    /// micro_units (Parquet). `progress` is called with the samples that are done and all there are. The file appears whole or
    /// not at all.
    ///
    /// Raises WriteError when it is there already and `overwrite` is not set, when it cannot be written, and when the take has
    /// nothing that the format holds.
    #[pyo3(signature = (path, *, overwrite = false, progress = None, **options))]
    fn write(
        &self,
        py: Python<'_>,
        path: FilePath,
        overwrite: bool,
        progress: Option<Py<PyAny>>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Saved> {
        write::write(py, self, path.0, overwrite, progress.as_ref(), options)
    }

    fn __len__(&self) -> usize {
        self.take().len()
    }

    fn __repr__(&self) -> String {
        let (take, segments) = (self.take(), self.take().subject.skeleton.segments.len());
        let (name, samples, rate) = (&take.subject.name, take.len(), take.rate);
        format!("<posewire.Take {name:?}: {samples} samples at {rate} Hz, {segments} segments>")
    }

    fn __copy__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __deepcopy__(this: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        this
    }

    #[staticmethod]
    fn __reduce__() -> PyResult<()> {
        let message =
            "a take cannot be pickled: take.write(\"walk.mvnx\") and posewire.read() carry it, and so do its arrays";
        Err(PyTypeError::new_err(message))
    }
}

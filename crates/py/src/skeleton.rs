//! Segments and joints, by name.

use crate::array;
use crate::error::usage;
use crate::number::Whole;
use posewire_motion::Subject;
use posewire_motion::standard::MAX_PROPS;
use pyo3::prelude::*;
use std::sync::Arc;

/// The segments of a subject and how they hang together.
#[pyclass(frozen, module = "posewire")]
#[derive(Clone)]
pub(crate) struct Skeleton {
    pub(crate) subject: Arc<Subject>,
}

#[pymethods]
impl Skeleton {
    /// MVN's skeleton: 23 body segments and 22 joints, then up to 4 `props`, then, with `fingers`, 20 segments of each hand.
    ///
    /// `sensors` are the names of the segments that wear motion trackers, in the order of the sensors' arrays: MVN's 17 if left out.
    ///
    /// Raises UsageError for another number of props, and for sensors that are no segments.
    #[staticmethod]
    #[pyo3(signature = (props = Whole::of(0), fingers = false, sensors = None),
        text_signature = "(props=0, fingers=False, sensors=None)")]
    fn standard(props: Whole, fingers: bool, sensors: Option<Vec<String>>) -> PyResult<Self> {
        let props = props.within("props", 0..=MAX_PROPS)?;
        let mut skeleton = posewire_motion::Skeleton::standard(props, fingers);
        if let Some(sensors) = sensors {
            skeleton.sensors = worn(&skeleton, &sensors)?;
        }
        let subject = Arc::new(Subject::new("", skeleton));
        Ok(Self { subject })
    }

    /// Names of the segments, in the order of the arrays.
    #[getter]
    fn segments(&self) -> Vec<&str> {
        let segments = self.subject.skeleton.segments.iter();
        segments.map(|segment| segment.name.as_str()).collect()
    }

    /// Per segment: the place of the one that it hangs on, None for the root and for what hangs on nothing.
    #[getter]
    fn parents(&self) -> Vec<Option<usize>> {
        self.subject
            .skeleton
            .segments
            .iter()
            .map(|segment| segment.parent)
            .collect()
    }

    /// Names of the joints, in the order of the joint angles.
    #[getter]
    fn joints(&self) -> Vec<&str> {
        let joints = self.subject.skeleton.joints.iter();
        joints.map(|joint| joint.name.as_str()).collect()
    }

    /// Names of the ergonomic angles.
    #[getter]
    fn ergonomic_angles(&self) -> Vec<&str> {
        let angles = self.subject.skeleton.ergonomic_angles.iter();
        angles.map(|angle| angle.name.as_str()).collect()
    }

    /// Per motion tracker: the name of the segment that wears it.
    #[getter]
    fn sensors(&self) -> Vec<&str> {
        let skeleton = &self.subject.skeleton;
        posewire_motion::Section::SensorOrientation.labels(skeleton).collect()
    }

    /// Names of the foot contacts.
    #[getter]
    fn contacts(&self) -> Vec<&str> {
        self.subject.skeleton.contacts.iter().map(String::as_str).collect()
    }

    /// Per segment: its origin in the T-pose, metres, an array (segments, 3); NaN where it is not known.
    #[getter]
    fn origins<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let segments = &self.subject.skeleton.segments;
        let origins = segments.iter().map(|segment| segment.origin);
        let numbers = origins.flat_map(|origin| origin.map_or([f64::NAN; 3], |origin| origin.to_array()));
        array::owned(py, [segments.len(), 3], numbers.collect())
    }

    fn __len__(&self) -> usize {
        self.subject.skeleton.segments.len()
    }

    fn __repr__(&self) -> String {
        let skeleton = &self.subject.skeleton;
        let (segments, joints) = (skeleton.segments.len(), skeleton.joints.len());
        format!("<posewire.Skeleton: {segments} segments, {joints} joints>")
    }
}

/// The places of the segments with these names, each once.
fn worn(skeleton: &posewire_motion::Skeleton, names: &[String]) -> PyResult<Vec<usize>> {
    let place = |name: &String| {
        let unknown = || {
            let segments: Vec<_> = skeleton.segments.iter().map(|segment| segment.name.as_str()).collect();
            usage(
                format!("expected names of segments as the sensors, found {name:?}"),
                format!("the segments are {}", segments.join(", ")),
            )
        };
        skeleton.segment(name).ok_or_else(unknown)
    };
    let places = names.iter().map(place).collect::<PyResult<Vec<_>>>()?;
    let twice = (0..places.len()).find(|&this| places[..this].contains(&places[this]));
    twice.map_or(Ok(places), |this| {
        let message = format!(
            "expected each sensor on a segment of its own, found {:?} twice",
            names[this]
        );
        Err(usage(message, "a segment wears one motion tracker"))
    })
}

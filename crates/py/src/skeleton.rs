//! Segments and joints, by name.

use crate::array;
use crate::error::usage;
use crate::number::{Names, Whole};
use numpy::{AllowTypeChange, PyArrayLike2};
use posewire_motion::standard::MAX_PROPS;
use posewire_motion::{DVec3, Segment, SegmentKind, Subject};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyType;
use std::collections::HashSet;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// The segments of a subject and how they hang together: MVN's own are `Skeleton.standard()`.
///
/// Skeleton(segments, parents=None, origins=None) is one of other segments, which `posewire.streamer` sends: `segments` are their
/// names, `parents` the place of the one that each hangs on, which stands before it, or None; `origins` (segments, 3) are
/// their places in the rest pose, metres, NaN where it is not known. NatNet carries all of it; MXTP carries such segments
/// under their names, without parents.
///
/// Skeletons are equal when all that they hold is, and are pickled where they have been made in Python.
#[pyclass(frozen, eq, hash, weakref, module = "posewire")]
#[derive(Clone)]
pub(crate) struct Skeleton {
    pub(crate) subject: Arc<Subject>,
}

impl PartialEq for Skeleton {
    fn eq(&self, other: &Self) -> bool {
        self.subject.skeleton == other.subject.skeleton
    }
}

impl Hash for Skeleton {
    fn hash<H: Hasher>(&self, state: &mut H) {
        for segment in &self.subject.skeleton.segments {
            (&segment.name, segment.parent).hash(state);
        }
    }
}

impl From<posewire_motion::Skeleton> for Skeleton {
    fn from(skeleton: posewire_motion::Skeleton) -> Self {
        let subject = Arc::new(Subject::new("", skeleton));
        Self { subject }
    }
}

#[pymethods]
impl Skeleton {
    #[new]
    #[pyo3(signature = (segments, parents = None, origins = None))]
    fn new(segments: Names, parents: Option<Vec<Option<Whole>>>, origins: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let Names(segments) = segments;
        check_names(&segments)?;
        let parents = parents.map_or_else(|| Ok(vec![None; segments.len()]), |given| parents_of(&segments, &given))?;
        let origins = origins.map_or_else(|| Ok(vec![None; segments.len()]), |given| origins_of(&segments, given))?;
        Ok(own(segments, parents, origins).into())
    }

    /// MVN's skeleton: 23 body segments and 22 joints, then up to 4 `props`, then, with `fingers`, 20 segments of each hand.
    ///
    /// `sensors` are the names of the segments that wear motion trackers, in the order of the sensors' arrays: MVN's 17 if left
    /// out.
    ///
    /// Raises UsageError for another number of props, and for sensors on no segment or twice on one.
    #[staticmethod]
    #[pyo3(
        signature = (props = Whole::of(0), fingers = false, sensors = None),
        text_signature = "(props=0, fingers=False, sensors=None)"
    )]
    fn standard(props: Whole, fingers: bool, sensors: Option<Names>) -> PyResult<Self> {
        let props = props.within("props", 0..=MAX_PROPS)?;
        let mut skeleton = posewire_motion::Skeleton::standard(props, fingers);
        if let Some(Names(sensors)) = sensors {
            skeleton.sensors = worn(&skeleton, &sensors)?;
        }
        Ok(skeleton.into())
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

    fn __copy__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __deepcopy__(this: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        this
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let class = PyType::new::<Self>(py);
        let skeleton = &self.subject.skeleton;
        let (props, fingers) = (skeleton.count(SegmentKind::Prop), skeleton.finger_count() > 0);
        let mut standard = posewire_motion::Skeleton::standard(props, fingers);
        standard.sensors.clone_from(&skeleton.sensors);
        if *skeleton == standard {
            let caller = py.import("operator")?.getattr("methodcaller")?;
            let arguments = (class,).into_pyobject(py)?.into_any();
            return Ok((caller.call1(("standard", props, fingers, self.sensors()))?, arguments));
        }
        let names: Vec<_> = skeleton.segments.iter().map(|segment| segment.name.clone()).collect();
        let origins = skeleton.segments.iter().map(|segment| segment.origin);
        if *skeleton == own(names.clone(), self.parents(), origins.collect()) {
            let arguments = (names, self.parents(), self.origins(py)?);
            return Ok((class.into_any(), arguments.into_pyobject(py)?.into_any()));
        }
        let message = "a skeleton with joints and points of a file or a stream cannot be pickled: pickle its lists";
        Err(PyTypeError::new_err(message))
    }
}

/// A skeleton of segments alone.
fn own(names: Vec<String>, parents: Vec<Option<usize>>, origins: Vec<Option<DVec3>>) -> posewire_motion::Skeleton {
    let segments = names.into_iter().zip(parents).zip(origins);
    let segments = segments.map(|((name, parent), origin)| Segment {
        parent,
        origin,
        ..Segment::new(name, SegmentKind::Body)
    });
    posewire_motion::Skeleton {
        segments: segments.collect(),
        ..posewire_motion::Skeleton::default()
    }
}

fn check_names(names: &[String]) -> PyResult<()> {
    let mut before = HashSet::new();
    for name in names {
        if !name.is_empty() && !name.contains('\0') && before.insert(name) {
            continue;
        }
        let message = format!("expected a name of its own for each segment, found {name:?}");
        return Err(usage(message, "no two may be alike, and none empty"));
    }
    if names.is_empty() {
        return Err(usage(
            "expected the names of segments, found none",
            "as in posewire.Skeleton([\"Base\", \"Arm\"], [None, 0])",
        ));
    }
    Ok(())
}

fn parents_of(names: &[String], given: &[Option<Whole>]) -> PyResult<Vec<Option<usize>>> {
    if given.len() != names.len() {
        let message = format!(
            "expected {} parents, one for each segment, found {}",
            names.len(),
            given.len()
        );
        return Err(usage(message, "None is the parent of a root"));
    }
    let place = |(segment, parent): (usize, &Option<Whole>)| {
        let Some(parent) = parent else { return Ok(None) };
        let argument = format!("the parent of {:?}", names[segment]);
        if segment == 0 {
            let message = format!("expected None as {argument}, the first segment, found {parent}");
            return Err(usage(message, "a parent stands before its children"));
        }
        parent.within(&argument, 0..=segment - 1).map(Some)
    };
    given.iter().enumerate().map(place).collect()
}

fn origins_of(names: &[String], given: &Bound<'_, PyAny>) -> PyResult<Vec<Option<DVec3>>> {
    let wrong = || {
        let shape = given.getattr("shape").map(|shape| format!("one of {shape}"));
        let kind = || given.get_type().name().map(|name| name.to_string());
        let found = shape.or_else(|_| kind()).unwrap_or_default();
        let message = format!("expected an array of ({}, 3) as origins, found {found}", names.len());
        usage(message, "a place for each segment, metres")
    };
    let array = given.extract::<PyArrayLike2<'_, f64, AllowTypeChange>>();
    let array = array.map_err(|_| wrong())?;
    let array = array.as_array();
    if array.dim() != (names.len(), 3) {
        return Err(wrong());
    }
    let origin = |row: [f64; 3]| Some(DVec3::from_array(row)).filter(|origin| !origin.is_nan());
    Ok(array.outer_iter().map(|row| origin([row[0], row[1], row[2]])).collect())
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

//! Arrays of the engine as numpy sees them.

use numpy::{PyArray1, PyArrayMethods};
use posewire::file::Recording;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

/// Numbers of a take where they are, for numpy: the `__array_interface__` of memory that the take owns.
///
/// An array made of it keeps it alive, and it keeps the take. Nobody can write to either.
#[pyclass(frozen, module = "posewire")]
pub(crate) struct Column {
    // Never changed and never moved while it is shared, so that the address below stays right.
    _owner: Arc<Recording>,
    address: usize,
    shape: Vec<usize>,
    typestr: &'static str,
}

#[pymethods]
impl Column {
    /// numpy's description of the memory, version 3: read-only, C-contiguous.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", self.typestr)?;
        interface.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        interface.set_item("data", (self.address, true))?;
        Ok(interface)
    }
}

/// A number that numpy knows.
pub(crate) trait Number {
    /// Its numpy type, in this machine's byte order.
    const TYPESTR: &'static str;
}

impl Number for f64 {
    const TYPESTR: &'static str = if cfg!(target_endian = "little") { "<f8" } else { ">f8" };
}

impl Number for u32 {
    const TYPESTR: &'static str = if cfg!(target_endian = "little") { "<u4" } else { ">u4" };
}

/// A read-only array of numbers that stand in a recording, without a copy. The shape holds as many.
pub(crate) fn shared<'py, T: Number>(
    py: Python<'py>,
    owner: &Arc<Recording>,
    shape: &[usize],
    numbers: &[T],
) -> PyResult<Bound<'py, PyAny>> {
    let column = Column {
        address: numbers.as_ptr().addr(),
        _owner: Arc::clone(owner),
        shape: shape.to_vec(),
        typestr: T::TYPESTR,
    };
    py.import("numpy")?.getattr("asarray")?.call1((column,))
}

/// A read-only array of numbers that are nobody else's.
pub(crate) fn owned<T: numpy::Element>(
    py: Python<'_>,
    shape: impl Into<Vec<usize>>,
    numbers: Vec<T>,
) -> PyResult<Bound<'_, PyAny>> {
    let array = PyArray1::from_vec(py, numbers).reshape(shape.into())?;
    let array = array.try_readwrite()?.make_nonwriteable();
    Ok(array.as_any().clone())
}

//! The extension module of the Python package `posewire`: takes and live streams as numpy arrays.
//!
//! ```python
//! import posewire
//!
//! take = posewire.read("walk.mvnx")
//! print(take.position.shape, take.rate)
//!
//! with posewire.listen("mxtp://0.0.0.0:9763") as stream:
//!     for frame in stream:
//!         print(frame.subject, frame.position[0])
//! ```
//!
//! What stands here translates and nothing else: arrays, errors and threads. The work is the engine's. Wherever something takes
//! time or waits, the interpreter is free to do other things, and no thread of the engine ever needs it: a program ends
//! whenever Python does.

#![allow(
    clippy::doc_markdown,
    reason = "what stands at Python's functions and classes is their docstring"
)]
#![allow(clippy::needless_pass_by_value, reason = "Python's arguments come by value")]

mod array;
mod arrow;
mod command;
mod decode;
mod error;
mod frame;
mod listen;
mod number;
mod process;
mod read;
mod recorder;
mod section;
mod skeleton;
mod streamer;
mod take;
mod wait;
mod write;

use pyo3::prelude::*;

/// What `posewire` gives out again; see there.
#[pymodule(gil_used = false)]
mod _posewire {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::array::Column;
    #[pymodule_export]
    use super::arrow::Table;
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::decode::decode;
    #[pymodule_export]
    use super::frame::Frame;
    #[pymodule_export]
    use super::listen::{Bell, Stream, listen};
    #[pymodule_export]
    use super::read::{read, read_all};
    #[pymodule_export]
    use super::recorder::Recorder;
    #[pymodule_export]
    use super::skeleton::Skeleton;
    #[pymodule_export]
    use super::streamer::{Streamer, streamer};
    #[pymodule_export]
    use super::take::Take;
    #[pymodule_export]
    use super::write::Saved;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

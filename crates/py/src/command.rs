//! The command line.

use pyo3::prelude::*;

/// Runs the command line and gives its exit code. `arguments` begins with the program's name.
///
/// It takes Ctrl-C for itself: once in a process.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| posewire_cli::main(arguments))
}

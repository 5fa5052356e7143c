//! The command line.

use crate::error::usage;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs the command line and gives its exit code. `arguments` begins with the program's name.
///
/// It takes Ctrl-C for itself and does not give it back, so that it runs once in a process.
///
/// Raises UsageError when it is called again.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    static HAS_RUN: AtomicBool = AtomicBool::new(false);
    if HAS_RUN.swap(true, Ordering::Relaxed) {
        return Err(usage(
            "expected one command line in a process, found another",
            "give it a process of its own: subprocess.run([sys.executable, \"-m\", \"posewire\", ...])",
        ));
    }
    Ok(py.detach(|| {
        let code = posewire_cli::main(arguments);
        // Python ends the process without the end that programs in Rust have.
        let _ = std::io::stdout().flush();
        code
    }))
}

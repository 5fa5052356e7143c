//! Arguments that do not go together, found before anything is read.

use crate::error::Usage;

/// A take is read from a file, some of it twice, and a file appears when it is whole: streams can do neither.
pub(super) fn standard_streams(inputs: &[String], output: &str) -> Result<(), Usage> {
    if inputs.iter().any(|input| input == "-") {
        return Err(Usage {
            problem: "takes are not read from the standard input (-)".to_owned(),
            help: "name a file; one that is called - is ./-".to_owned(),
        });
    }
    if output == "-" {
        return Err(Usage {
            problem: "takes are not written to the standard output (-)".to_owned(),
            help: "name a file, or a folder with --format; one that is called - is ./-".to_owned(),
        });
    }
    Ok(())
}

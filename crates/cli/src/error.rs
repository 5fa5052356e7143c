//! Failures as the user sees them: what went wrong, and what to do about it.

use std::io::Write;

/// Arguments that do not fit together, found only after parsing.
#[derive(Debug, thiserror::Error)]
#[error("{problem}")]
pub(crate) struct Usage {
    pub(crate) problem: String,
    pub(crate) help: String,
}

/// Something that could not be done, for a reason that the engine does not know.
#[derive(Debug, thiserror::Error)]
#[error("{problem}")]
pub(crate) struct Failure {
    pub(crate) problem: String,
    pub(crate) help: String,
}

/// Prints `error:` and `help:` lines and gives the exit code: 2 for wrong arguments, else 1.
pub(crate) fn report(error: &anyhow::Error) -> u8 {
    if is_closed_pipe(error) {
        return 0;
    }
    if let Some(error) = error.downcast_ref::<std::io::Error>() {
        return report(&posewire::Error::write("the standard output", error).into());
    }
    let (usage, help) = if let Some(error) = error.downcast_ref::<posewire::Error>() {
        (error.is_usage(), error.help())
    } else if let Some(usage) = error.downcast_ref::<Usage>() {
        (true, Some(usage.help.clone()))
    } else if let Some(help) = viewer_help(error) {
        (false, Some(help))
    } else {
        (
            false,
            error.downcast_ref::<Failure>().map(|failure| failure.help.clone()),
        )
    };
    let mut stderr = std::io::stderr().lock();
    // When even the standard error is closed nobody can be told.
    let _ = writeln!(stderr, "error: {error:#}");
    let _ = writeln!(
        stderr,
        "help: {}",
        help.unwrap_or_else(|| "posewire --help lists what can be done".to_owned())
    );
    if usage { 2 } else { 1 }
}

/// What to do about a failure of the browser page, if it is one.
#[cfg(feature = "viewer")]
fn viewer_help(error: &anyhow::Error) -> Option<String> {
    error.downcast_ref().and_then(posewire_viewer::Error::help)
}

#[cfg(not(feature = "viewer"))]
fn viewer_help(_: &anyhow::Error) -> Option<String> {
    None
}

/// Prints what the parsing of the arguments ended with: the help or version that was asked for, else what is wrong with
/// them, which ends with a `help:` line as every error does.
pub(crate) fn report_parsing(answer: &clap::Error) -> u8 {
    if !answer.use_stderr() {
        // When the reader of a help has seen enough there is nobody to be told.
        let _ = answer.print();
        return 0;
    }
    let text = answer.render().to_string();
    let text = text.trim_end();
    let problem = text.strip_suffix(TRY_HELP).map_or(text, str::trim_end);
    let _ = writeln!(
        std::io::stderr().lock(),
        "{problem}\n\nhelp: --help after a verb explains its arguments, alone it lists the verbs"
    );
    2
}

/// The reader of our output has seen enough, as `head` does.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let closed = std::io::ErrorKind::BrokenPipe;
    match error.downcast_ref::<posewire::Error>() {
        Some(posewire::Error::Write { kind, .. }) => *kind == closed,
        _ => error
            .downcast_ref::<std::io::Error>()
            .is_some_and(|error| error.kind() == closed),
    }
}

/// How clap ends what it has to say.
const TRY_HELP: &str = "For more information, try '--help'.";

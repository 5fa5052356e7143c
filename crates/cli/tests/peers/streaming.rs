//! `posewire stream` as a server.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;

/// A take that is streamed in a loop until this is dropped.
pub(crate) struct Streaming {
    child: Child,
    /// The target with the ports that it has got.
    pub(crate) target: String,
}

impl Streaming {
    /// Starts it and waits until it serves.
    ///
    /// # Errors
    /// What it said instead.
    pub(crate) fn start(take: &Path, to: &str) -> Result<Self, String> {
        let mut child = Command::new(env!("CARGO_BIN_EXE_posewire"))
            .arg("stream")
            .arg(take)
            .args(["--loop", "--to", to])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| error.to_string())?;
        let mut lines = BufReader::new(child.stderr.take().ok_or("no stderr")?)
            .lines()
            .map_while(Result::ok);
        let mut said = String::new();
        let target = lines.find_map(|line| {
            said = said.clone() + &line + "\n";
            line.strip_prefix("  to ").map(ToOwned::to_owned)
        });
        // What it says later must not fill the pipe.
        thread::spawn(move || lines.for_each(drop));
        match target {
            Some(target) => Ok(Self { child, target }),
            None => Err(said),
        }
    }

    /// The command port.
    pub(crate) fn port(&self) -> &str {
        let place = self.target.split('?').next().unwrap_or_default();
        place.rsplit(':').next().unwrap_or_default()
    }

    /// Ends it as Ctrl-C does, and gives its exit code: 0 when it has lost nothing.
    pub(crate) fn end(mut self) -> Option<i32> {
        let process = self.child.id().to_string();
        let asked = Command::new("kill").args(["-INT", &process]).status();
        asked.and_then(|_| self.child.wait()).ok()?.code()
    }

    /// The value of an option of the target.
    pub(crate) fn option(&self, name: &str) -> Option<&str> {
        let (_, options) = self.target.split_once('?')?;
        let mut options = options.split('&').filter_map(|option| option.split_once('='));
        options.find(|(key, _)| *key == name).map(|(_, value)| value)
    }
}

impl Drop for Streaming {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

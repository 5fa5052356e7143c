//! The program as a child process.

use crate::program::Ended;
use std::io::{BufRead, BufReader, Read, Write};
use std::mem;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;

/// The program while it runs; it ends with the test. What it prints and says is read as it comes: it waits for no reader.
pub(crate) struct Running {
    child: Child,
    out: Receiver<Vec<u8>>,
    err: Receiver<Vec<u8>>,
}

impl Running {
    /// Starts the program in a folder with these arguments.
    pub(crate) fn start(folder: &Path, arguments: &[&str]) -> Self {
        let program = env!("CARGO_BIN_EXE_posewire");
        Self::run(folder, Command::new(program).args(arguments), b"")
    }

    /// Starts what a command starts, which is this program in the end, and gives it all of its standard input.
    pub(crate) fn run(folder: &Path, command: &mut Command, input: &[u8]) -> Self {
        let command = command.current_dir(folder).stdin(Stdio::piped());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let out = lines(child.stdout.take().unwrap());
        let err = lines(child.stderr.take().unwrap());
        // A program that has failed already reads no input.
        let _ = child.stdin.take().unwrap().write_all(input);
        Self { child, out, err }
    }

    /// The next line that it says.
    pub(crate) fn line(&mut self) -> String {
        self.read_until(|_| true)
    }

    /// What it says up to a line that is the one looked for; panics with all of it when there is none.
    pub(crate) fn read_until(&mut self, is_it: impl Fn(&str) -> bool) -> String {
        let mut said = String::new();
        for line in &self.err {
            let line = String::from_utf8(line).unwrap();
            said += &line;
            if is_it(&line) {
                return said;
            }
        }
        panic!("it ended, and said only: {said:?}");
    }

    /// Whether a line that it has said by now and that was not read yet has these words.
    #[cfg(unix)]
    pub(crate) fn has_said(&mut self, words: &str) -> bool {
        let mut lines = self.err.try_iter().map(|line| String::from_utf8(line).unwrap());
        lines.any(|line| line.contains(words))
    }

    #[cfg(unix)]
    pub(crate) fn has_ended(&mut self) -> bool {
        self.child.try_wait().unwrap().is_some()
    }

    /// Sends it a signal, as in `-STOP`.
    #[cfg(unix)]
    pub(crate) fn signal(&self, name: &str) {
        let process = self.child.id().to_string();
        let sent = Command::new("kill").args([name, &process]).status();
        assert!(sent.unwrap().success());
    }

    /// Asks it to end, as Ctrl-C does.
    #[cfg(unix)]
    pub(crate) fn interrupt(&self) {
        self.signal("-INT");
    }

    /// Ends it at once, whatever it does.
    pub(crate) fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }

    /// Waits until it has ended; gives what it said since the last reading.
    pub(crate) fn end(mut self) -> Ended {
        let text = |lines: &Receiver<Vec<u8>>| String::from_utf8(lines.iter().flatten().collect()).unwrap();
        Ended {
            out: text(&self.out),
            err: text(&self.err),
            code: self.child.wait().unwrap().code(),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The port that a line ends in.
pub(crate) fn port(line: &str) -> u16 {
    let port = line.trim_end().rsplit(':').next().and_then(|port| port.parse().ok());
    port.unwrap_or_else(|| panic!("{line}"))
}

/// The lines of an output, read on a thread of its own.
fn lines(output: impl Read + Send + 'static) -> Receiver<Vec<u8>> {
    let (said, heard) = mpsc::channel();
    let mut output = BufReader::new(output);
    thread::spawn(move || {
        let mut line = Vec::new();
        while output.read_until(b'\n', &mut line).unwrap() > 0 && said.send(mem::take(&mut line)).is_ok() {}
    });
    heard
}

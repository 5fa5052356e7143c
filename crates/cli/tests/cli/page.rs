//! The live page, on a terminal made for it.

use nix::fcntl::{FcntlArg, FdFlag, fcntl};
use nix::pty::{OpenptyResult, Winsize, openpty};
use std::fs::File;
use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::process::{Child, Command, Stdio};

/// The program on a terminal of 100 columns, and the other end of that terminal.
struct Page {
    child: Child,
    terminal: File,
    shown: String,
}

impl Page {
    fn start(arguments: &[&str]) -> Self {
        let size = Winsize {
            ws_row: 40,
            ws_col: 100,
            ws_xpixel: 0,
            ws_ypixel: 0,
        };
        let OpenptyResult { master, slave } = openpty(&size, None).unwrap();
        // A terminal is gone when nobody has its other end, and the program is not to inherit it.
        fcntl(&master, FcntlArg::F_SETFD(FdFlag::FD_CLOEXEC)).unwrap();
        let end = |slave: &OwnedFd| Stdio::from(slave.try_clone().unwrap());
        let child = Command::new(env!("CARGO_BIN_EXE_posewire"))
            .args(arguments)
            .env("TERM", "xterm-256color")
            .stdin(end(&slave))
            .stdout(end(&slave))
            .stderr(end(&slave))
            .spawn()
            .unwrap();
        Self {
            child,
            terminal: master.into(),
            shown: String::new(),
        }
    }

    /// Reads what the terminal is sent until these words come.
    fn wait_for(&mut self, words: &str) {
        let mut buffer = [0; 4096];
        while !self.shown.contains(words) {
            let count = self.terminal.read(&mut buffer).unwrap();
            self.shown.push_str(&String::from_utf8_lossy(&buffer[..count]));
        }
    }
}

#[test]
fn q_ends_the_page_and_prints_the_numbers() {
    let mut page = Page::start(&["demo", "--people", "2"]);
    page.wait_for("Ada");
    page.terminal.write_all(b"q").unwrap();
    page.wait_for("lateness p50");
    assert_eq!(page.child.wait().unwrap().code(), Some(0));
    let (on_page, after) = page.shown.rsplit_once("\x1b[?1049l").unwrap();
    assert!(on_page.contains("\x1b[?1049h"), "the page is on the second screen");
    assert!(after.contains("character 1 Bram"), "{after}");
}

#[test]
fn a_terminal_that_goes_ends_the_program_and_not_by_a_crash() {
    let mut page = Page::start(&["monitor", "mxtp://127.0.0.1:0"]);
    page.wait_for("listening on");
    drop(page.terminal);
    let ended = page.child.wait().unwrap();
    assert!(ended.code().is_some(), "{ended}");
}

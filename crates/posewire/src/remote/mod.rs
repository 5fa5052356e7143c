//! Remote control as MVN understands it: XML messages over UDP, answered to where they came from.
//!
//! ```
//! use posewire::remote::{Controlled, Remote, Status};
//! use posewire::stop::Stop;
//! use std::net::UdpSocket;
//!
//! struct Studio;
//!
//! impl Controlled for Studio {
//!     fn status(&self) -> Status {
//!         Status { live: true, ..Status::default() }
//!     }
//! }
//!
//! let remote = Remote::bind("127.0.0.1:0".parse()?)?;
//! let address = remote.local_address();
//! let stop = Stop::new();
//! let serving = remote.serve("studio", Box::new(Studio), Box::new(|line| println!("{line}")), stop.clone());
//!
//! let client = UdpSocket::bind("127.0.0.1:0")?;
//! client.send_to(b"<SessionStatusReq/>", address)?;
//! let mut answer = [0; 200];
//! let length = client.recv(&mut answer)?;
//! assert_eq!(&answer[..length], br#"<SessionStatusAck isRecording="FALSE" isPaused="FALSE" isLive="TRUE"/>"#);
//! stop.stop();
//! serving.join().unwrap();
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! There is no password: whoever can send to the port is obeyed, so it is best bound to the loopback.

mod desk;
mod playing;
mod recording;
mod refusals;

pub use playing::PlayingControl;
pub use posewire_mxtp::remote::DEFAULT_PORT;
pub use recording::RecordingControl;

use crate::Result;
use crate::endpoint::Host;
use crate::net::{LocalAddress, ServedPort};
use crate::recording::TakeName;
use crate::stop::Stop;
use desk::Desk;
use posewire_mxtp::remote::{Content, Element};
use refusals::Refusals;
use std::net::{IpAddr, SocketAddr};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// What can be controlled from afar. What it does not do, it refuses.
///
/// Who asked is answered with `Ok` or with the reason, a few words without a full stop. What `Ok` holds is told to the people
/// beside this program.
pub trait Controlled: Send {
    /// What is going on.
    fn status(&self) -> Status;

    /// Begins to record.
    ///
    /// # Errors
    /// Why it does not.
    fn start_recording(&mut self, name: &TakeName) -> Result<String, String> {
        let _ = name;
        Err(NOT_HERE.to_owned())
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// Why it does not, as when there is none.
    fn stop_recording(&mut self) -> Result<String, String> {
        Err(NOT_HERE.to_owned())
    }

    /// Does something else that was asked for.
    ///
    /// # Errors
    /// Why it does not.
    fn carry_out(&mut self, request: &Content) -> Result<String, String> {
        let _ = request;
        Err(NOT_HERE.to_owned())
    }
}

/// What is going on at something that is controlled.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// What is recorded, if anything is.
    pub recording: Option<String>,
    /// How many recordings were begun.
    pub recordings: u32,
    /// Whether the playback is paused.
    pub paused: bool,
    /// Whether the motion happens now.
    pub live: bool,
}

/// A port for remote control, open and not yet served.
#[derive(Debug)]
pub struct Remote {
    port: ServedPort,
}

/// Takes a line for people, without a full stop.
pub type Tell = Box<dyn FnMut(&str) + Send>;

impl Remote {
    /// Opens the port; port 0 is the system's choice.
    ///
    /// # Errors
    /// [`Error::Socket`](crate::Error::Socket) when it cannot be had.
    pub fn bind(address: SocketAddr) -> Result<Self> {
        let host = Host::Address(address.ip());
        let port = ServedPort::bind(&host, address.port(), false, "take remote control on")?;
        Ok(Self { port })
    }

    /// Where it is open.
    pub fn local_address(&self) -> SocketAddr {
        self.port.local_address()
    }

    /// Answers on a thread of its own until `stop` is set. `name` is what it calls itself.
    pub fn serve(self, name: &str, controlled: Box<dyn Controlled>, tell: Tell, stop: Stop) -> JoinHandle<()> {
        let desk = Desk::new(name, controlled);
        let serving = Serving {
            port: self.port,
            desk,
            tell,
            refusals: Refusals::default(),
        };
        thread::spawn(move || serving.run(&stop))
    }
}

struct Serving {
    port: ServedPort,
    desk: Desk,
    tell: Tell,
    refusals: Refusals,
}

impl Serving {
    fn run(mut self, stop: &Stop) {
        // One byte more than a message may have, so that a longer one shows.
        let mut buffer = [0; Element::LONGEST + 1];
        while !stop.is_stopped() {
            match self.port.receive(LOOK_EVERY, &mut buffer) {
                Ok(Some((length, from))) => self.answer(&buffer[..length], from),
                Ok(None) => {}
                Err(_) => _ = stop.wait(LOOK_EVERY),
            }
            let more = self.refusals.more(Instant::now());
            self.tell_more(more);
        }
        let more = self.refusals.rest();
        self.tell_more(more);
    }

    fn answer(&mut self, bytes: &[u8], from: SocketAddr) {
        let port = &self.port;
        let handled = self.desk.handle(bytes, || own_address(port, from));
        if let Some(answer) = handled.answer {
            // A lost answer is asked for again.
            _ = self.port.send(answer.to_string().as_bytes(), from);
        }
        match handled.said {
            Some(Ok(done)) => (self.tell)(&format!("{from}: {done}")),
            Some(Err(problem)) if self.refusals.is_to_be_told(Instant::now()) => {
                (self.tell)(&format!("{from}: {problem}"));
            }
            _ => {}
        }
    }

    fn tell_more(&mut self, refused: Option<u64>) {
        if let Some(refused) = refused {
            (self.tell)(&format!("and {refused} more refused"));
        }
    }
}

/// The address by which `from` knows this machine.
fn own_address(port: &ServedPort, from: SocketAddr) -> Option<IpAddr> {
    let bound = port.local_address().ip();
    if !bound.is_unspecified() {
        return Some(bound);
    }
    LocalAddress::towards(from, None).ok().map(|address| address.ip)
}

/// Why something is refused that is done elsewhere.
const NOT_HERE: &str = "this cannot be done here";
const LOOK_EVERY: Duration = Duration::from_millis(50);

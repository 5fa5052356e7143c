//! What goes to a server.

use std::net::SocketAddr;

use posewire_motion::Stamp;

use super::requests::Step;
use super::timers::Timers;
use super::{Answer, Client, Event, LostReason, Mode};
use crate::command::{Connect, ConnectOptions, EchoRequest};
use crate::{Message, Version};

impl Client {
    pub(super) fn keep_up(&mut self, now: Stamp) {
        let to = self.address();
        if self.timers.model.is_due(now) {
            self.outputs.command(to, &Message::RequestModel);
        }
        if self.timers.keep_alive.is_due(now) {
            self.outputs.command(to, &Message::KeepAlive);
        }
        self.ask(now);
    }

    /// To be called with the time now: a datagram may have arrived a while before anything is sent for it.
    pub(super) fn ask_for_clock(&mut self, now: Stamp) {
        if self.timers.echo.is_due(now) {
            let client_ticks = self.clock.ask(now);
            let request = EchoRequest { client_ticks };
            self.outputs.command(self.address(), &Message::EchoRequest(request));
        }
    }

    pub(super) fn ask(&mut self, now: Stamp) {
        while let Some(step) = self.requests.step(now) {
            match step {
                Step::Ask(text) => {
                    let request = Message::Request(text.as_str().into());
                    self.outputs.command(self.address(), &request);
                }
                Step::GiveUp(request) => self.answer(now, request, Answer::Nothing),
            }
        }
    }

    /// Asks for the version that is wanted where connecting did not bring it, and then for the one that is sent.
    pub(super) fn negotiate(&mut self, now: Stamp) {
        let Some(peer) = &self.server else { return };
        let granted = peer.info.server.natnet_version;
        if self.options.mode == Mode::Multicast || granted < SINCE_BITSTREAM {
            return;
        }
        if let Some(wish) = self.options.version.filter(|wish| *wish < granted) {
            let text = format!("{BITSTREAM},{}.{}", wish.major, wish.minor);
            self.requests.push(now, &text, false);
        }
        self.requests.push(now, BITSTREAM, false);
    }

    pub(super) fn connect_message(&self) -> Connect {
        let options = ConnectOptions {
            subscribed_only: false,
            bitstream_version: self.options.version.unwrap_or(Version::UNSPECIFIED),
        };
        Connect::new(self.options.sender.clone(), Some(options))
    }

    pub(super) fn lose(&mut self, now: Stamp, reason: LostReason) {
        self.server = None;
        self.clock.doubt();
        self.numbers.pause();
        self.timers = Timers::new(&self.options);
        self.timers.connect.start(now.after(self.options.retry));
        self.outputs.event(Event::Lost(reason));
    }

    pub(super) fn address(&self) -> SocketAddr {
        self.server.as_ref().map_or(self.options.server, |peer| peer.address)
    }

    pub(super) fn requests_due(&self) -> Option<Stamp> {
        self.requests.next().filter(|_| self.server.is_some())
    }
}

pub(super) const BITSTREAM: &str = "Bitstream";
const SINCE_BITSTREAM: Version = Version::new(4, 0);

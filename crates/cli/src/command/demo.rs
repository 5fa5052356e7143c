//! `posewire demo`: walkers, streamed over the loopback, monitored and shown in a browser.

use super::End;
use super::monitor::{self, View};
use crate::browser::Browser;
use crate::cli::Demo;
use crate::context::{self, say};
use posewire::endpoint::{Endpoint, Host, UdpAddress, Walk};
use posewire::sink::{MxtpSink, MxtpSinkOptions};
use posewire::source::PlaybackOptions;
use posewire::{Session, Source};

pub(super) fn run(arguments: &Demo) -> anyhow::Result<End> {
    let stop = context::stop_on_interrupt()?;
    let loopback = Host::Address(std::net::Ipv4Addr::LOCALHOST.into());
    let receiving = Endpoint::MxtpUdp(UdpAddress::new(loopback, 0));
    let monitored = Source::open(&receiving, &PlaybackOptions::default())?;

    let walk = Endpoint::Synthetic(Walk {
        people: arguments.people,
        ..Walk::default()
    });
    let walkers = Source::open(&walk, &PlaybackOptions::default())?;
    let sink = MxtpSink::open(&[monitored.endpoint().clone()], MxtpSinkOptions::default())?;
    let progress = sink.progress();
    say(format_args!("{walk} is streamed to {}", monitored.endpoint()));

    let browser = Browser::anywhere(arguments.beside.view, &[monitored.endpoint().clone()])?;
    if let Some(browser) = browser.as_ref().filter(|_| arguments.open) {
        browser.open();
    }
    context::stop_after(&stop, arguments.duration);
    let streaming = Session::start([walkers], vec![Box::new(sink)], stop.clone());
    let end = monitor::show(
        vec![monitored],
        View::choose(arguments.json, false, arguments.plain),
        None,
        browser.as_ref(),
        &stop,
    );
    stop.stop();
    let unsent = streaming.wait()?.dropped;
    let progress = progress.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    say(crate::render::stream_summary(&progress, unsent));
    match end? {
        End::Done => Ok(End::with_lost(progress.lost() + unsent)),
        end => Ok(end),
    }
}

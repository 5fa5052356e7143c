//! `posewire monitor`: receive a stream, check it and show it.

mod board;
pub(super) mod hint;
mod page;
mod print;
mod protocol;
mod silence;

use super::End;
use super::stream::refuse;
use crate::browser::Browser;
use crate::cli::Monitor;
use crate::context::{self, say};
use crate::error::Usage;
use board::Board;
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;
use posewire::stop::Stop;
use posewire::{Session, Sink, Source, SourceId};
use print::{Format, Names, Printer};
use silence::Silence;
use std::time::{Duration, Instant};

pub(super) fn run(arguments: &Monitor) -> anyhow::Result<End> {
    let stop = context::stop_on_interrupt()?;
    let endpoint: Endpoint = arguments.url.parse()?;
    refuse_takes(&endpoint)?;
    refuse::capture(&arguments.again.capture, &endpoint)?;
    let sources = Source::open_all(&endpoint, &playback_options(arguments))?;
    refuse_poses(&sources)?;
    refuse_playback(arguments, &sources)?;
    context::stop_after(&stop, arguments.duration);
    let view = View::choose(arguments.json, arguments.frames, arguments.plain);
    let browser = Browser::beside(arguments.beside.view, &endpoints_of(&sources))?;
    show(sources, view, arguments.count, browser.as_ref(), &stop)
}

/// Where sources are open.
pub(super) fn endpoints_of(sources: &[Source]) -> Vec<Endpoint> {
    sources.iter().map(|source| source.endpoint().clone()).collect()
}

fn playback_options(arguments: &Monitor) -> PlaybackOptions {
    PlaybackOptions {
        speed: arguments.again.speed,
        looped: arguments.again.looped,
        only: arguments.again.capture.part.only.clone(),
        from: arguments.again.capture.part.from.unwrap_or_default(),
        until: arguments.again.capture.part.until,
        protocol: arguments.again.capture.protocol(),
        ..PlaybackOptions::default()
    }
}

/// A live stream comes as it comes.
fn refuse_playback(arguments: &Monitor, sources: &[Source]) -> Result<(), Usage> {
    let given = [
        ("--speed", arguments.again.speed.to_bits() != 1_f64.to_bits()),
        ("--loop", arguments.again.looped),
    ];
    let is_live = sources.iter().any(Source::is_live);
    match given.into_iter().find(|(_, is_given)| *is_given && is_live) {
        None => Ok(()),
        Some((option, _)) => Err(Usage {
            problem: format!("{option} is for recordings and captures, and the source is a live stream"),
            help: format!("leave {option} out"),
        }),
    }
}

/// What neither is live nor was is not monitored.
fn refuse_takes(endpoint: &Endpoint) -> Result<(), Usage> {
    let help = match endpoint {
        Endpoint::File { .. } => format!("posewire inspect {endpoint} says what it holds, posewire stream sends it"),
        Endpoint::Synthetic(_) => "posewire demo shows the walker".to_owned(),
        _ => return Ok(()),
    };
    Err(Usage {
        problem: format!("expected a live stream to monitor, as mxtp://0.0.0.0:9763, found {endpoint}"),
        help,
    })
}

/// What is monitored is datagrams, and a recording of the walker has none.
fn refuse_poses(sources: &[Source]) -> posewire::Result<()> {
    let poses = |source: &&Source| !source.is_live() && source.captured().is_none();
    match sources.iter().find(poses).map(Source::endpoint) {
        Some(Endpoint::Capture { path }) => Err(posewire::Error::PosesAlone { path: path.clone() }),
        _ => Ok(()),
    }
}

/// A board for each source.
fn boards_of(sources: &[Source], count: Option<u64>, stop: &Stop) -> Vec<Board> {
    let mut boards: Vec<Board> = Vec::new();
    for (place, source) in sources.iter().enumerate() {
        let board = board_of(source, count, stop);
        boards.push(match boards.first() {
            Some(first) => board.beside(first, place, sources.len()),
            None if sources.len() > 1 => board.clone().beside(&board, place, sources.len()),
            None => board,
        });
    }
    boards
}

/// The board of a source; that of a capture is shown as what was captured.
fn board_of(source: &Source, count: Option<u64>, stop: &Stop) -> Board {
    let board = |endpoint| Board::new(endpoint, count, stop.clone());
    let Some(captured) = source.captured() else {
        return board(source.endpoint());
    };
    let name = captured.name.parse().unwrap_or_else(|_| source.endpoint().clone());
    board(&name).playing(source.endpoint())
}

/// How a stream is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// The live page.
    Page,
    /// Printed a second at a time.
    Print(Format),
}

impl View {
    pub(super) fn choose(json: bool, frames: bool, plain: bool) -> Self {
        if json {
            Self::Print(Format::Json { frames })
        } else if plain || !context::has_terminal() {
            Self::Print(Format::Plain)
        } else {
            Self::Page
        }
    }
}

/// Shows streams until they end, `count` samples have come or `stop` is set; in a browser too, if there is one.
pub(super) fn show(
    sources: Vec<Source>,
    view: View,
    count: Option<u64>,
    browser: Option<&Browser>,
    stop: &Stop,
) -> anyhow::Result<End> {
    let mut boards = boards_of(&sources, count, stop);
    let is_live = sources.iter().any(Source::is_live);
    let names = Names::of(&sources);
    let mut sinks: Vec<Box<dyn Sink>> = vec![Box::new(Board::sink(&boards))];
    sinks.extend(browser.map(Browser::sink));
    match view {
        View::Print(format) => {
            for board in &boards {
                say(board.opening());
            }
            sinks.push(Box::new(Printer::new(format, count, names.clone())));
            let session = Session::start(sources, sinks, stop.clone());
            if is_live {
                warn_of_silence(&boards, &session, stop);
            }
            finish(session, &boards, &names, view)
        }
        View::Page => {
            if let Some(browser) = browser {
                boards = boards.into_iter().map(|board| board.shown_at(browser.url())).collect();
            }
            let session = Session::start(sources, sinks, stop.clone());
            let shown = page::run(&boards, stop);
            stop.stop();
            let end = finish(session, &boards, &names, view)?;
            shown.map(|()| end)
        }
    }
}

fn finish(session: Session, boards: &[Board], names: &Names, view: View) -> anyhow::Result<End> {
    let outcome = session.wait()?;
    let is_damaged = boards.iter().any(Board::is_damaged);
    let mut lost = outcome.dropped + u64::from(is_damaged);
    for (id, board) in (0..=u16::MAX).map(SourceId).zip(boards) {
        let Some(last) = board.statistics() else { continue };
        lost += last.lost_here();
        if view == View::Page {
            print::print_plain(&last, names.heading(id))?;
        }
    }
    if outcome.dropped > 0 {
        say(format_args!(
            "{} items were dropped here: the output was slower than the stream",
            outcome.dropped
        ));
    }
    Ok(End::with_lost(lost))
}

/// Says what to check whenever nothing that can be read has come for three seconds.
fn warn_of_silence(boards: &[Board], session: &Session, stop: &Stop) {
    let mut silences: Vec<_> = boards.iter().map(|_| Silence::new(Instant::now())).collect();
    while session.is_running() && !stop.wait(LOOK_EVERY) {
        for (board, silence) in boards.iter().zip(&mut silences) {
            if silence.is_to_be_told(board.heard(), Instant::now()) {
                say(board.hint());
            }
        }
    }
}

const LOOK_EVERY: Duration = Duration::from_millis(50);

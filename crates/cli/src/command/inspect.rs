//! `posewire inspect`: what a take holds, and whether it agrees with itself.

mod capture;
mod contents;
mod input;
mod recording;
mod sections;
mod survey;
mod text;
mod verify;

use super::End;
use crate::cli::Inspect;
use crate::context::{self, end_progress, show_progress};
use crate::json;
use contents::Contents;
use input::TakeFile;
use posewire::stop::Stop;
use std::io::{self, BufWriter, Write};
use std::time::{Duration, Instant};
use survey::Survey;
use verify::Verifier;

pub(super) fn run(arguments: &Inspect) -> anyhow::Result<End> {
    if recording::is_one(&arguments.file) {
        return recording::run(arguments);
    }
    recording::refuse(arguments)?;
    let stop = context::stop_on_interrupt()?;
    if capture::is_one(&arguments.file) {
        return capture::run(arguments, &stop);
    }
    capture::refuse(arguments)?;
    let mut file = TakeFile::open(&arguments.file, arguments.salvage)?;
    let survey = read(&mut file, &stop, arguments.verify);
    end_progress();
    let contents = Contents::of(&file, &survey?);
    let mut out = BufWriter::new(io::stdout().lock());
    if arguments.json {
        json::write(&mut out, &contents)?;
    } else {
        text::write(&contents, &mut out)?;
    }
    out.flush()?;
    Ok(End::Done)
}

/// Goes through the frames once, to the end or to the wish to stop.
fn read(file: &mut TakeFile, stop: &Stop, verify: bool) -> posewire::Result<Survey> {
    let rate = file.reader.subject().rate.unwrap_or(0.0);
    let mut survey = Survey {
        verifier: verify.then(|| Verifier::new(rate)),
        ..Survey::default()
    };
    let mut shown = Instant::now();
    while !stop.is_stopped() {
        let Some(frame) = file.next_frame()? else {
            survey.complete = true;
            break;
        };
        survey.add(&frame);
        if survey.frames.is_multiple_of(64) && shown.elapsed() > PROGRESS_EVERY {
            show_progress(file.progress(survey.frames));
            shown = Instant::now();
        }
    }
    if let Some(verifier) = &mut survey.verifier {
        verifier.finish();
    }
    Ok(survey)
}

const PROGRESS_EVERY: Duration = Duration::from_millis(500);

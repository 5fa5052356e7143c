//! `posewire doctor`: say why nothing arrives, or what is wrong with what does.

use super::End;
use crate::cli::Doctor;
use crate::context::{self, say};
use crate::error::Usage;
use crate::{json, render};
use posewire::doctor::{Check, Finding, Listened, Listener, Severity, examine_system};
use posewire::endpoint::Endpoint;
use posewire::source::PlaybackOptions;

pub(super) fn run(arguments: &Doctor) -> anyhow::Result<End> {
    let endpoint = arguments.url.as_deref().map(str::parse::<Endpoint>).transpose()?;
    let examined = match &endpoint {
        Some(endpoint) => examine(endpoint, arguments)?,
        None => Listened {
            findings: examine_system(),
            ..Listened::default()
        },
    };
    if arguments.json {
        for finding in &examined.findings {
            json::print(&json::FindingRecord::new(finding))?;
        }
        json::print(&json::DoctorRecord::new(endpoint.as_ref(), &examined))?;
    } else {
        render::print_findings(&examined.findings, endpoint.as_ref())?;
    }
    Ok(end(&examined))
}

/// Listens, and adds what of this machine may be in the way.
fn examine(endpoint: &Endpoint, arguments: &Doctor) -> anyhow::Result<Listened> {
    refuse(endpoint, arguments)?;
    let options = PlaybackOptions {
        only: arguments.only.clone(),
        ..PlaybackOptions::default()
    };
    let stop = context::stop_on_interrupt()?;
    // Before it listens itself.
    let of_system = examine_system();
    let is_live = !matches!(endpoint, Endpoint::Capture { .. });
    let listener = Listener::open(endpoint, &options)?;
    if is_live {
        let seconds = arguments.duration.as_secs_f64();
        say(format_args!("examining {} for {seconds} s", listener.endpoint()));
    }
    let mut listened = listener.listen(arguments.duration, &stop)?;
    let is_relevant = |finding: &Finding| is_live && finding.severity() != Severity::Note;
    listened.findings.extend(of_system.into_iter().filter(is_relevant));
    listened.findings.sort_by_key(Finding::severity);
    Ok(listened)
}

/// What neither is live nor was has no stream, and what is live has no sources to choose from.
fn refuse(endpoint: &Endpoint, arguments: &Doctor) -> Result<(), Usage> {
    let is_capture = matches!(endpoint, Endpoint::Capture { .. });
    if arguments.only.is_some() && !is_capture {
        return Err(Usage {
            problem: "--only is for recordings and captures, and the source is a live stream".to_owned(),
            help: "leave --only out".to_owned(),
        });
    }
    let help = match endpoint {
        Endpoint::File { .. } => format!("posewire inspect {endpoint} --verify says whether it agrees with itself"),
        Endpoint::Synthetic(_) => "posewire demo shows the walker".to_owned(),
        _ => return Ok(()),
    };
    Err(Usage {
        problem: format!("expected a live stream or a capture, as mxtp://0.0.0.0:9763, found {endpoint}"),
        help,
    })
}

fn end(examined: &Listened) -> End {
    let is_loss = |finding: &&Finding| finding.check == Check::KernelDrops;
    let broken = examined
        .findings
        .iter()
        .filter(|finding| finding.severity() == Severity::Broken);
    if broken.filter(|finding| !is_loss(finding)).count() > 0 {
        End::Broken
    } else {
        End::with_lost(examined.lost_here)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_lost_here_alone_ends_in_its_own_code() {
        let whole = Listened::default();
        assert_eq!(end(&whole), End::Done);
        let lost = Listened {
            lost_here: 7,
            ..Listened::default()
        };
        assert_eq!(end(&lost), End::LostData);
    }
}

//! The datagram types that go to MXTP targets.

use crate::cli;
use crate::context::say;
use crate::error::Usage;
use posewire::sink::MxtpSink;
use posewire::source::Preview;
use posewire_mxtp::MessageType;
use posewire_mxtp::motion::{MessageTypes, lacks};

/// The types asked for. `all` leaves out what the source cannot give and says so; a type asked for by number is refused
/// when the source cannot give it.
pub(super) fn choose(text: &str, preview: Option<&Preview>) -> anyhow::Result<MessageTypes> {
    let wanted = parse_types(text)?;
    let mut types = MessageTypes::NONE;
    for message_type in wanted.iter() {
        let why = preview.and_then(|preview| preview.first.iter().find_map(|frame| lacks(frame, message_type)));
        match why {
            None => types = types.with(message_type),
            Some(why) if text == "all" => say(format_args!("leaving out {}: it has {why}", describe(message_type))),
            Some(why) => return Err(cannot_give(message_type, why)),
        }
    }
    Ok(types)
}

/// What the subjects of another system never have is refused only when it was asked for by number.
pub(super) fn refuse_unfitted(text: &str, types: MessageTypes) -> anyhow::Result<()> {
    if [cli::Stream::TYPES, "all"].contains(&text) {
        return Ok(());
    }
    match MxtpSink::NOT_FITTED.iter().find(|never| types.contains(*never)) {
        None => Ok(()),
        Some(never) => Err(cannot_give(never, "nothing of it, as NatNet does not carry it")),
    }
}

fn describe(message_type: MessageType) -> String {
    format!("type {message_type} ({})", message_type.name())
}

fn cannot_give(message_type: MessageType, why: &str) -> anyhow::Error {
    let problem = format!("cannot send {}: the source has {why}", describe(message_type));
    let help = format!("leave {message_type} out of --types, or use --types all to send whatever there is");
    Usage { problem, help }.into()
}

fn parse_types(text: &str) -> Result<MessageTypes, Usage> {
    let types = text.parse().unwrap_or(MessageTypes::NONE);
    let unknown = types
        .iter()
        .any(|message_type| !MessageTypes::ALL.contains(message_type));
    if types.is_empty() || unknown {
        return Err(Usage {
            problem: format!("expected datagram types with two digits and commas as --types, found {text:?}"),
            help: format!("use all, or some of {}", MessageTypes::ALL),
        });
    }
    Ok(types)
}

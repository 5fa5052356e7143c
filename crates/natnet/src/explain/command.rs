//! Which fields the commands have.

use super::walk::Walk;
use crate::MessageId;
use crate::command::{Response, Sender};

pub(super) fn command(walk: &mut Walk<'_>, id: MessageId) -> Option<()> {
    walk.enter("payload");
    match id {
        MessageId::CONNECT => connect(walk),
        MessageId::SERVER_INFO => server_info(walk),
        MessageId::DISCOVERY | MessageId::UNRECOGNIZED_REQUEST => optional_sender(walk),
        MessageId::REQUEST | MessageId::MESSAGE_STRING => text(walk),
        MessageId::RESPONSE => response(walk),
        MessageId::ECHO_REQUEST => walk.u64("client_ticks", "ticks").map(drop),
        MessageId::ECHO_RESPONSE => {
            walk.u64("client_ticks", "ticks")?;
            walk.u64("server_ticks", "ticks").map(drop)
        }
        _ => Some(()),
    }
}

fn connect(walk: &mut Walk<'_>) -> Option<()> {
    if walk.left().len() < Sender::SIZE {
        return text(walk);
    }
    sender(walk)?;
    if walk.left().len() >= 5 {
        walk.u8("subscribed_only")?;
        version(walk, "bitstream_version")?;
    }
    Some(())
}

fn server_info(walk: &mut Walk<'_>) -> Option<()> {
    sender(walk)?;
    if walk.left().len() < 15 {
        return Some(());
    }
    walk.u64("clock_frequency", "Hz")?;
    walk.u16("data_port")?;
    walk.u8("is_multicast")?;
    for n in 0..4 {
        walk.u8(format!("group[{n}]"))?;
    }
    Some(())
}

fn optional_sender(walk: &mut Walk<'_>) -> Option<()> {
    if walk.left().len() < Sender::SIZE {
        return Some(());
    }
    sender(walk)
}

fn sender(walk: &mut Walk<'_>) -> Option<()> {
    walk.enter("sender");
    walk.text("name", 256)?;
    version(walk, "app_version")?;
    version(walk, "natnet_version")?;
    walk.enter("payload");
    Some(())
}

fn version(walk: &mut Walk<'_>, name: &str) -> Option<()> {
    ["major", "minor", "build", "revision"]
        .into_iter()
        .try_for_each(|part| walk.u8(format!("{name}.{part}")).map(drop))
}

fn text(walk: &mut Walk<'_>) -> Option<()> {
    let left = walk.left();
    let end = left
        .iter()
        .position(|byte| *byte == 0)
        .map_or(left.len(), |end| end + 1);
    match end {
        0 => Some(()),
        length => walk.text("text", length),
    }
}

fn response(walk: &mut Walk<'_>) -> Option<()> {
    let left = walk.left();
    if left.len() != 4 {
        return text(walk);
    }
    let float = Response { bytes: left.to_vec() }.as_float()?;
    walk.i32("number")?;
    walk.note(format!("or {float}"));
    Some(())
}

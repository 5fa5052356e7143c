//! What to say about a server.

use std::net::SocketAddr;

use posewire_natnet::Version;
use posewire_natnet::client::{LostReason, Mode};
use posewire_natnet::command::ServerInfo;
use posewire_natnet::model::{Description, Model};

use crate::endpoint::NatNetAddress;

/// `Motive 3.1, NatNet 4.1, at 10.0.0.5:1510`.
pub(super) fn named(server: SocketAddr, info: &ServerInfo) -> String {
    let sender = &info.server;
    let name = sender.name.to_string().replace(char::is_control, "\u{fffd}");
    let name = if name.is_empty() { "a nameless server" } else { &name };
    let (app, natnet) = (sender.app_version, sender.natnet_version);
    format!("{name} {app}, NatNet {natnet}, at {server}")
}

/// The endpoint to use when the server says that it sends its frames another way.
pub(super) fn better(address: &NatNetAddress, info: &ServerInfo) -> Option<NatNetAddress> {
    let connection = info.connection?;
    let mut better = NatNetAddress {
        mode: Mode::Unicast,
        group: NatNetAddress::GROUP,
        ..address.clone()
    };
    if connection.is_multicast {
        better.mode = Mode::Multicast;
        better.group = connection.group;
        better.data_port = connection.data_port;
    }
    (better != *address).then_some(better)
}

/// The way that the server says it sends its frames, and the endpoint for it.
pub(super) fn of_delivery(better: &NatNetAddress) -> String {
    let says = match better.mode {
        Mode::Multicast => format!("to the group {}:{}", better.group, better.data_port),
        Mode::Unicast => "to each client by itself".to_owned(),
    };
    format!("the server says that it sends {says}: use {better}")
}

/// A server that has not answered, and whose frames do not come either.
pub(super) fn of_nobody(server: SocketAddr) -> String {
    format!("no answer from {server} yet, asking on: is Motive streaming, and is that its Local Interface?")
}

/// What the server sends instead of the version that it was asked for, if it does.
pub(super) fn of_version(address: &NatNetAddress, sent: Version) -> Option<String> {
    let wish = address.version.filter(|wish| *wish != sent)?;
    let why = match address.mode {
        Mode::Multicast => "as everybody in a group gets the same",
        Mode::Unicast => "and is read so",
    };
    Some(format!(
        "NatNet {wish} was asked for, but the server sends {sent}, {why}"
    ))
}

/// Frames of a server that does not answer are of no known version.
pub(super) fn of_unread_frames() -> String {
    "frames come, but no server answers that says their version: name it, as in version=3.1".to_owned()
}

/// Why the server is lost.
pub(super) const fn of_loss(reason: LostReason) -> &'static str {
    match reason {
        LostReason::Silent => "nothing comes from it any more",
        LostReason::TimedOut => "it has heard nothing from us for too long",
        LostReason::Closed => "it has ended the connection",
    }
}

/// What a server describes that is no motion.
pub(super) fn of_model(model: &Model) -> Option<String> {
    let count = |is: fn(&Description) -> bool| model.descriptions.iter().filter(|one| is(one)).count();
    let all = [
        (count(|one| matches!(one, Description::ForcePlate(_))), "force plate"),
        (count(|one| matches!(one, Description::Device(_))), "device"),
        (count(|one| matches!(one, Description::Camera(_))), "camera"),
        (
            count(|one| matches!(one, Description::Unknown { .. })),
            "unknown description",
        ),
    ];
    let found = all.into_iter().filter(|(count, _)| *count > 0);
    let listed: Vec<_> = found.map(|(count, what)| plural(count, what)).collect();
    (!listed.is_empty()).then(|| format!("left out, as they are no motion: {}", listed.join(", ")))
}

/// Frames in which nothing moves that has a name of its own.
pub(super) fn of_marker_sets() -> String {
    "left out: frames hold only marker sets, of which no sample is made; turn on Rigid Bodies, Skeletons or Labeled Markers in \
     Motive"
        .to_owned()
}

fn plural(count: usize, what: &str) -> String {
    let s = if count == 1 { "" } else { "s" };
    format!("{count} {what}{s}")
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use posewire_natnet::command::ConnectionInfo;

    use super::*;
    use crate::endpoint::Endpoint;

    fn address(text: &str) -> NatNetAddress {
        match text.parse() {
            Ok(Endpoint::NatNet(address)) => address,
            other => panic!("{other:?}"),
        }
    }

    fn info(group: Option<Ipv4Addr>) -> ServerInfo {
        let connection = ConnectionInfo {
            clock_frequency: 1,
            data_port: 1600,
            is_multicast: group.is_some(),
            group: group.unwrap_or(NatNetAddress::GROUP),
        };
        ServerInfo {
            connection: Some(connection),
            ..ServerInfo::default()
        }
    }

    #[test]
    fn a_server_that_sends_another_way_is_answered_with_the_endpoint_that_it_wants() {
        let group = Some(Ipv4Addr::new(239, 1, 1, 1));
        let unicast = address("natnet://h?up=z");
        let of_delivery =
            |address: &NatNetAddress, info: &ServerInfo| better(address, info).map(|better| of_delivery(&better));
        let said = of_delivery(&unicast, &info(group)).unwrap();
        let wanted = "natnet://h:1510?mode=multicast&data-port=1600&group=239.1.1.1&up=z";
        assert!(
            said.ends_with(&format!("to the group 239.1.1.1:1600: use {wanted}")),
            "{said}"
        );
        assert_eq!(of_delivery(&address(wanted), &info(group)), None);
        assert_eq!(of_delivery(&unicast, &info(None)), None);
        assert_eq!(of_delivery(&unicast, &ServerInfo::default()), None);
        let said = of_delivery(&address("natnet://h?mode=multicast"), &info(None)).unwrap();
        assert!(said.ends_with("use natnet://h:1510?mode=unicast"), "{said}");
    }

    #[test]
    fn a_server_that_says_who_it_is_cannot_steer_a_terminal() {
        let mut info = ServerInfo::default();
        info.server.name = "Mo\u{1b}tive".into();
        let at: SocketAddr = ([10, 0, 0, 5], 1510).into();
        assert_eq!(named(at, &info), "Mo\u{fffd}tive 0.0, NatNet 0.0, at 10.0.0.5:1510");
    }
}

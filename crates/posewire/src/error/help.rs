//! What to do about what went wrong.

use super::{Error, listed};
use std::io;

impl Error {
    /// What to do about the error, as one sentence without a full stop, where there is something
    /// to do.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Url { part, .. } => Some(url_help(part)),
            Self::UnknownOption { known: [], .. } => Some("remove the part after the ?".into()),
            Self::UnknownOption { known, .. } => Some(format!("use {}", listed(known))),
            Self::UnknownScheme { known, .. } => Some(format!("use {}, or the path of a file", listed(known))),
            Self::NotSupportedYet { .. } => {
                Some("use mxtp://, mxtp+tcp://, natnet://, synthetic:walk or an .mvnx file".into())
            }
            Self::Proprietary { .. } => Some("open the take in MVN, export it as MVNX and use the .mvnx file".into()),
            Self::UnknownFormat { path, .. } => Some(path_help(path)),
            Self::Resolve { host, .. } => Some(format!("check the spelling of {host:?}, or use the numeric address")),
            Self::SeveralServers { .. } => Some("name one of them, as in natnet://HOST:1510".into()),
            Self::SeveralSources => Some("stream each by itself, to targets of its own".into()),
            Self::Interface { available, .. } => Some(format!("this machine has: {}", available.join(", "))),
            Self::Socket {
                action, address, kind, ..
            } => socket_help(action, address, *kind),
            Self::Stalled { peer, .. } => Some(format!("check that the program at {peer} reads its connection")),
            Self::Read { kind, .. } => read_help(*kind),
            Self::Take { error, frames, .. } => Some(take_help(error, *frames).into()),
            Self::NotACapture { .. } => Some("record one: posewire record mxtp://0.0.0.0:9763 -o take.mcap".into()),
            Self::NoDatagrams { .. } => {
                Some("posewire explain FILE --protocol mxtp takes every datagram for MXTP".into())
            }
            Self::PosesAlone { path } => Some(format!(
                "posewire stream {} --to mxtp://127.0.0.1 sends them; what is recorded there has datagrams",
                path.display()
            )),
            Self::CapturedSources { .. } => Some("choose one by number or name, as in --only 0".into()),
            Self::NothingForTarget { path, endpoint, .. } => Some(format!(
                "posewire stream {} --to \"{endpoint}\" reads it and sends that, in datagrams of its own",
                path.display()
            )),
            Self::NothingInTime { .. } => Some("--from and --until are seconds after its first datagram".into()),
            Self::MissingPart { .. } => Some(
                "put it beside the others; a later part, or the first in a folder of its own, is read alone".into(),
            ),
            Self::CaptureRate { .. } => Some("leave --rate out; --speed plays it faster or slower".into()),
            Self::TooLongForIp { .. } => None,
            Self::NoFrames { .. } => Some("posewire inspect says what it holds; export it again from MVN".into()),
            Self::Rate { .. } => Some("leave --rate out to send every sample".into()),
            Self::NotATarget { .. } => {
                Some("give a network address, as in --to mxtp://127.0.0.1:9763; posewire convert writes files".into())
            }
            Self::Descriptions { .. } => Some("stream fewer people to NatNet".into()),
            Self::Character { .. } => Some("start at a lower --character, or stream fewer people".into()),
            Self::Write { kind, .. } => Some(write_help(*kind).into()),
            Self::Format { .. } => Some("name one of these, as in --format csv".into()),
            Self::WriteOnly { .. } => Some("give the .mvnx file that it was made from".into()),
            Self::Fixed { what, .. } => Some(format!(
                "leave the {what} out, or choose a format that is free in it, as CSV is"
            )),
            Self::Lacks { .. } => Some("posewire inspect says what the take holds".into()),
            Self::NoSection { .. } => Some("leave it out: the poses do not tell it".into()),
            Self::NoSamples { .. } => Some("posewire inspect says which samples a take has".into()),
            Self::NewRate { .. } => Some("leave the rate out to keep every sample".into()),
            Self::Exists { .. } => Some("choose another name, or replace it with --overwrite".into()),
            Self::OntoItself { .. } => Some("write to another file: this one is read, and would be lost".into()),
            Self::BeingRecorded { .. } => Some("end that recording first, or choose another name".into()),
            Self::Removed { .. } => {
                Some("what was in it is lost: record anew, and leave the file alone meanwhile".into())
            }
            Self::TakeRuns { .. } => Some("end it first".into()),
            Self::TooManyTargets { .. } => Some("start the stream anew, or send to a multicast group".into()),
            Self::Stopped { .. } => Some("nothing was left half written; start again when you like".into()),
            Self::Feature { feature, .. } => Some(format!("cargo install --path crates/cli --features {feature}")),
            Self::NotAsRecorded { path, .. } => Some(format!(
                "name it {0}; posewire convert {0} {1} makes the other of it",
                path.with_extension("mcap").display(),
                path.display()
            )),
            Self::NotMcap { .. } => Some("give a file that posewire record has written".into()),
            Self::DamagedWithin { .. } => Some("-o FILE writes what comes before the damage to another file".into()),
            Self::Compressed { .. } => {
                Some("mcap compress --compression none, a tool of mcap.dev, writes it anew".into())
            }
            Self::Speed { .. } => Some("1 is real time, 0.5 half as fast".into()),
            Self::Faults { .. } => Some("as in --faults loss=1%,reorder=0.5%,reset@10s,seed=7".into()),
        }
    }
}

fn url_help(part: &str) -> String {
    match part {
        "host" | "port" | "address" => "write HOST, HOST:PORT or [IPV6]:PORT, as in mxtp://127.0.0.1:9763".into(),
        "server" => "name the server, with the group behind it: natnet://SERVER?mode=multicast&group=GROUP".into(),
        "interface" => "name it as the system does, as in interface=eth0, or by address".into(),
        "generator" => "write synthetic:walk, as in synthetic:walk?people=2&rate=240".into(),
        "scheme" => "write mxtp://HOST:PORT, mxtp+tcp://HOST:PORT or synthetic:walk".into(),
        "mode of a group" => "add mode=multicast, or leave group out".into(),
        "mode of copies" => "leave copy out: everybody in a group gets its frames".into(),
        "copy of a source" => "leave copy out, which is for servers, behind --to".into(),
        option => format!("correct {option}, or leave it out for its default"),
    }
}

/// An address without a scheme is the likely mistake when a "path" looks like one.
fn path_help(path: &str) -> String {
    let looks_like_address = path
        .rsplit_once(':')
        .is_some_and(|(_, port)| port.parse::<u16>().is_ok())
        || path.parse::<std::net::IpAddr>().is_ok();
    if looks_like_address {
        format!("for a network address write mxtp://{path}")
    } else {
        "give an .mvnx file, mxtp://HOST:PORT, or synthetic:walk".into()
    }
}

fn write_help(kind: io::ErrorKind) -> &'static str {
    match kind {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "ask for the right to write there, or write elsewhere"
        }
        io::ErrorKind::NotFound => "make the folder first, or write elsewhere",
        io::ErrorKind::IsADirectory | io::ErrorKind::InvalidInput => "name a file",
        io::ErrorKind::InvalidFilename => "choose a shorter name",
        _ => "make room there, or send the output elsewhere",
    }
}

fn take_help(error: &posewire_mvnx::Error, frames: u64) -> &'static str {
    use posewire_mvnx::Error;
    match error {
        Error::Binary { .. } => "open the take in MVN, export it as MVNX and use the .mvnx file",
        Error::Empty | Error::NotMvnx { .. } => "give a take that was exported from MVN as MVNX",
        Error::Version { .. } => "open the take in a current MVN and export it again as MVNX",
        _ if frames > 0 => "--salvage uses the frames before the damage; exporting again from MVN may mend it",
        Error::Io { .. } | Error::Truncated { .. } => {
            "export the take again from MVN: there is no whole frame before the damage"
        }
        _ => "export the take again from MVN, or mend the file at that place",
    }
}

fn read_help(kind: io::ErrorKind) -> Option<String> {
    match kind {
        io::ErrorKind::NotFound => Some("check the path; a name with spaces needs quotes".into()),
        io::ErrorKind::PermissionDenied => Some("ask for the right to read it".into()),
        io::ErrorKind::IsADirectory => Some("name a file in this folder".into()),
        _ => None,
    }
}

fn socket_help(action: &str, address: &str, kind: io::ErrorKind) -> Option<String> {
    let place = address.split_once(' ').map_or(address, |(_, place)| place);
    let text = match kind {
        io::ErrorKind::AddrInUse if action == Error::SERVE_COMMANDS => {
            format!(
                "another program, such as Motive, has {place}: stop it, or choose other ports as in \
                 natnet://HOST:1520?data-port=1521"
            )
        }
        io::ErrorKind::AddrInUse if action == Error::SERVE_FRAMES => {
            format!(
                "another program has {place}: stop it, or choose other ports as in natnet://HOST:1520?data-port=1521"
            )
        }
        io::ErrorKind::InvalidInput if place.ends_with(":0") => {
            "name the port, as Motive's 1510 or MVN's 9763, or leave it out for that".into()
        }
        io::ErrorKind::AddrInUse => {
            format!("another program listens on {place}: stop it or choose another port")
        }
        io::ErrorKind::AddrNotAvailable => {
            format!("{place} is not an address of this machine: use one of its own, or 0.0.0.0 for all")
        }
        io::ErrorKind::PermissionDenied => {
            "ports below 1024 and some interfaces need privileges: use another port, or check the \
             firewall"
                .into()
        }
        io::ErrorKind::NetworkUnreachable | io::ErrorKind::HostUnreachable => {
            format!("no route leads to {place}: check the cable, the address and the network mask")
        }
        io::ErrorKind::ConnectionRefused => {
            format!("nothing listens on {place}: start the receiving program first, or check the port")
        }
        io::ErrorKind::TimedOut => {
            format!("{place} does not answer: check the address, and that no firewall is in the way")
        }
        _ => return None,
    };
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_in_use_names_the_address_and_the_way_out() {
        let refusal = io::Error::from_raw_os_error(98);
        let error = Error::Socket {
            action: "listen on",
            address: "udp 127.0.0.1:9763".into(),
            kind: io::ErrorKind::AddrInUse,
            reason: super::super::reason(&refusal),
        };
        assert!(error.to_string().starts_with("cannot listen on udp 127.0.0.1:9763: "));
        assert!(!error.to_string().contains("os error"));
        assert_eq!(
            error.help().as_deref(),
            Some("another program listens on 127.0.0.1:9763: stop it or choose another port")
        );
    }

    #[test]
    fn a_taken_port_of_motive_is_answered_with_two_others() {
        for action in [Error::SERVE_COMMANDS, Error::SERVE_FRAMES] {
            let help = socket_help(action, "udp 0.0.0.0:1510", io::ErrorKind::AddrInUse).unwrap();
            assert!(help.ends_with("natnet://HOST:1520?data-port=1521"), "{help}");
        }
        let help = socket_help("connect to", "udp 10.0.0.7:0", io::ErrorKind::InvalidInput);
        assert!(help.is_some_and(|help| help.starts_with("name the port")));
    }

    #[test]
    fn an_address_given_as_a_path_is_offered_as_a_url() {
        let error = Error::UnknownFormat {
            path: "192.168.1.5:9763".into(),
            known: &[".mvnx"],
        };
        assert_eq!(
            error.help().as_deref(),
            Some("for a network address write mxtp://192.168.1.5:9763")
        );
    }
}

//! Everything that is looked for, by name.

use super::Severity;
use super::Severity::{Broken, Note, Warning};
use std::fmt;

/// Something that is looked for. docs/troubleshooting.md lists each by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Check {
    /// Nothing that is readable came.
    NothingArrives,
    /// The port belongs to another program.
    PortTaken,
    /// The sender uses TCP where UDP is listened to, or the other way round.
    OtherTransport,
    /// Something came to another port that is usual for motion capture.
    OtherPort,
    /// Datagrams of another protocol.
    WrongProtocol,
    /// No NatNet server answers.
    NoAnswer,
    /// A NatNet server sends its frames another way than they are awaited.
    OtherDelivery,
    /// Frames that cannot be read as the version that the server says, or another version than was asked for.
    VersionTrap,
    /// Messages, but none with a pose.
    NoPose,
    /// Frames with nothing in them that moves.
    NoSubjects,
    /// Two senders of the same character, or to the same group.
    TwoSenders,
    /// Lengths that no body has in metres.
    WrongUnit,
    /// A body that stands along another axis than up.
    WrongUpAxis,
    /// A head below the feet.
    UpsideDown,
    /// Quaternions with their parts in another order, or turned round.
    QuaternionOrder,
    /// Quaternions that are no rotation.
    QuaternionNorm,
    /// Bones given relative to their parents and read as in the world, or the other way round.
    RelativeBones,
    /// Numbers that are infinite or no number.
    NotFinite,
    /// Datagrams that this machine dropped.
    KernelDrops,
    /// Orientations that contradict the positions.
    OrientationMismatch,
    /// Messages that are missing.
    Loss,
    /// Datagrams that cannot be read.
    Malformed,
    /// More or fewer samples a second than the stream says.
    RateOff,
    /// The sender's clock, or ours, made a leap.
    ClockJump,
    /// Frames and descriptions do not go together.
    StaleModel,
    /// Something that is described and not seen.
    Untracked,
    /// A server that takes long.
    Latency,
    /// A receive buffer that is full after a short pause.
    ReceiveBuffer,
    /// A firewall that is switched on.
    Firewall,
    /// Only the loopback is up.
    NoNetwork,
    /// A body that lies, if its axes are right.
    Lying,
    /// The sender's time of day is another than ours.
    ClocksDiffer,
    /// Messages that come in bursts.
    UnevenArrival,
    /// Messages that come twice.
    Duplicates,
    /// A counter that began anew or leapt.
    SenderRestarts,
    /// Datagrams that IP cuts up.
    LargeDatagrams,
    /// Names or proportions that never came.
    NoDescription,
    /// Datagram types that are not known.
    UnknownType,
    /// Deviations from the specification.
    Quirks,
    /// What arrives.
    Stream,
    /// Who listens at a port of motion capture.
    Listener,
    /// The addresses of this machine.
    Interfaces,
    /// The groups that this machine has joined.
    MulticastGroups,
    /// Whether there is a firewall cannot be told.
    FirewallUnknown,
    /// What sets the clock.
    ClockSync,
    /// What this system does not tell.
    CannotTell,
}

/// What is to be said of a check.
struct Entry {
    check: Check,
    name: &'static str,
    severity: Severity,
    why: &'static str,
    remedy: &'static str,
}

impl Check {
    /// How many there are.
    pub const COUNT: usize = TABLE.len();

    /// All of them, the worst first.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|entry| entry.check)
    }

    /// The stable name, in kebab case: `two-senders`.
    pub const fn name(self) -> &'static str {
        self.entry().name
    }

    /// How bad it is when it is found.
    pub const fn severity(self) -> Severity {
        self.entry().severity
    }

    /// Why it matters, in a sentence.
    pub const fn why(self) -> &'static str {
        self.entry().why
    }

    /// What is usually to be done about it, in sentences.
    pub const fn remedy(self) -> &'static str {
        self.entry().remedy
    }

    /// Whether it is told by the numbers and times of what comes one after the other.
    pub(super) const fn is_of_numbering(self) -> bool {
        matches!(
            self,
            Self::Loss
                | Self::RateOff
                | Self::ClockJump
                | Self::UnevenArrival
                | Self::Duplicates
                | Self::SenderRestarts
        )
    }

    const fn entry(self) -> &'static Entry {
        &TABLE[self as usize]
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

const fn entry(check: Check, name: &'static str, severity: Severity, why: &'static str, remedy: &'static str) -> Entry {
    Entry {
        check,
        name,
        severity,
        why,
        remedy,
    }
}

/// In the order of the enumeration.
const TABLE: [Entry; 46] = [
    entry(
        Check::NothingArrives,
        "nothing-arrives",
        Broken,
        "Without datagrams there is no motion.",
        "Look at what is not excluded, from the first on.",
    ),
    entry(
        Check::PortTaken,
        "port-taken",
        Broken,
        "Only one program gets what comes to a port.",
        "End that program, or let the sender use another port and name it in the URL.",
    ),
    entry(
        Check::OtherTransport,
        "other-transport",
        Broken,
        "UDP and TCP are separate: what comes by one is not heard by the other.",
        "Use the URL of the transport that the sender uses, or set the sender to the other.",
    ),
    entry(
        Check::OtherPort,
        "other-port",
        Broken,
        "What comes to one port is not heard at another.",
        "Name that port in the URL, or set the sender to this one.",
    ),
    entry(
        Check::WrongProtocol,
        "wrong-protocol",
        Broken,
        "What is not of the protocol is not read, and may hide what is.",
        "Let that sender use another port, or use the URL of its protocol.",
    ),
    entry(
        Check::NoAnswer,
        "no-answer",
        Broken,
        "A NatNet server must answer before its frames can be read.",
        "In Motive, Settings > Streaming: Enable; as Local Interface the network that this machine is in. Let UDP 1510 \
         through the firewall there.",
    ),
    entry(
        Check::OtherDelivery,
        "other-delivery",
        Broken,
        "Unicast and multicast frames come to different addresses.",
        "Use the URL that fits the server, or change Transmission Type in Motive.",
    ),
    entry(
        Check::VersionTrap,
        "version-trap",
        Broken,
        "A frame does not say its version; read as the wrong one it is nonsense.",
        "Ask for another version, as in ?version=3.1, or take the one that the server sends.",
    ),
    entry(
        Check::NoPose,
        "no-pose",
        Broken,
        "Without a pose nothing can be shown or followed.",
        "In MVN's Network Streamer, tick Position + Orientation (Quaternion), type 02.",
    ),
    entry(
        Check::NoSubjects,
        "no-subjects",
        Broken,
        "Empty frames are no motion.",
        "In Motive, turn on Rigid Bodies, Skeletons or Labeled Markers in Settings > Streaming, and tick the assets.",
    ),
    entry(
        Check::TwoSenders,
        "two-senders",
        Broken,
        "Their samples mix: figures leap between two poses, and counters mean nothing.",
        "Stop one of them, or give each a port, a group or a character number of its own.",
    ),
    entry(
        Check::WrongUnit,
        "wrong-unit",
        Broken,
        "Everything that follows takes lengths for metres.",
        "Let the sender send what the specification says: metres, and in types 01 and 03 centimetres.",
    ),
    entry(
        Check::WrongUpAxis,
        "wrong-up-axis",
        Broken,
        "People lie on their sides, and heights and directions are wrong.",
        "Let the sender send what the specification says: Z up, and in types 01, 03 and 05 Y up.",
    ),
    entry(
        Check::UpsideDown,
        "upside-down",
        Broken,
        "Unless that is a handstand, an axis points the wrong way.",
        "Look at the axes of the sender. Stand upright and look again.",
    ),
    entry(
        Check::QuaternionOrder,
        "quaternion-order",
        Broken,
        "Positions look right and every limb is turned wrongly.",
        "MXTP has w first and turns from the segment to the world; change it in the sender.",
    ),
    entry(
        Check::QuaternionNorm,
        "quaternion-norm",
        Broken,
        "A rotation has length 1; others scale and shear what they turn.",
        "Normalise them in the sender. Zeros mostly stand for what was not tracked.",
    ),
    entry(
        Check::RelativeBones,
        "relative-bones",
        Broken,
        "All limbs lie in a heap at the origin.",
        "Add ?skeleton=local, or choose Global as Skeleton Coordinates in Motive.",
    ),
    entry(
        Check::NotFinite,
        "not-finite",
        Broken,
        "One such number makes everything computed from it useless.",
        "Look at the sender; MVN and Motive never send them.",
    ),
    entry(
        Check::KernelDrops,
        "kernel-drops",
        Broken,
        "They arrived at this machine and were lost here.",
        "Raise the limit of the receive buffer: sysctl -w net.core.rmem_max=8388608. Let less run beside it.",
    ),
    entry(
        Check::OrientationMismatch,
        "orientation-mismatch",
        Warning,
        "Either the positions or the orientations are not those of one body.",
        "Compare the sender's axes and its T-pose, in which every orientation is to be the identity.",
    ),
    entry(
        Check::Loss,
        "loss",
        Warning,
        "Motion stutters, and a recording has holes.",
        "Prefer a cable to Wi-Fi, or TCP to UDP. MVN itself leaves out samples when it is busy.",
    ),
    entry(
        Check::Malformed,
        "malformed",
        Warning,
        "What cannot be read is lost.",
        "Record some of it and look: posewire explain take.mcap.",
    ),
    entry(
        Check::RateOff,
        "rate-off",
        Warning,
        "Whoever counts samples gets time and speed wrong.",
        "Look at the speed of the playback in the sender, and at how busy its machine is.",
    ),
    entry(
        Check::ClockJump,
        "clock-jump",
        Warning,
        "What is timed by that clock has a hole or an overlap there.",
        "Let both clocks be set by NTP or PTP before the capture begins, and not during it.",
    ),
    entry(
        Check::StaleModel,
        "stale-model",
        Warning,
        "What is not described has no name and no bones; what is only described never moves.",
        "Untick and tick the assets in Motive; connect again.",
    ),
    entry(
        Check::Untracked,
        "untracked",
        Warning,
        "What is not seen has no pose.",
        "Look at the cameras and the markers, and whether the asset is the right one.",
    ),
    entry(
        Check::Latency,
        "latency",
        Warning,
        "Whoever follows the motion is behind by as much.",
        "Stream fewer data types, and let less run on the server.",
    ),
    entry(
        Check::ReceiveBuffer,
        "receive-buffer",
        Warning,
        "While a program is busy the kernel keeps what comes, as long as there is room.",
        "sysctl -w net.core.rmem_max=8388608, and the same line in /etc/sysctl.d/ for good.",
    ),
    entry(
        Check::Firewall,
        "firewall",
        Warning,
        "A firewall drops what comes without a word.",
        "Let the ports in that you listen to, UDP and TCP each by a rule of its own.",
    ),
    entry(
        Check::NoNetwork,
        "no-network",
        Warning,
        "Nothing can come from another machine.",
        "Plug in the cable, join the Wi-Fi, or give a container the network of its host.",
    ),
    entry(
        Check::Lying,
        "lying",
        Note,
        "When nobody lies, the up axis of the sender is wrong.",
        "Stand upright and look again.",
    ),
    entry(
        Check::ClocksDiffer,
        "clocks-differ",
        Note,
        "Several systems cannot be brought together by their time of day.",
        "Nothing, when a recording is played: the time is that of the recording. Otherwise set both clocks by the same NTP or \
         PTP server.",
    ),
    entry(
        Check::UnevenArrival,
        "uneven-arrival",
        Note,
        "Who shows each sample as it comes sees it stutter.",
        "Prefer a cable to Wi-Fi; buffer for as long as the longest gap.",
    ),
    entry(
        Check::Duplicates,
        "duplicates",
        Note,
        "Each is used once; many of them point to two ways between the machines.",
        "Let the sender use one address of this machine, and a group or that, not both.",
    ),
    entry(
        Check::SenderRestarts,
        "sender-restarts",
        Note,
        "A new recording or a rewind begins a new numbering, and is no loss.",
        "Nothing, when somebody did that. Otherwise look for a second sender.",
    ),
    entry(
        Check::LargeDatagrams,
        "large-datagrams",
        Note,
        "IP cuts them up; when one piece is lost all are, and some routers drop pieces.",
        "Nothing, as long as none is missing. Otherwise stream without fingers, or fewer data types.",
    ),
    entry(
        Check::NoDescription,
        "no-description",
        Note,
        "Some clients wait for it, and without it names or proportions are guessed.",
        "Stream types 12 and 13 as well; MVN does by itself. Listen longer: they come about once a second.",
    ),
    entry(
        Check::UnknownType,
        "unknown-type",
        Note,
        "It is passed over.",
        "Nothing, as long as the rest is there.",
    ),
    entry(
        Check::Quirks,
        "quirks",
        Note,
        "The sender deviates from the specification, and is understood all the same.",
        "Nothing here. Other receivers may be less patient.",
    ),
    entry(
        Check::Stream,
        "stream",
        Note,
        "It is what you have to work with.",
        "Nothing.",
    ),
    entry(
        Check::Listener,
        "listener",
        Note,
        "What comes to that port goes there, and nobody else can listen to it.",
        "Nothing, if it is meant to.",
    ),
    entry(
        Check::Interfaces,
        "interfaces",
        Note,
        "One of these addresses is where the sender must send to.",
        "Enter the one in the sender's network, in MVN under Options > Preferences > Network Streamer.",
    ),
    entry(
        Check::MulticastGroups,
        "multicast-groups",
        Note,
        "What is sent to a group comes only to interfaces that have joined it.",
        "If the interface is not the one to the sender, name it: ?interface=NAME.",
    ),
    entry(
        Check::FirewallUnknown,
        "firewall-unknown",
        Note,
        "A firewall drops what comes without a word, and its rules are for the administrator to see.",
        "As administrator: nft list ruleset, iptables -S or ufw status.",
    ),
    entry(
        Check::ClockSync,
        "clock-sync",
        Note,
        "Stamps of several machines agree only when their clocks do.",
        "chronyc tracking or timedatectl say how well it is set.",
    ),
    entry(
        Check::CannotTell,
        "cannot-tell",
        Note,
        "What is not looked at may be the reason.",
        "Use the system's own tools, as netstat.",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_check_has_its_entry_and_the_worst_come_first() {
        for (place, check) in Check::all().enumerate() {
            assert_eq!(check as usize, place, "{check}");
            assert!(check.why().ends_with('.') && check.remedy().ends_with('.'), "{check}");
        }
        assert!(TABLE.is_sorted_by_key(|entry| entry.severity));
        assert_eq!(Check::CannotTell as usize + 1, Check::COUNT);
    }

    #[test]
    fn the_page_on_troubles_lists_every_check_and_no_other() {
        let page = include_str!("../../../../docs/troubleshooting.md");
        let (_, findings) = page.split_once("\n## What the doctor finds\n").expect("the section");
        let findings = findings.split("\n## ").next().unwrap_or_default();
        let rows = findings.lines().filter_map(|line| line.strip_prefix("| `"));
        let listed: Vec<_> = rows.map(|row| row.split(" | ").take(2).collect::<Vec<_>>()).collect();
        let known: Vec<_> = Check::all()
            .map(|check| vec![format!("{}`", check.name()), check.severity().to_string()])
            .collect();
        assert_eq!(listed, known);
    }
}

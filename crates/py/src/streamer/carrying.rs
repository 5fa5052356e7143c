//! What the protocols of a streamer carry: what is given is sent, or refused with a reason.

use crate::error::usage;
use posewire_motion::{Frame, Per, Section};
use posewire_mxtp::MessageType;
use posewire_mxtp::motion::{MessageTypes, carriers, has_place, lacks, needed_sections};
use pyo3::prelude::*;

/// What the targets of a streamer carry together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carrying {
    /// The datagram types that are sent, where a target is MXTP.
    pub(super) mxtp: Option<MessageTypes>,
    /// Whether a target is NatNet.
    pub(super) natnet: bool,
}

impl Carrying {
    /// The last number that a sample can have.
    pub(super) fn last_sample(self) -> u32 {
        if self.natnet { i32::MAX as u32 } else { u32::MAX }
    }

    /// Checks that every number of these sections of a frame goes out to some target.
    pub(super) fn check(self, frame: &Frame, given: &[Section]) -> PyResult<()> {
        given.iter().try_for_each(|section| self.check_section(frame, *section))
    }

    /// Checks that a timecode goes out.
    pub(super) fn check_timecode(self) -> PyResult<()> {
        match self.mxtp {
            Some(types) if !self.natnet && !types.contains(MessageType::TIME_CODE) => Err(not_among(
                "timecode",
                types,
                MessageTypes::NONE.with(MessageType::TIME_CODE),
            )),
            _ => Ok(()),
        }
    }

    fn check_section(self, frame: &Frame, section: Section) -> PyResult<()> {
        if self.natnet && matches!(section, Section::Position | Section::Orientation) {
            return check_entries(frame, section, &[MessageType::QUATERNION]);
        }
        let all = carriers(section);
        let Some(types) = self.mxtp.filter(|_| !all.is_empty()) else {
            return Err(no_place(section, all));
        };
        let asked: Vec<_> = all.iter().filter(|carrier| types.contains(*carrier)).collect();
        let Some(first) = asked.first() else {
            return Err(not_among(section.name(), types, all));
        };
        if section.per() == Per::Body && !has(frame, section) {
            return Ok(());
        }
        let is_whole = |carrier: &MessageType| missing(frame, *carrier).is_empty() && lacks(frame, *carrier).is_none();
        let whole: Vec<_> = asked.iter().copied().filter(is_whole).collect();
        if whole.is_empty() {
            return Err(alone(frame, section, *first));
        }
        check_entries(frame, section, &whole)
    }
}

fn missing(frame: &Frame, carrier: MessageType) -> Vec<Section> {
    needed_sections(frame, carrier)
        .filter(|section| !has(frame, *section))
        .collect()
}

fn has(frame: &Frame, section: Section) -> bool {
    !frame.entries(section).is_empty()
}

/// Checks that each entry that is known goes out in one of these types, for which the frame has the sections.
fn check_entries(frame: &Frame, section: Section, carriers: &[MessageType]) -> PyResult<()> {
    if section == Section::ErgonomicAngles && !is_all_or_nothing(frame) {
        return Err(usage(
            "expected all the ergonomic angles or none, found some that are NaN",
            "in datagrams of type 20 they can be told apart only when none is left out",
        ));
    }
    let goes = |place: usize, carrier: &MessageType| {
        section == Section::ErgonomicAngles
            || has_place(&frame.subject.skeleton, *carrier, section, place)
                && needed_sections(frame, *carrier).all(|needed| is_known(frame, needed, place))
    };
    let stays =
        |place: &usize| is_known(frame, section, *place) && !carriers.iter().any(|carrier| goes(*place, carrier));
    let found = (0..frame.entries(section).len()).find(stays);
    found.map_or(Ok(()), |place| Err(halved(frame, section, place, carriers[0])))
}

fn is_all_or_nothing(frame: &Frame) -> bool {
    let known = frame.ergonomic_angles.iter().flatten().count();
    known == 0 || known == frame.ergonomic_angles.len()
}

fn is_known(frame: &Frame, section: Section, place: usize) -> bool {
    frame.entries(section).is_tracked(place)
}

/// For a section that no target has a place for.
fn no_place(section: Section, carriers: MessageTypes) -> PyErr {
    if carriers.is_empty() {
        let help = match section {
            Section::JointAnglesXzy => "leave it out: joint_angles=, by the ZXY sequence, is what MXTP carries",
            Section::ErgonomicAnglesXzy => "leave it out: ergonomic_angles=, by the ZXY sequence, is what MXTP carries",
            _ => "leave it out",
        };
        return usage(
            format!("{section} is not sent: neither MXTP nor NatNet has a place for it"),
            help,
        );
    }
    usage(
        format!("{section} is not sent: NatNet has no place for it"),
        format!("leave it out, or send to an mxtp:// url as well: datagram type {carriers} carries it"),
    )
}

/// For what is in none of the types that are sent.
fn not_among(what: &str, types: MessageTypes, carriers: MessageTypes) -> PyErr {
    let best = if carriers.contains(MessageType::QUATERNION) {
        Some(MessageType::QUATERNION)
    } else {
        carriers.iter().next()
    };
    let more = best.map_or(types, |best| types.with(best));
    usage(
        format!("{what} is not sent: datagram type {carriers} carries it, and those that are sent are {types}"),
        format!("types=\"{more}\" sends it, and so does types=\"all\"; or leave it out"),
    )
}

/// For a section that its type cannot be sent with alone.
fn alone(frame: &Frame, section: Section, carrier: MessageType) -> PyErr {
    let missing = missing(frame, carrier);
    if missing.is_empty() {
        let reason = lacks(frame, carrier).unwrap_or("not what it takes");
        return usage(
            format!("{section} is not sent: datagram type {carrier} carries it, and the skeleton has {reason}"),
            "choose other types=",
        );
    }
    let names: Vec<_> = missing.iter().map(|section| section.name()).collect();
    usage(
        format!(
            "{section} is not sent: datagram type {carrier} carries it only together with {}",
            names.join(" and ")
        ),
        format!("give {}= as well; what is not tracked is NaN", names.join("= and ")),
    )
}

/// For an entry that is known, and not in all the sections that its type needs.
fn halved(frame: &Frame, section: Section, place: usize, carrier: MessageType) -> PyErr {
    let label = section.labels(&frame.subject.skeleton).nth(place).unwrap_or_default();
    let unknown = needed_sections(frame, carrier).find(|needed| !is_known(frame, *needed, place));
    match unknown {
        Some(unknown) => usage(
            format!("expected the {unknown} of {label} beside its {section}, found none"),
            "they are sent together or not at all: what is not tracked is NaN in both",
        ),
        None => usage(
            format!("the {section} of {label} is not sent: datagram type {carrier} has no fingers"),
            "make it NaN, or choose other types=",
        ),
    }
}

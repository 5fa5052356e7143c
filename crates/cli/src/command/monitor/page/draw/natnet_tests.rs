//! The page of a NatNet server.

use super::super::controls::{Controls, Pane};
use super::super::example::natnet as example;
use super::tests::{assert_shows, picture, with};
use posewire_natnet::Version;
use std::time::Duration;

const SMALL: (u16, u16) = (80, 24);
const LARGE: (u16, u16) = (160, 50);

fn select(id: u32, pane: Pane) -> Controls {
    Controls {
        selected: Some(id),
        ..with(pane)
    }
}

#[test]
fn the_server_its_frames_and_latencies_are_shown() {
    for size in [SMALL, LARGE] {
        let picture = picture(size, &example::view(), &with(Pane::Stream));
        assert_shows(
            &picture,
            &["14520 frames, 120.0 Hz", "4 subjects", "server", "positions", "subject"],
        );
        assert_shows(&picture, &["Motive 3.1   NatNet 4.1   10.0.0.7:1510   live"]);
        assert_shows(
            &picture,
            &[
                "unicast, arriving on 10.0.0.2 (eth0)",
                "describes 1 skeleton, 2 rigid bodies",
            ],
        );
        assert_shows(&picture, &["camera to host", "5.00", "host to here", "± 0.12"]);
        assert!(
            !picture.contains("character") && !picture.contains("datagram"),
            "{picture}"
        );
    }
}

#[test]
fn what_is_lost_stands_out_and_is_named() {
    let picture = picture(SMALL, &example::view(), &with(Pane::Stream));
    assert_shows(&picture, &["◔ PART", "✗ LOST", " 1 lost ", "1/2", "0/1"]);
    assert_shows(
        &picture,
        &["not tracked now: Hat", "1 of 2 segments not tracked: Chest"],
    );
}

#[test]
fn unknown_latencies_say_why() {
    let mut view = example::view();
    let server = view.server.as_mut().unwrap();
    server.latencies.camera_to_host = None;
    assert_shows(
        &picture(SMALL, &view, &with(Pane::Stream)),
        &["unknown: the cameras do not say when they exposed"],
    );
    let server = view.server.as_mut().unwrap();
    server.version = Version::new(2, 7);
    server.latencies.software = None;
    assert_shows(
        &picture(SMALL, &view, &with(Pane::Stream)),
        &["unknown: frames have no times of it before NatNet 3.0"],
    );
}

#[test]
fn positions_are_those_of_segments_and_of_markers() {
    let view = example::view();
    assert_shows(
        &picture(SMALL, &view, &with(Pane::Details)),
        &["Hip", "1.000", "✗ Chest", "not tracked"],
    );
    assert_shows(
        &picture(SMALL, &view, &select(1, Pane::Details)),
        &["Wand", "·Tip", "0.250"],
    );
    assert_shows(&picture(SMALL, &view, &select(3, Pane::Details)), &["·marker 50007"]);
}

#[test]
fn a_body_is_drawn_as_its_axes_and_loose_markers_as_dots() {
    let view = example::view();
    let wand = picture(SMALL, &view, &select(1, Pane::Figure));
    assert_shows(&wand, &["x", "y", "z", "⡇"]);
    let dots = picture(SMALL, &view, &select(3, Pane::Figure));
    assert!(dots.contains(|symbol| ('⠁'..='⣿').contains(&symbol)), "{dots}");
    assert_shows(
        &picture(SMALL, &view, &select(2, Pane::Figure)),
        &["Nothing of it is tracked"],
    );
}

#[test]
fn who_moves_no_more_is_stale_tracked_or_not() {
    let mut view = example::view();
    view.characters
        .iter_mut()
        .for_each(|one| one.age = Duration::from_secs(1));
    let shown = picture(SMALL, &view, &with(Pane::Stream));
    assert_eq!(shown.matches("◐ STALE").count(), 4, "{shown}");
    assert!(!shown.contains("not tracked now"), "{shown}");
}

#[test]
fn silence_is_explained_beside_what_the_server_says() {
    let mut view = example::view();
    view.characters.iter_mut().for_each(|one| one.frame = None);
    view.hint = Some("Motive answers, but no frames come".to_owned());
    view.remarks = vec!["use natnet://10.0.0.7:1510?mode=multicast".to_owned()];
    let shown = picture(SMALL, &view, &with(Pane::Stream));
    assert_shows(
        &shown,
        &["NatNet 4.1", "○ WAIT", "but no frames come", "?mode=multicast"],
    );
}

#[test]
fn a_server_that_has_gone_is_a_problem() {
    let mut view = example::view();
    view.server.as_mut().unwrap().connected = false;
    let shown = picture(LARGE, &view, &with(Pane::Stream));
    assert_shows(&shown, &["✗ does not answer", "the server does not answer any more"]);
}

#[test]
fn no_size_is_too_small() {
    let mut view = example::view();
    for help in [false, true] {
        for size in [1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144]
            .into_iter()
            .flat_map(|width| [1, 2, 3, 5, 8, 13, 21, 34, 55].map(|height| (width, height)))
        {
            for (pane, id) in Pane::ALL.into_iter().zip(0..) {
                picture(
                    size,
                    &view,
                    &Controls {
                        help,
                        ..select(id, pane)
                    },
                );
            }
        }
        view.hint = Some("Motive answers, but no frames come".to_owned());
    }
}

//! The page on terminals of all sizes.

use super::super::controls::{Controls, Pane};
use super::super::example;
use super::super::theme::Theme;
use super::super::view::View;
use super::draw;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use std::sync::Arc;
use std::time::Duration;

pub(super) fn picture((width, height): (u16, u16), view: &View, controls: &Controls) -> String {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal
        .draw(|frame| _ = draw(frame, view, controls, Theme::True))
        .unwrap();
    let buffer = terminal.backend().buffer();
    let lines = buffer.content().chunks(width.into());
    let lines = lines.map(|line| line.iter().map(ratatui::buffer::Cell::symbol).collect::<String>());
    lines.collect::<Vec<_>>().join("\n")
}

pub(super) fn with(pane: Pane) -> Controls {
    Controls {
        pane,
        ..Controls::default()
    }
}

#[track_caller]
pub(super) fn assert_shows(picture: &str, parts: &[&str]) {
    for part in parts {
        assert!(picture.contains(part), "{part:?} is not in\n{picture}");
    }
}

#[test]
fn a_small_terminal_says_who_is_there_and_what_came() {
    let picture = picture((80, 24), &example::view(3), &with(Pane::Stream));
    assert_shows(
        &picture,
        &[
            "mxtp://0.0.0.0:9763",
            "512.3 kB/s",
            "3 characters",
            "Ada",
            "Grace",
            "Katherine",
        ],
    );
    assert_shows(
        &picture,
        &[
            "LIVE",
            "240.0",
            "12:34:56.789",
            "6681",
            "27.837",
            "19920",
            "joint angles",
            "4.17",
            "quit",
        ],
    );
    assert_shows(&picture, &["pelvis", "0.930", "centre of mass"]);
    assert_shows(
        &picture,
        &["latency   p50 1.30, p99 3.90, max 11.70 ms", "as far off as"],
    );
}

#[test]
fn a_large_terminal_shows_types_angles_and_figure_at_once() {
    for size in [(120, 40), (200, 60)] {
        let picture = picture(size, &example::view(2), &with(Pane::Stream));
        assert_shows(
            &picture,
            &["datagram types", "joint angles", "figure", "problems", "none"],
        );
        assert_shows(&picture, &["jL5S1", "jLeftBallFoot", "Vertical_T8", "front", "side"]);
        let has_dots = picture.contains(|symbol| ('⠁'..='⣿').contains(&symbol));
        assert!(has_dots, "{picture}");
        assert!(!picture.contains("Tab"), "there is nothing to switch");
    }
}

#[test]
fn troubles_are_said_with_what_to_do() {
    let mut view = example::view(1);
    example::trouble(&mut view);
    let picture = picture((200, 60), &view, &Controls::default());
    assert_shows(
        &picture,
        &["417 dropped by the kernel", "3 malformed", "rmem_max", "prefer a cable"],
    );
    assert_shows(&picture, &["item-count 240 of type 02", "one sample in 4"]);
}

#[test]
fn who_is_silent_is_stale_and_then_lost() {
    let mut view = example::view(3);
    view.characters[1].age = Duration::from_millis(300);
    view.characters[2].age = Duration::from_secs(5);
    assert_shows(
        &picture((80, 24), &view, &Controls::default()),
        &["● LIVE", "◐ STALE", "✗ LOST", "1 lost"],
    );
    let controls = Controls {
        selected: Some(2),
        pane: Pane::Figure,
        ..Controls::default()
    };
    assert_shows(&picture((80, 24), &view, &controls), &["as it was 5 s ago"]);
}

#[test]
fn many_characters_are_a_list_around_the_selected_one() {
    let controls = Controls {
        selected: Some(40),
        ..Controls::default()
    };
    let picture = picture((80, 24), &example::view(64), &controls);
    assert_shows(&picture, &["64 characters", "Walker 40"]);
    assert!(!picture.contains("Walker 20"));
}

#[test]
fn a_stream_without_positions_says_so() {
    let mut view = example::view(1);
    let mut frame = example::standing(0, "Ada");
    frame.position.clear();
    frame.joint_angles.clear();
    frame.ergonomic_angles.clear();
    frame.center_of_mass = None;
    view.characters[0].frame = Some(Arc::new(frame));
    assert_shows(
        &picture((80, 24), &view, &with(Pane::Figure)),
        &["No positions in this stream", "type 02"],
    );
    assert_shows(
        &picture((80, 24), &view, &with(Pane::Details)),
        &["No joint angles in this stream", "type 20"],
    );
}

#[test]
fn silence_is_answered_with_what_to_check() {
    let mut view = example::view(0);
    assert_shows(
        &picture((80, 24), &view, &Controls::default()),
        &["listening on mxtp://0.0.0.0:9763"],
    );
    view.hint = Some("nothing has come yet. Check that\n- no firewall keeps it away".to_owned());
    assert_shows(
        &picture((80, 24), &view, &Controls::default()),
        &["nothing heard", "no firewall keeps it away"],
    );
}

#[test]
fn help_and_pause_are_seen() {
    let controls = Controls {
        help: true,
        paused: true,
        ..Controls::default()
    };
    assert_shows(
        &picture((80, 24), &example::view(1), &controls),
        &["PAUSED", "another character", "specification"],
    );
}

#[test]
fn a_list_scrolls_to_its_end_and_no_further() {
    let view = example::view(1);
    let controls = Controls {
        scroll: 500,
        ..with(Pane::Details)
    };
    assert_shows(&picture((60, 20), &view, &controls), &["Vertical_T8", "▲"]);
}

#[test]
fn no_size_is_too_small() {
    let mut troubled = example::view(3);
    example::trouble(&mut troubled);
    troubled.characters[0].age = Duration::from_secs(9);
    let mut silent = example::view(0);
    silent.hint = Some("nothing has come yet".to_owned());
    let widths = [1, 2, 3, 5, 8, 13, 21, 34, 40, 55, 79, 80, 89, 118, 119, 120, 144, 233];
    let heights = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 16, 21, 24, 34, 55, 89];
    for size in widths
        .into_iter()
        .flat_map(|width| heights.map(|height| (width, height)))
    {
        for view in [&troubled, &silent] {
            for pane in Pane::ALL {
                let help = pane == Pane::Details;
                picture(size, view, &Controls { help, ..with(pane) });
            }
        }
    }
}

#[test]
fn without_colour_no_cell_has_one() {
    let mut view = example::view(2);
    example::trouble(&mut view);
    let mut terminal = Terminal::new(TestBackend::new(120, 40)).unwrap();
    terminal
        .draw(|frame| _ = draw(frame, &view, &Controls::default(), Theme::Plain))
        .unwrap();
    let plain = ratatui::style::Color::Reset;
    assert!(
        terminal
            .backend()
            .buffer()
            .content()
            .iter()
            .all(|cell| cell.fg == plain && cell.bg == plain)
    );
}

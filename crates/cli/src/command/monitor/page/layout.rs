//! Where the parts of the page are on a terminal of any size.

use super::blocks;
use super::controls::Pane;
use ratatui::layout::Rect;

/// Where the parts of the page are. What has no room is empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) header: Rect,
    pub(super) characters: Rect,
    /// The panes that are shown, and where.
    pub(super) panes: Vec<(Pane, Rect)>,
    /// Those that take turns at the place of the last pane; one or none is no choice.
    pub(super) turns: &'static [Pane],
    pub(super) footer: Rect,
}

/// How many lines the parts want.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) characters: u16,
    /// The list of characters may take one line in so many.
    pub(super) share: u16,
    pub(super) stream: u16,
    /// Joint angles or positions, not lines: how many lines they take depends on the width.
    pub(super) details: u16,
    pub(super) problems: u16,
}

impl Layout {
    /// Divides a terminal. `pane` is the one that the operator wants to see where they take turns.
    pub(super) fn new(area: Rect, wanted: Wanted, pane: Pane) -> Self {
        let mut rest = area;
        let header = top(&mut rest, 1);
        let footer = bottom(&mut rest, u16::from(area.height >= ROOM_FOR_FOOTER));
        let mut panes = Vec::new();
        if rest.width >= WIDE {
            panes.push((
                Pane::Figure,
                right(&mut rest, (area.width - BESIDE_FIGURE).clamp(FIGURE.0, FIGURE.1)),
            ));
        }
        let most = (rest.height / wanted.share).max(4);
        let characters = top(&mut rest, (wanted.characters + 2).min(most));
        let mut layout = Self {
            header,
            characters,
            panes,
            turns: &[],
            footer,
        };
        layout.fill(rest, wanted, pane);
        layout
    }

    /// Gives the rest to the panes: all of them, or some and the last in turns.
    fn fill(&mut self, mut rest: Rect, wanted: Wanted, pane: Pane) {
        let wide = !self.panes.is_empty();
        let (stream, details, problems) = (
            wanted.stream + TITLE,
            blocks::lines(wanted.details, rest.width) + TITLE,
            wanted.problems.max(1) + TITLE,
        );
        let problems_least = problems.min(PROBLEMS_LEAST);
        if wide && rest.height >= stream + details + problems_least {
            self.panes.push((Pane::Stream, top(&mut rest, stream)));
            self.panes.push((Pane::Details, top(&mut rest, details)));
            self.panes.push((Pane::Problems, rest));
            return;
        }
        self.turns = if wide {
            &[Pane::Stream, Pane::Details, Pane::Problems]
        } else {
            &Pane::ALL
        };
        if rest.height >= stream + FIGURE_LEAST {
            self.panes.push((Pane::Stream, top(&mut rest, stream)));
            self.turns = if wide {
                &[Pane::Details, Pane::Problems]
            } else {
                &OTHERS
            };
        }
        let turn = if self.turns.contains(&pane) {
            pane
        } else {
            self.turns[0]
        };
        if turn != Pane::Problems && rest.height >= problems_least + ROOM_FOR_PROBLEMS && wanted.problems > 0 {
            let strip = bottom(&mut rest, problems_least);
            self.panes.push((Pane::Problems, strip));
        }
        self.panes.push((turn, rest));
    }
}

/// Takes lines off the top.
pub(super) fn top(rest: &mut Rect, lines: u16) -> Rect {
    let lines = lines.min(rest.height);
    let taken = Rect { height: lines, ..*rest };
    *rest = Rect {
        y: rest.y + lines,
        height: rest.height - lines,
        ..*rest
    };
    taken
}

/// Takes lines off the bottom.
pub(super) fn bottom(rest: &mut Rect, lines: u16) -> Rect {
    let lines = lines.min(rest.height);
    rest.height -= lines;
    Rect {
        y: rest.y + rest.height,
        height: lines,
        ..*rest
    }
}

/// Takes columns off the right, and leaves one empty beside them.
fn right(rest: &mut Rect, columns: u16) -> Rect {
    let columns = columns.min(rest.width);
    let kept = rest.width - columns;
    let taken = Rect {
        x: rest.x + kept,
        width: columns,
        ..*rest
    };
    rest.width = kept.saturating_sub(1);
    taken
}

/// A figure beside the rest needs this many columns in all.
const WIDE: u16 = BESIDE_FIGURE + FIGURE.0;
/// The columns of the figure when it stands beside the rest, at least and at most.
const FIGURE: (u16, u16) = (38, 79);
/// The columns that the types and two columns of angles need.
const BESIDE_FIGURE: u16 = 82;
/// A pane's title.
const TITLE: u16 = 1;
/// The lines that a pane below the types needs to be worth its place.
const FIGURE_LEAST: u16 = 16;
const ROOM_FOR_FOOTER: u16 = 8;
/// A strip of problems is shown above this many lines of a pane.
const ROOM_FOR_PROBLEMS: u16 = 9;
/// A title and two lines.
const PROBLEMS_LEAST: u16 = 3;
const OTHERS: [Pane; 3] = [Pane::Figure, Pane::Details, Pane::Problems];

#[cfg(test)]
mod tests {
    use super::*;

    const WANTED: Wanted = Wanted {
        characters: 3,
        share: 4,
        stream: 9,
        details: 28,
        problems: 4,
    };

    fn shown(width: u16, height: u16, pane: Pane) -> Vec<Pane> {
        let layout = Layout::new(Rect::new(0, 0, width, height), WANTED, pane);
        layout.panes.iter().map(|(pane, _)| *pane).collect()
    }

    #[test]
    fn a_small_terminal_shows_one_pane_and_two_problems() {
        assert_eq!(shown(80, 24, Pane::Figure), [Pane::Problems, Pane::Figure]);
        assert_eq!(shown(80, 24, Pane::Problems), [Pane::Problems]);
        assert_eq!(shown(40, 10, Pane::Stream), [Pane::Stream]);
    }

    #[test]
    fn a_large_terminal_shows_everything() {
        let all = [Pane::Figure, Pane::Stream, Pane::Details, Pane::Problems];
        assert_eq!(shown(120, 40, Pane::Stream), all);
        assert_eq!(shown(200, 60, Pane::Problems), all);
    }

    #[test]
    fn a_tall_terminal_shows_the_types_and_one_more() {
        assert_eq!(
            shown(80, 50, Pane::Details),
            [Pane::Stream, Pane::Problems, Pane::Details]
        );
    }

    #[test]
    fn nothing_overlaps_or_leaves_the_terminal() {
        for (width, height) in (1..140)
            .step_by(3)
            .flat_map(|width| (1..60).map(move |height| (width, height)))
        {
            let area = Rect::new(0, 0, width, height);
            let layout = Layout::new(area, WANTED, Pane::Details);
            let mut parts = vec![layout.header, layout.characters, layout.footer];
            parts.extend(layout.panes.iter().map(|(_, part)| *part));
            for (place, part) in parts.iter().enumerate() {
                assert_eq!(part.intersection(area).area(), part.area(), "{width}x{height}");
                let apart = parts[place + 1..]
                    .iter()
                    .all(|other| part.intersection(*other).is_empty());
                assert!(apart, "{width}x{height}: {parts:?}");
            }
        }
    }
}

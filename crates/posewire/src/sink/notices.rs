//! What has happened to the peers of a target.

use crate::Notice;
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

/// What has happened to the peers of a target: the newest, and those last.
#[derive(Debug, Default)]
pub(crate) struct Notices {
    kept: Mutex<VecDeque<Notice>>,
}

impl Notices {
    pub(crate) fn push(&self, notice: Notice) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == MOST {
            kept.pop_front();
        }
        kept.push_back(notice);
    }

    pub(crate) fn to_vec(&self) -> Vec<Notice> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().cloned().collect()
    }
}

const MOST: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_are_kept() {
        let notice = |number: usize| Notice::Remark {
            text: number.to_string(),
        };
        let notices = Notices::default();
        (0..MOST + 3).map(notice).for_each(|notice| notices.push(notice));
        assert_eq!(notices.to_vec(), (3..MOST + 3).map(notice).collect::<Vec<_>>());
    }
}

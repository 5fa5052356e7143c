//! A recorded take.

use crate::{Error, Frame, Subject};
use std::sync::Arc;

/// A recorded take of one subject: its samples in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Take {
    /// Who was recorded.
    pub subject: Arc<Subject>,
    /// Samples a second.
    pub rate: f64,
    frames: Vec<Frame>,
}

impl Take {
    /// An empty take.
    pub fn new(subject: Arc<Subject>, rate: f64) -> Self {
        Self {
            subject,
            rate,
            frames: Vec::new(),
        }
    }

    /// Adds a sample at the end.
    ///
    /// # Errors
    /// [`Error::SectionLength`] when a section does not fit the frame's skeleton.
    pub fn push(&mut self, frame: Frame) -> Result<(), Error> {
        frame.check()?;
        self.frames.push(frame);
        Ok(())
    }

    /// The samples in order.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }
}

//! Frames with all that stands in them, and all that stands around them.

use super::{Reader, State};
use crate::markup::Kind;
use crate::{Document, Error, Remainder};
use posewire_motion::Frame;
use std::io::BufRead;
use std::sync::Arc;

impl<R: BufRead> Reader<R> {
    /// The next normal frame as the iterator gives it, and in `remainder` what else stands in the file since the frame
    /// before: so that both together can be written again.
    ///
    /// # Errors
    /// Those of the iterator.
    pub fn read_whole(&mut self, remainder: &mut Remainder) -> Option<Result<Frame, Error>> {
        let mut markup = remainder.begin();
        if matches!(self.state, State::Tag(_)) {
            markup.push(Kind::Start, self.xml.tag());
        }
        self.xml.record(markup);
        let frame = self.next();
        // At the end of the frames what was recorded became the beginning of the file's tail.
        if let Some(markup) = self.xml.recorded() {
            remainder.end(markup, &self.layout, self.header.version == 3);
        }
        frame
    }

    /// All that stands around the frames, as far as the file was read: what stands behind them is in it when the
    /// iterator has ended.
    pub fn document(&self) -> Document {
        Document {
            header: self.header.clone(),
            subject: Arc::clone(&self.subject),
            calibration: self.calibration.clone(),
            around: self.around.clone(),
        }
    }
}

//! The numbers of samples.

/// Numbers samples by moments: all subjects of a moment have the same number, which is one more than that of the last.
pub(super) struct Numbering {
    newest: Option<u32>,
    /// Per subject: whether it has been sent in the newest moment.
    sent: Vec<bool>,
}

impl Numbering {
    pub(super) fn new(subjects: usize) -> Self {
        Self {
            newest: None,
            sent: vec![false; subjects],
        }
    }

    /// The number of the sample of a subject that is sent now: the one that is given, or that of the moment. A subject that was
    /// sent in it already begins the next.
    pub(super) fn number(&mut self, subject: usize, given: Option<u32>) -> u32 {
        let of_moment = match self.newest {
            None => 0,
            Some(newest) => newest.wrapping_add(u32::from(self.sent[subject])),
        };
        let number = given.unwrap_or(of_moment);
        if self.newest.replace(number) != Some(number) {
            self.sent.fill(false);
        }
        self.sent[subject] = true;
        number
    }
}

//! What can be wrong with a pose's description.

/// What can be wrong with a pose's description.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Text that is not a time of day.
    #[error("not a timecode: expected HH:MM:SS.mmm, found {found:?}")]
    Timecode {
        /// The text.
        found: String,
    },
    /// Text that is not a colour.
    #[error("not a colour: expected RRGGBB in hexadecimal, found {found:?}")]
    Color {
        /// The text.
        found: String,
    },
    /// A frame whose section does not fit the subject's skeleton.
    #[error("{section} of sample {sample}: expected {expected} entries, found {found}")]
    SectionLength {
        /// The section, as a field of [`crate::Frame`].
        section: &'static str,
        /// The frame's sample number.
        sample: u32,
        /// Entries that the skeleton asks for.
        expected: usize,
        /// Entries that the frame holds.
        found: usize,
    },
    /// Text that names no section.
    #[error("not a section of a frame: expected a name like \"position\", found {found:?}")]
    Section {
        /// The text.
        found: String,
    },
    /// Numbers that are not as many as a column of a take has.
    #[error("{section}: expected {expected} numbers ({frames} frames x {width}), found {found}")]
    ColumnLength {
        /// The section, as a field of [`crate::Frame`].
        section: &'static str,
        /// Frames of the take.
        frames: usize,
        /// Numbers of a frame.
        width: usize,
        /// Numbers that the take asks for.
        expected: usize,
        /// Numbers there are.
        found: usize,
    },
    /// A rate at which nothing can be sampled.
    #[error("not a rate to sample at: expected more than 0 Hz and at most 1,000 times the rate before, found {found}")]
    Rate {
        /// The rate, samples a second.
        found: f64,
    },
}

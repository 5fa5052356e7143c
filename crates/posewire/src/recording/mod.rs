//! Recordings: MCAP files of every datagram as it came, and of the poses that were read from them.
//!
//! A [`Writer`] makes one, [`RecordSink`](crate::sink::RecordSink) makes one of a live session, [`Survey`] says what is in one and
//! [`recover`] completes one that was cut off. The format is described in `docs/recording.md`; the constants here are its words.

mod briefing;
mod described;
mod description;
mod ending;
mod format;
mod lock;
mod names;
mod part;
mod posed;
mod poses;
mod records;
mod recover;
mod reminder;
mod senders;
mod subjects;
mod survey;
mod take_name;
mod writer;

pub(crate) use briefing::Briefing;
pub use ending::check_ending;
pub(crate) use format::is_continued;
pub use format::{
    CONTINUED, END, FROM, KIND, NAME, POSES, RAW, RECORDING, REPEATED, SOURCE, SOURCE_RECORD, SUBJECT, SUBJECT_RECORD,
    TO, WIRE,
};
pub use lock::is_being_recorded;
pub(crate) use lock::{Whereabouts, read_locked};
pub(crate) use posed::Posed;
pub use recover::{Recovered, recover};
pub use survey::{SenderSurvey, SourceSurvey, SubjectSurvey, Survey};
pub use take_name::{NameError, TakeName};
pub use writer::{Writer, WriterOptions};

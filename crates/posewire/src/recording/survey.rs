//! What a recording holds.

use super::format;
use super::records::Records;
use crate::{Result, Wire};
use mcap::records::Record;
use posewire_motion::Stamp;
use std::collections::BTreeMap;
use std::path::Path;

/// What an MCAP file holds, gone through from its beginning to its end.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Survey {
    /// What wrote it, from its header: `posewire 0.1.0`.
    pub library: String,
    /// What the file says of itself: the record [`RECORDING`](super::RECORDING).
    pub about: BTreeMap<String, String>,
    /// Whether it was finished; otherwise the recording was cut off, and there is no index.
    pub complete: bool,
    /// What is wrong at the place where reading had to end, if it was not finished.
    pub damage: Option<String>,
    /// The sources, in their order.
    pub sources: Vec<SourceSurvey>,
    /// The subjects whose poses are in it, in the order of their first sample.
    pub subjects: Vec<SubjectSurvey>,
    /// Messages on channels that posewire does not write.
    pub other: u64,
    /// When the first message was received, and the last.
    pub span: Option<(Stamp, Stamp)>,
    /// Items that were lost while this and the files before it were recorded, where the file says so.
    pub lost: Option<u64>,
    /// Whether the recording goes on in another file.
    pub continued: bool,
}

/// A source of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceSurvey {
    /// Where it was open.
    pub endpoint: String,
    /// Who sent to it, in the order of their first datagrams.
    pub senders: Vec<SenderSurvey>,
    /// Datagrams at the beginning that repeat descriptions of an earlier file.
    pub repeated: u64,
}

/// A sender of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SenderSurvey {
    /// Its address.
    pub from: String,
    /// What carried its datagrams.
    pub wire: Option<Wire>,
    /// Its datagrams.
    pub datagrams: u64,
    /// Their bytes.
    pub bytes: u64,
    /// When the first was received, and the last.
    pub span: Option<(Stamp, Stamp)>,
}

/// A subject of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SubjectSurvey {
    /// Which source it is of.
    pub source: u16,
    /// Its number at the source.
    pub id: u32,
    /// Its name, empty where the source did not say.
    pub name: String,
    /// Its samples.
    pub frames: u64,
    /// When the first was received, and the last.
    pub span: Option<(Stamp, Stamp)>,
}

impl Survey {
    /// Goes through a file, also one that was not finished.
    ///
    /// # Errors
    /// [`Error::Read`](crate::Error::Read) when it cannot be read, [`Error::NotMcap`](crate::Error::NotMcap) when it is no MCAP
    /// file, and [`Error::Compressed`](crate::Error::Compressed) when its chunks are compressed.
    pub fn of(path: &Path) -> Result<Self> {
        let mut records = Records::open(path)?;
        let mut surveying = Surveying::default();
        while records.next(|record| {
            surveying.take(&record);
            Ok(())
        })? {}
        let mut survey = surveying.survey;
        survey.complete = records.is_complete();
        survey.damage = records.damage().map(str::to_owned);
        Ok(survey)
    }

    /// Datagrams of all sources.
    pub fn datagrams(&self) -> u64 {
        let senders = self.sources.iter().flat_map(|source| &source.senders);
        senders.map(|sender| sender.datagrams).sum()
    }
}

#[derive(Default)]
struct Surveying {
    survey: Survey,
    channels: BTreeMap<u16, Place>,
}

/// What a channel's messages belong to, by its place in the survey.
#[derive(Clone, Copy)]
enum Place {
    Sender(usize, usize),
    Repeated(usize),
    Subject(usize),
    Other,
}

impl Surveying {
    fn take(&mut self, record: &Record<'_>) {
        match record {
            Record::Header(header) => self.survey.library.clone_from(&header.library),
            Record::Metadata(metadata) => self.metadata(&metadata.name, &metadata.metadata),
            Record::Channel(channel) => {
                let known = self.channels.get(&channel.id).copied();
                let place = known.unwrap_or_else(|| self.place(&channel.metadata));
                self.channels.insert(channel.id, place);
            }
            Record::Message { header, data } => {
                let at = Stamp(i64::try_from(header.log_time).unwrap_or(i64::MAX));
                self.message(header.channel_id, at, data.len() as u64);
            }
            _ => {}
        }
    }

    fn metadata(&mut self, name: &str, keys: &BTreeMap<String, String>) {
        match name {
            format::RECORDING => self.survey.about.clone_from(keys),
            format::SOURCE_RECORD => {
                if let (Some(source), Some(endpoint)) = (number(keys, format::SOURCE), keys.get("endpoint")) {
                    self.source(source).endpoint.clone_from(endpoint);
                }
            }
            format::END => {
                self.survey.lost = keys.get("lost").and_then(|lost| lost.parse().ok());
                self.survey.continued = format::is_continued(keys);
            }
            _ => {}
        }
    }

    fn source(&mut self, number: u16) -> &mut SourceSurvey {
        let place = usize::from(number);
        if self.survey.sources.len() <= place {
            self.survey.sources.resize_with(place + 1, SourceSurvey::default);
        }
        &mut self.survey.sources[place]
    }

    fn place(&mut self, keys: &BTreeMap<String, String>) -> Place {
        let Some(source) = number(keys, format::SOURCE) else {
            return Place::Other;
        };
        let text = |key: &str| keys.get(key).cloned().unwrap_or_default();
        match keys.get(format::KIND).map(String::as_str) {
            Some(format::RAW) => {
                let senders = &mut self.source(source).senders;
                senders.push(SenderSurvey {
                    from: text(format::FROM),
                    wire: Wire::named(&text(format::WIRE)),
                    ..SenderSurvey::default()
                });
                Place::Sender(source.into(), senders.len() - 1)
            }
            Some(format::REPEATED) => {
                self.source(source);
                Place::Repeated(source.into())
            }
            Some(format::POSES) => {
                self.survey.subjects.push(SubjectSurvey {
                    source,
                    id: text(format::SUBJECT).parse().unwrap_or_default(),
                    name: text(format::NAME),
                    ..SubjectSurvey::default()
                });
                Place::Subject(self.survey.subjects.len() - 1)
            }
            _ => Place::Other,
        }
    }

    fn message(&mut self, channel: u16, at: Stamp, bytes: u64) {
        let survey = &mut self.survey;
        match self.channels.get(&channel) {
            Some(Place::Sender(source, sender)) => {
                let sender = &mut survey.sources[*source].senders[*sender];
                sender.datagrams += 1;
                sender.bytes += bytes;
                widen(&mut sender.span, at);
                widen(&mut survey.span, at);
            }
            Some(Place::Repeated(source)) => survey.sources[*source].repeated += 1,
            Some(Place::Subject(subject)) => {
                let subject = &mut survey.subjects[*subject];
                subject.frames += 1;
                widen(&mut subject.span, at);
                widen(&mut survey.span, at);
            }
            _ => survey.other += 1,
        }
    }
}

fn widen(span: &mut Option<(Stamp, Stamp)>, at: Stamp) {
    let (first, last) = span.get_or_insert((at, at));
    *first = at.min(*first);
    *last = at.max(*last);
}

fn number(keys: &BTreeMap<String, String>, key: &str) -> Option<u16> {
    keys.get(key)?.parse().ok()
}

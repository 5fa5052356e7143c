//! An examination of each source of a session.

use super::{Examination, Finding};
use crate::endpoint::Endpoint;
use crate::queue::Policy;
use crate::{Item, Result, Sink, SourceId, Wants};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Feeds an examination for each source, in the order in which the session has them. Clones share these.
#[derive(Clone, Debug)]
pub(super) struct Examiner(Arc<Mutex<Vec<Examination>>>);

impl Examiner {
    pub(super) fn of<'a>(endpoints: impl IntoIterator<Item = &'a Endpoint>) -> Self {
        let examinations = endpoints.into_iter().map(Examination::new);
        Self(Arc::new(Mutex::new(examinations.collect())))
    }

    pub(super) fn has_heard(&self) -> bool {
        self.lock().iter().any(Examination::has_heard)
    }

    pub(super) fn has_understood(&self) -> bool {
        self.lock().iter().any(Examination::has_understood)
    }

    pub(super) fn datagrams(&self) -> u64 {
        self.lock().iter().map(Examination::datagrams).sum()
    }

    pub(super) fn lost_here(&self) -> u64 {
        self.lock().iter().map(Examination::lost_here).sum()
    }

    /// What was found in each source, which is named where there are several.
    pub(super) fn findings(&self) -> Vec<Finding> {
        let examinations = self.lock();
        let are_several = examinations.len() > 1;
        let each = examinations.iter().flat_map(|examination| {
            let source = are_several.then(|| examination.endpoint().to_string());
            let findings = examination.findings().into_iter();
            findings.map(move |finding| match &source {
                Some(source) => of_source(finding, source),
                None => finding,
            })
        });
        each.collect()
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Examination>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn of_source(finding: Finding, source: &str) -> Finding {
    let place = match &finding.place {
        Some(place) => format!("{source}, {place}"),
        None => source.to_owned(),
    };
    finding.at(place)
}

impl Sink for Examiner {
    fn queue(&self) -> (Policy, usize) {
        (Policy::Lossless, QUEUED_ITEMS)
    }

    fn wants(&self) -> Wants {
        Wants::ALL
    }

    fn accept(&mut self, source: SourceId, item: &Item) -> Result<()> {
        if let Some(examination) = self.lock().get_mut(usize::from(source.0)) {
            examination.take(item);
        }
        Ok(())
    }
}

/// A second or so of many people.
const QUEUED_ITEMS: usize = 65_536;

#[cfg(test)]
mod tests {
    use super::super::Check;
    use super::super::test::{datagram, endpoint, mxtp};
    use super::*;

    #[test]
    fn findings_of_several_sources_name_theirs() {
        let [one, other] = ["mxtp://10.0.0.1", "mxtp://10.0.0.2"].map(endpoint);
        let mut examiner = Examiner::of([&one, &other]);
        let item = Item::Datagram(Arc::new(datagram("10.0.0.7:5000", &mxtp(0, 20))));
        examiner.accept(SourceId(1), &item).unwrap();
        let found = examiner.findings();
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].check, Check::NoPose);
        assert_eq!(found[0].place.as_deref(), Some("mxtp://10.0.0.2:9763, character 0"));
        assert_eq!((examiner.datagrams(), examiner.has_understood()), (1, true));
    }
}

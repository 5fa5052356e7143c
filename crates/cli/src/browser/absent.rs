//! A build without the page.

use posewire::endpoint::Endpoint;
use posewire::{Error, Sink};
use std::convert::Infallible;
use std::net::SocketAddr;

/// There is none in this build.
#[derive(Debug)]
pub(crate) struct Browser(Infallible);

impl Browser {
    /// Refuses to show anything.
    pub(crate) fn beside(listen: Option<SocketAddr>, _: &[Endpoint]) -> anyhow::Result<Option<Self>> {
        match listen {
            None => Ok(None),
            Some(_) => Err(Self::missing().into()),
        }
    }

    /// The same: a demonstration goes without.
    pub(crate) fn anywhere(listen: Option<SocketAddr>, sources: &[Endpoint]) -> anyhow::Result<Option<Self>> {
        Self::beside(listen, sources)
    }

    /// What is said when the page is asked for.
    pub(crate) fn missing() -> Error {
        Error::Feature {
            what: "the browser page",
            feature: "viewer",
        }
    }

    pub(crate) fn sink(&self) -> Box<dyn Sink> {
        match self.0 {}
    }

    pub(crate) fn url(&self) -> &str {
        match self.0 {}
    }

    pub(crate) fn open(&self) {
        match self.0 {}
    }
}

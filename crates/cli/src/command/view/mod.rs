//! `posewire view`: live streams or takes in a browser.

#[cfg(feature = "viewer")]
mod show;
#[cfg(feature = "viewer")]
mod takes;

use super::End;
use crate::cli::View;

#[cfg(feature = "viewer")]
pub(super) fn run(arguments: &View) -> anyhow::Result<End> {
    show::run(arguments)
}

#[cfg(not(feature = "viewer"))]
pub(super) fn run(_: &View) -> anyhow::Result<End> {
    Err(crate::browser::Browser::missing().into())
}

//! The browser page beside what a verb does.

#[cfg(not(feature = "viewer"))]
mod absent;
#[cfg(feature = "viewer")]
mod here;
#[cfg(feature = "viewer")]
mod qr;

#[cfg(not(feature = "viewer"))]
pub(crate) use absent::Browser;
#[cfg(feature = "viewer")]
pub(crate) use here::Browser;

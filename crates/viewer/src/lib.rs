//! The page that shows motion capture live and from files, and its server.
//!
//! A [`Feed`] holds the newest frame of every subject; a [`ViewerSink`] fills it from a session, and a [`Server`] shows it
//! to any number of browsers, each at its own rate:
//!
//! ```
//! use posewire::source::PlaybackOptions;
//! use posewire::stop::Stop;
//! use posewire::{Session, Source};
//! use posewire_viewer::{Content, Feed, Options, Server, ViewerSink};
//! use std::time::Duration;
//!
//! let options = PlaybackOptions { duration: Some(Duration::from_millis(50)), ..PlaybackOptions::default() };
//! let source = Source::open(&"synthetic:walk?people=2".parse()?, &options)?;
//! let feed = Feed::new(&[source.endpoint().clone()]);
//! let options = Options { listen: "127.0.0.1:0".parse()?, ..Options::default() };
//! let server = Server::start(Content::Live(feed.clone()), &options)?;
//! println!("open http://{}", server.address());
//!
//! Session::start([source], vec![Box::new(ViewerSink::new(&feed))], Stop::new()).wait()?;
//! server.stop();
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod app;
mod assets;
mod channel;
mod connection;
mod counts;
mod derived;
mod error;
mod feed;
mod guard;
mod hold;
mod live;
mod metrics;
mod page;
mod patience;
mod recorder;
mod recordings;
mod refusal;
mod room;
mod routes;
mod scene;
mod series;
mod server;
mod sink;
mod statistics;
mod takes;
mod token;
mod wire;

pub use error::{Error, Result};
pub use feed::Feed;
pub use recorder::Recorder;
pub use server::{Content, Options, Server};
pub use sink::ViewerSink;
pub use takes::Takes;

//! MVN's remote control: short XML messages over UDP, one in a datagram, on port [`DEFAULT_PORT`].
//!
//! A program sends a request, as `<IdentifyReq/>`, and MVN answers to where it came from, as `<IdentifyAck ..>`. The vendor
//! publishes the names; what attributes they have is known from its own clients. Two ways to record exist side by side:
//! [`StartRecordingReq`](Content::StartRecordingReq) and, as other capture systems have it,
//! [`CaptureName`](Content::CaptureName) and [`CaptureStart`](Content::CaptureStart).
//!
//! ```
//! use posewire_mxtp::remote::{Content, Message};
//!
//! let request = Message::decode(b"<StartRecordingReq SessionName='walk' Operator='Ada'>")?;
//! let Content::StartRecordingReq { session_name, .. } = &request.content else { unreachable!() };
//! assert_eq!(session_name.as_deref(), Some("walk"));
//! assert_eq!(request.rest.attributes[0].0, "Operator", "what is not known is kept");
//!
//! let answer = request.content.answer(Ok(())).unwrap();
//! assert_eq!(Message::from(answer).to_string(), r#"<StartRecordingAck Result="TRUE"/>"#);
//! # Ok::<(), posewire_mxtp::Error>(())
//! ```

mod element;
mod fields;
mod message;
#[cfg(test)]
mod tests;

pub use element::Element;
pub use message::{Content, Message, Rest};

/// The UDP port that MVN listens on for requests.
pub const DEFAULT_PORT: u16 = 6004;

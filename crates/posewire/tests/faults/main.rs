//! What a receiver counts is what was done to the stream, and the same seed does the same.

mod exact;
mod oracle;
mod repeated;
mod stream;

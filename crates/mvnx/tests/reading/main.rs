//! Files of all sorts under the reader and the writer: made-up ones, damaged ones, and the reference takes where they are.

mod contents;
mod conventions;
mod conversion;
mod damage;
mod described;
mod made_up;
mod reference;
mod round_trip;

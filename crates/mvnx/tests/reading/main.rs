//! Files of all sorts under the reader: made-up ones, damaged ones, and the reference takes where they are.

mod contents;
mod conventions;
mod damage;
mod made_up;
mod reference;

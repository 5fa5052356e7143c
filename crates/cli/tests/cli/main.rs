//! Runs the program as its users do.

mod explain;
mod inspect;
mod program;

//! Packets of every kind and version, to and from bytes.

mod reference;

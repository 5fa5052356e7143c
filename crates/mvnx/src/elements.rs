//! What reading a frame needs of a reader of XML.

use crate::xml::Raw;
use crate::{Error, Place};

/// A reader that stands on one tag at a time: [`Xml`](crate::xml::Xml) of any XML, [`Scan`](crate::scan::Scan) of MVN's own.
pub(crate) trait Elements {
    /// How many bytes of the file were read.
    fn offset(&self) -> u64;

    /// Where the tag begins on which the reader stands.
    fn place(&self) -> Place;

    /// The name of the start tag read last, without its namespace.
    fn name(&self) -> &str;

    /// Gives the attributes of the start tag read last to `read`.
    fn each_attribute(&self, read: impl FnMut(&str, &str) -> Result<(), Error>) -> Result<(), Error>;

    /// Goes to the next child of the element on whose start tag the reader stands: `false` at its end tag.
    fn child(&mut self) -> Result<bool, Error>;

    /// The text of the element on whose start tag the reader stands, and where it begins; goes to its end tag.
    ///
    /// What is no number need not be what stands in the file: [`leaf_string`](Self::leaf_string) is for text.
    fn leaf(&mut self) -> Result<(&[u8], Place), Error>;

    /// As [`leaf`](Self::leaf), as a string.
    fn leaf_string(&mut self) -> Result<String, Error>;

    /// Passes over the content of the element on whose start tag the reader stands; goes to its end tag.
    fn skip(&mut self) -> Result<(), Error>;

    /// The first `limit` bytes of the element on whose start tag the reader stands; goes to its end tag.
    fn skip_keeping(&mut self, limit: usize) -> Result<Raw, Error>;

    /// The text before the end tag read last.
    fn text(&self) -> &[u8];
}

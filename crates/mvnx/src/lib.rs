//! MVNX, the take format of Xsens MVN: reader and writer.
//!
//! [`Reader`] reads files of version 3 and 4, plain or compressed with gzip, in UTF-8 or UTF-16, one frame at a time and in constant memory,
//! and gives them in the canonical convention of [`posewire_motion`]; [`read_take`] reads a whole take at once.
//! [`Writer`] writes both versions in MVN's own layout, frame by frame; [`write_take`] and [`rewrite`] write a take or
//! a file at once. The crate opens no file: it reads any [`BufRead`](std::io::BufRead) and writes to any
//! [`Write`](std::io::Write).
//!
//! A file that MVN wrote comes out byte for byte: a [`Document`] keeps what stands around the frames, a [`Remainder`] what
//! stands in a frame besides its numbers. Without either, [`Document::describe`] makes the document of any subject.
//!
//! ```
//! let file = br#"<mvnx version="4">
//!   <subject label="Ada" frameRate="240" segmentCount="1">
//!     <segments><segment label="Pelvis" id="1"/></segments>
//!     <frames segmentCount="1">
//!       <frame time="0" index="0" type="normal">
//!         <orientation>1.000000 0.000000 0.000000 0.000000</orientation>
//!         <position>0.100000 0.200000 0.950000</position>
//!       </frame>
//!     </frames>
//!   </subject>
//! </mvnx>"#;
//! let mut reader = posewire_mvnx::Reader::new(&file[..])?;
//! assert_eq!(reader.subject().name, "Ada");
//! for frame in &mut reader {
//!     let pelvis = frame?.pose(0).expect("both sections are there");
//!     assert_eq!(pelvis.position.z, 0.95);
//! }
//!
//! // The same file as MVN would lay it out: tabs, one element a line.
//! let mut again = Vec::new();
//! let mut reader = posewire_mvnx::Reader::new(&file[..])?;
//! let left_out = posewire_mvnx::rewrite(&mut reader, posewire_mvnx::Version::V4, &mut again)?;
//! assert!(left_out.is_empty());
//! assert!(String::from_utf8_lossy(&again).contains("\n\t\t\t\t<position>0.100000 0.200000 0.950000</position>\n"));
//! # Ok::<(), posewire_mvnx::Error>(())
//! ```

mod calibration;
mod convert;
mod describe;
mod document;
mod elements;
mod error;
mod frame;
mod head;
mod header;
mod input;
mod markup;
mod null_pose;
mod number;
mod reader;
mod remainder;
mod rewind;
mod scan;
mod section;
mod sections;
mod skeleton;
mod utf16;
mod writer;
mod xml;

pub use calibration::{Calibration, CalibrationKind};
pub use convert::{rewrite, write_take};
pub use document::Document;
pub use error::{Error, Place};
pub use header::{
    ConnectorDefinition, ErgonomicAngleDefinition, Hands, Header, JointDefinition, PointDefinition, SegmentDefinition,
    UnknownElement,
};
pub use reader::{FrameCounts, Reader, read_take};
pub use remainder::Remainder;
pub use sections::SectionInfo;
pub use writer::{LeftOut, Reason, Version, Writer};

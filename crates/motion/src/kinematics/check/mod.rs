//! Whether what a source sends agrees with itself.
//!
//! Each check takes one sample after the other and keeps what was worst.
//!
//! ```
//! use posewire_motion::kinematics::check::LengthErrors;
//! use posewire_motion::kinematics::Largest;
//! use posewire_motion::{DQuat, Frame, Skeleton, Subject};
//! use std::sync::Arc;
//!
//! let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
//! frame.orientation = vec![Some(DQuat::IDENTITY * 1.25); 23];
//! let mut errors = LengthErrors::new();
//! errors.add(&frame);
//! assert_eq!(errors.segments()[0], Some(Largest { value: 0.25, sample: 0 }));
//! ```

mod angles;
mod clock;
mod derivatives;
mod dropouts;
mod lengths;

pub use angles::{AngleDifferences, Compared};
pub use clock::{ClockCheck, ClockReport};
pub use derivatives::{Comparison, DerivativeDifferences};
pub use dropouts::{Dropouts, Runs};
pub use lengths::LengthErrors;

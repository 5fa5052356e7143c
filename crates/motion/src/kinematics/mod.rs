//! What follows from poses: joint angles, rotations of segments against their parents, positions, velocities, an estimate of
//! the centre of mass, gaps at joints, samples at another rate.
//!
//! Everything here works on the canonical space and leaves unknown what does not follow from what is known.
//!
//! ```
//! use posewire_motion::kinematics::{complete, segment_positions};
//! use posewire_motion::{DQuat, DVec3, Frame, Skeleton, Subject};
//! use std::sync::Arc;
//!
//! // A subject who stands in the T-pose, of whom only the orientations are known.
//! let mut frame = Frame::new(Arc::new(Subject::new("Ada", Skeleton::standard(0, false))));
//! frame.orientation = vec![Some(DQuat::IDENTITY); 23];
//! let hips = DVec3::new(2.0, 0.0, 0.93);
//! segment_positions(&frame.subject.skeleton, hips, &frame.orientation, &mut frame.position);
//! assert_eq!(frame.position[6], Some(DVec3::new(2.0, 0.0, 1.52)));
//!
//! complete(&mut frame);
//! assert_eq!(frame.joint_angles.len(), 22);
//! assert!(frame.center_of_mass.is_some());
//! ```

mod center_of_mass;
pub mod check;
mod complete;
mod continuity;
mod differences;
mod ergonomic;
mod forward;
mod gaps;
mod joint_angles;
mod largest;
mod local;
mod resample;
mod sensors;
mod whole_take;

pub use center_of_mass::center_of_mass;
pub use complete::complete;
pub use continuity::ContinuousSigns;
pub use differences::Differences;
pub use ergonomic::AllErgonomicAngles;
pub use forward::{forward_kinematics, segment_positions};
pub use gaps::{LargestGaps, joint_gaps};
pub use joint_angles::{ergonomic_angles, joint_angles};
pub use largest::Largest;
pub use local::{local_poses, local_rotations, orientations};
pub use resample::Resampler;
pub use whole_take::{completed, continuous, dropouts, resampled};

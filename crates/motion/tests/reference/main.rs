//! Kinematics against two takes that MVN wrote.

mod angles;
mod poses;
mod scan;

//! What follows from poses: joint angles, velocities, accelerations.

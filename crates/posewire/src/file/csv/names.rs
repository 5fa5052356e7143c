//! The names of sheets and columns in MVN's Excel export.

use posewire_motion::{Section, Skeleton};

/// The sheet on which MVN has a section.
pub(super) const fn sheet(section: Section) -> &'static str {
    match section {
        Section::Position => "Segment Position",
        Section::Orientation => "Segment Orientation - Quat",
        Section::Velocity => "Segment Velocity",
        Section::Acceleration => "Segment Acceleration",
        Section::AngularVelocity => "Segment Angular Velocity",
        Section::AngularAcceleration => "Segment Angular Acceleration",
        Section::JointAngles => "Joint Angles ZXY",
        Section::JointAnglesXzy => "Joint Angles XZY",
        Section::ErgonomicAngles => "Ergonomic Joint Angles ZXY",
        Section::ErgonomicAnglesXzy => "Ergonomic Joint Angles XZY",
        Section::SensorOrientation => "Sensor Orientation - Quat",
        Section::SensorFreeAcceleration => "Sensor Free Acceleration",
        Section::SensorAcceleration => "Sensor Acceleration",
        Section::SensorAngularVelocity => "Sensor Angular Velocity",
        Section::SensorMagneticField => "Sensor Magnetic Field",
        Section::CenterOfMass | Section::CenterOfMassVelocity | Section::CenterOfMassAcceleration => "Center of Mass",
        _ => section.name(),
    }
}

/// The names of a section's columns.
pub(super) fn columns(section: Section, skeleton: &Skeleton) -> Vec<String> {
    let entries = section.labels(skeleton);
    entries.flat_map(|entry| entry_columns(section, entry)).collect()
}

fn entry_columns(section: Section, entry: &str) -> Vec<String> {
    let three = |words: String, ends: [&str; 3]| ends.map(|end| format!("{words} {end}")).to_vec();
    match section {
        Section::JointAngles | Section::JointAnglesXzy => {
            let joint = entry.strip_prefix('j').unwrap_or(entry);
            three(spaced(joint), angles(joint))
        }
        Section::ErgonomicAngles | Section::ErgonomicAnglesXzy => {
            three(entry.to_owned(), ["Lateral Bending", "Axial Bending", FLEXION])
        }
        Section::CenterOfMass => three("CoM pos".to_owned(), AXES),
        Section::CenterOfMassVelocity => three("CoM vel".to_owned(), AXES),
        Section::CenterOfMassAcceleration => three("CoM acc".to_owned(), AXES),
        _ if section.components() == 4 => {
            let words = spaced(entry);
            (0..4).map(|component| format!("{words} q{component}")).collect()
        }
        _ => three(spaced(entry), AXES),
    }
}

/// What a joint's turns about x, y and z are called.
fn angles(joint: &str) -> [&'static str; 3] {
    let limb = joint.strip_prefix("Right").or_else(|| joint.strip_prefix("Left"));
    match limb {
        None if joint == "L5S1" => ["Lateral Bending", "Axial Bending", FLEXION],
        None => ["Lateral Bending", "Axial Rotation", FLEXION],
        Some("Elbow" | "Wrist") => ["Ulnar Deviation/Radial Deviation", "Pronation/Supination", FLEXION],
        Some("Ankle") => [ABDUCTION, ROTATION, "Dorsiflexion/Plantarflexion"],
        Some(_) => [ABDUCTION, ROTATION, FLEXION],
    }
}

/// A name with spaces between its words: `RightT4Shoulder` as "Right T4 Shoulder".
fn spaced(name: &str) -> String {
    let characters: Vec<_> = name.chars().collect();
    let mut words = String::new();
    for (place, &character) in characters.iter().enumerate() {
        let before = place.checked_sub(1).map(|place| characters[place]);
        let begins_word = match before {
            Some(before) if before.is_lowercase() => character.is_uppercase(),
            // Not within "L5S1", whose second letter begins no word.
            Some(before) if before.is_ascii_digit() => {
                character.is_uppercase() && characters.get(place + 1).is_some_and(|next| next.is_lowercase())
            }
            _ => false,
        };
        if begins_word {
            words.push(' ');
        }
        words.push(character);
    }
    words.replace("Fore Arm", "Forearm")
}

const AXES: [&str; 3] = ["x", "y", "z"];
const FLEXION: &str = "Flexion/Extension";
const ABDUCTION: &str = "Abduction/Adduction";
const ROTATION: &str = "Internal/External Rotation";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_and_joints_are_spelled_as_in_excel() {
        for (name, expected) in [
            ("Pelvis", "Pelvis"),
            ("T12", "T12"),
            ("RightUpperArm", "Right Upper Arm"),
            ("LeftForeArm", "Left Forearm"),
            ("L5S1", "L5S1"),
            ("L1T12", "L1T12"),
            ("C1Head", "C1 Head"),
            ("RightT4Shoulder", "Right T4 Shoulder"),
            ("LeftBallFoot", "Left Ball Foot"),
        ] {
            assert_eq!(spaced(name), expected);
        }
    }

    #[test]
    fn turns_are_called_after_what_the_joint_does() {
        let skeleton = Skeleton::standard(0, false);
        let names = columns(Section::JointAngles, &skeleton);
        assert_eq!(names.len(), 66);
        for (place, expected) in [
            (1, "L5S1 Axial Bending"),
            (4, "L4L3 Axial Rotation"),
            (17, "C1 Head Flexion/Extension"),
            (18, "Right T4 Shoulder Abduction/Adduction"),
            (24, "Right Elbow Ulnar Deviation/Radial Deviation"),
            (28, "Right Wrist Pronation/Supination"),
            (50, "Right Ankle Dorsiflexion/Plantarflexion"),
            (65, "Left Ball Foot Flexion/Extension"),
        ] {
            assert_eq!(names[place], expected);
        }
        let ergonomic = columns(Section::ErgonomicAngles, &skeleton);
        assert_eq!(ergonomic[0], "T8_Head Lateral Bending");
        assert_eq!(columns(Section::CenterOfMassVelocity, &skeleton)[2], "CoM vel z");
        assert_eq!(columns(Section::Orientation, &skeleton)[3], "Pelvis q3");
    }
}

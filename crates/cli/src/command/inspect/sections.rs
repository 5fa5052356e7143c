//! What the numbers of a section are (MVN User Manual MV0319, the frame element).

/// What one entry of a section holds.
pub(super) struct Meaning {
    /// What there is an entry for: `segment`, `joint`; empty for the body as a whole.
    pub(super) per: &'static str,
    /// Numbers of an entry.
    pub(super) width: usize,
    /// The unit in the file; empty for what has none.
    pub(super) unit: &'static str,
    /// What the numbers are, for people.
    pub(super) values: &'static str,
}

/// The meaning of the section with this element name, if it is known.
pub(super) fn meaning(section: &str) -> Option<&'static Meaning> {
    let row = TABLE.iter().find(|(names, _)| names.contains(&section));
    row.map(|(_, meaning)| meaning)
}

const fn vectors(per: &'static str, unit: &'static str) -> Meaning {
    Meaning {
        per,
        width: 3,
        unit,
        values: "x y z",
    }
}

const fn quaternions(per: &'static str) -> Meaning {
    Meaning {
        per,
        width: 4,
        unit: "",
        values: "w x y z",
    }
}

const TABLE: &[(&[&str], Meaning)] = &[
    (&["orientation"], quaternions("segment")),
    (&["position"], vectors("segment", "m")),
    (&["velocity"], vectors("segment", "m/s")),
    (&["acceleration"], vectors("segment", "m/s2")),
    (&["angularVelocity"], vectors("segment", "rad/s")),
    (&["angularAcceleration"], vectors("segment", "rad/s2")),
    (
        &["footContacts"],
        Meaning {
            per: "contact",
            width: 1,
            unit: "",
            values: "0 or 1",
        },
    ),
    (
        &["sensorFreeAcceleration", "sensorAcceleration"],
        vectors("sensor", "m/s2"),
    ),
    (&["sensorAngularVelocity"], vectors("sensor", "rad/s")),
    (&["sensorMagneticField"], vectors("sensor", "a.u.")),
    (&["sensorOrientation"], quaternions("sensor")),
    (&["jointAngle", "jointAngleXZY"], vectors("joint", "deg")),
    (
        &["jointAngleErgo", "jointAngleErgoXZY"],
        vectors("ergonomic angle", "deg"),
    ),
    (&["centerOfMass"], vectors("", "m")),
    (
        &["positionFingersLeft", "positionFingersRight"],
        vectors("finger segment", "m"),
    ),
    (
        &["orientationFingersLeft", "orientationFingersRight"],
        quaternions("finger segment"),
    ),
    (
        &[
            "jointAngleFingersLeft",
            "jointAngleFingersRight",
            "jointAngleFingersLeftXZY",
            "jointAngleFingersRightXZY",
        ],
        vectors("finger joint", "deg"),
    ),
];

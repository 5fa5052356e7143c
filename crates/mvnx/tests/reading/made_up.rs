//! Writes made-up takes: every number follows from its frame, its section and its place.

use posewire_motion::{DQuat, Skeleton, standard};
use std::fmt::Write;

/// A take to write, and how.
#[derive(Clone, Debug)]
pub(crate) struct MadeUp {
    pub(crate) version: u32,
    pub(crate) frames: u32,
    pub(crate) props: usize,
    pub(crate) fingers: bool,
    pub(crate) sensors: usize,
    pub(crate) center_of_mass_columns: usize,
    pub(crate) calibration: bool,
    pub(crate) indent: &'static str,
    pub(crate) newline: &'static str,
    /// Written into every frame.
    pub(crate) extra: &'static str,
    /// Written before the frames.
    pub(crate) head: &'static str,
}

impl Default for MadeUp {
    fn default() -> Self {
        Self {
            version: 4,
            frames: 3,
            props: 0,
            fingers: false,
            sensors: 17,
            center_of_mass_columns: 3,
            calibration: true,
            indent: "\t",
            newline: "\n",
            extra: "",
            head: "",
        }
    }
}

/// The value at a place of a section of a frame, in millionths.
pub(crate) fn millionths(frame: u32, section: &str, place: usize) -> i64 {
    let section = section
        .bytes()
        .fold(7_i64, |hash, byte| (hash * 31 + i64::from(byte)) % 99_991);
    (i64::from(frame) * 7_919 + section * 104_729 + place as i64 * 1_299_709) % 1_999_993 - 1_000_000
}

/// The same as a number.
pub(crate) fn value(frame: u32, section: &str, place: usize) -> f64 {
    millionths(frame, section, place) as f64 / 1e6
}

/// The values of a section.
pub(crate) fn values(frame: u32, section: &str, count: usize) -> Vec<f64> {
    (0..count).map(|place| value(frame, section, place)).collect()
}

impl MadeUp {
    pub(crate) fn skeleton(&self) -> Skeleton {
        Skeleton::standard(self.props, self.fingers)
    }

    /// Segments of body and props.
    pub(crate) fn segments(&self) -> usize {
        23 + self.props
    }

    /// The names of the sections of a frame, with the count of their numbers.
    pub(crate) fn sections(&self) -> Vec<(&'static str, usize)> {
        let (segments, sensors) = (self.segments(), self.sensors);
        let mut sections = vec![("orientation", 4 * segments)];
        for name in [
            "position",
            "velocity",
            "acceleration",
            "angularVelocity",
            "angularAcceleration",
        ] {
            sections.push((name, 3 * segments));
        }
        let of_sensors = if self.version == 4 {
            vec![("sensorFreeAcceleration", 3)]
        } else {
            vec![("sensorAcceleration", 3), ("sensorAngularVelocity", 3)]
        };
        if sensors > 0 {
            sections.extend(of_sensors.into_iter().map(|(name, columns)| (name, columns * sensors)));
            sections.extend([("sensorMagneticField", 3 * sensors), ("sensorOrientation", 4 * sensors)]);
        }
        sections.extend([("jointAngle", 66), ("jointAngleXZY", 66)]);
        if self.version == 4 {
            sections.extend([("jointAngleErgo", 18), ("jointAngleErgoXZY", 18)]);
        }
        sections.push(("centerOfMass", self.center_of_mass_columns));
        if self.fingers {
            sections.extend([("positionFingersLeft", 60), ("positionFingersRight", 60)]);
            sections.extend([("orientationFingersLeft", 80), ("orientationFingersRight", 80)]);
            sections.extend([("jointAngleFingersLeft", 57), ("jointAngleFingersRight", 57)]);
            sections.extend([("jointAngleFingersLeftXZY", 57), ("jointAngleFingersRightXZY", 57)]);
        }
        sections
    }

    /// The file.
    pub(crate) fn write(&self) -> String {
        let mut to = Writer {
            text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(),
            depth: 0,
            style: self,
        };
        let root = format!(
            "mvnx xmlns=\"http://www.xsens.com/mvn/mvnx\" version=\"{}\"",
            self.version
        );
        to.element(&root, |to| {
            to.line("<mvn version=\"2019.0.0\" build=\"Version &lt;1&gt;\"/>");
            to.line("<comment>Of the file</comment>");
            let segments = self.segments();
            let subject = format!(
                "subject label=\"Ada &amp; Eve\" torsoColor=\"#e96417\" frameRate=\"100\" segmentCount=\"{segments}\" recDate=\"gio nov 3\" odd=\"kept\""
            );
            to.element(&subject, |to| self.write_subject(to));
            to.line("<securityCode code=\"0123abcd\"/>");
        });
        to.text
    }

    fn write_subject(&self, to: &mut Writer<'_>) {
        to.line("<comment></comment>");
        let skeleton = self.skeleton();
        let (body, fingers) = skeleton.segments.split_at(self.segments());
        to.segments("segments", body);
        if self.sensors > 0 {
            let sensors = &standard::SENSORS[..self.sensors];
            to.element("sensors", |to| {
                for &place in sensors {
                    to.line(&format!("<sensor label=\"{}\"/>", skeleton.segments[place].name));
                }
            });
        }
        to.joints(
            "joints",
            &standard::JOINTS.map(|joint| (joint.name.to_owned(), joint.parent, joint.child)),
            &skeleton,
        );
        if self.version == 4 {
            write_angles_and_contacts(to, &skeleton);
        }
        if self.fingers {
            let (left, right) = fingers.split_at(20);
            to.segments("fingerTrackingSegmentsLeft", left);
            to.segments("fingerTrackingSegmentsRight", right);
            for (side, first) in [("Left", self.segments()), ("Right", self.segments() + 20)] {
                let joint = |place: usize| {
                    (
                        format!("j{}", skeleton.segments[place].name),
                        skeleton.segments[place].parent.unwrap(),
                        place,
                    )
                };
                let joints: Vec<_> = (first + 1..first + 20).map(joint).collect();
                to.joints(&format!("fingerTrackingJoints{side}"), &joints, &skeleton);
            }
        }
        to.text.push_str(self.head);
        let frames = format!(
            "frames segmentCount=\"{}\" sensorCount=\"{}\" jointCount=\"22\"",
            self.segments(),
            self.sensors
        );
        to.element(&frames, |to| self.write_frames(to, &skeleton));
    }

    fn write_frames(&self, to: &mut Writer<'_>, skeleton: &Skeleton) {
        if self.calibration {
            let kinds: &[&str] = if self.version == 4 {
                &["identity", "tpose", "tpose-isb"]
            } else {
                &["npose", "tpose"]
            };
            for kind in kinds {
                to.element(
                    &format!("frame time=\"0\" index=\"\" tc=\"00:00:00:00\" ms=\"0\" type=\"{kind}\""),
                    |to| {
                        self.write_calibration(to, kind, skeleton);
                    },
                );
            }
        }
        for frame in 0..self.frames {
            let milliseconds = 1_542_082_631_842 + u64::from(frame) * 10;
            let tag = format!(
                "frame time=\"{}\" index=\"{}\" tc=\"04:17:11:84\" ms=\"{milliseconds}\" type=\"normal\"",
                frame * 10,
                frame + 5
            );
            to.element(&tag, |to| self.write_frame(to, frame));
        }
    }

    fn write_calibration(&self, to: &mut Writer<'_>, kind: &str, skeleton: &Skeleton) {
        let body = &skeleton.segments[..self.segments()];
        let isb = matches!(kind, "npose" | "tpose-isb");
        let orientations = body.iter().flat_map(|segment| {
            let q = if isb { segment.isb } else { DQuat::IDENTITY };
            [q.w, q.x, q.y, q.z]
        });
        to.numbers("orientation", orientations.collect());
        to.numbers(
            "position",
            body.iter()
                .flat_map(|segment| segment.origin.unwrap().to_array())
                .collect(),
        );
    }

    fn write_frame(&self, to: &mut Writer<'_>, frame: u32) {
        for (name, count) in self.sections() {
            to.numbers(name, values(frame, name, count));
        }
        if self.version == 4 {
            to.line(&format!("<footContacts>1 0 {} 0</footContacts>", frame % 2));
        }
        to.text.push_str(self.extra);
    }
}

fn write_angles_and_contacts(to: &mut Writer<'_>, skeleton: &Skeleton) {
    to.element("ergonomicJointAngles", |to| {
        for (index, angle) in standard::ERGONOMIC_ANGLES.iter().enumerate() {
            let parent = angle.parent.map_or("Vertical", |place| &skeleton.segments[place].name);
            let (name, child) = (angle.name, &skeleton.segments[angle.child].name);
            to.line(&format!(
                "<ergonomicJointAngle label=\"{name}\" index=\"{index}\" parentSegment=\"{parent}\" childSegment=\"{child}\"/>"
            ));
        }
    });
    to.element("footContactDefinition", |to| {
        for (index, label) in standard::FOOT_CONTACTS.iter().enumerate() {
            to.line(&format!("<contactDefinition label=\"{label}\" index=\"{index}\"/>"));
        }
    });
}

struct Writer<'a> {
    text: String,
    depth: usize,
    style: &'a MadeUp,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        let indent = self.style.indent.repeat(self.depth);
        let _ = write!(self.text, "{indent}{line}{}", self.style.newline);
    }

    fn element(&mut self, tag: &str, content: impl FnOnce(&mut Self)) {
        self.line(&format!("<{tag}>"));
        self.depth += 1;
        content(self);
        self.depth -= 1;
        let name = tag.split(' ').next().unwrap_or_default();
        self.line(&format!("</{name}>"));
    }

    fn numbers(&mut self, name: &str, numbers: Vec<f64>) {
        let text: Vec<_> = numbers.into_iter().map(|number| format!("{number:.6}")).collect();
        self.line(&format!("<{name}>{}</{name}>", text.join(" ")));
    }

    fn segments(&mut self, name: &str, segments: &[posewire_motion::Segment]) {
        let offset = if self.style.version == 4 { "pos_b" } else { "pos_s" };
        self.element(name, |to| {
            for (segment, id) in segments.iter().zip(1..) {
                to.element(&format!("segment label=\"{}\" id=\"{id}\"", segment.name), |to| {
                    to.element("points", |to| {
                        for point in &segment.points {
                            to.element(&format!("point label=\"{}\"", point.name), |to| {
                                to.numbers(offset, point.offset.to_array().to_vec());
                            });
                        }
                    });
                });
            }
        });
    }

    fn joints(&mut self, name: &str, joints: &[(String, usize, usize)], skeleton: &Skeleton) {
        self.element(name, |to| {
            for (label, parent, child) in joints {
                to.element(&format!("joint label=\"{label}\""), |to| {
                    for (number, segment) in [(1, *parent), (2, *child)] {
                        let segment = &skeleton.segments[segment].name;
                        to.line(&format!("<connector{number}>{segment}/{label}</connector{number}>"));
                    }
                });
            }
        });
    }
}

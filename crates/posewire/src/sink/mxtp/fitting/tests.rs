use super::*;

fn subject(id: u32, name: &str, bones: &[&str]) -> Arc<Subject> {
    let segment = |name: &&str| Segment::new(*name, SegmentKind::Body);
    let skeleton = Skeleton {
        segments: bones.iter().map(segment).collect(),
        ..Skeleton::default()
    };
    Arc::new(Subject {
        id,
        ..Subject::new(name, skeleton)
    })
}

fn posed(subject: &Arc<Subject>) -> Frame {
    let mut frame = Frame::new(Arc::clone(subject));
    let count = subject.skeleton.segments.len();
    frame.position = (0..count).map(|place| Some(DVec3::Z * place as f64)).collect();
    frame.orientation = vec![Some(DQuat::IDENTITY); count];
    frame
}

fn told(fitting: &Fitting) -> Vec<String> {
    let line = |entry: &LeftOut| format!("{}: {}", entry.what, entry.why);
    fitting.left_out().iter().map(line).collect()
}

#[test]
fn a_body_named_as_mvns_passes_with_props_and_fingers_and_gets_its_angles() {
    let standard = Skeleton::standard(2, true);
    let names: Vec<_> = standard.segments.iter().map(|segment| segment.name.as_str()).collect();
    let ada = subject(4, "Ada", &names);
    let mut fitting = Fitting::default();
    let fitted = fitting.frame(&posed(&ada)).unwrap();
    assert_eq!((fitted.subject.id, fitted.subject.name.as_str()), (0, "Ada"));
    let kinds = |skeleton: &Skeleton| skeleton.segments.iter().map(|segment| segment.kind).collect::<Vec<_>>();
    assert_eq!(kinds(&fitted.subject.skeleton), kinds(&standard));
    assert_eq!(fitted.position, posed(&ada).position);
    assert!(fitted.joint_angles.len() >= 22 && fitted.joint_angles[0].is_some());
    assert_eq!(told(&fitting), [""; 0]);
}

#[test]
fn motives_bones_are_found_by_name_and_what_it_lacks_is_said() {
    let bones = [
        "Hip",
        "Ab",
        "Chest",
        "Neck",
        "Head",
        "LShoulder",
        "LUArm",
        "LFArm",
        "LHand",
        "RShoulder",
        "RUArm",
        "RFArm",
        "RHand",
        "LThigh",
        "LShin",
        "LFoot",
        "LToe",
        "RThigh",
        "RShin",
        "RFoot",
        "RToe",
        "LThumb1",
    ];
    for prefix in ["", "Bea_"] {
        let bones: Vec<_> = bones.iter().map(|bone| format!("{prefix}{bone}")).collect();
        let names: Vec<_> = bones.iter().map(String::as_str).collect();
        let bea = subject(0, "Bea", &names);
        let mut fitting = Fitting::default();
        let fitted = fitting.frame(&posed(&bea)).unwrap();
        let place = |name: &str| fitted.subject.skeleton.segment(name).unwrap();
        assert_eq!(fitted.position[place("LeftToe")], Some(DVec3::Z * 16.0));
        assert_eq!(fitted.position[place("RightUpperArm")], Some(DVec3::Z * 10.0));
        assert_eq!(fitted.position[place("T12")], None);
        assert_eq!(fitted.check(), Ok(()));
        let expected = [
            format!("{prefix}LThumb1 of Bea: MXTP has no place for it"),
            "L3, T12 of Bea: the source has no such segment".to_owned(),
        ];
        assert_eq!(told(&fitting), expected);
    }
}

#[test]
fn what_is_no_person_is_left_out_and_takes_no_number() {
    let standard = Skeleton::standard(0, false);
    let names: Vec<_> = standard.segments.iter().map(|segment| segment.name.as_str()).collect();
    let mut fitting = Fitting::default();
    for (id, name, bones) in [
        (0, "Wand", &["Wand"][..]),
        (1, "Dog", &["Hip", "Tail"]),
        (2, "Markers", &[]),
    ] {
        assert_eq!(fitting.frame(&posed(&subject(id, name, bones))), None);
    }
    let ada = subject(3, "Ada", &names);
    assert_eq!(fitting.character(&ada).unwrap().id, 0);
    assert_eq!(fitting.character(&subject(9, "Bea", &names)).unwrap().id, 1);
    let again = subject(3, "Ada Lovelace", &names);
    assert_eq!(fitting.character(&again).unwrap().id, 0);
    let expected = [
        "rigid body Wand: MXTP has no place for it",
        "skeleton Dog, whose bones are not named as a person's: MXTP has no place for it",
        "markers without a body: MXTP has no place for it",
    ];
    assert_eq!(told(&fitting), expected);
}

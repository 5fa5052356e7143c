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
    fitting.left_out().iter().map(line).collect()
}

fn line(entry: &LeftOut) -> String {
    format!("{}: {}", entry.what, entry.why)
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
fn types_that_fitted_frames_never_fill_are_left_out() {
    let mut types = MessageTypes::DEFAULT;
    let left_out = Fitting::leave_out_types(&mut types);
    assert_eq!(types, MessageTypes::DEFAULT.without(MessageType::CENTER_OF_MASS));
    let expected = "datagram type 24 (centre of mass): the source does not carry what it holds";
    assert_eq!(left_out.iter().map(line).collect::<Vec<_>>(), [expected]);
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

/// Two skeletons under one number: without names as found in frames, and named as MVN's.
fn nameless_and_named(id: u32) -> [Arc<Subject>; 2] {
    let standard = Skeleton::standard(0, false);
    let names: Vec<_> = standard.segments.iter().map(|segment| segment.name.as_str()).collect();
    [
        subject(id, "Skeleton 3", &["Bone 1", "Bone 2"]),
        subject(id, "Ada", &names),
    ]
}

#[test]
fn a_person_whose_names_come_late_is_a_character_from_then_on() {
    let [nameless, named] = nameless_and_named(0);
    let mut fitting = Fitting::default();
    assert_eq!(fitting.frame(&posed(&nameless)), None);
    assert_eq!(fitting.frame(&posed(&named)).unwrap().subject.id, 0);
}

#[test]
fn a_number_is_not_given_twice_when_a_person_is_described_as_something_else() {
    let [(other, ada), (_, bea), (_, eve)] = [0, 1, 2].map(|id| nameless_and_named(id).into());
    let mut fitting = Fitting::default();
    let mut number = |subject| fitting.character(subject).map(|character| character.id);
    let numbers = [&ada, &bea, &other, &eve, &ada].map(&mut number);
    assert_eq!(numbers, [Some(0), Some(1), None, Some(2), Some(0)]);
}

#[test]
fn what_is_left_out_of_a_source_that_always_changes_is_bounded() {
    let mut fitting = Fitting::default();
    for number in 0..1000 {
        fitting.character(&subject(0, &format!("Wand {number}"), &["Wand"]));
    }
    assert_eq!(fitting.left_out().len(), MOST_TOLD);
}

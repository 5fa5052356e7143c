//! Parquet.

#[cfg(not(feature = "parquet"))]
#[test]
fn without_the_feature_the_answer_is_how_to_get_it() {
    use posewire::endpoint::FileFormat;
    use posewire::file::{Progress, Recording, WriteOptions, write};
    let recording = Recording::from(crate::walk());
    let mut out = std::io::Cursor::new(Vec::new());
    let result = write(
        FileFormat::Parquet,
        &recording,
        &WriteOptions::default(),
        &Progress::default(),
        &mut out,
    );
    let error = result.unwrap_err();
    assert_eq!(error.to_string(), "Parquet is not in this build of posewire");
    assert!(error.help().unwrap().contains("--features parquet"));
}

#[cfg(feature = "parquet")]
mod with_the_feature {
    use crate::{FORE_ARM, things, walk, written_with};
    use ::parquet::basic::Type;
    use ::parquet::file::reader::{FileReader, SerializedFileReader};
    use ::parquet::record::{Field, Row};
    use posewire::endpoint::FileFormat;
    use posewire::file::{ParquetOptions, WriteOptions};
    use posewire_motion::{DVec3, Frame, Section, Take};
    use std::collections::HashSet;
    use std::fs::File;
    use std::io::{Seek, Write};
    use std::sync::Arc;

    struct Table {
        file: SerializedFileReader<File>,
        rows: Vec<Row>,
    }

    impl Table {
        fn of(take: &Take, micro_units: bool) -> Self {
            let options = WriteOptions {
                parquet: ParquetOptions { micro_units },
                ..WriteOptions::default()
            };
            let mut file = tempfile::tempfile().unwrap();
            file.write_all(&written_with(FileFormat::Parquet, take, &options).0)
                .unwrap();
            file.rewind().unwrap();
            let file = SerializedFileReader::new(file).unwrap();
            let rows = file.get_row_iter(None).unwrap().map(Result::unwrap).collect();
            Self { file, rows }
        }

        fn value(&self, row: usize, name: &str) -> &Field {
            let mut columns = self.rows[row].get_column_iter();
            let found = columns.find(|(found, _)| *found == name);
            found.unwrap_or_else(|| panic!("{name} is a column")).1
        }

        fn metadata(&self, key: &str) -> String {
            let pairs = self.file.metadata().file_metadata().key_value_metadata().unwrap();
            pairs
                .iter()
                .find(|pair| pair.key == key)
                .and_then(|pair| pair.value.clone())
                .unwrap()
        }

        fn kind(&self, name: &str) -> Type {
            let schema = self.file.metadata().file_metadata().schema_descr();
            let columns = schema.columns().iter();
            columns
                .filter(|column| column.name() == name)
                .map(|column| column.physical_type())
                .next()
                .unwrap()
        }
    }

    #[test]
    fn a_row_is_a_frame_and_what_is_not_tracked_is_null() {
        let take = walk();
        let table = Table::of(&take, false);
        assert_eq!(table.rows.len(), 3);
        assert_eq!(table.value(2, "subject"), &Field::Str("Zoë 🕺".into()));
        assert_eq!(table.value(2, "sample"), &Field::Long(2));
        assert_eq!(table.value(2, "event"), &Field::Str("left; größer".into()));
        assert_eq!(table.value(1, "event"), &Field::Null);
        assert_eq!(table.value(0, "contact_LeftFoot_Heel"), &Field::Null);
        assert_eq!(table.value(1, "contact_LeftFoot_Heel"), &Field::Bool(true));
        assert_eq!(table.value(1, "position_RightForeArm_x"), &Field::Null);
        let expected = take.column(Section::Position).unwrap().vector(2, FORE_ARM).unwrap();
        assert_eq!(table.value(2, "position_RightForeArm_x"), &Field::Double(expected.x));
        assert_eq!(
            table.value(0, "joint_angles_jRightElbow_z"),
            &Field::Double(0.5_f64.to_degrees())
        );
    }

    #[test]
    fn the_metadata_tells_what_columns_do_not() {
        let table = Table::of(&walk(), false);
        assert_eq!(
            (table.metadata("posewire.subject"), table.metadata("posewire.rate")),
            ("Zoë 🕺".into(), "60".into())
        );
        let skeleton: serde_json::Value = serde_json::from_str(&table.metadata("posewire.skeleton")).unwrap();
        assert_eq!(
            (&skeleton["segments"][6]["name"], &skeleton["segments"][6]["parent"]),
            (&"Head".into(), &5.into())
        );
        let sections: serde_json::Value = serde_json::from_str(&table.metadata("posewire.sections")).unwrap();
        assert_eq!(sections["joint_angles"]["unit"], "deg");
        assert_eq!(sections["position"]["columns"][20], "position_Head_z");
    }

    #[test]
    fn micro_units_are_decimals_as_wide_as_they_must_be() {
        let mut take = Take::new(walk().subject, 60.0);
        let mut frame = Frame::new(Arc::clone(&take.subject));
        frame.position = vec![Some(DVec3::new(-0.000_001, 999.999_999, 0.5)); 23];
        frame.acceleration = vec![Some(DVec3::new(1000.25, 0.0, f64::INFINITY)); 23];
        take.push(&frame).unwrap();
        let table = Table::of(&take, true);
        assert_eq!(table.kind("position_Head_x"), Type::INT32);
        assert_eq!(table.kind("acceleration_Head_x"), Type::INT64);
        let text = |name: &str| table.value(0, name).to_string();
        assert_eq!(
            (text("position_Head_x"), text("position_Head_y")),
            ("-0.000001".into(), "999.999999".into())
        );
        assert_eq!(
            (text("acceleration_Head_x"), text("acceleration_Head_z")),
            ("1000.250000".into(), "null".into())
        );
    }

    #[test]
    fn digits_that_micro_units_lose_are_said() {
        let options = WriteOptions {
            parquet: ParquetOptions { micro_units: true },
            ..WriteOptions::default()
        };
        let (_, left_out) = written_with(FileFormat::Parquet, &walk(), &options);
        assert!(
            left_out
                .iter()
                .any(|line| line == "digits of the position after the sixth"),
            "{left_out}"
        );
    }

    #[test]
    fn long_takes_are_in_several_groups_of_rows() {
        let table = Table::of(&things(1, 20_001), false);
        assert_eq!((table.file.num_row_groups(), table.rows.len()), (2, 20_001));
        assert_eq!(table.value(20_000, "sample"), &Field::Long(20_000));
    }

    #[test]
    fn names_need_no_quotes_and_are_told_apart() {
        let mut subject = (*things(3, 0).subject).clone();
        for (segment, name) in subject.skeleton.segments.iter_mut().zip(["Öl 1.a", "ÖL-1-a", "b"]) {
            segment.name = name.to_owned();
        }
        let mut take = Take::new(Arc::new(subject), 60.0);
        take.push(&Frame {
            subject: Arc::clone(&take.subject),
            ..things(3, 1).frame(0)
        })
        .unwrap();
        let table = Table::of(&take, false);
        let columns: Vec<_> = table.rows[0].get_column_iter().map(|(name, _)| name.clone()).collect();
        assert_eq!(
            columns[3..7],
            [
                "position_Öl_1_a_x",
                "position_Öl_1_a_y",
                "position_Öl_1_a_z",
                "position_ÖL_1_a_x_2"
            ]
        );
        let names: HashSet<_> = columns.iter().map(|name| name.to_lowercase()).collect();
        assert_eq!(names.len(), columns.len());
    }

    #[test]
    fn a_take_without_frames_is_a_table_without_rows() {
        let table = Table::of(&walk().slice(0..0), true);
        assert!(table.rows.is_empty());
    }
}

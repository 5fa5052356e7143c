//! Comma-separated values with the names of MVN's Excel export.
//!
//! Lines end as RFC 4180 has them, numbers have six decimals, what is not tracked is an empty field. Angles of joints are
//! in degrees and angular velocities in rad/s, as MVN writes both; lengths are in the unit of the file.

mod names;

use super::problem::Problem;
use super::text::Line;
use super::{Job, LeftOut, Output};
use names::{columns, sheet};
use posewire_motion::{Column, Section, Take};

/// One file: the sections of the job side by side, or as one sheet of MVN's when each section has a file.
pub(super) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let table = Table::of(job);
    let mut line = Line::new(',');
    table.write_names(job.take, &mut line);
    line.end(out, END)?;
    let mut values = Vec::new();
    let mut events = job.take.events().iter().peekable();
    for frame in 0..job.take.len() {
        table.write_times(job.take, frame, &mut line);
        for column in &table.columns {
            job.read_row(column, frame, &mut values);
            write_values(&values, column.section(), &mut line);
        }
        if table.details {
            write_contacts(job.take, frame, &mut line);
            let mut names = Vec::new();
            while let Some((_, name)) = events.next_if(|(place, _)| *place == frame) {
                names.push(name.as_str());
            }
            line.field(&quoted(&names.join("; ")));
        }
        line.end(out, END)?;
        job.progress.advance(1)?;
    }
    Ok(LeftOut::new())
}

/// What the columns of a file are.
struct Table<'a> {
    columns: Vec<&'a Column>,
    /// Whether sections stand side by side and their names are needed to tell columns apart.
    with_sheets: bool,
    /// Whether the frames' times stand there.
    times: bool,
    /// Whether timecodes, contacts and events stand there.
    details: bool,
}

impl<'a> Table<'a> {
    fn of(job: &Job<'a>) -> Self {
        let columns: Vec<_> = job.sections().filter_map(|section| job.take.column(section)).collect();
        let asked = job.options.sections.as_deref();
        let sheets = job.options.csv.file_per_section;
        Self {
            with_sheets: !sheets,
            times: !sheets || columns.is_empty(),
            details: asked.is_none() || (sheets && columns.is_empty()),
            columns,
        }
    }

    fn write_names(&self, take: &Take, line: &mut Line) {
        line.field("Frame");
        if self.times {
            line.field("Time");
        }
        if self.details {
            line.field("Timecode");
        }
        for column in &self.columns {
            for name in columns(column.section(), &take.subject.skeleton) {
                if self.with_sheets {
                    line.field(&quoted(&format!("{} {name}", sheet(column.section()))));
                } else {
                    line.field(&quoted(&name));
                }
            }
        }
        if self.details {
            for contact in &take.subject.skeleton.contacts {
                line.field(&quoted(&format!("Contact {contact}")));
            }
            line.field("Events");
        }
    }

    fn write_times(&self, take: &Take, frame: usize, line: &mut Line) {
        line.whole(take.samples()[frame]);
        if self.times {
            line.number(take.times()[frame].as_secs_f64(), DECIMALS);
        }
        if self.details {
            let timecode = take.timecodes()[frame].map(|timecode| timecode.to_string());
            line.field(&timecode.unwrap_or_default());
        }
    }
}

fn write_values(values: &[f64], section: Section, line: &mut Line) {
    let in_degrees = section.unit() == "rad";
    for value in values {
        let value = if in_degrees { value.to_degrees() } else { *value };
        line.number(value, DECIMALS);
    }
}

fn write_contacts(take: &Take, frame: usize, line: &mut Line) {
    let contacts = take.contacts(frame);
    for place in 0..take.subject.skeleton.contacts.len() {
        line.field(match contacts.get(place) {
            Some(true) => "1",
            Some(false) => "0",
            None => "",
        });
    }
}

/// A field as RFC 4180 has it: in quotes where it holds a comma, a quote or a line break.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\r', '\n']) {
        return format!("\"{}\"", text.replace('"', "\"\""));
    }
    text.to_owned()
}

const DECIMALS: usize = 6;
const END: &str = "\r\n";

#[cfg(test)]
mod tests {
    use super::super::tests::{text_of, walk};
    use crate::endpoint::FileFormat;
    use crate::file::{Axes, CsvOptions, WriteOptions};
    use posewire_motion::{DVec3, Frame, Section, Skeleton, Subject, Take, Timecode, Unit};
    use std::f64::consts::FRAC_PI_2;
    use std::sync::Arc;
    use std::time::Duration;

    fn small() -> Take {
        let mut skeleton = Skeleton::standard(0, false);
        skeleton.segments.truncate(2);
        skeleton.joints.truncate(1);
        skeleton.ergonomic_angles.clear();
        skeleton.sensors.clear();
        skeleton.contacts.truncate(1);
        let subject = Arc::new(Subject::new("Ada", skeleton));
        let mut take = Take::new(Arc::clone(&subject), 60.0);
        let mut frame = Frame::new(subject);
        frame.sample = 7;
        frame.time = Duration::from_millis(125);
        frame.timecode = Some(Timecode::from_milliseconds(1500));
        frame.position = vec![Some(DVec3::new(1.0, -2.5, 0.25)), None];
        frame.angular_velocity = vec![Some(DVec3::new(1.0, 2.0, 3.0)), None];
        frame.joint_angles = vec![Some(DVec3::new(0.0, FRAC_PI_2, -FRAC_PI_2))];
        frame.contacts = vec![true];
        frame.events = vec!["say \"go\"".to_owned(), "jump, land".to_owned()];
        take.push(&frame).unwrap();
        take
    }

    #[test]
    fn a_wide_file_has_all_sections_side_by_side() {
        let text = text_of(FileFormat::Csv, small(), &WriteOptions::default());
        let expected = "Frame,Time,Timecode,Segment Position Pelvis x,Segment Position Pelvis y,Segment Position Pelvis z,\
            Segment Position L5 x,Segment Position L5 y,Segment Position L5 z,\
            Segment Angular Velocity Pelvis x,Segment Angular Velocity Pelvis y,Segment Angular Velocity Pelvis z,\
            Segment Angular Velocity L5 x,Segment Angular Velocity L5 y,Segment Angular Velocity L5 z,\
            Joint Angles ZXY L5S1 Lateral Bending,Joint Angles ZXY L5S1 Axial Bending,\
            Joint Angles ZXY L5S1 Flexion/Extension,Contact LeftFoot_Heel,Events\r\n\
            7,0.125000,00:00:01.500,1.000000,-2.500000,0.250000,,,,1.000000,2.000000,3.000000,,,,\
            0.000000,90.000000,-90.000000,1,\"say \"\"go\"\"; jump, land\"\r\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_sheet_has_the_columns_of_mvn_alone() {
        let options = WriteOptions {
            sections: Some(vec![Section::JointAngles]),
            csv: CsvOptions { file_per_section: true },
            ..WriteOptions::default()
        };
        let text = text_of(FileFormat::Csv, small(), &options);
        let expected = "Frame,L5S1 Lateral Bending,L5S1 Axial Bending,L5S1 Flexion/Extension\r\n7,0.000000,90.000000,-90.000000\r\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn other_axes_and_units_are_written_where_asked_for() {
        let options = WriteOptions {
            axes: Some(Axes::Unity),
            unit: Some(Unit::Centimetre),
            sections: Some(vec![Section::Position, Section::AngularVelocity]),
            ..WriteOptions::default()
        };
        let text = text_of(FileFormat::Csv, small(), &options);
        let row = text.lines().nth(1).unwrap();
        assert_eq!(
            row,
            "7,0.125000,250.000000,25.000000,100.000000,,,,2.000000,-3.000000,-1.000000,,,"
        );
    }

    #[test]
    fn every_row_has_a_field_for_each_name() {
        let text = text_of(FileFormat::Csv, walk(3), &WriteOptions::default());
        let fields: Vec<_> = text.lines().map(|line| line.split(',').count()).collect();
        assert_eq!(fields.len(), 4);
        assert!(fields.windows(2).all(|pair| pair[0] == pair[1]), "{fields:?}");
    }
}

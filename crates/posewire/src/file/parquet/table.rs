//! Which columns the table of a take has.

use super::super::Job;
use super::super::names::Unique;
use super::{MILLION, Schema};
use ::parquet::basic::{LogicalType, Repetition, Type};
use ::parquet::schema::types::Type as SchemaType;
use posewire_motion::{Column, Per, Section};
use std::sync::Arc;

/// The columns of a take's table, in order.
pub(super) struct Table {
    pub(super) fields: Vec<Field>,
}

/// One column.
pub(super) struct Field {
    /// Of letters, digits and `_`; the only one of this name whatever the case.
    pub(super) name: String,
    pub(super) kind: Type,
    pub(super) of: Of,
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Of {
    Subject,
    Sample,
    Time,
    Timecode,
    Event,
    Contact(usize),
    /// The number at a place of each row of a section.
    Number {
        section: Section,
        place: usize,
    },
}

impl Table {
    /// Of the sections to write. Events, contacts and timecodes are columns where any frame has them.
    pub(super) fn of(job: &Job<'_>) -> Self {
        let take = job.take;
        let mut table = Self { fields: Vec::new() };
        table.add("subject", Type::BYTE_ARRAY, Of::Subject);
        table.add("sample", Type::INT64, Of::Sample);
        table.add("time", Type::DOUBLE, Of::Time);
        if take.timecodes().iter().any(Option::is_some) {
            table.add("timecode_ms", Type::INT32, Of::Timecode);
        }
        if job.options.sections.is_none() {
            table.add_marks(job);
        }
        for column in job.sections().filter_map(|section| take.column(section)) {
            table.add_section(job, column);
        }
        table.make_unique();
        table
    }

    /// Subject, sample and time are in every row; all else may be null.
    pub(super) fn schema(&self) -> Schema {
        let fields: Result<Vec<_>, _> = self
            .fields
            .iter()
            .map(|field| schema_field(field).map(Arc::new))
            .collect();
        let schema = SchemaType::group_type_builder("take").with_fields(fields?).build()?;
        Ok(Arc::new(schema))
    }

    fn add(&mut self, name: &str, kind: Type, of: Of) {
        let letter = |letter: char| if letter.is_alphanumeric() { letter } else { '_' };
        let name = name.chars().map(letter).collect();
        self.fields.push(Field { name, kind, of });
    }

    fn add_marks(&mut self, job: &Job<'_>) {
        let take = job.take;
        if !take.events().is_empty() {
            self.add("event", Type::BYTE_ARRAY, Of::Event);
        }
        let told = (0..take.len())
            .map(|frame| take.contacts(frame).len())
            .max()
            .unwrap_or(0);
        let names = &take.subject.skeleton.contacts;
        for contact in 0..told {
            let name = names.get(contact).map_or_else(|| contact.to_string(), Clone::clone);
            self.add(&format!("contact_{name}"), Type::BOOLEAN, Of::Contact(contact));
        }
    }

    fn add_section(&mut self, job: &Job<'_>, column: &Column) {
        let section = column.section();
        let kind = number_kind(job, column);
        let labels: Vec<_> = section.labels(&job.take.subject.skeleton).collect();
        let [_, entries, components] = column.shape();
        for place in 0..entries * components {
            let axis = section.axes()[place % components];
            let label = labels.get(place / components).copied().unwrap_or_default();
            let name = match section.per() {
                Per::Body => format!("{section}_{axis}"),
                _ => format!("{section}_{label}_{axis}"),
            };
            self.add(&name, kind, Of::Number { section, place });
        }
    }

    /// Gives a number to a name that is there already.
    fn make_unique(&mut self) {
        let mut names = Unique::default();
        for field in &mut self.fields {
            field.name = names.name(&field.name);
        }
    }
}

/// The numbers of a frame in the file's axes and unit, and angles in degrees.
pub(super) fn read_row(job: &Job<'_>, column: &Column, frame: usize, to: &mut Vec<f64>) {
    job.read_row(column, frame, to);
    if is_angle(column.section()) {
        for number in to {
            *number = number.to_degrees();
        }
    }
}

/// Whether the section's numbers are angles, which the file has in degrees.
pub(super) fn is_angle(section: Section) -> bool {
    section.unit() == "rad"
}

/// The type of a section's numbers: the smaller of the decimals that holds them all.
fn number_kind(job: &Job<'_>, column: &Column) -> Type {
    if !job.options.parquet.micro_units {
        return Type::DOUBLE;
    }
    let mut row = Vec::new();
    let fits = (0..job.take.len()).all(|frame| {
        read_row(job, column, frame, &mut row);
        row.iter()
            .all(|number| !number.is_finite() || (number * MILLION).round().abs() <= MOST_SHORT)
    });
    if fits { Type::INT32 } else { Type::INT64 }
}

fn schema_field(field: &Field) -> Result<SchemaType, ::parquet::errors::ParquetError> {
    let repetition = match field.of {
        Of::Subject | Of::Sample | Of::Time => Repetition::REQUIRED,
        _ => Repetition::OPTIONAL,
    };
    let builder = SchemaType::primitive_type_builder(&field.name, field.kind).with_repetition(repetition);
    let decimal = matches!(field.of, Of::Number { .. });
    let builder = match field.kind {
        Type::BYTE_ARRAY => builder.with_logical_type(Some(LogicalType::String)),
        Type::INT32 if decimal => builder
            .with_logical_type(Some(LogicalType::decimal(6, 9)))
            .with_precision(9)
            .with_scale(6),
        Type::INT64 if decimal => builder
            .with_logical_type(Some(LogicalType::decimal(6, 18)))
            .with_precision(18)
            .with_scale(6),
        _ => builder,
    };
    builder.build()
}

/// The greatest whole number of a decimal of nine digits.
const MOST_SHORT: f64 = 999_999_999.0;

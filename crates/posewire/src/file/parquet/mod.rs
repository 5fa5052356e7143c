//! Parquet: a row for each frame, a column for each number, for `DuckDB`, Polars and Spark.
//!
//! | column | type | |
//! |---|---|---|
//! | `subject` | text | the same in every row, so that a folder of takes is one table |
//! | `sample`, `time` | `INT64`, `DOUBLE` | the source's number and clock, s |
//! | `timecode_ms` | `INT32` | since midnight, UTC; Spark reads no type for a time of day |
//! | `event` | text | names of the events set at the frame, with `; ` between |
//! | `contact_LeftFoot_Heel`, ... | `BOOLEAN` | |
//! | `position_Pelvis_x`, ... | `DOUBLE` | joint angles in degrees |
//!
//! Columns are flat, and their names of letters, digits and `_`, so that none of the three needs quotes: with dots in a name
//! Spark and `DuckDB` look for a structure, and lists of fixed size come out as lists of any size, which are slower and
//! cannot be read one component at a time. What is not tracked is null. The names as the source has them, units, skeleton and
//! rate are in the file's key-value metadata.
//!
//! In micro-units a number is a `DECIMAL` of six digits behind the point: lossless for what MVNX says, and small as the
//! differences of whole numbers. All three read it as what it is, without a factor.

mod metadata;
mod table;

use super::output::Output;
use super::problem::Problem;
use super::{Job, LeftOut};
use ::parquet::basic::{Compression, Encoding, Type, ZstdLevel};
use ::parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int32Type, Int64Type};
use ::parquet::errors::ParquetError;
use ::parquet::file::properties::{EnabledStatistics, WriterProperties};
use ::parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use ::parquet::schema::types::{ColumnPath, TypePtr};
use posewire_motion::{Column, Section};
use std::io::{self, Write};
use std::ops::Range;
use std::sync::Arc;
use table::{Field, Of, Table};

/// Writes the sections asked for, and subject, sample and time in any case.
///
/// # Errors
/// When `out` fails.
pub(super) fn write(job: &Job<'_>, out: &mut Output<'_>) -> Result<LeftOut, Problem> {
    let table = Table::of(job);
    let schema = table.schema().map_err(failed)?;
    let properties = Arc::new(properties(job, &table));
    let mut file = SerializedFileWriter::new(Vec::new(), schema, properties).map_err(failed)?;
    let mut rows = Rows::new(job);
    for begin in (0..job.take.len()).step_by(ROWS) {
        let range = begin..job.take.len().min(begin + ROWS);
        let mut group = file.next_row_group().map_err(failed)?;
        for field in &table.fields {
            let mut column = group
                .next_column()
                .map_err(failed)?
                .ok_or_else(|| failed(too_few_columns()))?;
            rows.write(field, range.clone(), &mut column).map_err(failed)?;
            column.close().map_err(failed)?;
            job.progress.advance(0)?;
        }
        group.close().map_err(failed)?;
        file.flush()?;
        out.write_all(&std::mem::take(file.inner_mut()))?;
        job.progress.advance(range.len() as u64)?;
    }
    out.write_all(&file.into_inner().map_err(failed)?)?;
    Ok(rows.left_out())
}

fn properties(job: &Job<'_>, table: &Table) -> WriterProperties {
    let mut properties = WriterProperties::builder()
        .set_created_by(concat!("posewire ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_offset_index_disabled(true)
        .set_key_value_metadata(Some(metadata::of(job, table)));
    for field in &table.fields {
        let path = ColumnPath::new(vec![field.name.clone()]);
        let encoding = match field.kind {
            Type::INT32 | Type::INT64 => Encoding::DELTA_BINARY_PACKED,
            Type::DOUBLE => Encoding::BYTE_STREAM_SPLIT,
            Type::BYTE_ARRAY => {
                properties = properties.set_column_dictionary_enabled(path.clone(), true);
                Encoding::PLAIN
            }
            _ => Encoding::PLAIN,
        };
        properties = properties.set_column_encoding(path, encoding);
    }
    properties.build()
}

/// The frames of a take as rows: a section at a time, a group of rows at a time.
struct Rows<'a> {
    job: &'a Job<'a>,
    /// The rows of a section that were read last, and which they are.
    values: Vec<f64>,
    read: Option<(Section, Range<usize>)>,
    /// Sections in decimals that have more than six digits behind the point.
    rounded: Vec<Section>,
}

impl<'a> Rows<'a> {
    fn new(job: &'a Job<'a>) -> Self {
        Self {
            job,
            values: Vec::new(),
            read: None,
            rounded: Vec::new(),
        }
    }

    fn write(
        &mut self,
        field: &Field,
        range: Range<usize>,
        to: &mut SerializedColumnWriter<'_>,
    ) -> Result<(), ParquetError> {
        let take = self.job.take;
        match field.of {
            Of::Subject => {
                let name = ByteArray::from(take.subject.name.as_bytes().to_vec());
                required::<ByteArrayType>(to, &vec![name; range.len()])
            }
            Of::Sample => {
                let samples: Vec<_> = take.samples()[range].iter().map(|sample| i64::from(*sample)).collect();
                required::<Int64Type>(to, &samples)
            }
            Of::Time => {
                let times: Vec<_> = take.seconds().skip(range.start).take(range.len()).collect();
                required::<DoubleType>(to, &times)
            }
            Of::Timecode => {
                let timecodes = take.timecodes()[range].iter();
                optional::<Int32Type>(
                    to,
                    timecodes.map(|timecode| Some(timecode.as_ref()?.milliseconds() as i32)),
                )
            }
            Of::Event => optional::<ByteArrayType>(to, range.map(|frame| self.events(frame))),
            Of::Contact(contact) => {
                optional::<BoolType>(to, range.map(|frame| take.contacts(frame).get(contact).copied()))
            }
            Of::Number { section, place } => self.write_number(field.kind, section, place, range, to),
        }
    }

    fn write_number(
        &mut self,
        kind: Type,
        section: Section,
        place: usize,
        range: Range<usize>,
        to: &mut SerializedColumnWriter<'_>,
    ) -> Result<(), ParquetError> {
        let Some(column) = self.job.take.column(section) else {
            return Ok(());
        };
        self.read(column, range);
        let [_, entries, components] = column.shape();
        let numbers = self.values.iter().skip(place).step_by(entries * components);
        let numbers = numbers.map(|number| number.is_finite().then_some(*number));
        match kind {
            Type::INT32 => optional::<Int32Type>(to, numbers.map(|number| Some(micro(number?)? as i32))),
            Type::INT64 => optional::<Int64Type>(to, numbers.map(|number| micro(number?))),
            _ => optional::<DoubleType>(to, numbers),
        }
    }

    /// Reads the rows of a section, unless they were read last.
    fn read(&mut self, column: &Column, range: Range<usize>) {
        let wanted = Some((column.section(), range.clone()));
        if self.read == wanted {
            return;
        }
        self.values.clear();
        let mut row = Vec::new();
        for frame in range {
            table::read_row(self.job, column, frame, &mut row);
            self.values.extend_from_slice(&row);
        }
        let section = column.section();
        if self.job.options.parquet.micro_units
            && !self.rounded.contains(&section)
            && self.values.iter().any(|v| is_finer(*v))
        {
            self.rounded.push(section);
        }
        self.read = wanted;
    }

    fn events(&self, frame: usize) -> Option<ByteArray> {
        let events = self.job.take.events();
        let first = events.partition_point(|(at, _)| *at < frame);
        let names = events[first..]
            .iter()
            .take_while(|(at, _)| *at == frame)
            .map(|(_, name)| name.as_str());
        let names: Vec<_> = names.collect();
        (!names.is_empty()).then(|| ByteArray::from(names.join("; ").into_bytes()))
    }

    fn left_out(&self) -> LeftOut {
        let mut left_out = LeftOut::new();
        for section in &self.rounded {
            left_out.push(format!(
                "digits of the {} after the sixth",
                section.name().replace('_', " ")
            ));
        }
        left_out
    }
}

fn required<T: DataType>(to: &mut SerializedColumnWriter<'_>, values: &[T::T]) -> Result<(), ParquetError> {
    to.typed::<T>().write_batch(values, None, None).map(|_| ())
}

fn optional<T: DataType>(
    to: &mut SerializedColumnWriter<'_>,
    values: impl Iterator<Item = Option<T::T>>,
) -> Result<(), ParquetError> {
    let (mut known, mut levels) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(value.is_some()));
        known.extend(value);
    }
    to.typed::<T>().write_batch(&known, Some(&levels), None).map(|_| ())
}

/// A number in whole millionths, where they fit into the 18 digits of a decimal.
fn micro(number: f64) -> Option<i64> {
    let micro = (number * MILLION).round();
    (micro.abs() <= MOST_LONG).then_some(micro as i64)
}

/// Whether millionths do not say all of a number: by more than what came from turning text, or degrees, into floating point.
fn is_finer(number: f64) -> bool {
    let micro = number * MILLION;
    (micro - micro.round()).abs() > 1e-3
}

fn failed(error: ParquetError) -> Problem {
    Problem::Output(io::Error::other(error))
}

fn too_few_columns() -> ParquetError {
    ParquetError::General("the schema has fewer columns than the table".to_owned())
}

/// Rows of a group: so many that a group is some megabytes, so few that one fits into memory.
const ROWS: usize = 20_000;
const MILLION: f64 = 1e6;
/// The greatest whole number of a decimal of 18 digits.
const MOST_LONG: f64 = 999_999_999_999_999_999.0;

type Schema = Result<TypePtr, ParquetError>;

//! Takes as Arrow tables, by the PyCapsule interface.

use crate::error::exception;
use crate::section::named;
use crate::take::Take;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, RecordBatch, RecordBatchIterator, StringArray, Time32MillisecondArray,
    UInt32Array,
};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use posewire_motion::{Column, Per, Section, Skeleton};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyIterator};
use std::collections::HashSet;
use std::sync::Arc;

/// What `polars.from_arrow` goes by: of an object that could not be pyarrow's, by the names of its classes, it makes one column of
/// structures, whatever the object is. One that could be, and is not, is asked for record batches, and they become a table.
#[pyclass(frozen, subclass, module = "posewire.pyarrow")]
pub(crate) struct Batches;

/// A table that polars, pyarrow, DuckDB and pandas take by the Arrow PyCapsule interface: polars.DataFrame(table),
/// pyarrow.table(table).
#[pyclass(frozen, extends = Batches, module = "posewire")]
pub(crate) struct Table {
    rows: RecordBatch,
}

#[pymethods]
impl Table {
    /// Names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        let schema = self.rows.schema();
        schema.fields().iter().map(|field| field.name().clone()).collect()
    }

    fn __len__(&self) -> usize {
        self.rows.num_rows()
    }

    /// The whole table as one batch. A schema that is asked for is the consumer's to make of it.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        let batches = RecordBatchIterator::new([Ok(self.rows.clone())], self.rows.schema());
        let stream = FFI_ArrowArrayStream::new(Box::new(batches));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    /// Its record batches as pyarrow has them, which must be installed: `polars.from_arrow` asks for them.
    fn __iter__<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyIterator>> {
        let pyarrow = this.py().import("pyarrow")?;
        let batches = pyarrow.call_method1("table", (this,))?.call_method0("to_batches")?;
        batches.try_iter()
    }

    fn __repr__(&self) -> String {
        let (rows, columns) = (self.rows.num_rows(), self.rows.num_columns());
        format!("<posewire.Table: {rows} rows, {columns} columns>")
    }
}

/// The table of a take: `Take.to_arrow`.
pub(crate) fn table(py: Python<'_>, take: &Take, sections: Option<&[String]>) -> PyResult<Py<Table>> {
    let sections = sections.map(named).transpose()?;
    let lacks = |section: &&Section| take.recording.take.column(**section).is_none();
    if let Some(section) = sections.iter().flatten().find(lacks) {
        return Err(take.lacks(*section));
    }
    let take = &take.recording.take;
    let rows = py.detach(|| rows(take, sections.as_deref()));
    let rows = rows.map_err(|error| exception("Error", error.to_string(), None))?;
    Py::new(py, PyClassInitializer::from(Batches).add_subclass(Table { rows }))
}

/// The same columns in the same order as in Parquet, but that a timecode is a time of day, which all that read Arrow know.
fn rows(take: &posewire_motion::Take, sections: Option<&[Section]>) -> Result<RecordBatch, ArrowError> {
    let mut columns = Columns::default();
    let names = std::iter::repeat_n(take.subject.name.as_str(), take.len());
    columns.add("subject", false, Arc::new(StringArray::from_iter_values(names)));
    let samples = take.samples().iter().copied();
    columns.add("sample", false, Arc::new(UInt32Array::from_iter_values(samples)));
    columns.add("time", false, Arc::new(Float64Array::from_iter_values(take.seconds())));
    columns.add_timecodes(take);
    if sections.is_none() {
        columns.add_events(take);
        columns.add_contacts(take);
    }
    let asked = |section: &Section| sections.is_none_or(|asked| asked.contains(section));
    for column in take.sections().filter(asked).filter_map(|section| take.column(section)) {
        columns.add_section(column, &take.subject.skeleton);
    }
    RecordBatch::try_new(Arc::new(Schema::new(columns.fields)), columns.arrays)
}

#[derive(Default)]
struct Columns {
    fields: Vec<Field>,
    arrays: Vec<ArrayRef>,
    names: HashSet<String>,
}

impl Columns {
    /// Names are of letters, digits and `_`, so that SQL needs no quotes, and none is there twice, whatever its case.
    fn add(&mut self, name: &str, nullable: bool, numbers: ArrayRef) {
        let letter = |letter: char| if letter.is_alphanumeric() { letter } else { '_' };
        let name: String = name.chars().map(letter).collect();
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let mut choices = std::iter::once(name.clone()).chain(numbered);
        let free = choices.find(|name| self.names.insert(name.to_lowercase()));
        let kind: DataType = numbers.data_type().clone();
        self.fields.push(Field::new(free.unwrap_or_default(), kind, nullable));
        self.arrays.push(numbers);
    }

    /// Times of day, UTC, where any sample has one.
    fn add_timecodes(&mut self, take: &posewire_motion::Take) {
        if take.timecodes().iter().all(Option::is_none) {
            return;
        }
        let time =
            |code: &Option<posewire_motion::Timecode>| code.and_then(|code| i32::try_from(code.milliseconds()).ok());
        let times: Time32MillisecondArray = take.timecodes().iter().map(time).collect();
        self.add("timecode", true, Arc::new(times));
    }

    /// The names of the events set at each sample, with `; ` between, as Parquet has them: text is compared and searched in every
    /// tool, while lists want functions of their own in each.
    fn add_events(&mut self, take: &posewire_motion::Take) {
        let mut events = take.events().iter().peekable();
        if events.peek().is_none() {
            return;
        }
        let names = (0..take.len()).map(|frame| {
            let here: Vec<_> = std::iter::from_fn(|| events.next_if(|(at, _)| *at == frame))
                .map(|(_, name)| name.as_str())
                .collect();
            (!here.is_empty()).then(|| here.join("; "))
        });
        let names: StringArray = names.collect();
        self.add("event", true, Arc::new(names));
    }

    /// Whether each point touches the ground: `contact_LeftFoot_Heel`.
    fn add_contacts(&mut self, take: &posewire_motion::Take) {
        let told = (0..take.len()).map(|frame| take.contacts(frame).len()).max();
        let names = &take.subject.skeleton.contacts;
        for contact in 0..told.unwrap_or(0) {
            let name = names.get(contact).map_or_else(|| contact.to_string(), Clone::clone);
            let touches = (0..take.len()).map(|frame| take.contacts(frame).get(contact).copied());
            let touches: BooleanArray = touches.collect();
            self.add(&format!("contact_{name}"), true, Arc::new(touches));
        }
    }

    /// A column for each component of each entry, null where nothing was tracked: `position_Pelvis_x`.
    fn add_section(&mut self, column: &Column, skeleton: &Skeleton) {
        let section = column.section();
        let labels: Vec<_> = section.labels(skeleton).collect();
        let [_, entries, components] = column.shape();
        for place in 0..entries * components {
            let axis = section.axes()[place % components];
            let label = labels.get(place / components).copied().unwrap_or_default();
            let name = match section.per() {
                Per::Body => format!("{section}_{axis}"),
                _ => format!("{section}_{label}_{axis}"),
            };
            let numbers = column
                .rows()
                .map(|row| Some(row[place]).filter(|number| !number.is_nan()));
            self.add(&name, true, Arc::new(numbers.collect::<Float64Array>()));
        }
    }
}

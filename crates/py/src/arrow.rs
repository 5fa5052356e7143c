//! Takes as Arrow tables, by the PyCapsule interface.

use crate::error::exception;
use crate::section::named;
use crate::take::Take;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{ArrayRef, Float64Array, RecordBatch, RecordBatchIterator, StringArray, UInt32Array};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use posewire_motion::{Column, Per, Section, Skeleton};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use std::collections::HashSet;
use std::sync::Arc;
use std::time::Duration;

/// A table that polars, pyarrow, DuckDB and pandas take by the Arrow PyCapsule interface: polars.DataFrame(table),
/// pyarrow.table(table).
#[pyclass(frozen, module = "posewire")]
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

    fn __repr__(&self) -> String {
        let (rows, columns) = (self.rows.num_rows(), self.rows.num_columns());
        format!("<posewire.Table: {rows} rows, {columns} columns>")
    }
}

/// The table of a take: `Take.to_arrow`.
pub(crate) fn table(py: Python<'_>, take: &Take, sections: Option<&[String]>) -> PyResult<Table> {
    let sections = sections.map(named).transpose()?;
    let take = &take.recording.take;
    let rows = py.detach(|| rows(take, sections.as_deref()));
    let rows = rows.map_err(|error| exception("Error", error.to_string(), None))?;
    Ok(Table { rows })
}

fn rows(take: &posewire_motion::Take, sections: Option<&[Section]>) -> Result<RecordBatch, ArrowError> {
    let mut columns = Columns::default();
    let names = std::iter::repeat_n(take.subject.name.as_str(), take.len());
    columns.add("subject", false, Arc::new(StringArray::from_iter_values(names)));
    let samples = take.samples().iter().copied();
    columns.add("sample", false, Arc::new(UInt32Array::from_iter_values(samples)));
    let times = take.times().iter().map(Duration::as_secs_f64);
    columns.add("time", false, Arc::new(Float64Array::from_iter_values(times)));
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
    fn add(&mut self, name: &str, nullable: bool, numbers: ArrayRef) {
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let mut choices = std::iter::once(name.to_owned()).chain(numbered);
        let free = choices.find(|name| self.names.insert(name.to_lowercase()));
        let kind: DataType = numbers.data_type().clone();
        self.fields.push(Field::new(free.unwrap_or_default(), kind, nullable));
        self.arrays.push(numbers);
    }

    /// A column for each component of each entry, null where nothing was tracked: `position_Pelvis_x`, as in Parquet.
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

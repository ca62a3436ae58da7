//! Columns written as a file.

use super::{Column, text};
use hadar::error::{Error, Result};
use hadar_study::sweep::Cell;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{Type, TypePtr};
use std::sync::Arc;

/// What the values of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Boolean,
    Integer,
    Number,
    Text,
}

impl Kind {
    fn of(column: &Column) -> Self {
        if column.is_text { Self::Text } else { Self::of_cells(&column.cells) }
    }

    fn of_cells(cells: &[Cell]) -> Self {
        let kinds = cells.iter().filter_map(|cell| match cell {
            Cell::Empty => None,
            Cell::Boolean(_) => Some(Self::Boolean),
            Cell::Integer(_) => Some(Self::Integer),
            Cell::Number(_) => Some(Self::Number),
            Cell::Text(_) => Some(Self::Text),
        });
        let joined = kinds.reduce(|one, other| match (one, other) {
            (one, other) if one == other => one,
            (Self::Integer, Self::Number) | (Self::Number, Self::Integer) => Self::Number,
            _ => Self::Text,
        });
        joined.unwrap_or(Self::Number)
    }

    fn field(self, name: &str) -> std::result::Result<TypePtr, ParquetError> {
        let (physical, logical) = match self {
            Self::Boolean => (Physical::BOOLEAN, None),
            Self::Integer => (Physical::INT64, None),
            Self::Number => (Physical::DOUBLE, None),
            Self::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(name, physical).with_repetition(Repetition::OPTIONAL);
        field.with_logical_type(logical).build().map(Arc::new)
    }

    fn write(
        self,
        cells: &[Cell],
        writer: &mut SerializedColumnWriter<'_>,
    ) -> std::result::Result<(), ParquetError> {
        match self {
            Self::Boolean => put::<BoolType>(writer, cells, |cell| match cell {
                Cell::Boolean(value) => Some(*value),
                _ => None,
            }),
            Self::Integer => put::<Int64Type>(writer, cells, |cell| match cell {
                Cell::Integer(whole) => Some(*whole),
                _ => None,
            }),
            Self::Number => put::<DoubleType>(writer, cells, |cell| cell.number().filter(|n| n.is_finite())),
            Self::Text => put::<ByteArrayType>(writer, cells, |cell| {
                (*cell != Cell::Empty).then(|| ByteArray::from(text(cell).into_bytes()))
            }),
        }
    }
}

/// Values with a level for each row: 1 where there is one, 0 where there is none.
fn put<T: DataType>(
    writer: &mut SerializedColumnWriter<'_>,
    cells: &[Cell],
    value: impl Fn(&Cell) -> Option<T::T>,
) -> std::result::Result<(), ParquetError> {
    let found: Vec<Option<T::T>> = cells.iter().map(value).collect();
    let levels: Vec<i16> = found.iter().map(|value| i16::from(value.is_some())).collect();
    let values: Vec<T::T> = found.into_iter().flatten().collect();
    writer.typed::<T>().write_batch(&values, Some(&levels), None).map(drop)
}

/// The columns as a file.
///
/// # Errors
/// Columns of different lengths, or of one name.
pub fn file(columns: &[Column]) -> Result<Vec<u8>> {
    let rows = columns.first().map_or(0, |column| column.cells.len());
    for (i, column) in columns.iter().enumerate() {
        if column.cells.len() != rows {
            let what = format!("column `{}`", column.name);
            return Err(Error::Length { what, found: column.cells.len(), expected: rows });
        }
        if columns.iter().take(i).any(|other| other.name == column.name) {
            let found = format!("two columns `{}`", column.name);
            return Err(Error::malformed(found, "give them different names"));
        }
    }
    bytes(columns).map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))
}

fn bytes(columns: &[Column]) -> std::result::Result<Vec<u8>, ParquetError> {
    let kinds: Vec<Kind> = columns.iter().map(Kind::of).collect();
    let fields = columns.iter().zip(&kinds).map(|(column, kind)| kind.field(&column.name));
    let fields = fields.collect::<std::result::Result<Vec<_>, _>>()?;
    let schema = Arc::new(Type::group_type_builder("table").with_fields(fields).build()?);
    let properties = Arc::new(WriterProperties::builder().set_compression(Compression::SNAPPY).build());
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, properties)?;
    let mut group = writer.next_row_group()?;
    for (column, kind) in columns.iter().zip(kinds) {
        if let Some(mut writer) = group.next_column()? {
            kind.write(&column.cells, &mut writer)?;
            writer.close()?;
        }
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader as _, SerializedFileReader};

    #[test]
    fn a_column_has_the_type_of_its_values() {
        let number = Cell::Number(0.5);
        assert_eq!(Kind::of_cells(&[Cell::Empty]), Kind::Number);
        assert_eq!(Kind::of_cells(&[Cell::Integer(1), Cell::Empty]), Kind::Integer);
        assert_eq!(Kind::of_cells(&[Cell::Integer(1), number.clone()]), Kind::Number);
        assert_eq!(Kind::of_cells(&[Cell::Boolean(true), number]), Kind::Text);
    }

    #[test]
    fn what_is_written_is_read_again() {
        let column =
            |name: &str, cells: &[Cell]| Column { name: name.into(), cells: cells.to_vec(), is_text: false };
        let columns = [
            column("n", &[Cell::Integer(1 << 60), Cell::Empty]),
            column("x_m", &[Cell::Number(0.1), Cell::Integer(2)]),
            column("ok", &[Cell::Empty, Cell::Boolean(true)]),
            column("said", &[Cell::Text("für".into()), Cell::Empty]),
        ];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.parquet");
        std::fs::write(&path, file(&columns).unwrap()).unwrap();
        let read = SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
        let rows: Vec<String> =
            read.get_row_iter(None).unwrap().map(|row| row.unwrap().to_string()).collect();
        assert_eq!(rows[0], "{n: 1152921504606846976, x_m: 0.1, ok: null, said: \"für\"}");
        assert_eq!(rows[1], "{n: null, x_m: 2.0, ok: true, said: null}");
        let twice = [columns[0].clone(), columns[0].clone()];
        assert!(file(&twice).unwrap_err().to_string().contains("two columns `n`"));
    }
}

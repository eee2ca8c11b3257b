//! Columns of numbers out of records of one size.

use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{Encoding, PIECE, SHARE, Scalar, Values};
use crate::error::Fault;
use crate::fresh::{Fresh, Unwritten};
use crate::input::Input;
use crate::raw::{self, Positions};

/// Where a value lies in each fixed-size record of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    pub scalar: Scalar,
    pub components: usize,
    pub offset: usize,
}

/// The numbers of a slot, to be written.
enum Column {
    U8(Fresh<u8>),
    I32(Fresh<i32>),
    I64(Fresh<i64>),
    F32(Fresh<f32>),
    F64(Fresh<f64>),
}

/// A part of a column.
enum Part<'a> {
    U8(Unwritten<'a, u8>),
    I32(Unwritten<'a, i32>),
    I64(Unwritten<'a, i64>),
    F32(Unwritten<'a, f32>),
    F64(Unwritten<'a, f64>),
}

impl Input<'_> {
    /// The columns of `count` records of `size` bytes, one for each slot.
    pub fn records(
        &mut self,
        count: u64,
        size: usize,
        slots: &[Slot],
        encoding: Encoding,
    ) -> Result<Vec<Values>, Fault> {
        self.record_columns(count, size, slots, encoding, |_| {})
    }

    /// The same where one slot is that of the positions.
    pub fn particle_records(
        &mut self,
        count: u64,
        size: usize,
        position: Slot,
        others: &[Slot],
        encoding: Encoding,
    ) -> Result<(Positions, Vec<Values>), Fault> {
        let slots: Vec<Slot> = [position].into_iter().chain(others.iter().copied()).collect();
        // Looked at while they are near, which saves a way through memory.
        let are_finite = AtomicBool::new(true);
        let mut columns = self.record_columns(count, size, &slots, encoding, |numbers| {
            if !numbers.is_some_and(raw::all_finite) {
                are_finite.store(false, Ordering::Relaxed);
            }
        })?;
        let positions = Positions::from_triples(columns.remove(0));
        Ok((positions.checked(are_finite.into_inner()), columns))
    }

    /// The columns, and numbers of the first handed to `look` while they are near, if they are f32.
    fn record_columns(
        &mut self,
        count: u64,
        size: usize,
        slots: &[Slot],
        encoding: Encoding,
        look: impl Fn(Option<&[f32]>) + Sync,
    ) -> Result<Vec<Values>, Fault> {
        let known = self.claim(count, size)?;
        let per_piece = (PIECE / size).max(1);
        let read = |from: &mut dyn Read, (rows, mut parts): (usize, Vec<Part>)| {
            let mut block = vec![0; rows.min(per_piece) * size];
            let mut done = 0;
            while done < rows {
                let piece = per_piece.min(rows - done);
                let records = &mut block[..piece * size];
                from.read_exact(records)?;
                for (index, (part, slot)) in parts.iter_mut().zip(slots).enumerate() {
                    let floats = part.take(piece * slot.components).fill(records, size, *slot, encoding);
                    if index == 0 {
                        look(floats);
                    }
                }
                done += piece;
            }
            Ok(())
        };
        let columns_of = |rows: usize| -> Vec<Column> {
            slots.iter().map(|slot| Column::new(slot.scalar, rows * slot.components)).collect()
        };
        if self.is_exact() {
            let mut fresh = columns_of(known);
            let mut parts: Vec<Part> = fresh.iter_mut().map(Column::unwritten).collect();
            let per_share = (SHARE / size).max(1);
            let shares = (0..known).step_by(per_share).map(|first| {
                let rows = per_share.min(known - first);
                let parts = parts.iter_mut().zip(slots).map(|(part, slot)| part.take(rows * slot.components));
                ((rows * size) as u64, (rows, parts.collect()))
            });
            self.parts(shares.collect(), read)?;
            return Ok(fresh.into_iter().map(Column::into_values).collect());
        }
        let mut columns: Vec<Values> = slots.iter().map(|slot| slot.scalar.array(known * slot.components)).collect();
        let mut done = 0;
        while done < count as usize {
            let rows = per_piece.min(count as usize - done);
            let mut piece = columns_of(rows);
            read(self, (rows, piece.iter_mut().map(Column::unwritten).collect()))?;
            for ((column, piece), slot) in columns.iter_mut().zip(piece).zip(slots) {
                column.grow(rows * slot.components, count as usize * slot.components);
                column.append(piece.into_values())?;
            }
            done += rows;
        }
        Ok(columns)
    }
}

impl Column {
    fn new(scalar: Scalar, count: usize) -> Self {
        match scalar.array(0) {
            Values::U8(_) => Self::U8(Fresh::new(count)),
            Values::I32(_) => Self::I32(Fresh::new(count)),
            Values::I64(_) => Self::I64(Fresh::new(count)),
            Values::F32(_) => Self::F32(Fresh::new(count)),
            Values::F64(_) => Self::F64(Fresh::new(count)),
        }
    }

    fn unwritten(&mut self) -> Part<'_> {
        match self {
            Self::U8(array) => Part::U8(array.unwritten()),
            Self::I32(array) => Part::I32(array.unwritten()),
            Self::I64(array) => Part::I64(array.unwritten()),
            Self::F32(array) => Part::F32(array.unwritten()),
            Self::F64(array) => Part::F64(array.unwritten()),
        }
    }

    fn into_values(self) -> Values {
        match self {
            Self::U8(array) => Values::U8(array.into_vec()),
            Self::I32(array) => Values::I32(array.into_vec()),
            Self::I64(array) => Values::I64(array.into_vec()),
            Self::F32(array) => Values::F32(array.into_vec()),
            Self::F64(array) => Values::F64(array.into_vec()),
        }
    }
}

impl<'a> Part<'a> {
    /// Takes so many numbers from its beginning.
    fn take(&mut self, count: usize) -> Self {
        match self {
            Self::U8(array) => Self::U8(array.take(count)),
            Self::I32(array) => Self::I32(array.take(count)),
            Self::I64(array) => Self::I64(array.take(count)),
            Self::F32(array) => Self::F32(array.take(count)),
            Self::F64(array) => Self::F64(array.take(count)),
        }
    }

    /// Fills it with the values at `slot` of each record of `size` bytes, and returns those that are f32.
    fn fill(self, records: &[u8], size: usize, slot: Slot, encoding: Encoding) -> Option<&'a [f32]> {
        let big = encoding == Encoding::Big;
        macro_rules! fill {
            ($array:expr, $from:ty) => {
                // Each order by itself, and the most frequent widths: what is known to the compiler is twice as fast.
                if big { rows!($array, $from, from_be_bytes) } else { rows!($array, $from, from_le_bytes) }
            };
        }
        macro_rules! rows {
            ($array:expr, $from:ty, $read:ident) => {{
                const SIZE: usize = size_of::<$from>();
                let number = |&bytes: &[u8; SIZE]| <$from>::$read(bytes) as _;
                let rows = records.chunks_exact(size).map(|record| &record[slot.offset..][..slot.components * SIZE]);
                match slot.components {
                    components if components * SIZE == size => {
                        $array.write_rows(records.as_chunks().0.iter().map(|bytes| [number(bytes)]))
                    }
                    1 => $array.write_rows(rows.map(|row| [number(&row.as_chunks().0[0])])),
                    3 => $array.write_rows(rows.map(|row| [0, 1, 2].map(|k| number(&row.as_chunks().0[k])))),
                    _ => $array.write_rows(rows.flat_map(|row| row.as_chunks().0).map(|bytes| [number(bytes)])),
                }
            }};
        }
        match (self, slot.scalar) {
            (Self::F32(array), _) => return Some(fill!(array, f32)),
            (Self::F64(array), _) => drop(fill!(array, f64)),
            (Self::U8(array), _) => drop(fill!(array, u8)),
            (Self::I32(array), Scalar::I8) => drop(fill!(array, i8)),
            (Self::I32(array), Scalar::I16) => drop(fill!(array, i16)),
            (Self::I32(array), Scalar::U16) => drop(fill!(array, u16)),
            (Self::I32(array), _) => drop(fill!(array, i32)),
            (Self::I64(array), Scalar::U32) => drop(fill!(array, u32)),
            (Self::I64(array), Scalar::U64) => drop(fill!(array, u64)),
            (Self::I64(array), _) => drop(fill!(array, i64)),
        }
        None
    }
}

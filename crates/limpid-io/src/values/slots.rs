//! Columns of numbers out of records of one size.

use std::io::Read;

use super::{Encoding, PIECE, SHARE, Scalar, Values};
use crate::error::Fault;
use crate::input::Input;

/// Where a value lies in each fixed-size record of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    pub scalar: Scalar,
    pub components: usize,
    pub offset: usize,
}

/// A part of a column.
enum Part<'a> {
    U8(&'a mut [u8]),
    I32(&'a mut [i32]),
    I64(&'a mut [i64]),
    F32(&'a mut [f32]),
    F64(&'a mut [f64]),
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
        let known = self.claim(count, size)?;
        let per_piece = (PIECE / size).max(1);
        let read = |from: &mut dyn Read, (rows, mut parts): (usize, Vec<Part>)| {
            let mut block = vec![0; rows.min(per_piece) * size];
            let mut done = 0;
            while done < rows {
                let piece = per_piece.min(rows - done);
                let records = &mut block[..piece * size];
                from.read_exact(records)?;
                for (part, slot) in parts.iter_mut().zip(slots) {
                    part.take(piece * slot.components).fill(records, size, *slot, encoding);
                }
                done += piece;
            }
            Ok(())
        };
        if self.is_exact() {
            let mut columns: Vec<Values> =
                slots.iter().map(|slot| slot.scalar.zeros(known * slot.components)).collect();
            let mut parts: Vec<Part> = columns.iter_mut().map(|column| Part::of(column, 0)).collect();
            let per_share = (SHARE / size).max(1);
            let shares = (0..known).step_by(per_share).map(|first| {
                let rows = per_share.min(known - first);
                let parts = parts.iter_mut().zip(slots).map(|(part, slot)| part.take(rows * slot.components));
                ((rows * size) as u64, (rows, parts.collect()))
            });
            self.parts(shares.collect(), read)?;
            return Ok(columns);
        }
        let mut columns: Vec<Values> = slots.iter().map(|slot| slot.scalar.array(known * slot.components)).collect();
        let mut done = 0;
        while done < count as usize {
            let rows = per_piece.min(count as usize - done);
            let tails = columns.iter_mut().zip(slots).map(|(column, slot)| {
                column.extend_with_zeros(rows * slot.components, count as usize * slot.components);
                Part::of(column, done * slot.components)
            });
            read(self, (rows, tails.collect()))?;
            done += rows;
        }
        Ok(columns)
    }
}

impl<'a> Part<'a> {
    /// A column from one of its numbers on.
    fn of(values: &'a mut Values, first: usize) -> Self {
        match values {
            Values::U8(array) => Self::U8(&mut array[first..]),
            Values::I32(array) => Self::I32(&mut array[first..]),
            Values::I64(array) => Self::I64(&mut array[first..]),
            Values::F32(array) => Self::F32(&mut array[first..]),
            Values::F64(array) => Self::F64(&mut array[first..]),
        }
    }

    /// Takes so many numbers from its beginning.
    fn take(&mut self, count: usize) -> Part<'a> {
        macro_rules! take {
            ($kind:path, $array:expr) => {{
                let (first, rest) = std::mem::take($array).split_at_mut(count);
                *$array = rest;
                $kind(first)
            }};
        }
        match self {
            Self::U8(array) => take!(Part::U8, array),
            Self::I32(array) => take!(Part::I32, array),
            Self::I64(array) => take!(Part::I64, array),
            Self::F32(array) => take!(Part::F32, array),
            Self::F64(array) => take!(Part::F64, array),
        }
    }

    /// Fills it with the values at `slot` of each record of `size` bytes.
    fn fill(self, records: &[u8], size: usize, slot: Slot, encoding: Encoding) {
        let big = encoding == Encoding::Big;
        macro_rules! fill {
            ($array:expr, $from:ty) => {{
                const SIZE: usize = size_of::<$from>();
                let number = |&bytes: &[u8; SIZE]| {
                    (if big { <$from>::from_be_bytes(bytes) } else { <$from>::from_le_bytes(bytes) }) as _
                };
                if slot.components * SIZE == size {
                    $array.iter_mut().zip(records.as_chunks().0).for_each(|(to, bytes)| *to = number(bytes));
                    return;
                }
                let records = records.chunks_exact(size).map(|record| record[slot.offset..].as_chunks().0);
                // By far the most frequent widths: what is known to the compiler is twice as fast.
                match slot.components {
                    1 => $array.iter_mut().zip(records).for_each(|(to, numbers)| *to = number(&numbers[0])),
                    3 => {
                        for (row, numbers) in $array.as_chunks_mut::<3>().0.iter_mut().zip(records) {
                            *row = [0, 1, 2].map(|k| number(&numbers[k]));
                        }
                    }
                    components => {
                        for (row, numbers) in $array.chunks_exact_mut(components.max(1)).zip(records) {
                            row.iter_mut().zip(numbers).for_each(|(to, bytes)| *to = number(bytes));
                        }
                    }
                }
            }};
        }
        match (self, slot.scalar) {
            (Self::U8(array), _) => fill!(array, u8),
            (Self::I32(array), Scalar::I8) => fill!(array, i8),
            (Self::I32(array), Scalar::I16) => fill!(array, i16),
            (Self::I32(array), Scalar::U16) => fill!(array, u16),
            (Self::I32(array), _) => fill!(array, i32),
            (Self::I64(array), Scalar::U32) => fill!(array, u32),
            (Self::I64(array), Scalar::U64) => fill!(array, u64),
            (Self::I64(array), _) => fill!(array, i64),
            (Self::F32(array), _) => fill!(array, f32),
            (Self::F64(array), _) => fill!(array, f64),
        }
    }
}

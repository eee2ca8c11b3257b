//! Typed arrays and how numbers of any type become one.

use std::borrow::Cow;

use bytemuck::Pod;

use crate::error::{Fault, broken};
use crate::input::{self, Input, parse};

/// Numbers read at a time, which stay in a core's cache meanwhile.
const PIECE: usize = 1 << 16;

/// The numbers of an attribute, one particle after the other, in a type that holds what the file has exactly.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Values {
    /// Bytes.
    U8(Vec<u8>),
    /// Integers of up to 32 bits with a sign, or 16 without.
    I32(Vec<i32>),
    /// Larger integers. 64 bits without a sign wrap.
    I64(Vec<i64>),
    /// Single precision.
    F32(Vec<f32>),
    /// Double precision.
    F64(Vec<f64>),
}

impl Values {
    /// How many numbers there are: particles times components.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(array) => array.len(),
            Self::I32(array) => array.len(),
            Self::I64(array) => array.len(),
            Self::F32(array) => array.len(),
            Self::F64(array) => array.len(),
        }
    }

    /// Puts numbers of the same type behind these.
    pub(crate) fn append(&mut self, other: Self) -> Result<(), Fault> {
        match (self, other) {
            (Self::U8(array), Self::U8(mut other)) => array.append(&mut other),
            (Self::I32(array), Self::I32(mut other)) => array.append(&mut other),
            (Self::I64(array), Self::I64(mut other)) => array.append(&mut other),
            (Self::F32(array), Self::F32(mut other)) => array.append(&mut other),
            (Self::F64(array), Self::F64(mut other)) => array.append(&mut other),
            (this, other) if this.is_empty() => *this = other,
            (_, other) if other.is_empty() => {}
            _ => return broken!("an array has another type in each of its pieces"),
        }
        Ok(())
    }

    /// Makes room for more numbers, of at most so many in all.
    pub(crate) fn grow(&mut self, more: usize, most: usize) {
        match self {
            Self::U8(array) => input::grow(array, more, most),
            Self::I32(array) => input::grow(array, more, most),
            Self::I64(array) => input::grow(array, more, most),
            Self::F32(array) => input::grow(array, more, most),
            Self::F64(array) => input::grow(array, more, most),
        }
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers as f32, copied only if they are of another type.
    pub fn floats(&self) -> Cow<'_, [f32]> {
        match self {
            Self::F32(array) => Cow::Borrowed(array),
            Self::F64(array) => array.iter().map(|&x| x as f32).collect(),
            Self::U8(array) => array.iter().map(|&x| f32::from(x)).collect(),
            Self::I32(array) => array.iter().map(|&x| x as f32).collect(),
            Self::I64(array) => array.iter().map(|&x| x as f32).collect(),
        }
    }

    /// One number as f64.
    pub fn get(&self, index: usize) -> f64 {
        match self {
            Self::U8(array) => f64::from(array[index]),
            Self::I32(array) => f64::from(array[index]),
            Self::I64(array) => array[index] as f64,
            Self::F32(array) => f64::from(array[index]),
            Self::F64(array) => array[index],
        }
    }
}

/// A number type of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// How a file writes its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Ascii,
    Little,
    Big,
}

/// Where a value lies in each fixed-size record of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    pub scalar: Scalar,
    pub components: usize,
    pub offset: usize,
}

impl Scalar {
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    pub fn array(self, capacity: usize) -> Values {
        match self {
            Self::U8 => Values::U8(Vec::with_capacity(capacity)),
            Self::I8 | Self::I16 | Self::U16 | Self::I32 => Values::I32(Vec::with_capacity(capacity)),
            Self::U32 | Self::I64 | Self::U64 => Values::I64(Vec::with_capacity(capacity)),
            Self::F32 => Values::F32(Vec::with_capacity(capacity)),
            Self::F64 => Values::F64(Vec::with_capacity(capacity)),
        }
    }
}

impl Values {
    pub(crate) fn push_word(&mut self, word: &[u8]) -> Result<(), Fault> {
        match self {
            Self::U8(array) => array.push(parse(word)?),
            Self::I32(array) => array.push(parse(word)?),
            Self::I64(array) => array.push(parse(word).or_else(|_| parse::<u64>(word).map(|x| x as i64))?),
            Self::F32(array) => array.push(parse(word)?),
            Self::F64(array) => array.push(parse(word)?),
        }
        Ok(())
    }

    /// Appends the values at `slot` of each record of `size` bytes.
    pub(crate) fn extend_from_records(&mut self, records: &[u8], size: usize, slot: Slot, encoding: Encoding) {
        let big = encoding == Encoding::Big;
        macro_rules! extend {
            ($array:expr, $from:ty, $to:ty) => {{
                const SIZE: usize = size_of::<$from>();
                let number = |&bytes: &[u8; SIZE]| {
                    (if big { <$from>::from_be_bytes(bytes) } else { <$from>::from_le_bytes(bytes) }) as $to
                };
                if slot.components * SIZE == size {
                    $array.extend(records.as_chunks().0.iter().map(number));
                } else if slot.components == 1 {
                    let first = |record: &[u8]| record[slot.offset..].first_chunk().map_or(<$to>::default(), number);
                    $array.extend(records.chunks_exact(size).map(first));
                } else {
                    let known = $array.len();
                    $array.resize(known + records.len() / size * slot.components, <$to>::default());
                    let records = records.chunks_exact(size).map(|record| record[slot.offset..].as_chunks().0);
                    if slot.components == 3 {
                        for (row, numbers) in $array[known..].as_chunks_mut::<3>().0.iter_mut().zip(records) {
                            *row = [0, 1, 2].map(|k| number(&numbers[k]));
                        }
                    } else {
                        for (row, numbers) in $array[known..].chunks_exact_mut(slot.components.max(1)).zip(records) {
                            row.iter_mut().zip(numbers).for_each(|(to, bytes)| *to = number(bytes));
                        }
                    }
                }
            }};
        }
        match (self, slot.scalar) {
            (Self::U8(array), _) => extend!(array, u8, u8),
            (Self::I32(array), Scalar::I8) => extend!(array, i8, i32),
            (Self::I32(array), Scalar::I16) => extend!(array, i16, i32),
            (Self::I32(array), Scalar::U16) => extend!(array, u16, i32),
            (Self::I32(array), _) => extend!(array, i32, i32),
            (Self::I64(array), Scalar::U32) => extend!(array, u32, i64),
            (Self::I64(array), Scalar::U64) => extend!(array, u64, i64),
            (Self::I64(array), _) => extend!(array, i64, i64),
            (Self::F32(array), _) => extend!(array, f32, f32),
            (Self::F64(array), _) => extend!(array, f64, f64),
        }
    }
}

/// The f32 triple that lies `offset` bytes into each record of `size` bytes.
pub(crate) fn triples(
    records: &[u8],
    size: usize,
    offset: usize,
    encoding: Encoding,
) -> impl ExactSizeIterator<Item = [f32; 3]> + '_ {
    let big = encoding == Encoding::Big;
    records.chunks_exact(size).map(move |record| {
        let numbers = record[offset..].as_chunks::<4>().0;
        [0, 1, 2].map(|axis| if big { f32::from_be_bytes(numbers[axis]) } else { f32::from_le_bytes(numbers[axis]) })
    })
}

impl Input<'_> {
    /// An array of `count` numbers.
    pub fn values(&mut self, scalar: Scalar, encoding: Encoding, count: u64) -> Result<Values, Fault> {
        if encoding == Encoding::Ascii {
            let mut columns = self.columns(&[scalar], count)?;
            return Ok(columns.swap_remove(0));
        }
        let swaps = (encoding == Encoding::Big) != cfg!(target_endian = "big");
        Ok(match scalar {
            Scalar::U8 => Values::U8(self.array(count, false, |x| x)?),
            Scalar::I32 => Values::I32(self.array(count, swaps, i32::swap_bytes)?),
            Scalar::I64 | Scalar::U64 => Values::I64(self.array(count, swaps, i64::swap_bytes)?),
            Scalar::F32 => Values::F32(self.array(count, swaps, |x: f32| f32::from_bits(x.to_bits().swap_bytes()))?),
            Scalar::F64 => Values::F64(self.array(count, swaps, |x: f64| f64::from_bits(x.to_bits().swap_bytes()))?),
            Scalar::I8 | Scalar::I16 | Scalar::U16 | Scalar::U32 => {
                let size = scalar.size();
                let mut values = scalar.array(self.claim(count, size)?);
                let slot = Slot { scalar, components: 1, offset: 0 };
                self.blocks(count, size, |block| {
                    values.grow(block.len() / size, count as usize);
                    values.extend_from_records(block, size, slot, encoding);
                })?;
                values
            }
        })
    }

    /// Numbers whose type is that of the file, but for the order of their bytes: read to where they stay.
    fn array<T: Pod>(&mut self, count: u64, swaps: bool, swap: impl Fn(T) -> T) -> Result<Vec<T>, Fault> {
        let known = self.claim(count, size_of::<T>())?;
        // Memory that is zero to begin with costs nothing until it is written to.
        let mut array = vec![T::zeroed(); if self.is_exact() { known } else { 0 }];
        let mut done = 0;
        while done < count as usize {
            let end = count.min(done as u64 + PIECE as u64) as usize;
            if end > array.len() {
                input::grow(&mut array, end - done, count as usize);
                array.resize(end, T::zeroed());
            }
            let piece = &mut array[done..end];
            self.exact(bytemuck::cast_slice_mut(piece))?;
            if swaps {
                piece.iter_mut().for_each(|x| *x = swap(*x));
            }
            done = end;
        }
        Ok(array)
    }

    /// Passes over an array of `count` numbers.
    pub fn skip_values(&mut self, scalar: Scalar, encoding: Encoding, count: u64) -> Result<(), Fault> {
        if encoding == Encoding::Ascii {
            return self.skip_words(count);
        }
        self.claim(count, scalar.size())?;
        self.skip(count * scalar.size() as u64)
    }

    /// One whole number of at least 0, as an index or the length of a list.
    pub fn length(&mut self, scalar: Scalar, encoding: Encoding) -> Result<u64, Fault> {
        if encoding == Encoding::Ascii {
            return parse(self.word()?);
        }
        let mut bytes = [0; 8];
        let bytes = &mut bytes[..scalar.size()];
        self.exact(bytes)?;
        if encoding == Encoding::Big {
            bytes.reverse();
        }
        let unsigned = bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte));
        let negative = bytes.last().is_some_and(|byte| *byte >= 0x80);
        match scalar {
            Scalar::F32 | Scalar::F64 => broken!("a list has a length that is no whole number"),
            Scalar::I8 | Scalar::I16 | Scalar::I32 | Scalar::I64 if negative => {
                broken!("a list has a negative length or index")
            }
            _ => Ok(unsigned),
        }
    }
}

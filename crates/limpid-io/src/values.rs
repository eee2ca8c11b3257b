//! Typed arrays and how numbers of any type become one.

mod slots;

use std::borrow::Cow;
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};

use bytemuck::Pod;

use crate::error::{Fault, broken};
use crate::fresh::{self, Fresh, Unwritten};
use crate::input::{self, Input, parse};
use crate::raw::{self, Positions};

pub(crate) use slots::Slot;

/// Bytes read at a time: they stay in a core's cache meanwhile, and for so many no allocator asks the system.
pub(crate) const PIECE: usize = 3 << 15;

/// Bytes that a core reads in the time that it takes to ask it.
const SHARE: usize = 1 << 20;

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

    /// The memory of the numbers, where numbers of this type lie in it as they lie in a file.
    pub(crate) fn bytes_mut(&mut self, scalar: Scalar) -> Option<&mut [u8]> {
        let bytes = match self {
            Self::U8(array) => array,
            Self::I32(array) => bytemuck::cast_slice_mut(array),
            Self::I64(array) => bytemuck::cast_slice_mut(array),
            Self::F32(array) => bytemuck::cast_slice_mut(array),
            Self::F64(array) => bytemuck::cast_slice_mut(array),
        };
        scalar.is_kept().then_some(bytes)
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

impl Encoding {
    /// Whether binary numbers have their bytes in the order that is not this machine's.
    pub fn swaps(self) -> bool {
        (self == Self::Big) != cfg!(target_endian = "big")
    }
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

    /// Whether an array keeps such numbers in as many bytes.
    fn is_kept(self) -> bool {
        !matches!(self, Self::I8 | Self::I16 | Self::U16 | Self::U32)
    }

    /// So many zeros.
    pub fn zeros(self, count: usize) -> Values {
        match self.array(0) {
            Values::U8(_) => Values::U8(fresh::zeros(count)),
            Values::I32(_) => Values::I32(fresh::zeros(count)),
            Values::I64(_) => Values::I64(fresh::zeros(count)),
            Values::F32(_) => Values::F32(fresh::zeros(count)),
            Values::F64(_) => Values::F64(fresh::zeros(count)),
        }
    }

    /// An array without numbers, but with room for some.
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
}

impl Input<'_> {
    /// An array of `count` numbers.
    pub fn values(&mut self, scalar: Scalar, encoding: Encoding, count: u64) -> Result<Values, Fault> {
        if encoding == Encoding::Ascii {
            let mut columns = self.columns(&[scalar], count)?;
            return Ok(columns.swap_remove(0));
        }
        let swaps = encoding.swaps();
        macro_rules! array {
            ($number:ty) => {
                self.array(count, |piece: &mut [$number]| {
                    if swaps {
                        piece.iter_mut().for_each(|x| *x = <$number>::from_be_bytes(x.to_le_bytes()));
                    }
                })?
            };
        }
        Ok(match scalar {
            Scalar::U8 => Values::U8(array!(u8)),
            Scalar::I32 => Values::I32(array!(i32)),
            Scalar::I64 | Scalar::U64 => Values::I64(array!(i64)),
            Scalar::F32 => Values::F32(array!(f32)),
            Scalar::F64 => Values::F64(array!(f64)),
            Scalar::I8 | Scalar::I16 | Scalar::U16 | Scalar::U32 => {
                let slot = Slot { scalar, components: 1, offset: 0 };
                self.records(count, scalar.size(), &[slot], encoding)?.swap_remove(0)
            }
        })
    }

    /// An array of x, y and z of `count` particles.
    pub fn positions(&mut self, scalar: Scalar, encoding: Encoding, count: u64) -> Result<Positions, Fault> {
        let Some(numbers) = count.checked_mul(3) else { return broken!("it claims {count} times 3 numbers") };
        if scalar != Scalar::F32 || encoding == Encoding::Ascii {
            return Ok(Positions::from_triples(self.values(scalar, encoding, numbers)?));
        }
        let swaps = encoding.swaps();
        // Looked at while they are near, which saves a way through memory.
        let are_finite = AtomicBool::new(true);
        let numbers = self.array(numbers, |piece: &mut [f32]| {
            if swaps {
                piece.iter_mut().for_each(|x| *x = f32::from_be_bytes(x.to_le_bytes()));
            }
            if !raw::all_finite(piece) {
                are_finite.store(false, Ordering::Relaxed);
            }
        })?;
        Ok(Positions::from_triples(Values::F32(numbers)).checked(are_finite.into_inner()))
    }

    /// Numbers whose type is that of the file, but for the order of their bytes: read to where they stay, and each piece handed to
    /// `finish` while it is near.
    fn array<T: Pod + Send>(&mut self, count: u64, finish: impl Fn(&mut [T]) + Sync) -> Result<Vec<T>, Fault> {
        let known = self.claim(count, size_of::<T>())?;
        let per_piece = PIECE / size_of::<T>();
        let read = |from: &mut dyn Read, piece: &mut [T]| -> Result<(), Fault> {
            from.read_exact(bytemuck::cast_slice_mut(piece))?;
            finish(piece);
            Ok(())
        };
        if self.is_exact() {
            let mut array = Fresh::new(known);
            let shares = array.unwritten().chunks(SHARE / size_of::<T>());
            let shares = shares.map(|share| ((share.len() * size_of::<T>()) as u64, share)).collect();
            self.parts(shares, |from, share: Unwritten<T>| {
                share.chunks(per_piece).try_for_each(|piece| read(from, piece.write_zeros()))
            })?;
            return Ok(array.into_vec());
        }
        let mut block = vec![T::zeroed(); (count as usize).min(per_piece)];
        let mut array = Vec::new();
        while array.len() < count as usize {
            let more = (count as usize - array.len()).min(per_piece);
            read(self, &mut block[..more])?;
            input::grow(&mut array, more, count as usize);
            array.extend_from_slice(&block[..more]);
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

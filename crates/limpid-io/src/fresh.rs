//! Memory for arrays that several cores write, each number once: nothing is zeroed before, and the system is asked for large pages.

#![allow(unsafe_code, reason = "memory that has not been written to")]

use std::mem::MaybeUninit;
use std::sync::atomic::{AtomicUsize, Ordering};

use bytemuck::Pod;

/// An array to be written.
pub(crate) struct Fresh<T> {
    numbers: Box<[MaybeUninit<T>]>,
    written: AtomicUsize,
}

/// A part of it, which nobody else has.
pub(crate) struct Unwritten<'a, T> {
    numbers: &'a mut [MaybeUninit<T>],
    written: &'a AtomicUsize,
}

impl<T: Copy> Fresh<T> {
    pub fn new(count: usize) -> Self {
        let mut numbers = Box::new_uninit_slice(count);
        ask_for_large_pages(&mut numbers);
        Self { numbers, written: AtomicUsize::new(0) }
    }

    /// All of it.
    pub fn unwritten(&mut self) -> Unwritten<'_, T> {
        *self.written.get_mut() = 0;
        Unwritten { numbers: &mut self.numbers, written: &self.written }
    }

    /// The array, once every number of it is written.
    pub fn into_vec(self) -> Vec<T> {
        assert_eq!(self.written.into_inner(), self.numbers.len(), "part of an array was not read");
        // SAFETY: `Unwritten` counts a number when it has written it, and gives its place away with that. So as many as there are
        // have been written.
        unsafe { self.numbers.assume_init() }.into_vec()
    }
}

impl<'a, T: Copy> Unwritten<'a, T> {
    /// Takes so many numbers from its beginning.
    pub fn take(&mut self, count: usize) -> Self {
        let (numbers, rest) = std::mem::take(&mut self.numbers).split_at_mut(count);
        self.numbers = rest;
        Self { numbers, written: self.written }
    }

    /// Parts of so many numbers, the last of what is left.
    pub fn chunks(self, count: usize) -> impl Iterator<Item = Self> {
        let written = self.written;
        self.numbers.chunks_mut(count).map(move |numbers| Self { numbers, written })
    }

    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Writes rows of `N` numbers, as many as there are or go in, and returns their numbers.
    pub fn write_rows<const N: usize>(self, rows: impl Iterator<Item = [T; N]>) -> &'a [T] {
        let mut count = 0;
        for (to, row) in self.numbers.as_chunks_mut::<N>().0.iter_mut().zip(rows) {
            *to = row.map(MaybeUninit::new);
            count += N;
        }
        self.first_written(count)
    }

    /// Writes zeros for a stream to write over: what is small enough to be near goes to memory once even so.
    pub fn write_zeros(self) -> &'a mut [T]
    where
        T: Pod,
    {
        let count = self.numbers.len();
        self.numbers.fill(MaybeUninit::new(T::zeroed()));
        self.first_written(count)
    }

    /// Counts the numbers that have just been written, and gives up the place.
    fn first_written(self, count: usize) -> &'a mut [T] {
        let numbers = &mut self.numbers[..count];
        self.written.fetch_add(count, Ordering::Relaxed);
        // SAFETY: the callers above have written that many, from the first on.
        unsafe { numbers.assume_init_mut() }
    }
}

/// So many zeros, for what cannot write to memory that has not been written to. The system hands them out as such.
pub(crate) fn zeros<T: Pod>(count: usize) -> Vec<T> {
    let mut numbers = vec![T::zeroed(); count];
    ask_for_large_pages(&mut numbers);
    numbers
}

/// The first writing to memory in pages of 4 KB takes the system longer than reading takes. NumPy asks for large ones, too.
#[cfg(target_os = "linux")]
fn ask_for_large_pages<T>(memory: &mut [T]) {
    /// Smaller memory is hardly worth asking.
    const LEAST: usize = 1 << 22;
    const PAGE: usize = 1 << 12;
    let address = memory.as_mut_ptr().cast::<u8>();
    let skipped = address.align_offset(PAGE);
    if let Some(length) = size_of_val(memory).checked_sub(skipped).filter(|length| *length >= LEAST) {
        // SAFETY: the pages lie within the memory, and the advice changes nothing that is in them. Where the system does not take it,
        // nothing is lost.
        unsafe {
            libc::madvise(address.add(skipped).cast(), length / PAGE * PAGE, libc::MADV_HUGEPAGE);
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn ask_for_large_pages<T>(_: &mut [T]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_in_any_order_make_the_whole() {
        let mut fresh = Fresh::new(10);
        let mut rest = fresh.unwritten();
        let first = rest.take(6);
        rest.write_zeros().copy_from_slice(&[6, 7, 8, 9]);
        let mut parts = first.chunks(3);
        parts.next().unwrap().write_rows([[0, 1, 2]].into_iter());
        parts.next().unwrap().write_rows((3..6).map(|x| [x]));
        drop(parts);
        assert_eq!(fresh.into_vec(), (0..10).collect::<Vec<i32>>());
        // Large enough for large pages.
        let numbers: Vec<u64> = (0..3 << 20).collect();
        let mut fresh = Fresh::new(numbers.len());
        fresh.unwritten().write_rows(numbers.iter().map(|x| [*x]));
        assert_eq!(fresh.into_vec(), numbers);
    }

    #[test]
    #[should_panic(expected = "part of an array was not read")]
    fn what_is_not_written_is_not_handed_out() {
        let mut fresh = Fresh::new(6);
        // Fewer rows than go in, and more than go in.
        let mut rest = fresh.unwritten();
        rest.take(4).write_rows([[0.0; 3]; 2].into_iter());
        rest.write_rows([[1.0]; 9].into_iter());
        fresh.into_vec();
    }
}

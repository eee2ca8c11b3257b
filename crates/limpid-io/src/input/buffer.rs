//! A stream whose next bytes can be looked at, as many as are asked for, before they are taken.

use std::io::{self, BufRead, ErrorKind, Read};

pub(super) struct Buffer<R> {
    stream: R,
    bytes: Vec<u8>,
    /// Where the bytes begin and end that are read and not yet taken.
    start: usize,
    end: usize,
}

impl<R: Read> Buffer<R> {
    pub fn new(capacity: usize, stream: R) -> Self {
        Self { stream, bytes: vec![0; capacity], start: 0, end: 0 }
    }

    /// Goes on with another stream.
    pub fn restart(&mut self, stream: R) {
        self.stream = stream;
        (self.start, self.end) = (0, 0);
    }

    /// The next bytes: at least so many, or all that there are.
    pub fn peek(&mut self, wanted: usize) -> io::Result<&[u8]> {
        while self.end - self.start < wanted {
            if self.end == self.bytes.len() {
                self.bytes.copy_within(self.start..self.end, 0);
                (self.start, self.end) = (0, self.end - self.start);
                // Step by step: nothing says that the file is that long.
                if self.end > self.bytes.len() / 2 {
                    self.bytes.resize(2 * self.bytes.len(), 0);
                }
            }
            match self.stream.read(&mut self.bytes[self.end..]) {
                Ok(0) => break,
                Ok(count) => self.end += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(&self.bytes[self.start..self.end])
    }
}

impl<R: Read> Read for Buffer<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.start == self.end && to.len() >= self.bytes.len() {
            return self.stream.read(to);
        }
        let count = self.fill_buf()?.read(to)?;
        self.consume(count);
        Ok(count)
    }
}

impl<R: Read> BufRead for Buffer<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.start == self.end {
            (self.start, self.end) = (0, 0);
        }
        self.peek(1)
    }

    fn consume(&mut self, count: usize) {
        self.start = (self.start + count).min(self.end);
    }
}

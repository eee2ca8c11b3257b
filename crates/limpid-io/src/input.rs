//! A particle file as a stream of bytes, words and records, unpacked if it is gzipped.
//!
//! Whatever a header claims is checked against the file's size before memory is reserved for it.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::str::FromStr;

use flate2::read::GzDecoder;

use crate::error::{Fault, broken, quote};

const BUFFER: usize = 1 << 17;
/// Twice the buffer: what is left of a block once the buffer is empty goes past it, from the file into the block.
const BLOCK: usize = 2 * BUFFER;
const HEAD: usize = 64;
const LONGEST_LINE: usize = 1 << 16;
const LONGEST_WORD: usize = 1 << 10;

/// Deflate cannot pack tighter than this.
const GZIP_RATIO: u64 = 1032;

/// Records reserved for at once where only reading on tells how many there are.
const FIRST_RECORDS: usize = 1 << 14;

pub(crate) struct Input<'a> {
    reader: BufReader<Box<dyn Read + 'a>>,
    head: Vec<u8>,
    gzipped: bool,
    /// Bytes still to come: exact for a plain file, an upper bound for a gzipped one.
    left: u64,
    word: Vec<u8>,
}

impl Input<'static> {
    pub fn open(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        if file.metadata()?.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        let size = file.metadata()?.len();
        Self::of(Box::new(file), size)
    }

    /// A file of `size` bytes, wherever it comes from.
    pub fn of(file: Box<dyn Read>, size: u64) -> io::Result<Self> {
        let mut file = BufReader::with_capacity(BUFFER, file);
        let gzipped = file.fill_buf()?.starts_with(&[0x1f, 0x8b]);
        let mut stream: Box<dyn Read> = if gzipped { Box::new(GzDecoder::new(file)) } else { Box::new(file) };
        let mut head = Vec::new();
        // A damaged gzip stream may fail right here: the reader meets the same error again and reports it.
        let opening = (&mut stream).take(HEAD as u64).read_to_end(&mut head);
        if !gzipped {
            opening?;
        }
        let reader = BufReader::with_capacity(BUFFER, Box::new(io::Cursor::new(head.clone()).chain(stream)) as Box<_>);
        let left = if gzipped { size.saturating_mul(GZIP_RATIO) } else { size };
        Ok(Self { reader, head, gzipped, left, word: Vec::new() })
    }
}

impl<'a> Input<'a> {
    /// Bytes from elsewhere, at most so many, as a stream: what is claimed is checked against that.
    pub fn of_stream(stream: Box<dyn Read + 'a>, most: u64) -> Self {
        let reader = BufReader::with_capacity(BUFFER, stream);
        Self { reader, head: Vec::new(), gzipped: true, left: most, word: Vec::new() }
    }

    /// The first bytes, for telling the format.
    pub fn head(&self) -> &[u8] {
        &self.head
    }

    pub fn is_gzipped(&self) -> bool {
        self.gzipped
    }

    /// Bytes that are still to come, at most.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Checks that `count` records of `size` bytes can follow; returns for how many to reserve memory now.
    pub fn claim(&self, count: u64, size: usize) -> Result<usize, Fault> {
        match count.checked_mul(size as u64) {
            Some(bytes) if bytes <= self.left => {
                let count = count as usize;
                Ok(if self.gzipped { count.min(FIRST_RECORDS) } else { count })
            }
            _ => broken!("it claims {count} records of {size} bytes or more where only {} bytes follow", self.left),
        }
    }

    /// The same for words of text, which take less room in the file than in memory.
    pub fn claim_words(&self, count: u64) -> Result<usize, Fault> {
        match count.checked_mul(2) {
            // The last word needs no space after it.
            Some(bytes) if bytes <= self.left.saturating_add(1) => Ok((count as usize).min(FIRST_RECORDS)),
            _ => broken!("it claims {count} numbers where only {} bytes follow", self.left),
        }
    }

    fn consume(&mut self, bytes: usize) {
        self.reader.consume(bytes);
        self.left = self.left.saturating_sub(bytes as u64);
    }

    pub fn exact(&mut self, bytes: &mut [u8]) -> Result<(), Fault> {
        self.reader.read_exact(bytes)?;
        self.left = self.left.saturating_sub(bytes.len() as u64);
        Ok(())
    }

    pub fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let mut bytes = [0; N];
        self.exact(&mut bytes)?;
        Ok(bytes)
    }

    pub fn skip(&mut self, bytes: u64) -> Result<(), Fault> {
        let mut wanted = bytes;
        while wanted > 0 {
            let here = self.reader.fill_buf()?.len() as u64;
            if here == 0 {
                return broken!("it ends too early");
            }
            let step = here.min(wanted);
            self.consume(step as usize);
            wanted -= step;
        }
        Ok(())
    }

    /// True at the end of the file. For a gzipped one this also verifies the checksum.
    pub fn at_end(&mut self) -> Result<bool, Fault> {
        Ok(self.reader.fill_buf()?.is_empty())
    }

    /// Hands over `count` records of `size` bytes, many whole ones at a time.
    pub fn blocks(&mut self, count: u64, size: usize, mut each: impl FnMut(&[u8])) -> Result<(), Fault> {
        let per_block = (BLOCK / size).max(1) as u64;
        let mut block = vec![0; per_block.min(count) as usize * size];
        let mut left = count;
        while left > 0 {
            let records = left.min(per_block);
            let bytes = &mut block[..records as usize * size];
            self.exact(bytes)?;
            each(bytes);
            left -= records;
        }
        Ok(())
    }

    /// Decodes `count` records of `N` bytes straight into their final array.
    pub fn records<const N: usize, T>(&mut self, count: u64, decode: impl Fn(&[u8; N]) -> T) -> Result<Vec<T>, Fault> {
        let mut records = Vec::with_capacity(self.claim(count, N)?);
        self.blocks(count, N, |block| records.extend(block.as_chunks().0.iter().map(&decode)))?;
        Ok(records)
    }

    /// The next line without its end, or `None` at the end of the file.
    pub fn line(&mut self) -> Result<Option<Vec<u8>>, Fault> {
        let mut line = Vec::new();
        Ok(self.line_into(&mut line)?.then_some(line))
    }

    /// The same into a buffer, for many lines; false at the end of the file.
    pub fn line_into(&mut self, line: &mut Vec<u8>) -> Result<bool, Fault> {
        line.clear();
        loop {
            let buffer = self.reader.fill_buf()?;
            let end = buffer.iter().position(|&byte| byte == b'\n');
            line.extend_from_slice(&buffer[..end.unwrap_or(buffer.len())]);
            let (empty, bytes) = (buffer.is_empty(), end.map_or(buffer.len(), |end| end + 1));
            self.consume(bytes);
            if line.len() > LONGEST_LINE {
                return broken!("a line of text is longer than {LONGEST_LINE} bytes: {}", quote(line));
            }
            if end.is_some() || empty {
                if line.is_empty() && empty {
                    return Ok(false);
                }
                if line.last() == Some(&b'\r') {
                    line.pop();
                }
                return Ok(true);
            }
        }
    }

    /// The next word between spaces or line ends.
    pub fn word(&mut self) -> Result<&[u8], Fault> {
        self.word.clear();
        loop {
            let buffer = self.reader.fill_buf()?;
            if buffer.is_empty() {
                break;
            }
            let skipped = if self.word.is_empty() {
                buffer.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(buffer.len())
            } else {
                0
            };
            let rest = &buffer[skipped..];
            let end = rest.iter().position(u8::is_ascii_whitespace);
            self.word.extend_from_slice(&rest[..end.unwrap_or(rest.len())]);
            let bytes = skipped + end.unwrap_or(rest.len());
            self.consume(bytes);
            if self.word.len() > LONGEST_WORD {
                return broken!("a number was expected, not {}", quote(&self.word));
            }
            if end.is_some() && !self.word.is_empty() {
                break;
            }
        }
        if self.word.is_empty() { broken!("it ends too early") } else { Ok(&self.word) }
    }

    /// Everything that is left, in memory.
    pub fn all(&mut self) -> Result<Vec<u8>, Fault> {
        let mut bytes = Vec::new();
        if !self.gzipped {
            bytes.reserve_exact(self.left as usize);
        }
        self.reader.read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Everything that is left, for formats whose text another crate parses.
    pub fn rest(&mut self) -> impl Read {
        &mut self.reader
    }
}

pub(crate) fn parse<T: FromStr>(word: &[u8]) -> Result<T, Fault> {
    match std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()) {
        Some(number) => Ok(number),
        None => broken!("a number was expected, not {}", quote(word)),
    }
}

//! A particle file as a stream of bytes, words and records, unpacked if it is gzipped.
//!
//! Whatever a header claims is checked against the file's size before memory is reserved for it.

mod buffer;
mod plain;

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

use flate2::read::MultiGzDecoder;

use crate::error::{Fault, broken, quote};
use crate::parallel;
use buffer::Buffer;
use plain::Plain;

pub(crate) use plain::Place;

const BUFFER: usize = 1 << 17;
const HEAD: usize = 64;
const LONGEST_LINE: usize = 1 << 16;
pub(crate) const LONGEST_WORD: usize = 1 << 10;

const GZIP: &[u8] = &[0x1f, 0x8b];
/// Deflate cannot pack tighter than this.
const GZIP_RATIO: u64 = 1032;

/// Records reserved for at once where only reading on tells how many there are.
const FIRST_RECORDS: usize = 1 << 14;

pub(crate) struct Input<'a> {
    reader: Buffer<Box<dyn Read + 'a>>,
    head: Vec<u8>,
    gzipped: bool,
    /// Whether as many bytes follow as `left` says, so that memory may be reserved for them.
    exact: bool,
    /// Bytes still to come, or an upper bound.
    left: u64,
    word: Vec<u8>,
    /// The file's beginning, unless it must be unpacked.
    first: Option<Place>,
}

impl Input<'static> {
    pub fn open(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let metadata = file.metadata()?;
        if metadata.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if metadata.is_file() { Self::of_plain(Plain::File(file), metadata.len()) } else { Self::of_pipe(file) }
    }

    /// A file that is in memory.
    pub fn of_bytes(bytes: Arc<[u8]>) -> io::Result<Self> {
        let size = bytes.len() as u64;
        Self::of_plain(Plain::Bytes(bytes), size)
    }

    fn of_plain(plain: Plain, size: u64) -> io::Result<Self> {
        let first = Place::first(plain, size);
        let head = head_of(&mut first.clone())?;
        if head.starts_with(GZIP) {
            return Ok(Self::of_gzip(first, size.saturating_mul(GZIP_RATIO)));
        }
        Ok(Self { head, exact: true, first: Some(first.clone()), ..Self::of_stream(first, size) })
    }

    /// What comes from another program, which cannot be read at any place, nor tells its length.
    fn of_pipe(mut pipe: File) -> io::Result<Self> {
        let head = head_of(&mut pipe)?;
        let whole = Cursor::new(head.clone()).chain(pipe);
        if head.starts_with(GZIP) {
            return Ok(Self::of_gzip(whole, u64::MAX));
        }
        Ok(Self { head, ..Self::of_stream(whole, u64::MAX) })
    }

    fn of_gzip(packed: impl Read + 'static, most: u64) -> Self {
        let mut stream = MultiGzDecoder::new(BufReader::with_capacity(BUFFER, packed));
        let mut head = Vec::new();
        // A damaged stream may fail right here: the reader meets the same error again and reports it.
        drop((&mut stream).take(HEAD as u64).read_to_end(&mut head));
        let whole = Cursor::new(head.clone()).chain(stream);
        Self { head, gzipped: true, ..Self::of_stream(whole, most) }
    }
}

fn head_of(stream: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    stream.take(HEAD as u64).read_to_end(&mut head)?;
    Ok(head)
}

impl<'a> Input<'a> {
    /// Bytes from elsewhere, at most so many, as a stream: what is claimed is checked against that.
    pub fn of_stream(stream: impl Read + 'a, most: u64) -> Self {
        let reader = Buffer::new(BUFFER, Box::new(stream) as Box<_>);
        Self { reader, head: Vec::new(), gzipped: false, exact: false, left: most, word: Vec::new(), first: None }
    }

    /// The same where so many bytes are known to be there: memory for them is reserved at once.
    pub fn of_whole_stream(stream: impl Read + 'a, length: u64) -> Self {
        Self { exact: true, ..Self::of_stream(stream, length) }
    }

    /// The beginning of the whole file, to be read at any place; in memory if it has to be unpacked.
    pub fn whole(&mut self) -> Result<Place, Fault> {
        if let Some(first) = &self.first {
            return Ok(first.clone());
        }
        let mut bytes = Vec::new();
        self.reader.read_to_end(&mut bytes)?;
        let size = bytes.len() as u64;
        Ok(Place::first(Plain::Bytes(bytes.into()), size))
    }

    /// The first bytes, for telling the format.
    pub fn head(&self) -> &[u8] {
        &self.head
    }

    pub fn is_gzipped(&self) -> bool {
        self.gzipped
    }

    /// Whether the bytes that are still to come are as many as is said.
    pub fn is_exact(&self) -> bool {
        self.exact
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
                Ok(if self.exact { count } else { count.min(FIRST_RECORDS) })
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

    /// The next bytes: at least so many, or all that there are.
    pub fn peek(&mut self, wanted: usize) -> Result<&[u8], Fault> {
        Ok(self.reader.peek(wanted)?)
    }

    pub fn consume(&mut self, bytes: usize) {
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
        if bytes > self.left {
            return broken!("it ends too early");
        }
        if bytes > BUFFER as u64 && self.go_on_at(bytes) {
            return Ok(());
        }
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

    /// Goes on so many bytes further, without reading them; false where only reading leads there.
    fn go_on_at(&mut self, bytes: u64) -> bool {
        let Some(first) = &self.first else { return false };
        self.left -= bytes;
        self.reader.restart(Box::new(first.before_end(self.left)));
        true
    }

    /// Reads parts that follow each other, each of so many bytes, by `work`, which takes all bytes of its part: on several cores
    /// where the file lies there as it is.
    pub fn parts<T: Send>(
        &mut self,
        parts: Vec<(u64, T)>,
        work: impl Fn(&mut dyn Read, T) -> Result<(), Fault> + Sync,
    ) -> Result<(), Fault> {
        if parts.len() < 2 || self.first.is_none() {
            return parts.into_iter().try_for_each(|(_, part)| work(self, part));
        }
        let mut length = 0;
        let placed = parts.into_iter().map(|(bytes, part)| {
            let at = length;
            length += bytes;
            (at, part)
        });
        let placed = placed.collect();
        if self.at_places(placed, length, work)? { Ok(()) } else { broken!("it ends too early") }
    }

    /// The same for parts that begin so many bytes from here, of `length` bytes in all; false, and nothing is read, where the file does
    /// not lie there as it is, or is too short. After an error nothing is taken.
    pub fn at_places<T: Send>(
        &mut self,
        parts: Vec<(u64, T)>,
        length: u64,
        work: impl Fn(&mut dyn Read, T) -> Result<(), Fault> + Sync,
    ) -> Result<bool, Fault> {
        let Some(first) = self.first.as_ref().filter(|_| length <= self.left) else { return Ok(false) };
        let here = first.before_end(self.left);
        let results = parallel::map(parts, |(at, part)| work(&mut here.further(at), part));
        results.into_iter().collect::<Result<(), _>>()?;
        Ok(self.go_on_at(length))
    }

    /// True at the end of the file. For a gzipped one this also verifies the checksum.
    pub fn at_end(&mut self) -> Result<bool, Fault> {
        Ok(self.reader.fill_buf()?.is_empty())
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

    /// Passes over what is before the next such byte; false if there is none.
    pub fn skip_to(&mut self, byte: u8) -> Result<bool, Fault> {
        loop {
            let buffer = self.reader.fill_buf()?;
            let (at, length) = (buffer.iter().position(|other| *other == byte), buffer.len());
            self.consume(at.unwrap_or(length));
            if at.is_some() || length == 0 {
                return Ok(at.is_some());
            }
        }
    }

    /// Appends everything through the next such byte; false if there is none.
    pub fn through(&mut self, byte: u8, text: &mut Vec<u8>, longest: usize) -> Result<bool, Fault> {
        loop {
            let buffer = self.reader.fill_buf()?;
            let end = buffer.iter().position(|other| *other == byte).map(|at| at + 1);
            let length = end.unwrap_or(buffer.len());
            text.extend_from_slice(&buffer[..length]);
            self.consume(length);
            if text.len() > longest {
                return broken!("a piece of its text is longer than {longest} bytes: {}", quote(text));
            }
            if end.is_some() || length == 0 {
                return Ok(end.is_some());
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

    /// The next byte that is no space, which is left to be read.
    pub fn after_space(&mut self) -> Result<Option<u8>, Fault> {
        loop {
            let buffer = self.reader.fill_buf()?;
            let (at, length) = (buffer.iter().position(|byte| !byte.is_ascii_whitespace()), buffer.len());
            let found = at.map(|at| buffer[at]);
            self.consume(at.unwrap_or(length));
            if found.is_some() || length == 0 {
                return Ok(found);
            }
        }
    }
}

impl Read for Input<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(to)?;
        self.left = self.left.saturating_sub(count as u64);
        Ok(count)
    }
}

/// Makes room for more records: twice as much as there was, but never for more than `most`, where a growing array would go beyond.
pub(crate) fn grow<T>(records: &mut Vec<T>, more: usize, most: usize) {
    let wanted = records.len() + more;
    if wanted > records.capacity() {
        records.reserve_exact((2 * records.capacity()).min(most).max(wanted) - records.len());
    }
}

pub(crate) fn parse<T: FromStr>(word: &[u8]) -> Result<T, Fault> {
    match std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()) {
        Some(number) => Ok(number),
        None => broken!("a number was expected, not {}", quote(word)),
    }
}

//! Columns of numbers in text, parsed on several cores.

use crate::error::{Fault, broken, quote};
use crate::input::{Input, LONGEST_WORD};
use crate::values::Scalar;
use crate::{Values, number, parallel};

/// Text for one core to parse at a time.
const PIECE: usize = 1 << 18;
/// What a number takes in most files, with the space after it.
const WORD: u64 = 20;

/// A part of a text that begins and ends between words.
struct Piece<'a> {
    text: &'a [u8],
    words: u64,
}

impl Input<'_> {
    /// Numbers that follow each other by rows, whatever the lines, as an array for each column.
    pub fn columns(&mut self, columns: &[Scalar], rows: u64) -> Result<Vec<Values>, Fault> {
        let Some(count) = rows.checked_mul(columns.len() as u64) else {
            return broken!("it claims {rows} rows of {} numbers", columns.len());
        };
        let capacity = self.claim_words(count)?.min(rows as usize);
        let mut arrays: Vec<Values> = columns.iter().map(|scalar| scalar.array(capacity)).collect();
        let mut done = 0;
        self.each_pieces(count, |pieces| {
            let firsts = pieces.into_iter().map(|piece| {
                let first = (done % columns.len() as u64) as usize;
                done += piece.words;
                (piece, first)
            });
            for parsed in parallel::map(firsts.collect(), |(piece, first)| parse(&piece, columns, first)) {
                for (array, part) in arrays.iter_mut().zip(parsed?) {
                    array.grow(part.len(), rows as usize);
                    array.append(part)?;
                }
            }
            Ok(())
        })?;
        Ok(arrays)
    }

    /// Passes over words.
    pub fn skip_words(&mut self, count: u64) -> Result<(), Fault> {
        self.claim_words(count)?;
        self.each_pieces(count, |_| Ok(()))
    }

    /// Hands over `count` words, in pieces for as many cores as there are at a time.
    fn each_pieces(&mut self, count: u64, mut each: impl FnMut(Vec<Piece>) -> Result<(), Fault>) -> Result<(), Fault> {
        let mut left = count;
        while left > 0 {
            let most = PIECE * parallel::threads();
            // A word that is longer than any number must be seen whole, to be shown.
            let wanted = left.saturating_mul(WORD).clamp(LONGEST_WORD as u64 + 1, most as u64) as usize;
            let text = self.peek(wanted)?;
            let is_end = text.len() < wanted;
            let text = &text[..text.len().min(wanted)];
            // Where the file goes on, so may the last word.
            let whole = if is_end { Some(text.len()) } else { text.iter().rposition(is_space).map(|last| last + 1) };
            let Some(whole) = whole else { return broken!("a number was expected, not {}", quote(text)) };
            let pieces = cut(&text[..whole], left);
            let words: u64 = pieces.iter().map(|piece| piece.words).sum();
            if is_end && words < left && text[..whole].iter().all(u8::is_ascii_whitespace) {
                return broken!("it ends too early");
            }
            let used = pieces.iter().map(|piece| piece.text.len()).sum();
            each(pieces)?;
            self.consume(used);
            left -= words;
        }
        Ok(())
    }
}

/// Cuts a text between words into pieces that together hold `most` words, or all that there are.
fn cut(text: &[u8], most: u64) -> Vec<Piece<'_>> {
    let mut texts = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let at =
            rest.get(PIECE..).and_then(|after| after.iter().position(is_space)).map_or(rest.len(), |at| PIECE + at + 1);
        let (piece, after) = rest.split_at(at);
        texts.push(piece);
        rest = after;
    }
    let mut pieces = parallel::map(texts, |text| Piece { text, words: count(text) });
    let mut before = 0;
    for index in 0..pieces.len() {
        let piece = &mut pieces[index];
        if before + piece.words >= most {
            piece.words = most - before;
            piece.text = &piece.text[..end_of(piece.text, piece.words)];
            pieces.truncate(index + 1);
            break;
        }
        before += piece.words;
    }
    pieces
}

fn is_space(byte: &u8) -> bool {
    byte.is_ascii_whitespace()
}

/// How many words a text has. In small sums of bytes, for which processors take many at a time.
fn count(text: &[u8]) -> u64 {
    const SHORT: usize = 128;
    let starts = |(before, byte): (&u8, &u8)| u8::from(is_space(before) & !is_space(byte));
    let Some(rest) = text.get(1..) else { return 0 };
    let pairs = text.chunks(SHORT).zip(rest.chunks(SHORT));
    let inner: u64 = pairs.map(|(before, byte)| u64::from(before.iter().zip(byte).map(starts).sum::<u8>())).sum();
    inner + u64::from(!is_space(&text[0]))
}

/// Where the last of the first `words` words ends.
fn end_of(text: &[u8], words: u64) -> usize {
    let mut at = 0;
    for _ in 0..words {
        at += text[at..].iter().take_while(|byte| is_space(byte)).count();
        at += text[at..].iter().take_while(|byte| !is_space(byte)).count();
    }
    at
}

/// The numbers of a piece whose first one belongs to the column `first`.
fn parse(piece: &Piece, columns: &[Scalar], first: usize) -> Result<Vec<Values>, Fault> {
    let capacity = piece.words as usize / columns.len() + 1;
    let mut arrays: Vec<Values> = columns.iter().map(|scalar| scalar.array(capacity)).collect();
    let text = piece.text;
    let (mut at, mut column) = (0, first);
    loop {
        at += text[at..].iter().take_while(|byte| is_space(byte)).count();
        if at == text.len() {
            return Ok(arrays);
        }
        at += push(&mut arrays[column], &text[at..])?;
        column = if column + 1 == arrays.len() { 0 } else { column + 1 };
    }
}

/// Appends the number that a text begins with; its length.
fn push(array: &mut Values, text: &[u8]) -> Result<usize, Fault> {
    let is_whole = |length: &usize| text.get(*length).is_none_or(is_space);
    match array {
        Values::F32(array) => {
            if let Some((x, length)) = number::f32_of(text).filter(|(_, length)| is_whole(length)) {
                array.push(x);
                return Ok(length);
            }
        }
        Values::F64(array) => {
            if let Some((x, length)) = number::f64_of(text).filter(|(_, length)| is_whole(length)) {
                array.push(x);
                return Ok(length);
            }
        }
        _ => {}
    }
    let length = text.iter().take_while(|byte| !is_space(byte)).count();
    array.push_word(&text[..length])?;
    Ok(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_the_same_however_the_text_is_cut() {
        // Several pieces' worth of rows with spaces of all kinds between the numbers, and something after them.
        let rows = 120_000;
        let spaces = [" ", "\n", "\t ", "\r\n", "   "];
        let mut text = String::new();
        for row in 0..rows {
            text += &format!("{row}{}{}.25{}-{row}e-3{}", spaces[row % 5], row % 7, spaces[row % 3], spaces[row % 4]);
        }
        text += "after it";
        assert!(text.len() > 8 * PIECE);
        let mut input = Input::of_stream(text.as_bytes(), text.len() as u64);
        let columns = input.columns(&[Scalar::I32, Scalar::F32, Scalar::F64], rows as u64).unwrap();
        let Values::I32(whole) = &columns[0] else { panic!() };
        let Values::F32(single) = &columns[1] else { panic!() };
        let Values::F64(double) = &columns[2] else { panic!() };
        assert!(whole.iter().copied().eq(0..rows as i32));
        assert!(single.iter().enumerate().all(|(row, x)| *x == (row % 7) as f32 + 0.25));
        assert!(double.iter().enumerate().all(|(row, x)| *x == format!("-{row}e-3").parse::<f64>().unwrap()));
        assert_eq!(input.word().unwrap(), b"after");
    }

    #[test]
    fn words_are_counted_and_passed_over() {
        for (text, words) in [("", 0), (" ", 0), ("a", 1), (" a\nb ", 2), ("\t\r\x0c1 22\t333\n", 3)] {
            assert_eq!(count(text.as_bytes()), words, "{text:?}");
        }
        let text = "1 ".repeat(PIECE) + &" ".repeat(3 * PIECE) + "2 3";
        let mut input = Input::of_stream(text.as_bytes(), text.len() as u64);
        input.skip_words(PIECE as u64 + 1).unwrap();
        assert_eq!(input.word().unwrap(), b"3");
        let mut short = Input::of_stream(&b"1 2 3   "[..], 8);
        assert!(matches!(short.skip_words(4), Err(Fault::Broken(_))));
    }

    #[test]
    fn what_is_no_number_is_shown() {
        let long = "1".repeat(5000) + "x";
        for text in ["1 2 drei 4", "1 2 3", &long] {
            let mut input = Input::of_stream(text.as_bytes(), 1 << 20);
            assert!(matches!(input.columns(&[Scalar::F32], 4), Err(Fault::Broken(_))), "{text}");
        }
    }
}

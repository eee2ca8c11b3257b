//! NumPy's structured arrays: records of fields with names.

use super::{number_type, quoted};
use crate::Attribute;
use crate::error::{Fault, broken};
use crate::input::Input;
use crate::values::{Encoding, Slot};

/// More fields, and larger ones, than any solver has.
const MOST_FIELDS: usize = 256;
const LARGEST_FIELD: usize = 1 << 16;

pub(crate) struct Records {
    fields: Vec<(String, Slot)>,
    /// Bytes of a record.
    size: usize,
    encoding: Option<Encoding>,
}

impl Records {
    /// Fields such as `[('position', '<f4', (3,)), ('id', '<i4')]`; None where this is no list of them, or some hold others.
    pub fn parse(descr: &str) -> Option<Self> {
        let mut records = Self { fields: Vec::new(), size: 0, encoding: None };
        let mut rest = descr.trim_start().strip_prefix('[')?;
        loop {
            rest = rest.trim_start_matches([',', ' ']);
            if rest.starts_with(']') {
                return Some(records);
            }
            let (name, after) = quoted(rest.strip_prefix('(')?)?;
            let (kind, after) = quoted(after.strip_prefix(',')?)?;
            let (components, after) = count(after)?;
            rest = after.trim_start().strip_prefix(')')?;
            records.push(name, kind, components)?;
        }
    }

    fn push(&mut self, name: &str, kind: &str, components: usize) -> Option<()> {
        // Room between fields, and texts.
        let passed_over = ["|V", "|S"].iter().find_map(|mark| kind.strip_prefix(mark)?.parse::<usize>().ok());
        let bytes = match (number_type(kind), passed_over) {
            (Some((scalar, encoding)), _) => {
                if scalar.size() > 1 && self.encoding.replace(encoding).is_some_and(|other| other != encoding) {
                    return None;
                }
                self.fields.push((name.to_owned(), Slot { scalar, components, offset: self.size }));
                scalar.size()
            }
            (None, Some(bytes)) => bytes,
            (None, None) => return None,
        };
        self.size += bytes.checked_mul(components).filter(|bytes| *bytes <= LARGEST_FIELD)?;
        (self.fields.len() <= MOST_FIELDS).then_some(())
    }

    /// The names of its fields of numbers, and how many each has.
    pub fn fields(&self) -> impl Iterator<Item = (&str, usize)> {
        self.fields.iter().map(|(name, slot)| (name.as_str(), slot.components))
    }

    pub fn read(self, input: &mut Input, rows: u64) -> Result<Vec<Attribute>, Fault> {
        if self.fields.is_empty() {
            return broken!("its records have no fields of numbers");
        }
        let slots: Vec<Slot> = self.fields.iter().map(|(_, slot)| *slot).collect();
        let columns = input.records(rows, self.size, &slots, self.encoding.unwrap_or(Encoding::Little))?;
        let fields = self.fields.into_iter().zip(columns);
        Ok(fields.map(|((name, slot), values)| Attribute { name, components: slot.components, values }).collect())
    }
}

/// How many numbers a field has, such as `, (3,)` says, and what follows.
fn count(text: &str) -> Option<(usize, &str)> {
    let Some(rest) = text.trim_start().strip_prefix(',') else { return Some((1, text)) };
    let (count, rest) = rest.trim_start().strip_prefix('(')?.split_once(')')?;
    let count = count.trim_end_matches([',', ' ']).parse().ok().filter(|count| *count > 0)?;
    Some((count, rest))
}

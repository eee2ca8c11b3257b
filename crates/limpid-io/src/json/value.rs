//! A JSON text as columns of numbers, without a tree of its values.

use std::fmt;

use serde::de::{Deserialize, DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// More members of an object than any solver writes.
const MOST_MEMBERS: usize = 4096;

/// Numbers, so many for each particle.
#[derive(Default)]
pub(super) struct Column {
    pub components: usize,
    pub values: Vec<f64>,
}

pub(super) enum Value {
    /// An array of numbers, or of arrays of as many numbers each.
    Array(Column),
    /// An array of objects, each of the same numbers.
    Table(Vec<(String, Column)>),
    Object(Vec<(String, Value)>),
    /// What holds no numbers, and what is odd about it if it might.
    Odd(Option<String>),
}

/// What an element of an array is. Its numbers go to a column.
enum Element {
    Number,
    Row(usize),
    Object(Vec<(String, Column)>),
    Other,
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ValueVisitor)
    }
}

struct ValueVisitor;

/// What both visitors make of numbers and of what is none.
macro_rules! visit_scalars {
    ($number:expr, $other:expr) => {
        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("numbers")
        }

        fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
            Ok($number(self, number as f64))
        }

        fn visit_u64<E>(self, number: u64) -> Result<Self::Value, E> {
            Ok($number(self, number as f64))
        }

        fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
            Ok($number(self, number))
        }

        /// What JSON writes for numbers that are none.
        fn visit_unit<E>(self) -> Result<Self::Value, E> {
            Ok($number(self, f64::NAN))
        }

        fn visit_bool<E>(self, _: bool) -> Result<Self::Value, E> {
            Ok($other)
        }

        fn visit_str<E>(self, _: &str) -> Result<Self::Value, E> {
            Ok($other)
        }
    };
}

impl<'de> Visitor<'de> for ValueVisitor {
    type Value = Value;

    visit_scalars!(|_, _| Value::Odd(None), Value::Odd(None));

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        let mut table = Table::default();
        // Numbers that each element has; 0: bare ones.
        let mut each = None;
        let mut rows = 0;
        while let Some(element) = elements.next_element_seed(ElementSeed(&mut values))? {
            let count = match element {
                Element::Number => Some(0),
                Element::Row(count) => Some(count),
                Element::Object(columns) if values.is_empty() => {
                    table.push(columns);
                    None
                }
                _ => return ignore_rest(elements, None),
            };
            if rows > 0 && each != count {
                return ignore_rest(elements, Some(format!("element {rows} of an array is unlike those before")));
            }
            (each, rows) = (count, rows + 1);
        }
        Ok(match each {
            None if rows > 0 => Value::Table(table.whole()),
            // An empty row counts as one of none.
            Some(0) if values.is_empty() => Value::Odd(None),
            each => Value::Array(Column { components: each.unwrap_or(3).max(1), values }),
        })
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Value, A::Error> {
        let mut found = Vec::new();
        while let Some(name) = members.next_key::<String>()? {
            match members.next_value::<Value>()? {
                Value::Odd(None) => {}
                value if found.len() < MOST_MEMBERS => found.push((name, value)),
                _ => {}
            }
        }
        Ok(Value::Object(found))
    }
}

fn ignore_rest<'de, A: SeqAccess<'de>>(mut elements: A, odd: Option<String>) -> Result<Value, A::Error> {
    while elements.next_element::<IgnoredAny>()?.is_some() {}
    Ok(Value::Odd(odd))
}

/// Reads an element, and puts its numbers behind others.
struct ElementSeed<'a>(&'a mut Vec<f64>);

impl<'de> DeserializeSeed<'de> for ElementSeed<'_> {
    type Value = Element;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Element, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ElementSeed<'_> {
    type Value = Element;

    visit_scalars!(
        |this: Self, number| {
            this.0.push(number);
            Element::Number
        },
        Element::Other
    );

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Element, A::Error> {
        let mut count = 0;
        let mut is_row = true;
        while let Some(number) = numbers.next_element_seed(ElementSeed(self.0))? {
            is_row &= matches!(number, Element::Number);
            count += 1;
        }
        Ok(if is_row { Element::Row(count) } else { Element::Other })
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Element, A::Error> {
        let mut columns = Vec::new();
        while let Some(name) = members.next_key::<String>()? {
            let mut values = Vec::new();
            let components = match members.next_value_seed(ElementSeed(&mut values))? {
                Element::Number => 1,
                Element::Row(count) => count,
                _ => continue,
            };
            if columns.len() < MOST_MEMBERS {
                columns.push((name, Column { components, values }));
            }
        }
        Ok(Element::Object(columns))
    }
}

/// Columns of the numbers of objects.
#[derive(Default)]
struct Table {
    columns: Vec<(String, Column)>,
    rows: usize,
}

impl Table {
    fn push(&mut self, members: Vec<(String, Column)>) {
        for (index, (name, mut member)) in members.into_iter().enumerate() {
            // Nearly always in the same order.
            let is_same = |(other, _): &(String, Column)| *other == name;
            let place = Some(index).filter(|index| self.columns.get(*index).is_some_and(is_same));
            match place.or_else(|| self.columns.iter().position(is_same)) {
                Some(place) => {
                    let column = &mut self.columns[place].1;
                    if column.components == member.components {
                        column.values.append(&mut member.values);
                    }
                }
                // What the first objects lack, no particles have.
                None if self.rows == 0 => self.columns.push((name, member)),
                None => {}
            }
        }
        self.rows += 1;
    }

    /// The columns that all objects have.
    fn whole(mut self) -> Vec<(String, Column)> {
        self.columns.retain(|(_, column)| column.values.len() == self.rows * column.components);
        self.columns
    }
}

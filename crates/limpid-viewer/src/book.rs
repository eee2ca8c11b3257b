//! The options of a shot as they are being edited, with undo and redo.

use limpid_shot::{Error, Options, config};
use toml::{Table, Value};

/// The most steps that can be taken back.
const DEPTH: usize = 200;

/// Options and their past.
pub struct Book {
    options: Options,
    table: Table,
    /// What `options` were when the last step was completed.
    settled: Options,
    past: Vec<Options>,
    future: Vec<Options>,
}

impl Book {
    /// Starts with these.
    pub fn new(options: Options) -> Self {
        let table = table_of(&options);
        Self { settled: options.clone(), options, table, past: Vec::new(), future: Vec::new() }
    }

    /// Every option as it is.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The same by key.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// Replaces all of them.
    pub fn set_all(&mut self, options: Options) {
        self.table = table_of(&options);
        self.options = options;
    }

    /// Sets one, and what follows from it (a filter has its own defaults).
    ///
    /// # Errors
    /// A value outside its range.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), Error> {
        self.set_several(Table::from_iter([(key.to_owned(), value)]))
    }

    /// Sets several at once.
    ///
    /// # Errors
    /// A value outside its range.
    pub fn set_several(&mut self, values: Table) -> Result<(), Error> {
        let layer: Options = values.try_into().map_err(|error: toml::de::Error| Error::usage(error.message()))?;
        self.set_all(config::change(&self.options, &layer)?);
        Ok(())
    }

    /// Takes options away, so that they are chosen by the program.
    pub fn remove(&mut self, keys: &[&str]) {
        let mut table = self.table.clone();
        keys.iter().for_each(|key| drop(table.remove(*key)));
        if let Ok(options) = table.try_into() {
            self.set_all(options);
        }
    }

    /// Makes a step of what has changed since the last one. Call it when no drag is going on.
    pub fn settle(&mut self) {
        if self.options != self.settled {
            self.past.push(std::mem::replace(&mut self.settled, self.options.clone()));
            self.future.clear();
            if self.past.len() > DEPTH {
                self.past.remove(0);
            }
        }
    }

    /// Whether there is a step to take back.
    pub fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether there is a step to take again.
    pub fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }

    /// Takes a step back.
    pub fn undo(&mut self) {
        self.settle();
        if let Some(options) = self.past.pop() {
            self.future.push(std::mem::replace(&mut self.settled, options.clone()));
            self.set_all(options);
        }
    }

    /// Takes a step again.
    pub fn redo(&mut self) {
        if let Some(options) = self.future.pop() {
            self.past.push(std::mem::replace(&mut self.settled, options.clone()));
            self.set_all(options);
        }
    }
}

fn table_of(options: &Options) -> Table {
    // Options are made of TOML's own kinds of values.
    Table::try_from(options).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_taken_back_and_again() {
        let mut book = Book::new(Options::defaults());
        book.set("fov", Value::Float(30.0)).unwrap();
        book.settle();
        book.set("filter", Value::String("bilateral".into())).unwrap();
        book.settle();
        let last = book.options().clone();
        assert!(book.set("fov", Value::Float(500.0)).is_err());
        assert_eq!(*book.options(), last);
        book.undo();
        assert_eq!(book.options().fov, Some(30.0));
        assert_eq!(book.options().filter, Options::defaults().filter);
        book.undo();
        assert_eq!(*book.options(), Options::defaults());
        assert!(!book.can_undo());
        book.redo();
        book.redo();
        assert_eq!(*book.options(), last);
        assert!(!book.can_redo());
    }
}

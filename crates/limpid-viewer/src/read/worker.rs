//! Reading on a page, which has one thread: small files between two pictures, large ones in a worker. The page brings the
//! worker along (`reader.js`); it runs this same program.

use super::parcel::{self, Head};
use super::{Found, Loaded, found};
use crate::frames::Source;
use js_sys::{Array, Function, Uint8Array};
use limpid_shot::{Options, Reading};
use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::{Rc, Weak};
use wasm_bindgen::prelude::*;

/// Bytes of a file that hold no picture up.
const SMALL: usize = 1 << 20;

/// The page's function that hands a file to the worker: of its name, its bytes, the options as TOML, and whether it is new. A promise
/// of what [`read`] returns there; of null where there is no worker to be had.
pub type ReadBeside = Option<Function>;

/// Reads one file after the other.
pub struct Reader {
    reading: Reading,
    options: String,
    beside: ReadBeside,
    wake: Rc<dyn Fn()>,
    asked: Option<Asked>,
    answer: Rc<RefCell<Option<Answer>>>,
}

struct Asked {
    index: usize,
    source: Source,
    is_new: bool,
}

enum Answer {
    Read(Loaded),
    /// Not there.
    Returned(Asked),
}

impl Reader {
    /// All of them in one way, which the options ask for; `wake` is called when one has been read.
    pub fn new(reading: Reading, options: &Options, beside: ReadBeside, wake: impl Fn() + 'static) -> Self {
        Self {
            reading,
            options: toml::to_string(options).unwrap_or_default(),
            beside,
            wake: Rc::new(wake),
            asked: None,
            answer: Rc::default(),
        }
    }

    /// Asks for a frame, and if it is new for what the survey needs.
    pub fn ask(&mut self, index: usize, source: Source, is_new: bool) {
        let asked = Asked { index, source, is_new };
        match (&self.beside, &asked.source) {
            (Some(beside), Source::Bytes(path, bytes)) if bytes.len() > SMALL => {
                let arguments = Array::of4(
                    &path.display().to_string().into(),
                    &Uint8Array::from(&**bytes),
                    &self.options.as_str().into(),
                    &is_new.into(),
                );
                let promise = beside.apply(&JsValue::NULL, &arguments);
                let (answer, wake) = (Rc::downgrade(&self.answer), Rc::clone(&self.wake));
                wasm_bindgen_futures::spawn_local(wait(promise, asked, answer, wake));
            }
            _ => {
                self.asked = Some(asked);
                (self.wake)();
            }
        }
    }

    /// What has been read.
    pub fn take(&mut self) -> Option<Loaded> {
        let Asked { index, source, is_new } = match self.answer.borrow_mut().take() {
            Some(Answer::Read(loaded)) => return Some(loaded),
            Some(Answer::Returned(asked)) => asked,
            None => self.asked.take()?,
        };
        (self.wake)();
        Some(Loaded { index, outcome: found(&source, is_new, &self.reading) })
    }
}

/// Until the worker has answered. Whoever asked may have gone meanwhile.
async fn wait(
    promise: Result<JsValue, JsValue>,
    asked: Asked,
    answer: Weak<RefCell<Option<Answer>>>,
    wake: Rc<dyn Fn()>,
) {
    let parts = match promise {
        Ok(promise) => wasm_bindgen_futures::JsFuture::from(js_sys::Promise::resolve(&promise)).await,
        Err(problem) => Err(problem),
    };
    let Some(answer) = answer.upgrade() else { return };
    let outcome = match parts {
        Ok(parts) if parts.is_null() => None,
        Ok(parts) => Some(opened(&Array::from(&parts))),
        Err(problem) => {
            let text = problem.as_string().unwrap_or_else(|| format!("{problem:?}"));
            Some(Err(text))
        }
    };
    *answer.borrow_mut() = Some(match outcome {
        Some(outcome) => Answer::Read(Loaded { index: asked.index, outcome }),
        None => Answer::Returned(asked),
    });
    wake();
}

/// In the worker: a file's particles, for the page. The first part is a text, the others are the bytes of arrays.
#[wasm_bindgen]
pub fn read(name: &str, bytes: Vec<u8>, options: &str, is_new: bool) -> Result<Array, JsValue> {
    let outcome = options_of(options).and_then(|reading| {
        let source = Source::Bytes(PathBuf::from(name), bytes.into());
        found(&source, is_new, &reading)
    });
    let (set, survey) = outcome.map_err(|problem| JsValue::from(problem.as_str()))?;
    let (head, columns) = parcel::packed(&set, survey.as_ref());
    Ok(std::iter::once(JsValue::from(head)).chain(columns.map(|column| Uint8Array::from(column).into())).collect())
}

fn options_of(text: &str) -> Result<Reading, String> {
    let options: Options = toml::from_str(text).map_err(|error| error.to_string())?;
    Reading::of(&options).map_err(|error| error.to_string())
}

/// On the page: what [`read`] has packed.
fn opened(parts: &Array) -> Result<Found, String> {
    let head: Head =
        toml::from_str(&parts.get(0).as_string().unwrap_or_default()).map_err(|error| error.to_string())?;
    let mut columns = parts.iter().skip(1).map(Uint8Array::from);
    parcel::opened(head, |bytes| match columns.next() {
        Some(column) if column.length() as usize == bytes.len() => column.copy_to(bytes),
        _ => {}
    })
}

//! What must hold of any bytes at all: an error of one line, or particles that are whole.

use std::path::Path;
use std::sync::Arc;

/// Reads bytes as a file of this name, and panics where something is wrong.
pub fn check(name: &str, bytes: &[u8]) {
    match limpid_io::read_bytes(Path::new(name), Arc::from(bytes)) {
        Ok(mut set) => {
            assert!(set.positions.iter().flatten().all(|x| x.is_finite()), "a position is not finite");
            assert!(set.origin.iter().all(|x| x.is_finite()), "the origin is not finite");
            for attribute in &set.attributes {
                let wanted = set.len() * attribute.components;
                assert_eq!(attribute.values.len(), wanted, "attribute {:?} is not whole", attribute.name);
            }
            set.estimate_spacing();
            let selection =
                limpid_io::Selection { clip: Some([-1.0, -1.0, -1.0, 1.0, 1.0, 1.0]), ..Default::default() };
            assert!(selection.apply(&mut set, Some(0.1)).is_ok(), "its particles cannot be chosen from");
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.contains(name) && !message.contains(char::is_control), "no good message: {message:?}");
        }
    }
}

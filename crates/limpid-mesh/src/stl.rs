//! STL, binary and ASCII. Triangles share no vertices, as in the file; its normals say nothing that the corners don't.

use crate::error::{Fault, quote};
use crate::{Mesh, Part};

/// A title and the count come before the triangles of a binary file.
const HEADER: usize = 84;
/// Normal, three corners and two bytes for the writer's own use.
const TRIANGLE: usize = 50;

pub(crate) fn read(bytes: &[u8]) -> Result<Mesh, Fault> {
    let positions = match bytes.get(80..HEADER) {
        Some(count) if bytes.len() == HEADER + TRIANGLE * count_of(count) => read_binary(&bytes[HEADER..]),
        _ if is_text(bytes) => read_text(bytes)?,
        Some(count) => {
            let count = count_of(count);
            let size = bytes.len();
            return Err(Fault::broken(format!(
                "its header claims {count} triangles, which do not fit its {size} bytes"
            )));
        }
        None => return Err(Fault::broken("it ends in its header")),
    };
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Ok(Mesh { parts: vec![Part { positions, triangles, ..Part::default() }], warnings: Vec::new() })
}

fn count_of(bytes: &[u8]) -> usize {
    bytes.first_chunk().map_or(0, |&bytes| u32::from_le_bytes(bytes) as usize)
}

/// Binary files may start with "solid" too, but no text has the count's bytes.
fn is_text(bytes: &[u8]) -> bool {
    bytes.trim_ascii_start().starts_with(b"solid") && !bytes.iter().take(1024).any(|byte| *byte == 0)
}

fn read_binary(triangles: &[u8]) -> Vec<[f32; 3]> {
    let corners = triangles.chunks_exact(TRIANGLE).flat_map(|triangle| triangle[12..48].as_chunks::<12>().0);
    let number = |corner: &[u8; 12], axis: usize| f32::from_le_bytes(corner.as_chunks().0[axis]);
    corners.map(|corner| [0, 1, 2].map(|axis| number(corner, axis))).collect()
}

fn read_text(bytes: &[u8]) -> Result<Vec<[f32; 3]>, Fault> {
    let text = String::from_utf8_lossy(bytes);
    let mut positions = Vec::new();
    let mut ended = false;
    for (index, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let broken = || Fault::broken(format!("line {}: {}", index + 1, quote(line)));
        match words[..] {
            ["vertex", x, y, z] => {
                let number = |word: &str| word.parse().map_err(|_| broken());
                positions.push([number(x)?, number(y)?, number(z)?]);
            }
            ["vertex", ..] => return Err(broken()),
            ["endloop"] if !positions.len().is_multiple_of(3) => {
                return Err(Fault::broken(format!("line {} ends a facet that has not three corners", index + 1)));
            }
            ["endsolid", ..] => ended = true,
            ["solid", ..] => ended = false,
            _ => {}
        }
    }
    if !ended || !positions.len().is_multiple_of(3) {
        return Err(Fault::broken("it ends too early: there is no endsolid"));
    }
    Ok(positions)
}

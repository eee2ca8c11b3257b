//! What browsers refuse in shaders and naga does not: found without a browser.

use std::path::{Path, PathBuf};

/// Every shader of the workspace.
fn shaders(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            shaders(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            found.push(path);
        }
    }
}

/// The lines in which `&&` and `||` stand beside each other without parentheses.
fn mixed(source: &str) -> Vec<usize> {
    let mut lines = Vec::new();
    // Which of the two there has been, for each parenthesis that is open.
    let mut open = vec![[false; 2]];
    for (number, line) in source.lines().enumerate() {
        let code = line.split("//").next().unwrap_or_default().as_bytes();
        for (at, byte) in code.iter().enumerate() {
            match byte {
                b'(' => open.push([false; 2]),
                b')' => _ = open.pop(),
                b'{' | b'}' | b';' | b',' => *open.last_mut().unwrap() = [false; 2],
                b'&' | b'|' if at > 0 && code[at - 1] == *byte => {
                    let seen = open.last_mut().unwrap();
                    seen[usize::from(*byte == b'|')] = true;
                    if *seen == [true; 2] {
                        lines.push(number + 1);
                    }
                }
                _ => {}
            }
        }
    }
    lines
}

#[test]
fn and_and_or_are_mixed_only_with_parentheses() {
    assert_eq!(mixed("if a || b && c {"), [1]);
    assert_eq!(mixed("if a &&\n (b || c) { d = e || f; } // && g"), [0; 0]);
    let mut paths = Vec::new();
    shaders(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), &mut paths);
    assert!(!paths.is_empty());
    for path in paths {
        assert_eq!(mixed(&std::fs::read_to_string(&path).unwrap()), [0; 0], "{}", path.display());
    }
}

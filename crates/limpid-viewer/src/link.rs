//! Settings in the address of a page: after the `#`, TOML's lines with `&` between them, percent-encoded.

use limpid_shot::{Error, Options, config};

/// What follows the `#`: only what differs from the defaults.
pub fn fragment(options: &Options) -> Result<String, Error> {
    let lines = config::difference(options)?.to_string();
    Ok(lines.lines().map(encode).collect::<Vec<_>>().join("&"))
}

/// Options of such an address.
///
/// # Errors
/// What is wrong with it.
pub fn options(fragment: &str) -> Result<Options, Error> {
    let lines: Vec<String> = fragment.trim_start_matches('#').split('&').map(decode).collect();
    config::of_text(&lines.join("\n"))
}

/// As in a query, but readable: the signs that TOML needs stay.
fn encode(text: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~=,[]:/".contains(&byte);
    let squeezed = text.replace(" = ", "=").replace(", ", ",");
    squeezed
        .bytes()
        .map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

fn decode(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let hex = text.get(i + 1..i + 3).and_then(|hex| u8::from_str_radix(hex, 16).ok());
        match (bytes[i], hex) {
            (b'%', Some(byte)) => {
                decoded.push(byte);
                i += 3;
            }
            (byte, _) => {
                decoded.push(byte);
                i += 1;
            }
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_come_back_from_an_address() {
        let text = "look = \"honey\"\nfov = 30.5\ncamera-eye = [1.0, -2.5, 3.0]\nmesh = [\"a b&c=100%.obj\"]";
        let given = config::of_text(text).unwrap();
        let fragment = fragment(&given).unwrap();
        assert!(!fragment.contains([' ', '"', '\n']), "{fragment}");
        assert_eq!(options(&format!("#{fragment}")).unwrap(), given);
        assert_eq!(options("").unwrap(), Options::defaults());
        assert!(options("fov=1000").unwrap_err().to_string().contains("fov"));
    }
}

//! Texts, numbers and files as a page holds them.

use tracelight_maths::log10;
use tracelight_picture::Raster;

use crate::error::EncodeError;

/// A text made safe for element content and quoted attributes.
#[must_use]
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // control characters are no legal HTML; a name may hold any
            c if c.is_control() => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A number with about `digits` significant digits, for people: no exponent, a true minus sign.
#[must_use]
pub fn number(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let size = value.abs();
    let whole = if size < 1.0 { 1 } else { log10(size).floor() as usize + 1 };
    let text = format!("{value:.*}", digits.saturating_sub(whole).min(6));
    // a negative number that rounds to nothing is nothing
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }
}

/// A file inside the page.
#[must_use]
pub fn data_uri(media_type: &str, bytes: &[u8]) -> String {
    format!("data:{media_type};base64,{}", base64(bytes))
}

/// A picture inside the page, its longer side and quality at most so much. `of` is the file that is named if it can not be.
pub(super) fn jpeg_uri(
    raster: &Raster,
    (longest_px, quality): (u32, u8),
    of: &str,
) -> Result<String, EncodeError> {
    let jpeg = raster.shrunk(longest_px).jpeg(quality);
    let jpeg = jpeg.map_err(|e| EncodeError { name: of.to_owned(), reason: e.to_string() })?;
    Ok(data_uri("image/jpeg", &jpeg))
}

/// Base 64 of RFC 4648 §4.
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let word = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * i) & 63) as usize];
            out.push(if i <= three.len() { char::from(letter) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_a_name_stays_a_name() {
        assert_eq!(escaped("<b onload='x'>\"&\u{1b}"), "&lt;b onload=&#39;x&#39;&gt;&quot;&amp;\u{fffd}");
    }

    #[test]
    fn numbers_read_well() {
        for (value, digits, wanted) in [
            (0.2113, 2, "0.2"),
            (0.2113, 3, "0.21"),
            (12.345, 3, "12.3"),
            (1234.5, 3, "1234"),
            (-0.5, 3, "−0.50"),
            (-0.0001, 3, "0.00"),
            (f64::NAN, 3, "–"),
        ] {
            assert_eq!(number(value, digits), wanted);
        }
    }

    #[test]
    fn base64_has_the_vectors_of_its_standard() {
        for (bytes, wanted) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(bytes.as_bytes()), wanted);
        }
    }
}

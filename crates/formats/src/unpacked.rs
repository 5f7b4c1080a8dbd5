//! Plain bytes and text of files that are packed, or in another encoding than UTF-8.

use std::borrow::Cow;
use std::io::Read;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE};
use flate2::read::MultiGzDecoder;

use crate::FormatError;
use crate::limit::MAX_BYTES;

/// How a file begins that gzip has packed.
const GZIP: &[u8] = b"\x1f\x8b";

/// Unpacked, a file has so many bytes at most: those of the largest one that a reader takes.
const MAX_UNPACKED: usize = 64 << 20;

/// The bytes of a file without their packing, if gzip has packed them (`.svgz`); as they are otherwise.
///
/// # Errors
/// A file whose packing is broken or cut off, and one that is larger than any reader takes.
pub fn unpacked(bytes: &[u8]) -> Result<Cow<'_, [u8]>, FormatError> {
    if !bytes.starts_with(GZIP) {
        return Ok(bytes.into());
    }
    let mut plain = Vec::new();
    // one byte more tells what is too large from what is just large enough
    let read = MultiGzDecoder::new(bytes).take(MAX_UNPACKED as u64 + 1).read_to_end(&mut plain);
    if plain.len() > MAX_UNPACKED {
        let found = plain.len();
        return Err(FormatError::TooLarge {
            what: "unpacked file",
            found,
            unit: "bytes",
            limit: MAX_UNPACKED,
        });
    }
    match read {
        Ok(_) => Ok(plain.into()),
        Err(error) => Err(FormatError::Packing { message: error.to_string() }),
    }
}

/// The text of an XML file, in the encoding that its byte order mark, its first bytes or its declaration names.
///
/// # Errors
/// Bytes that are no text in that encoding, and text that is larger than a reader takes.
pub(crate) fn xml_text(bytes: &[u8]) -> Result<Cow<'_, str>, FormatError> {
    let encoding = encoding_of(bytes);
    if encoding == UTF_8 {
        return crate::text(bytes).map(Cow::Borrowed);
    }
    let (text, _) = encoding.decode_with_bom_removal(bytes);
    match text.len() > MAX_BYTES {
        true => {
            let found = text.len();
            Err(FormatError::TooLarge { what: "file as UTF-8", found, unit: "bytes", limit: MAX_BYTES })
        }
        false => Ok(text),
    }
}

/// XML 1.0, appendix F: by the byte order mark, else by how `<?` is written, else by the declaration.
fn encoding_of(bytes: &[u8]) -> &'static Encoding {
    if let Some((encoding, _)) = Encoding::for_bom(bytes) {
        return encoding;
    }
    match bytes {
        [b'<', 0, ..] => UTF_16LE,
        [0, b'<', ..] => UTF_16BE,
        _ => declared(bytes).unwrap_or(UTF_8),
    }
}

/// The encoding that an XML declaration names. One that is written in single bytes cannot mean UTF-16, whatever it says.
fn declared(bytes: &[u8]) -> Option<&'static Encoding> {
    const LONGEST: usize = 256;
    let head = bytes.trim_ascii_start().strip_prefix(b"<?xml")?;
    let end = head.iter().take(LONGEST).position(|&b| b == b'>')?;
    let head = std::str::from_utf8(&head[..end]).ok()?;
    let (_, value) = head.split_once("encoding")?;
    let value = value.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let label = value[1..].split(quote).next()?;
    Encoding::for_label(label.as_bytes()).filter(|&e| e != UTF_16LE && e != UTF_16BE)
}

/// The first characters of a text, whichever encoding it is in: enough to tell what it is.
#[must_use]
pub fn head(bytes: &[u8]) -> String {
    const LENGTH: usize = 1024;
    let bytes = &bytes[..bytes.len().min(LENGTH)];
    let (text, _) = encoding_of(bytes).decode_with_bom_removal(bytes);
    text.trim_start().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packer.write_all(bytes).unwrap();
        packer.finish().unwrap()
    }

    #[test]
    fn packed_files_are_unpacked_and_others_are_as_they_are() {
        assert_eq!(unpacked(b"<svg/>").unwrap(), &b"<svg/>"[..]);
        let once = packed(b"<svg/>");
        assert_eq!(unpacked(&once).unwrap(), &b"<svg/>"[..]);
        assert_eq!(unpacked(&[once.clone(), packed(b"<!-- -->")].concat()).unwrap(), &b"<svg/><!-- -->"[..]);
        for cut in 2..once.len() {
            let found = unpacked(&once[..cut]).unwrap_err().to_string();
            assert!(found.contains("packed with gzip, and broken"), "{found}");
        }
        let bomb = packed(&vec![b' '; MAX_UNPACKED + 1]);
        assert!(matches!(unpacked(&bomb), Err(FormatError::TooLarge { .. })));
    }

    #[test]
    fn the_encoding_is_that_of_the_mark_or_the_declaration() {
        let check = |bytes: &[u8], wanted: &str| assert_eq!(xml_text(bytes).unwrap(), wanted);
        check(b"<?xml version='1.0' encoding='iso-8859-1'?><a b='caf\xe9'/>", {
            "<?xml version='1.0' encoding='iso-8859-1'?><a b='café'/>"
        });
        check(b"<?xml version=\"1.0\" encoding = \"windows-1252\"?>\x80", {
            "<?xml version=\"1.0\" encoding = \"windows-1252\"?>€"
        });
        check("<a b='ß'/>".as_bytes(), "<a b='ß'/>");
        check("\u{feff}<a/>".as_bytes(), "<a/>");
        // said to be UTF-16, and plainly not
        check(b"<?xml encoding='UTF-16'?><a/>", "<?xml encoding='UTF-16'?><a/>");
        let wide = |text: &str, of: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(of).collect::<Vec<u8>>();
        for text in ["\u{feff}<a b='ß€'/>", "<a b='ß€'/>"] {
            check(&wide(text, u16::to_le_bytes), "<a b='ß€'/>");
            check(&wide(text, u16::to_be_bytes), "<a b='ß€'/>");
        }
        assert_eq!(xml_text(b"<a b='\xe9'/>"), Err(FormatError::NotText { offset: 6 }));
        assert_eq!(head(&wide("\u{feff} <svg/>", u16::to_be_bytes)), "<svg/>");
    }
}

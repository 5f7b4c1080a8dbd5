//! What stands for a character in the texts of a DXF: bytes in the file's code page, `\U+2205`, `%%c`.

use encoding_rs::Encoding;

use super::groups;

/// The encoding that `$DWGCODEPAGE` names: `ANSI_1252` and the like.
pub(super) fn encoding(code_page: &[u8]) -> Option<&'static Encoding> {
    let name = std::str::from_utf8(code_page).ok()?.trim().to_ascii_lowercase();
    let number = name.trim_start_matches("ansi_").trim_start_matches("dos");
    let label = match number {
        "874" | "1250" | "1251" | "1252" | "1253" | "1254" | "1255" | "1256" | "1257" | "1258" => {
            format!("windows-{number}")
        }
        "866" => "ibm866".to_owned(),
        "932" => "shift_jis".to_owned(),
        "936" => "gbk".to_owned(),
        "949" => "euc-kr".to_owned(),
        "950" => "big5".to_owned(),
        _ => return None,
    };
    Encoding::for_label(label.as_bytes())
}

/// Bytes as characters: UTF-8 where they are that, otherwise by the code page. `\U+XXXX` becomes its character.
pub(super) fn decoded(bytes: &[u8], encoding: Option<&'static Encoding>) -> String {
    match encoding {
        Some(encoding) if std::str::from_utf8(bytes).is_err() => {
            let (text, _) = encoding.decode_without_bom_handling(bytes);
            groups::characters(text.as_bytes(), usize::MAX)
        }
        _ => groups::characters(bytes, usize::MAX),
    }
}

/// A line of text without the codes in it: `%%d` is a degree sign, `%%065` an A, `%%u` underlines, which is not drawn.
pub(super) fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find("%%") {
        out.push_str(&rest[..at]);
        rest = &rest[at + 2..];
        let (character, used) = code(rest);
        out.extend(character);
        rest = &rest[used..];
    }
    out.push_str(rest);
    uncontrolled(&out)
}

/// The character that a code after `%%` stands for, and how many bytes the code has.
fn code(rest: &str) -> (Option<char>, usize) {
    let Some(first) = rest.chars().next() else { return (None, 0) };
    match first.to_ascii_lowercase() {
        'd' => (Some('°'), 1),
        'p' => (Some('±'), 1),
        'c' => (Some('Ø'), 1),
        '%' => (Some('%'), 1),
        'u' | 'o' | 'k' => (None, 1),
        '0'..='9' => {
            let digits = rest.bytes().take(3).take_while(u8::is_ascii_digit).count();
            let number = rest[..digits].parse::<u32>().ok();
            (number.and_then(char::from_u32).filter(|c| !c.is_control()), digits)
        }
        // what is no code is text
        _ => (None, 0),
    }
}

/// `^I` is a tab, `^J` the end of a line, `^ ` the caret itself.
fn uncontrolled(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match (c, rest.peek()) {
            ('^', Some(' ')) => {
                rest.next();
                out.push('^');
            }
            ('^', Some('I' | 'J' | 'M')) => {
                rest.next();
                out.push(' ');
            }
            ('\t', _) => out.push(' '),
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_become_what_they_stand_for() {
        let check = |text: &str, expected: &str| assert_eq!(plain(text), expected, "{text}");
        check("%%c20 %%p0.1 45%%d 100%%%", "Ø20 ±0.1 45° 100%");
        check("%%C20 %%uunder%%u %%065%%066", "Ø20 under AB");
        check("%%", "");
        check("50% %5 %%x", "50% %5 x");
        check("a^Ib^ c", "a b^c");
    }

    #[test]
    fn old_files_are_read_in_their_code_page() {
        let check = |page: &str, bytes: &[u8], expected: &str| {
            assert_eq!(decoded(bytes, encoding(page.as_bytes())), expected, "{page}");
        };
        check("ANSI_1250", b"\xA3\xF3d\x9F", "Łódź");
        check("ANSI_1251", b"\xCC\xE8\xF0", "Мир");
        check("ansi_1252", b"Stra\xDFe \x80", "Straße €");
        check("ANSI_1252", "Straße".as_bytes(), "Straße");
        check("dos866", b"\x8C\xA8\xE0", "Мир");
        check("ANSI_1252", b"\\U+2205 \xDF", "∅ ß");
        check("nothing", b"\xDF", "ß");
    }
}

//! A name for files from words.

use unicode_normalization::char::decompose_canonical;

/// Longest name, characters.
const LONGEST: usize = 40;

/// Small letters, digits and hyphens that read like the words: `CAFÉ Łódź` is `cafe-lodz`; `text` for words without such letters.
#[must_use]
pub fn slug(words: &str) -> String {
    let mut name = String::new();
    for letter in words.chars().flat_map(char::to_lowercase) {
        let mut base = None;
        decompose_canonical(letter, |part| {
            base.get_or_insert(part);
        });
        match plain(base.unwrap_or(letter)) {
            Some(plain) => name.push_str(&plain),
            None if is_mark(letter) => {}
            None if name.is_empty() || name.ends_with('-') => {}
            None => name.push('-'),
        }
    }
    let name: String = name.chars().take(LONGEST).collect();
    let name = name.trim_matches('-');
    if name.is_empty() { "text".to_owned() } else { name.to_owned() }
}

fn is_mark(letter: char) -> bool {
    unicode_normalization::char::is_combining_mark(letter)
}

/// A letter of the Latin alphabet as one or two without marks.
fn plain(letter: char) -> Option<String> {
    let two = match letter {
        'ß' => "ss",
        'æ' => "ae",
        'œ' => "oe",
        'ø' => "o",
        'ł' => "l",
        'đ' | 'ð' => "d",
        'ħ' => "h",
        'ŧ' => "t",
        'ı' => "i",
        'ĳ' => "ij",
        'ŋ' => "ng",
        'þ' => "th",
        c if c.is_ascii_alphanumeric() => return Some(c.to_string()),
        _ => return None,
    };
    Some(two.to_owned())
}

#[cfg(test)]
mod tests {
    use super::slug;

    #[test]
    fn words_become_a_name_that_reads_alike() {
        let check = |words: &str, expected: &str| assert_eq!(slug(words), expected, "{words}");
        check("CAFÉ", "cafe");
        check("CAFÉ ŁÓDŹ\nStraße", "cafe-lodz-strasse");
        check("e\u{301}t\u{e9} 3/4", "ete-3-4");
        check("…", "text");
        check("Привет", "text");
        check(&"a".repeat(99), &"a".repeat(40));
    }
}

//! What of a text is not drawn as asked, in words.

use std::collections::BTreeSet;

/// Says which characters are missing and which are outlines; nothing where all is well.
#[must_use]
pub fn remarks(missing: &BTreeSet<char>, outlined: &BTreeSet<char>) -> Vec<String> {
    let missing = (!missing.is_empty())
        .then(|| format!("not drawn: {}, which no font here has; --font FILE adds one", named(missing)));
    let outlined = (!outlined.is_empty()).then(|| {
        format!(
            "drawn as outlines: {}, which no single-line font here has; --font FILE adds one",
            named(outlined)
        )
    });
    missing.into_iter().chain(outlined).collect()
}

/// Characters as people know them, with their code where they cannot be seen.
#[must_use]
pub fn named(characters: &BTreeSet<char>) -> String {
    const NAMED: usize = 12;
    let name = |&c: &char| match c {
        c if c.is_alphanumeric() || c.is_ascii_graphic() => format!("{c} (U+{:04X})", u32::from(c)),
        c => format!("U+{:04X}", u32::from(c)),
    };
    let names: Vec<String> = characters.iter().take(NAMED).map(name).collect();
    let more = characters.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more characters") } else { String::new() };
    names.join(", ") + &more
}

//! Command lines as a shell takes them.

/// An argument as a shell takes it: in quotes where a character of it means something else there.
#[must_use]
pub fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+%".contains(c);
    if argument.chars().all(plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_needs_quotes_has_them() {
        assert_eq!(quoted("K11 G11"), "'K11 G11'");
        assert_eq!(quoted("--out"), "--out");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted("--threshold=30%"), "--threshold=30%");
    }
}

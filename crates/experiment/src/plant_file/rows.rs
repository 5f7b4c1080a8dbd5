//! Fields of a line of a table, whatever separates them.

/// Fields of a line; further ones are not looked at. No matrix has as many columns.
const MOST_FIELDS: usize = 1024;

/// What separates the fields of a whole file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Sign(char),
    Blanks,
}

impl Separator {
    /// Of a file's lines: a semicolon or a tab anywhere is one; then a comma; else blanks.
    pub(super) fn of<'a>(lines: impl Iterator<Item = &'a str> + Clone) -> Self {
        let sign = [';', '\t', ','].into_iter().find(|sign| lines.clone().any(|line| line.contains(*sign)));
        sign.map_or(Self::Blanks, Self::Sign)
    }

    /// The fields, without blanks and quotes around them.
    pub(super) fn fields(self, line: &str) -> Vec<&str> {
        match self {
            Self::Sign(sign) => line
                .split(sign)
                .take(MOST_FIELDS)
                .map(|field| field.trim().trim_matches('"').trim())
                .collect(),
            Self::Blanks => {
                line.split_whitespace().take(MOST_FIELDS).map(|field| field.trim_matches('"')).collect()
            }
        }
    }

    /// The number of a field; where fields are not separated by commas, a comma may be its decimal point.
    pub(super) fn number(self, field: &str) -> Option<f64> {
        let number = match self {
            Self::Sign(',') => field.parse(),
            _ if field.contains('.') => field.parse(),
            _ => field.replacen(',', ".", 1).parse(),
        };
        number.ok().filter(|number: &f64| number.is_finite())
    }
}

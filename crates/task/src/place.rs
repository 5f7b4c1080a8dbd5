//! Where in a file something is wrong.

/// A place in a file, lines and columns counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file's name, as it was given.
    pub file: String,
    /// Its line.
    pub line: u64,
    /// The character in that line.
    pub column: Option<u64>,
}

impl Place {
    /// The place that a message begins with, in either way in which messages do.
    pub(crate) fn before(message: &str) -> Option<Self> {
        // what is wrong follows the first colon behind the place, and a file's name may have others
        message.match_indices(": ").find_map(|(end, _)| {
            let (before, after) = (&message[..end], &message[end + 2..]);
            numbered(before).or_else(|| told(before, after.split(": ").next()?))
        })
    }
}

/// `file:line:column` or `file:line`.
fn numbered(text: &str) -> Option<Place> {
    let (rest, last) = text.rsplit_once(':')?;
    let last = last.parse().ok()?;
    let both = rest.rsplit_once(':').and_then(|(file, line)| Some((file, line.parse().ok()?)));
    let (file, line, column) = match both {
        Some((file, line)) => (file, line, Some(last)),
        None => (rest, last, None),
    };
    (!file.is_empty()).then(|| Place { file: file.to_owned(), line, column })
}

/// Of a file, `line 12`, `CIRCLE at line 12` or `line 12, column 4`.
fn told(file: &str, what: &str) -> Option<Place> {
    let (before, number) = what.rsplit_once("line ")?;
    let is_place = before.is_empty() || before.ends_with(" at ");
    let (line, column) = match number.split_once(", column ") {
        Some((line, column)) => (line, Some(column.parse().ok()?)),
        None => (number, None),
    };
    let line = line.parse().ok().filter(|_| is_place && !file.is_empty())?;
    Some(Place { file: file.to_owned(), line, column })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_found_however_it_is_written() {
        for (message, wanted) in [
            ("my.toml:3:17: unknown key safety.banana", Some(("my.toml", 3, Some(17)))),
            ("log.csv:2: \"x\" in column 3 is no number", Some(("log.csv", 2, None))),
            ("a b.json: line 2, column 5: not valid JSON: at line 2", Some(("a b.json", 2, Some(5)))),
            ("C:\\plans\\a.dxf: CIRCLE at line 12: radius is \"x\"", Some(("C:\\plans\\a.dxf", 12, None))),
            ("a.csv: line 3: y_m is \"zz\"", Some(("a.csv", 3, None))),
            ("a.png is broken: unexpected end of file", None),
            ("--width 3: a line 4 is none", None),
            ("stroke 1 leaves the head's reach: the beam would meet (1 m, 2 m)", None),
            ("", None),
        ] {
            let found = Place::before(message);
            let found = found.as_ref().map(|place| (place.file.as_str(), place.line, place.column));
            assert_eq!(found, wanted, "{message}");
        }
    }
}

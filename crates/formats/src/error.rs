use crate::limit::MAX_COORDINATE;

/// Why bytes are no drawing: what, where, the value, the bound, and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormatError {
    /// More of something than is read.
    #[error("the {what} has {} {unit}, at most {limit} are read: simplify or split the drawing", counted(*.found))]
    TooLarge {
        /// Of what.
        what: &'static str,
        /// How many; [`usize::MAX`] for more than can be counted.
        found: usize,
        /// In which unit: bytes, elements.
        unit: &'static str,
        /// How many at most.
        limit: usize,
    },
    /// Bytes that are no UTF-8 text.
    #[error("byte {offset} is not UTF-8 text: save the file as UTF-8")]
    NotText {
        /// Offset of the first byte that is not.
        offset: usize,
    },
    /// A packed file that cannot be unpacked.
    #[error("the file is packed with gzip, and broken or cut off ({message}): save it again")]
    Packing {
        /// What the unpacker says.
        message: String,
    },
    /// The format's own grammar is broken.
    #[error("line {line}, column {column}: not valid {format}: {message}")]
    Syntax {
        /// `SVG`, `JSON`.
        format: &'static str,
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// A value that cannot be meant.
    #[error("{place}: {field} is {value}, expected {expected}")]
    Value {
        /// Line, stroke and point.
        place: String,
        /// Name of the field.
        field: &'static str,
        /// As found.
        value: String,
        /// What is accepted.
        expected: &'static str,
    },
    /// A point beyond what is drawn.
    #[error("{place}: the point ({}, {}) lies beyond ±{MAX_COORDINATE}: check the file's numbers and unit", short(*.x), short(*.y))]
    Far {
        /// Stroke and point.
        place: String,
        /// As found.
        x: f64,
        /// As found.
        y: f64,
    },
    /// A file that is in order and draws nothing.
    #[error("nothing to draw: {hint}")]
    Nothing {
        /// Why that may be.
        hint: &'static str,
    },
    /// A file that is in order and holds only what is not drawn.
    #[error("nothing to draw: {hint} ({found} found)")]
    Undrawn {
        /// Why that may be.
        hint: &'static str,
        /// What it holds, by name and number.
        found: String,
    },
    /// A font that is not used.
    #[error(transparent)]
    Font(#[from] tracelight_letters::LettersError),
    /// Something that is in order and not read, because it can be made to fill the memory.
    #[error("{what} is not read: {instead}")]
    Refused {
        /// What it is.
        what: &'static str,
        /// What to do instead.
        instead: &'static str,
    },
}

/// A number of things in a sentence.
fn counted(found: usize) -> String {
    if found == usize::MAX { "countless".to_owned() } else { found.to_string() }
}

/// A coordinate as people read it: of one with hundreds of digits the first few, and how many there are.
fn short(value: f64) -> String {
    const MOST: usize = 24;
    const SHOWN: usize = 10;
    let digits = value.to_string();
    match digits.len() {
        ..=MOST => digits,
        _ if value.abs() < 1.0 => format!("{value:e}"),
        length => format!("{}… ({} digits)", &digits[..SHOWN], length - usize::from(value < 0.0)),
    }
}

/// Why a font is not used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LettersError {
    /// Bytes that are no font.
    #[error(
        "{name} is no font that is read: expected TrueType, OpenType, or an SVG with <font> and <glyph> ({why})"
    )]
    NoFont {
        /// Name of the file.
        name: String,
        /// What its reader says.
        why: String,
    },
    /// A font of the other kind than the one asked for.
    #[error(
        "{name} has outlines and no single lines: give an SVG font with single-line letters, or draw outlines (--letters outline)"
    )]
    NoLines {
        /// Name of the file.
        name: String,
    },
    /// More of something than is read.
    #[error("{name}: its {what} are more than the {limit} that are read")]
    TooMany {
        /// Name of the file.
        name: String,
        /// Of what.
        what: &'static str,
        /// How many at most.
        limit: usize,
    },
}

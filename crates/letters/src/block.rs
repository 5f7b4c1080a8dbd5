//! Several lines of text.

use std::collections::BTreeSet;

use tracelight_stroke::{Affine, Path, Vec2};

use crate::faces::Faces;

/// From one baseline to the next, in heights of capitals: what drawing programs have.
pub const LINE_SPACING: f64 = 5.0 / 3.0;

/// Where lines of different lengths begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Below each other.
    #[default]
    Left,
    /// Their middles below each other.
    Centre,
    /// Their ends below each other.
    Right,
}

/// Text as paths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// Each with whether it is the edge of a letter. In heights of capitals, y up; the first baseline at y = 0, lines begin, have their
    /// middle or end at x = 0.
    pub paths: Vec<(Path, bool)>,
    /// Length of the longest line, in heights of capitals.
    pub width: f64,
    /// Characters that no face has.
    pub missing: BTreeSet<char>,
    /// Characters that are drawn as outlines, as no single-line face has them.
    pub outlined: BTreeSet<char>,
}

/// Sets lines of text below each other.
#[must_use]
pub fn block(faces: &Faces, text: &str, align: Align) -> Block {
    let scale = 1.0 / faces.capital_height();
    let mut block = Block::default();
    for (i, line) in text.lines().enumerate() {
        let run = faces.run(line);
        let width = run.advance * scale;
        let x = match align {
            Align::Left => 0.0,
            Align::Centre => -0.5 * width,
            Align::Right => -width,
        };
        let start = Affine::translate(Vec2::new(x, -(i as f64) * LINE_SPACING)) * Affine::scale(scale);
        for letter in &run.letters {
            let place = start * Affine::translate(Vec2::new(letter.at, 0.0));
            block
                .paths
                .extend(letter.paths.iter().map(|path| (path.transformed(place), letter.has_outlines)));
        }
        block.width = block.width.max(width);
        block.missing.extend(run.missing);
        block.outlined.extend(run.outlined);
    }
    block
}

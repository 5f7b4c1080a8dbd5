//! Reads the cells of a marker and looks them up.

use tracelight_image::Plane;
use tracelight_image::solve::linear;
use tracelight_stroke::Vec2;

use super::codes::CODES;
use super::square::{SIDE, Square};

/// Cells that may be wrong, if they are unclear: the family tells up to five, and what is no marker has clear ones.
const MOST_WRONG: u32 = 2;
/// Share of the way from halfway to white, or to black, within which a cell is unclear.
const UNCLEAR: f64 = 0.5;
/// Cells of the border and of the white about it that may be wrong.
const MOST_WRONG_ABOUT: usize = 3;

/// What was read.
pub(super) struct Read {
    pub(super) id: u16,
    /// Which of the corners is the upper left as printed.
    pub(super) turns: usize,
    pub(super) wrong: u8,
}

/// Cells of a side with the white about them.
const ALL: usize = SIDE + 2;

/// Mean levels of a square's cells and of those about it, row by row.
#[derive(Clone)]
pub(super) struct Levels([[f64; ALL]; ALL]);

impl Levels {
    /// Of a square in an image; `None` where it is not all in front of the camera.
    pub(super) fn of(plane: &Plane<u8>, square: &Square) -> Option<Self> {
        let mut levels = [[0.0; ALL]; ALL];
        for (row, levels) in levels.iter_mut().enumerate() {
            for (column, v) in levels.iter_mut().enumerate() {
                let is_inside = |v: usize| (1..=SIDE).contains(&v);
                let (x, y) = (column as f64 - 0.5, row as f64 - 0.5);
                // there may be less white about it than a cell
                *v = match is_inside(column) && is_inside(row) {
                    true => mean(plane, square, x, y)?,
                    false => plane.at(square.at(x, y)?),
                };
            }
        }
        Some(Self(levels))
    }

    /// With so much more of what each differs by from the four beside it: what blur mixed into it from them is taken out.
    pub(super) fn sharpened(&self, share: f64) -> Self {
        let Self(levels) = self;
        let mut sharp = *levels;
        for y in 1..ALL - 1 {
            for x in 1..ALL - 1 {
                let beside = levels[y - 1][x] + levels[y + 1][x] + levels[y][x - 1] + levels[y][x + 1];
                sharp[y][x] += share * (4.0 * levels[y][x] - beside);
            }
        }
        Self(sharp)
    }

    /// Which marker they are.
    pub(super) fn read(&self) -> Option<Read> {
        let level = |x: usize, y: usize| (x as f64 - 0.5, y as f64 - 0.5, self.0[y][x]);
        // white about the border, black on it: both vary with the light
        let (mut white, mut black) = (Vec::with_capacity(4 * SIDE), Vec::with_capacity(4 * SIDE));
        for k in 1..=SIDE {
            white.extend([(k, 0), (k, SIDE + 1), (0, k), (SIDE + 1, k)].map(|(x, y)| level(x, y)));
            black.extend([(k, 1), (k, SIDE), (1, k), (SIDE, k)].map(|(x, y)| level(x, y)));
        }
        let (bright, dim) = (Light::through(&white)?, Light::through(&black)?);
        let threshold = |x: f64, y: f64| f64::midpoint(bright.at(x, y), dim.at(x, y));
        let wrong_white = white.iter().filter(|&&(x, y, v)| v <= threshold(x, y)).count();
        let wrong_black = black.iter().filter(|&&(x, y, v)| v >= threshold(x, y)).count();
        if wrong_white > MOST_WRONG_ABOUT
            || wrong_black > MOST_WRONG_ABOUT
            || bright.at(4.0, 4.0) - dim.at(4.0, 4.0) < 8.0
        {
            return None;
        }
        let (mut code, mut unclear) = (0, 0);
        for row in 2..SIDE {
            for column in 2..SIDE {
                let (x, y, v) = level(column, row);
                let above = v - threshold(x, y);
                code = code << 1 | u64::from(above > 0.0);
                unclear =
                    unclear << 1 | u64::from(above.abs() < UNCLEAR * (bright.at(x, y) - threshold(x, y)));
            }
        }
        look_up(code, unclear)
    }
}

/// The id of a code as it is seen, and how it is turned; what is wrong must be among what is unclear.
fn look_up(code: u64, unclear: u64) -> Option<Read> {
    let (mut code, mut unclear) = (code, unclear);
    for turns in 0..4 {
        let wrong = |&known: &u64| (known ^ code).count_ones();
        if let Some(id) = CODES.iter().position(|known| wrong(known) <= MOST_WRONG) {
            let put_right = (CODES[id] ^ code) & !unclear == 0;
            return put_right.then(|| Read { id: id as u16, turns, wrong: wrong(&CODES[id]) as u8 });
        }
        (code, unclear) = (quarter_turn(code), quarter_turn(unclear));
    }
    None
}

/// The code of the square turned anticlockwise by a quarter: what was the upper right corner is now the upper left.
fn quarter_turn(code: u64) -> u64 {
    let bit = |row: usize, column: usize| code >> (35 - (6 * row + column)) & 1;
    let cells = (0..6).flat_map(|row| (0..6).map(move |column| (row, column)));
    cells.fold(0, |turned, (row, column)| turned << 1 | bit(column, 5 - row))
}

/// Mean level of the inner half of a cell, by its middle in cells.
fn mean(plane: &Plane<u8>, square: &Square, x: f64, y: f64) -> Option<f64> {
    let (middle, across, down) = square.with_slopes(x, y)?;
    let (across, down) = (0.18 * across, 0.18 * down);
    let mut levels = [0.0; 4];
    for (two, k) in levels.chunks_exact_mut(2).zip([-1.0, 1.0]) {
        plane.along(middle - across + k * down, 2.0 * across, two);
    }
    Some(f64::from(levels.iter().sum::<f32>()) / 4.0)
}

/// Levels that rise evenly: a plane over the cells.
struct Light {
    middle: f64,
    slope: Vec2,
}

impl Light {
    /// By least squares, about the middle of the square.
    fn through(levels: &[(f64, f64, f64)]) -> Option<Self> {
        let mut rows = [[0.0; 4]; 3];
        for &(x, y, v) in levels {
            let terms = [1.0, x - 4.0, y - 4.0, v];
            for (row, factor) in rows.iter_mut().zip(terms) {
                row.iter_mut().zip(terms).for_each(|(sum, term)| *sum += factor * term);
            }
        }
        linear(rows).map(|[middle, x, y]| Self { middle, slope: Vec2::new(x, y) })
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        self.middle + self.slope.dot(Vec2::new(x - 4.0, y - 4.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_differ_in_eleven_cells_however_they_are_turned() {
        let turned = |code: u64| {
            let mut all = [code; 4];
            (1..4).for_each(|k| all[k] = quarter_turn(all[k - 1]));
            all
        };
        assert!(CODES.iter().all(|code| quarter_turn(turned(*code)[3]) == *code));
        for (i, code) in CODES.iter().enumerate() {
            let own = turned(*code);
            assert!(own[1..].iter().all(|other| (code ^ other).count_ones() >= 11), "{i} turned");
            for (j, other) in CODES[..i].iter().enumerate() {
                assert!(own.iter().all(|code| (code ^ other).count_ones() >= 11), "{i} and {j}");
            }
        }
    }

    #[test]
    fn codes_are_steps_of_the_familys_prime_apart() {
        // the first sixty are few steps apart: far too few for a slip of a digit to pass
        let mut code = CODES[0];
        for &next in &CODES[1..60] {
            let steps = (1..=20).find(|_| {
                code = (code + 982_451_653) % (1 << 36);
                code == next
            });
            assert!(steps.is_some(), "{next:x}");
        }
    }

    #[test]
    fn two_wrong_cells_are_put_right_if_they_are_unclear_and_three_are_not() {
        let code = CODES[100] ^ 0b1001;
        let read = look_up(code, 0b1001).unwrap();
        assert_eq!((read.id, read.turns, read.wrong), (100, 0, 2));
        assert!(look_up(code, 0b0001).is_none());
        assert!(look_up(CODES[100] ^ 0b1011, 0b1111).is_none());
        let turned = look_up(
            quarter_turn(quarter_turn(quarter_turn(code))),
            quarter_turn(quarter_turn(quarter_turn(0b1001))),
        );
        assert_eq!(turned.map(|read| (read.id, read.turns)), Some((100, 1)));
    }
}

//! Arrow heads along a line.

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, Polygon, SVGBackend};
use plotters::style::Color;

use crate::colour::Colour;
use crate::lettering::FINE;
use crate::theme::Theme;

/// Which way a line is gone along: arrow heads on it, evenly over what of it is shown.
#[derive(Clone, Debug)]
pub struct Arrows {
    /// Of its curve.
    pub colour: Colour,
    /// The line, in its direction. NaN lifts the pen.
    pub points: Vec<(f64, f64)>,
    /// How many; fewer where the line is short.
    pub count: usize,
    /// See-through, as a faint curve.
    pub is_faint: bool,
}

/// Pixels: how long a head is, how far its corners are from the line, and what of the line each needs.
const LONG: f64 = 10.0;
const ASIDE: f64 = 4.5;
const APART: f64 = 30.0;

/// How far one place is from another.
pub(crate) fn distance(from: (f64, f64), to: (f64, f64)) -> f64 {
    let (x, y) = (to.0 - from.0, to.1 - from.1);
    (x * x + y * y).sqrt()
}

/// A head: its middle, and its direction as a vector of length 1, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Head {
    pub(crate) middle: (f64, f64),
    pub(crate) way: (f64, f64),
}

/// Heads on some lines, evenly over their whole length.
pub(crate) fn heads(runs: &[Vec<(f64, f64)>], count: usize) -> Vec<Head> {
    let pieces = || runs.iter().flat_map(|run| run.windows(2)).map(|pair| (pair[0], pair[1]));
    let length = |(from, to)| distance(from, to);
    let whole: f64 = pieces().map(length).sum();
    let count = count.min((whole / APART) as usize);
    let mut placed = Vec::with_capacity(count);
    let mut gone = 0.0;
    for piece in pieces() {
        let long = length(piece);
        while placed.len() < count {
            let next = whole * (placed.len() as f64 + 0.5) / count as f64;
            if next > gone + long || long == 0.0 {
                break;
            }
            let (from, to) = piece;
            let way = ((to.0 - from.0) / long, (to.1 - from.1) / long);
            let along = next - gone;
            placed.push(Head { middle: (from.0 + along * way.0, from.1 + along * way.1), way });
        }
        gone += long;
    }
    placed
}

/// Draws heads.
pub(crate) fn draw(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    heads: &[Head],
    arrows: &Arrows,
    theme: Theme,
) -> Result<(), Box<dyn std::error::Error>> {
    let fine = |at: (f64, f64)| ((f64::from(FINE) * at.0) as i32, (f64::from(FINE) * at.1) as i32);
    let style = arrows.colour.rgb(theme).plotted().mix(if arrows.is_faint { 0.5 } else { 1.0 }).filled();
    for &Head { middle, way } in heads {
        let at = |along: f64, aside: f64| {
            (middle.0 + along * way.0 - aside * way.1, middle.1 + along * way.1 + aside * way.0)
        };
        let corners = [at(0.5 * LONG, 0.0), at(-0.5 * LONG, ASIDE), at(-0.5 * LONG, -ASIDE)];
        area.draw(&Polygon::new(corners.map(fine).to_vec(), style))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_stand_evenly_along_a_line_and_point_along_it() {
        let corner = vec![(0.0, 0.0), (100.0, 0.0), (100.0, 100.0)];
        let placed = heads(&[corner], 4);
        let middles: Vec<(f64, f64)> = placed.iter().map(|head| head.middle).collect();
        assert_eq!(middles, [(25.0, 0.0), (75.0, 0.0), (100.0, 25.0), (100.0, 75.0)]);
        assert_eq!((placed[0].way, placed[3].way), ((1.0, 0.0), (0.0, 1.0)));
        // what is too short for a head has none
        assert!(heads(&[vec![(0.0, 0.0), (5.0, 0.0)]], 3).is_empty());
        assert!(heads(&[], 3).is_empty());
    }
}

//! Gradients as they are seen: a colour and an opacity at each place.

use tracelight_stroke::{Affine, Point, Vec2};

use super::colour::Rgb;

/// What a gradient paints, its stops in rising order of their offsets.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gradient {
    /// From the sheet to the gradient's own numbers.
    pub(crate) own: Affine,
    pub(crate) along: Along,
    pub(crate) spread: Spread,
    /// Offset, colour, opacity.
    pub(crate) stops: Vec<(f64, Rgb, f64)>,
}

/// Along what colours change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Along {
    /// From a point to another.
    Line([Point; 2]),
    /// From a focus outwards to a circle.
    Circle {
        /// Where the first colour is.
        focus: Point,
        /// Centre of the circle.
        centre: Point,
        /// Radius of the circle.
        radius: f64,
    },
}

/// What is beyond the ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Spread {
    /// The last colour.
    Pad,
    /// The gradient again, there and back.
    Reflect,
    /// The gradient again.
    Repeat,
}

impl Gradient {
    /// Colour and opacity at a point of the sheet.
    pub(crate) fn at(&self, p: Point) -> (Rgb, f64) {
        let t = match (self.along.offset(self.own * p), self.spread) {
            (t, Spread::Pad) => t.clamp(0.0, 1.0),
            (t, Spread::Repeat) => t.rem_euclid(1.0),
            (t, Spread::Reflect) => 1.0 - (t.rem_euclid(2.0) - 1.0).abs(),
        };
        let after = self.stops.partition_point(|&(offset, ..)| offset <= t);
        match (after.checked_sub(1).and_then(|i| self.stops.get(i)), self.stops.get(after)) {
            (Some(&(low, a, from)), Some(&(high, b, to))) => {
                let share = (t - low) / (high - low).max(f64::MIN_POSITIVE);
                (a.under(b, share), from + (to - from) * share)
            }
            (Some(&(_, colour, alpha)), None) | (None, Some(&(_, colour, alpha))) => (colour, alpha),
            (None, None) => (Rgb::BLACK, 0.0),
        }
    }
}

impl Along {
    /// How far between its ends a point is, 0 to 1, or beyond.
    fn offset(&self, p: Point) -> f64 {
        let t = match *self {
            Self::Line([from, to]) => {
                let way = to - from;
                (p - from).dot(way) / way.hypot2()
            }
            Self::Circle { focus, centre, radius } => outwards(p - focus, centre - focus, radius),
        };
        if t.is_finite() { t } else { 1.0 }
    }
}

/// Which of the circles from a point to the outer one passes a place: centres and radii grow alike.
fn outwards(place: Vec2, centre: Vec2, radius: f64) -> f64 {
    let (square, along) = (centre.hypot2() - radius * radius, place.dot(centre));
    // the focus lies within the circle: `square` is negative, and this is the positive root
    (along - (along * along - square * place.hypot2()).max(0.0).sqrt()) / square
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(along: Along, spread: Spread) -> Gradient {
        let stops = vec![(0.0, Rgb::BLACK, 1.0), (1.0, Rgb::WHITE, 0.0)];
        Gradient { own: Affine::IDENTITY, along, spread, stops }
    }

    #[track_caller]
    fn check(gradient: &Gradient, x: f64, wanted: f64) {
        let (colour, alpha) = gradient.at(Point::new(x, 0.0));
        assert!((colour.luminance() - wanted).abs() < 1e-9 && (alpha - 1.0 + wanted).abs() < 1e-9, "{x}");
    }

    #[test]
    fn colours_and_opacity_change_along_a_line_and_go_on_as_is_asked() {
        let line = Along::Line([Point::ORIGIN, Point::new(10.0, 0.0)]);
        let ends = [(-5.0, 0.0), (2.5, 0.25), (15.0, 1.0)];
        ends.into_iter().for_each(|(x, t)| check(&grey(line, Spread::Pad), x, t));
        check(&grey(line, Spread::Repeat), 12.5, 0.25);
        check(&grey(line, Spread::Reflect), 12.5, 0.75);
    }

    #[test]
    fn colours_change_outwards_from_a_focus() {
        let circle =
            |x: f64| Along::Circle { focus: Point::new(x, 0.0), centre: Point::ORIGIN, radius: 10.0 };
        let round = [(0.0, 0.0), (5.0, 0.5), (-5.0, 0.5), (20.0, 1.0)];
        round.into_iter().for_each(|(x, t)| check(&grey(circle(0.0), Spread::Pad), x, t));
        let aside = [(5.0, 0.0), (10.0, 1.0), (-10.0, 1.0), (7.5, 0.5)];
        aside.into_iter().for_each(|(x, t)| check(&grey(circle(5.0), Spread::Pad), x, t));
    }
}

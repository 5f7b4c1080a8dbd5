//! Paper that is ruled, squared or dotted.

use tracelight_maths::planar;
use tracelight_stroke::{Point, Stroke, Vec2};

use crate::shapes::polyline;
use crate::{Ink, Kind, Nib, Random, Size, Touch};

/// A printed pattern. Rules run along u; v counts across them.
pub(crate) struct Paper {
    pattern: Kind,
    centre: Point,
    /// Direction of the rules.
    along: Vec2,
    /// The sheet's curl: v grows by this times u².
    bend: f64,
    pitch: f64,
    phase: (f64, f64),
    width: f64,
    /// Share of the ink's darkness.
    pub(crate) dark: f64,
    /// Where a line stands across the rules, u.
    margin: Option<f64>,
    reach: f64,
}

/// Rules nearer than this, px and widths, leave no paper to draw on.
const LEAST_PITCH_PX: f64 = 8.0;
const LEAST_PITCH_WIDTHS: f64 = 5.0;
/// A drawn line runs along a rule within this angle, rad, and so many pens; for more than so many pens it is not drawn.
const ALONG_RAD: f64 = 0.14;
const ALONG_PENS: f64 = 1.0;
const LONGEST_ALONG_PENS: f64 = 5.0;
/// Papers tried until no line runs along a rule.
const TRIED: usize = 40;

impl Paper {
    /// A paper of a kind's pattern on which these strokes, drawn with a pen, cross the rules and do not follow them.
    pub(crate) fn under(
        random: &mut Random,
        pattern: Kind,
        size: Size,
        strokes: &[Stroke],
        pen: f64,
    ) -> Option<Self> {
        let papers = (0..TRIED).map(|_| Self::any(random, pattern, size, pen));
        papers.into_iter().find(|paper| pattern == Kind::Dotted || !paper.is_followed(strokes, pen))
    }

    fn any(random: &mut Random, pattern: Kind, size: Size, pen: f64) -> Self {
        let rows = size.height.min(size.width) as f64;
        let width = (random.log_between(1.0, 3.0) * (rows / 720.0).sqrt().max(1.0)).min(pen.max(1.0));
        let pitch = rows * random.log_between(1.0 / 40.0, 1.0 / 10.0);
        let upright = pattern == Kind::Ruled && random.chance(0.2);
        let turn = random.between(-3.0, 3.0) + if upright { 90.0 } else { 0.0 };
        let bent = random.chance(0.4);
        let reach = (size.width + size.height) as f64;
        Self {
            pattern,
            centre: Point::new(0.5 * size.width as f64, 0.5 * size.height as f64),
            along: planar::direction(turn.to_radians()),
            // the border's middle is off by up to a fiftieth of the width
            bend: if bent { random.between(-1.0, 1.0) * 0.08 / size.width as f64 } else { 0.0 },
            pitch: pitch.max(LEAST_PITCH_PX).max(LEAST_PITCH_WIDTHS * width),
            phase: (random.between(0.0, 1.0), random.between(0.0, 1.0)),
            width,
            dark: random.between(0.2, 1.1),
            margin: random.chance(0.5).then(|| random.between(-0.42, -0.3) * size.width as f64),
            reach,
        }
    }

    fn point(&self, u: f64, v: f64) -> Point {
        let v = v + self.bend * u * u;
        self.centre + self.along * u + Vec2::new(-self.along.y, self.along.x) * v
    }

    /// The pattern's ink, from border to border and beyond.
    pub(crate) fn ink(&self) -> Vec<Ink> {
        let count = (0.5 * self.reach / self.pitch) as isize + 1;
        let places = |phase: f64| (-count..=count).map(move |i| (i as f64 + phase) * self.pitch);
        let steps = |from: f64, to: f64| (0..=24).map(move |i| from + (to - from) * f64::from(i) / 24.0);
        let (low, high) = (-0.5 * self.reach, 0.5 * self.reach);
        let line = |points: Vec<Point>| Ink::Line {
            path: polyline(&points, false),
            pen: self.width,
            nib: Nib::Round,
        };
        let rule = |v: f64| line(steps(low, high).map(|u| self.point(u, v)).collect());
        let upright = |u: f64| line(steps(low, high).map(|v| self.point(u, v)).collect());
        match self.pattern {
            Kind::Dotted => {
                let spot = |u: f64, v: f64| Touch {
                    at: self.point(u, v),
                    reach: Vec2::ZERO,
                    radius: 0.6 * self.width,
                    dark: 1.0,
                };
                let spots = places(self.phase.0).flat_map(|u| places(self.phase.1).map(move |v| (u, v)));
                vec![Ink::Touches(spots.map(|(u, v)| spot(u, v)).collect())]
            }
            Kind::Squared => {
                let across = places(self.phase.0).map(upright);
                places(self.phase.1).map(rule).chain(across).collect()
            }
            _ => places(self.phase.1).map(rule).chain(self.margin.map(upright)).collect(),
        }
    }

    /// Whether a stroke runs along a rule for long.
    fn is_followed(&self, strokes: &[Stroke], pen: f64) -> bool {
        strokes.iter().any(|stroke| {
            let mut run = 0.0;
            stroke.path.flatten(0.05).windows(2).any(|pair| {
                let steps = (pair[0].distance(pair[1]) / pen).ceil().max(1.0);
                (0..steps as usize).any(|i| {
                    let at = pair[0].lerp(pair[1], (i as f64 + 0.5) / steps);
                    let beside = self.is_beside(at, pair[1] - pair[0], pen);
                    run = if beside { run + pair[0].distance(pair[1]) / steps } else { 0.0 };
                    run > LONGEST_ALONG_PENS * pen
                })
            })
        })
    }

    fn is_beside(&self, at: Point, way: Vec2, pen: f64) -> bool {
        let from = at - self.centre;
        let u = from.dot(self.along);
        let v = -from.cross(self.along) - self.bend * u * u;
        let near = |place: f64| (place - place.round()).abs() * self.pitch < ALONG_PENS * pen + self.width;
        let rule = self.along + Vec2::new(-self.along.y, self.along.x) * (2.0 * self.bend * u);
        let turned = |to: Vec2| (way.cross(to) / (way.hypot() * to.hypot())).abs() < ALONG_RAD.sin();
        let across = Vec2::new(-self.along.y, self.along.x);
        let by_margin = self.margin.is_some_and(|m| (m - u).abs() < ALONG_PENS * pen + self.width);
        let by_upright = match self.pattern {
            Kind::Squared => near(u / self.pitch - self.phase.0),
            _ => by_margin,
        };
        (turned(rule) && near(v / self.pitch - self.phase.1)) || (turned(across) && by_upright)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Page;

    #[test]
    fn nearly_every_page_finds_a_paper_whose_rules_it_does_not_follow() {
        let size = Size { width: 640, height: 480 };
        for pattern in [Kind::Ruled, Kind::Squared] {
            let found = (0..60).filter(|&seed| {
                let page = Page::draw(&mut Random::new(seed), pattern, size, 1.0);
                Paper::under(&mut Random::new(seed), pattern, size, &page.strokes(), page.pen).is_some()
            });
            let count = found.count();
            assert!(count >= 56, "{pattern:?}: {count} of 60");
        }
    }

    #[test]
    fn a_line_on_a_rule_follows_it_and_one_between_rules_does_not() {
        let size = Size { width: 640, height: 480 };
        let paper =
            Paper { bend: 0.0, margin: None, ..Paper::any(&mut Random::new(3), Kind::Squared, size, 2.0) };
        let along = |v: f64| {
            let points = [paper.point(-90.0, v), paper.point(90.0, v)];
            paper.is_followed(&[Stroke::new(polyline(&points, false))], 2.0)
        };
        assert!(along(paper.phase.1 * paper.pitch));
        assert!(!along((paper.phase.1 + 0.5) * paper.pitch));
    }
}

use tracelight_maths::planar;
use tracelight_stroke::{Path, Point, Vec2};

use super::plain;
use crate::rules::broken;
use crate::shapes::spline;
use crate::{Figure, Hand, Random};

/// Lines tried on a drawing.
const TRIED: usize = 16;
/// A drawing of one piece has up to so many lines.
const MOST: usize = 8;
/// Angles at which a line leaves another one, degrees.
const ASIDE_DEG: (f64, f64) = (45.0, 135.0);

/// A drawing of one piece, as most are that people make: a first line, and others that begin on or cross what is there.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [plain::closed, plain::closed, plain::free, plain::bent, plain::cornered];
    let mut figure = random.pick(&variants)(random, hand);
    let wanted = random.whole(2, MOST);
    for _ in 0..TRIED {
        if figure.strokes.len() >= wanted || broken(&figure, hand.pen, hand.paper).is_some() {
            break;
        }
        let on = figure.strokes[random.whole(0, figure.strokes.len() - 1)].path.clone();
        let more = figure.clone().and(Figure::lines(hand, [leaving(random, hand, &on)]));
        if broken(&more, hand.pen, hand.paper).is_none() {
            figure = more;
        }
    }
    figure
}

/// A bent line that begins somewhere on another one, or goes on across it.
fn leaving(random: &mut Random, hand: &Hand, on: &Path) -> Path {
    let (foot, tangent) = somewhere(random, on);
    let turn = random.between(ASIDE_DEG.0, ASIDE_DEG.1).to_radians() * random.sign();
    let way = planar::direction(planar::heading(tangent) + turn);
    let aside = Vec2::new(-way.y, way.x) * random.between(-0.4, 0.4);
    let length = hand.size * random.between(0.4, 1.2);
    let at = |share: f64| foot + (way * share + aside * (share * share)) * length;
    let from = if random.chance(0.25) { -0.5 } else { 0.0 };
    spline(&[0.0, 0.35, 0.7, 1.0].map(|share| at(from + share * (1.0 - from))), false)
}

/// A place on a path, not near its ends, and the direction there.
fn somewhere(random: &mut Random, path: &Path) -> (Point, Vec2) {
    let points = path.flatten(0.005);
    let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = length * random.between(0.1, 0.9);
    for pair in points.windows(2) {
        let piece = pair[0].distance(pair[1]);
        if left <= piece {
            return (pair[0].lerp(pair[1], left / piece.max(1e-12)), pair[1] - pair[0]);
        }
        left -= piece;
    }
    (path.end(), Vec2::new(1.0, 0.0))
}

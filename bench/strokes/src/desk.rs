//! A sheet on a table: what is seen beside it, over it and below it.

use tracelight_maths::planar;
use tracelight_stroke::{Point, Rect, Vec2};

use crate::grain::Grain;
use crate::ink::draw;
use crate::plane::Plane;
use crate::shapes::polyline;
use crate::warp::Warp;
use crate::{Ink, Random, Size};

/// The table differs from the sheet by this many levels at least.
const LEAST_STEP: f64 = 25.0;
/// This share is not photographed on a table, but scanned: square, with a dark rim.
const SCANNED: f64 = 0.2;
/// Places tried for a finger.
const TRIED: usize = 16;

/// Everything around a sheet.
pub(crate) struct Desk {
    /// The sheet's corners on the page.
    sheet: [Point; 4],
    /// Another one below it, and its level.
    below: Option<([Point; 4], f64)>,
    table: Table,
    /// How far the sheet's shadow falls, px, and how dark it is there.
    shade: (Vec2, f64, f64),
    finger: Option<Finger>,
}

/// A table's level at each place.
struct Table {
    level: f64,
    depth: f64,
    /// Direction of its grain.
    along: Vec2,
    grain: Grain,
    weave: Option<f64>,
    /// Beyond this edge (a place, the way out) is the floor, darker or brighter by so much.
    edge: Option<(Point, Vec2, f64)>,
}

struct Finger {
    from: Point,
    tip: Point,
    radius: f64,
    level: f64,
}

/// How a sheet lies before the camera.
pub(crate) fn lay(random: &mut Random, size: Size) -> Warp {
    let (w, h) = (size.width as f64, size.height as f64);
    let scanned = random.chance(SCANNED);
    // furthest aside and most turned, degrees, and least share of the picture's sides
    let (aside, turned, least) = if scanned { (0.1, 1.5, 0.92) } else { (20.0, 12.0, 0.68) };
    let tilt = random.between(0.0, aside).to_radians() * random.sign();
    let turn = random.between(-turned, turned).to_radians();
    let share = random.between(least, 0.99);
    let corner = Point::new(random.between(0.0, (1.0 - share) * w), random.between(0.0, (1.0 - share) * h));
    let within = Rect::from_origin_size(corner, (share * w, share * h));
    Warp::new(size, random.angle(), tilt).fitted(size, turn, within)
}

impl Desk {
    /// Around a sheet of this level whose ink is at these points of the picture.
    pub(crate) fn around(
        random: &mut Random,
        size: Size,
        paper: f64,
        (warp, ink): (&Warp, &[Point]),
    ) -> Self {
        let rows = size.height as f64;
        if warp.is_square_on() {
            return Self::of_a_scanner(random, size, paper);
        }
        Self {
            sheet: sheet(random, size),
            below: random
                .chance(0.3)
                .then(|| (other_sheet(random, size), paper * random.between(0.86, 1.03))),
            table: Table::any(random, size, paper),
            shade: (
                planar::direction(random.angle()) * (0.006 * rows * random.between(0.2, 1.0)),
                rows * random.log_between(0.004, 0.03),
                random.between(0.1, 0.5),
            ),
            finger: random.chance(0.4).then(|| Finger::beside(random, size, warp, ink)).flatten(),
        }
    }

    /// A scanner's lid: dark, even, no shadow.
    fn of_a_scanner(random: &mut Random, size: Size, paper: f64) -> Self {
        let level = random.between(0.0, 0.35 * paper);
        let table = Table { level, depth: 0.0, weave: None, edge: None, ..Table::any(random, size, paper) };
        Self { sheet: sheet(random, size), below: None, table, shade: (Vec2::ZERO, 1.0, 0.0), finger: None }
    }

    /// Covers what is beside the sheet, and what a finger hides.
    pub(crate) fn cover(&self, seen: &mut Plane, warp: &Warp) {
        let drawn = |corners: &[Point; 4]| {
            let mut plane = Plane::filled(seen.width, seen.height, 0.0);
            draw(&mut plane, &Ink::Fill(vec![polyline(corners, true)]), Some(warp));
            plane
        };
        let sheet = drawn(&self.sheet);
        let below = self.below.as_ref().map(|(corners, level)| (drawn(corners), *level));
        let corners = self.sheet.map(|c| warp.point(c) + self.shade.0);
        for i in 0..seen.values.len() {
            let at = Point::new((i % seen.width) as f64 + 0.5, (i / seen.width) as f64 + 0.5);
            let on_sheet = f64::from(sheet.values[i]);
            if on_sheet < 1.0 {
                let mut under = self.table.level(at);
                if let Some((plane, level)) = &below {
                    under += (level - under) * f64::from(plane.values[i]);
                }
                let near = (1.0 - outside(&corners, at) / self.shade.1).clamp(0.0, 1.0);
                under *= 1.0 - self.shade.2 * near * near;
                seen.values[i] = (under + (f64::from(seen.values[i]) - under) * on_sheet) as f32;
            }
            if let Some(finger) = &self.finger {
                finger.cover(at, &mut seen.values[i]);
            }
        }
    }
}

/// The page and a little more; now and then far more on one side, so that it runs out of the picture.
fn sheet(random: &mut Random, size: Size) -> [Point; 4] {
    let (w, h) = (size.width as f64, size.height as f64);
    let rim = random.between(0.0, 0.02) * h;
    let mut sides = [-rim, -rim, w + rim, h + rim];
    if random.chance(0.3) {
        let side = random.whole(0, 3);
        sides[side] += if side < 2 { -0.6 * w } else { 0.6 * w };
    }
    let [left, top, right, bottom] = sides;
    [(left, top), (right, top), (right, bottom), (left, bottom)].map(Point::from)
}

fn other_sheet(random: &mut Random, size: Size) -> [Point; 4] {
    let (w, h) = (size.width as f64, size.height as f64);
    let turn = planar::direction(random.between(4.0, 20.0).to_radians() * random.sign());
    let middle = Point::new(0.5 * w, 0.5 * h)
        + Vec2::new(random.between(-0.2, 0.2) * w, random.between(-0.2, 0.2) * h);
    [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y): (f64, f64)| {
        let from = Vec2::new(x * w, y * h);
        middle + Vec2::new(turn.x * from.x - turn.y * from.y, turn.y * from.x + turn.x * from.y)
    })
}

/// How far a point lies outside a convex quadrilateral; none within it.
fn outside(corners: &[Point; 4], at: Point) -> f64 {
    let centre = corners.iter().fold(Vec2::ZERO, |sum, c| sum + c.to_vec2() / 4.0).to_point();
    let mut inside = true;
    let mut least = f64::INFINITY;
    for i in 0..4 {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let way = b - a;
        inside &= way.cross(at - a) * way.cross(centre - a) > 0.0;
        let share = ((at - a).dot(way) / way.hypot2()).clamp(0.0, 1.0);
        least = least.min(at.distance(a + way * share));
    }
    if inside { 0.0 } else { least }
}

impl Table {
    fn any(random: &mut Random, size: Size, paper: f64) -> Self {
        let rows = size.height as f64;
        let darker = random.chance(0.75) || paper > 255.0 - 1.2 * LEAST_STEP;
        let level = match darker {
            true => random.between(25.0, paper - 2.0 * LEAST_STEP),
            false => random.between(paper + LEAST_STEP, 255.0),
        };
        let wood = random.chance(0.5);
        let fine = (rows / 60.0).max(2.0) * random.between(0.4, 1.2);
        let cell = if wood { (14.0 * fine, fine) } else { (fine, fine) };
        let edge = random.chance(0.25).then(|| {
            let out = planar::direction(random.angle());
            let middle = Point::new(0.5 * size.width as f64, 0.5 * rows);
            (middle + out * (0.45 * rows), out, level * random.between(-0.6, -0.25))
        });
        Self {
            level,
            depth: level * random.between(0.03, if wood { 0.35 } else { 0.2 }),
            along: planar::direction(random.angle()),
            grain: Grain::new(random.bits(), cell),
            weave: (!wood && random.chance(0.5)).then(|| (rows / 90.0).max(3.0)),
            edge,
        }
    }

    fn level(&self, at: Point) -> f64 {
        let (u, v) = (at.to_vec2().dot(self.along), at.to_vec2().cross(self.along));
        let mut value = self.grain.at(u, v) - 0.5;
        if let Some(pitch) = self.weave {
            value = 0.4 * value + 0.3 * (u / pitch * 3.0).sin() * (v / pitch * 3.0).sin();
        }
        let floor = self.edge.filter(|(on, out, _)| (at - *on).dot(*out) > 0.0).map_or(0.0, |e| e.2);
        self.level + floor + self.depth * value
    }
}

impl Finger {
    /// From the border onto the sheet, clear of the ink.
    fn beside(random: &mut Random, size: Size, warp: &Warp, ink: &[Point]) -> Option<Self> {
        let (w, h) = (size.width as f64, size.height as f64);
        let clear = 0.02 * h;
        (0..TRIED).find_map(|_| {
            let corner = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
            let side = random.whole(0, 3);
            let (a, b): (Point, Point) = (corner[side].into(), corner[(side + 1) % 4].into());
            let from = a.lerp(b, random.between(0.1, 0.9));
            let inward = Point::new(0.5 * w, 0.5 * h) - from;
            let turn = planar::heading(inward) + random.between(-0.4, 0.4);
            let tip = from + planar::direction(turn) * (h * random.between(0.12, 0.28));
            let finger = Self {
                from,
                tip,
                radius: h * random.between(0.03, 0.055),
                level: random.between(90.0, 185.0),
            };
            let near = warp.point(Point::new(0.5 * w, 0.5 * h)).distance(tip) < 0.6 * w;
            (near && ink.iter().all(|&p| finger.off(p) > clear)).then_some(finger)
        })
    }

    /// How far a point lies beside it; negative on it.
    fn off(&self, at: Point) -> f64 {
        let way = self.tip - self.from;
        let share = ((at - self.from).dot(way) / way.hypot2()).clamp(-1.0, 1.0);
        at.distance(self.from + way * share) - self.radius
    }

    fn cover(&self, at: Point, value: &mut f32) {
        let off = self.off(at);
        if off > self.radius {
            return;
        }
        // its shadow on the paper, then the skin, round and so darker towards its sides
        let shaded = f64::from(*value) * (1.0 - 0.35 * (1.0 - off.max(0.0) / self.radius).powi(2));
        let depth = (1.0 + off / self.radius).clamp(0.0, 1.0);
        let nail = at.distance(self.tip) < 0.55 * self.radius;
        let skin = self.level * (1.05 - 0.35 * depth.powi(3)) + if nail { 22.0 } else { 0.0 };
        *value = (shaded + (skin - shaded) * (0.5 - off).clamp(0.0, 1.0)) as f32;
    }
}

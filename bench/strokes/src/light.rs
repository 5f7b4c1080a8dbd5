use tracelight_maths::planar;
use tracelight_stroke::Vec2;

use crate::Random;

/// The share of the light that arrives at a place.
#[derive(Clone, Copy)]
pub(crate) enum Light {
    Even,
    /// From a lamp near a corner: (x, y) as shares of the picture.
    Lamp(f64, f64),
    /// Linear, from 1 to 0.35 along a direction.
    Slope(f64),
    /// Behind an edge through a point (shares) with a normal (rad), this share arrives; soft over so many px.
    Shadow {
        through: (f64, f64),
        normal: f64,
        left: f64,
        soft: f64,
    },
    /// Down by this much in the corners.
    Vignette(f64),
    /// This share of it inside of a pane that the sun throws, or that something far away keeps it from, and that outside; soft over so
    /// many px.
    Pane {
        pane: Pane,
        inside: f64,
        outside: f64,
        soft: f64,
    },
}

/// A parallelogram: where it is, and each pair of sides' normal (rad) and distance. Places and distances are shares of the picture's
/// width and height.
#[derive(Clone, Copy)]
pub(crate) struct Pane {
    at: (f64, f64),
    normals: [f64; 2],
    across: [f64; 2],
}

impl Pane {
    /// 1 inside, 0 outside, and between them over `soft` px.
    fn share(&self, x: f64, y: f64, (width, height): (f64, f64), soft: f64) -> f64 {
        let from = Vec2::new(x - self.at.0 * width, y - self.at.1 * height);
        let sides = self.normals.iter().zip(self.across);
        let of = |(&normal, across): (&f64, f64)| {
            let aside = from.dot(planar::direction(normal)).abs();
            let into = ((0.5 * across * height - aside) / soft + 0.5).clamp(0.0, 1.0);
            into * into * (3.0 - 2.0 * into)
        };
        sides.map(of).product()
    }
}

impl Light {
    pub(crate) fn at(self, x: f64, y: f64, width: f64, height: f64) -> f64 {
        let (u, v) = (x / width, y / height);
        match self {
            Light::Even => 1.0,
            Light::Lamp(lx, ly) => {
                0.35 + 0.65 * (1.0 - (u - lx).powi(2) - ((v - ly) / 1.15).powi(2)).clamp(0.0, 1.0)
            }
            Light::Slope(way) => {
                let (sin, cos) = way.sin_cos();
                let along = ((u - 0.5) * cos + (v - 0.5) * sin) / (cos.abs() + sin.abs());
                1.0 - 0.65 * (along + 0.5)
            }
            Light::Shadow { through, normal, left, soft } => {
                let from = Vec2::new(x - through.0 * width, y - through.1 * height);
                let into = (from.dot(planar::direction(normal)) / soft + 0.5).clamp(0.0, 1.0);
                1.0 - (1.0 - left) * into
            }
            Light::Pane { pane, inside, outside, soft } => {
                outside + (inside - outside) * pane.share(x, y, (width, height), soft)
            }
            Light::Vignette(depth) => 1.0 - depth * 2.0 * ((u - 0.5).powi(2) + (v - 0.5).powi(2)),
        }
    }
}

pub(crate) fn one_sided(random: &mut Random) -> Light {
    if random.chance(0.5) {
        return Light::Slope(random.angle());
    }
    Light::Lamp(random.pick(&[0.15, 0.85]), random.pick(&[0.1, 0.9]))
}

pub(crate) fn shadow(random: &mut Random) -> Light {
    let through = (random.between(0.25, 0.75), random.between(0.25, 0.75));
    Light::Shadow {
        through,
        normal: random.angle(),
        left: random.between(0.5, 0.7),
        soft: random.between(1.0, 3.0),
    }
}

/// The sun through a window, or the shadow of something far from the paper: no edge of it is sharp.
pub(crate) fn soft(random: &mut Random, height: f64) -> Light {
    let one = random.angle();
    let pane = Pane {
        at: (random.between(0.0, 1.0), random.between(0.0, 1.0)),
        normals: [one, one + random.between(0.7, 1.57)],
        across: [random.between(0.1, 0.6), random.between(0.5, 3.0)],
    };
    let dim = random.between(0.45, 0.75);
    let (inside, outside) = if random.chance(0.5) { (1.0, dim) } else { (dim, 1.0) };
    Light::Pane { pane, inside, outside, soft: height * random.between(0.04, 0.12) }
}

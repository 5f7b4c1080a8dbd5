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
                let into = (from.dot(Vec2::from_angle(normal)) / soft + 0.5).clamp(0.0, 1.0);
                1.0 - (1.0 - left) * into
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

//! The same for the plane's directions and turns: what `kurbo` would ask the C library for.

use kurbo::{Affine, Vec2};

/// The unit vector at this angle in radians, counted from x towards y.
#[inline]
pub fn direction(angle_rad: f64) -> Vec2 {
    let (sin, cos) = crate::sin_cos(angle_rad);
    Vec2::new(cos, sin)
}

/// The angle of `vector`, from −π to π, counted from x towards y; 0 for none.
#[inline]
pub fn heading(vector: Vec2) -> f64 {
    crate::atan2(vector.y, vector.x)
}

/// The turn about the origin by this angle in radians, from x towards y.
#[inline]
pub fn rotation(angle_rad: f64) -> Affine {
    let (sin, cos) = crate::sin_cos(angle_rad);
    Affine::new([cos, sin, -sin, cos, 0.0, 0.0])
}

use std::f64::consts::TAU;

use tracelight_maths::{complex, exp2, log2};

use crate::Complex;
use crate::binary::{join, split};

/// An edge of the Newton polygon: so many roots are about so far from zero.
pub(super) struct Edge {
    first: usize,
    count: usize,
    /// Logarithm of that distance to base 2.
    pub(super) radius_log2: f64,
}

/// The upper edges of log |cᵢ| over i, coefficients highest power first, first and last not zero: the largest roots first.
pub(super) fn polygon(coefficients: &[f64]) -> Vec<Edge> {
    let height = |c: f64| {
        let (mantissa, exponent) = split(c);
        log2(mantissa.abs()) + f64::from(exponent)
    };
    let points = (0..).zip(coefficients).filter(|(_, c)| **c != 0.0).map(|(i, &c)| (i, height(c)));
    let corners = upper_edge(&points.collect::<Vec<_>>());
    let edge = |pair: &[(usize, f64)]| {
        let ((first, high), (last, low)) = (pair[0], pair[1]);
        Edge { first, count: last - first, radius_log2: (low - high) / (last - first) as f64 }
    };
    corners.windows(2).map(edge).collect()
}

/// Where to look for the roots first: as many on circles as the Newton polygon says (Bini 1996).
pub(super) fn starts(coefficients: &[f64]) -> Vec<Complex> {
    /// Anything that no symmetry of the coefficients has.
    const TURN: f64 = 0.7;
    let degree = (coefficients.len() - 1) as f64;
    let on_circle = |edge: Edge| {
        let whole = edge.radius_log2.clamp(-1000.0, 1000.0).floor();
        let radius = join(exp2(edge.radius_log2.clamp(-1000.0, 1000.0) - whole), whole as i32);
        (0..edge.count).map(move |k| {
            let turn = TAU * (k as f64 / edge.count as f64 + edge.first as f64 / degree) + TURN;
            complex::from_polar(radius, turn)
        })
    };
    polygon(coefficients).into_iter().flat_map(on_circle).collect()
}

/// The upper convex hull of points from left to right (Andrew's monotone chain).
fn upper_edge(points: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let mut edge: Vec<(usize, f64)> = Vec::new();
    for &point in points {
        while let [.., a, b] = edge[..] {
            let slope = |p: (usize, f64), q: (usize, f64)| (q.1 - p.1) / (q.0 - p.0) as f64;
            if slope(a, b) > slope(b, point) {
                break;
            }
            edge.pop();
        }
        edge.push(point);
    }
    edge
}

//! What an axis shows, and what of a curve lies within.

/// What an axis shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Range {
    /// From the least to the greatest of some values, with some room where they are all one.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Self {
        let seen = values.filter(|v| v.is_finite());
        let (low, high) = seen.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let size = low.abs().max(high.abs());
        match (low.is_finite(), high - low) {
            (true, span) if span > 1e-9 * size => Self { low, high },
            (true, _) => Self { low: low - 0.5 * size.max(1e-3), high: high + 0.5 * size.max(1e-3) },
            (false, _) => Self { low: 0.0, high: 1.0 },
        }
    }

    /// Somewhat wider on a logarithmic axis.
    pub(crate) fn decades(&self) -> Self {
        Self { low: 0.8 * self.low, high: 1.25 * self.high }
    }

    /// One whose lines can be counted: no further than `f64` reaches from one end to the other.
    pub(crate) fn sane(self, log: bool) -> Self {
        const FURTHEST: f64 = 1e300;
        let finite = |value: f64, otherwise: f64| {
            if value.is_nan() { otherwise } else { value.clamp(-FURTHEST, FURTHEST) }
        };
        let (low, high) = (finite(self.low, 0.0), finite(self.high, 1.0));
        if log {
            let low = low.max(1.0 / FURTHEST);
            return Self { low, high: high.clamp(1.01 * low, low * FURTHEST) };
        }
        if high > low { Self { low, high } } else { Self { low: low - 0.5, high: low + 0.5 } }
    }

    /// Whether it is shown.
    pub(crate) fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    pub(crate) fn span(&self) -> f64 {
        self.high - self.low
    }

    pub(crate) fn widen(&mut self, span: f64) {
        let more = 0.5 * (span - self.span()).max(0.0);
        (self.low, self.high) = (self.low - more, self.high + more);
    }
}

/// The parts of a line through these points that lie in a rectangle, each with its ends on the edge where it leaves. A point that is
/// no number ends a part.
pub(crate) fn inside(points: &[(f64, f64)], x: Range, y: Range) -> Vec<Vec<(f64, f64)>> {
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut last_end = None;
    for pair in points.windows(2) {
        let Some((from, to)) = cut(pair[0], pair[1], x, y) else { continue };
        match runs.last_mut() {
            Some(run) if last_end == Some(from) => run.push(to),
            _ => runs.push(vec![from, to]),
        }
        last_end = Some(to);
    }
    runs
}

/// What of a straight line lies in a rectangle (Liang & Barsky 1984).
fn cut(from: (f64, f64), to: (f64, f64), x: Range, y: Range) -> Option<((f64, f64), (f64, f64))> {
    if ![from.0, from.1, to.0, to.1].into_iter().all(f64::is_finite) {
        return None;
    }
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (start, step, range) in [(from.0, dx, x), (from.1, dy, y)] {
        for (room, way) in [(start - range.low, -step), (range.high - start, step)] {
            if way == 0.0 && room < 0.0 {
                return None;
            }
            if way < 0.0 {
                enters = enters.max(room / way);
            } else if way > 0.0 {
                leaves = leaves.min(room / way);
            }
        }
    }
    let at = |share: f64| match share {
        0.0 => from,
        1.0 => to,
        _ => (from.0 + share * dx, from.1 + share * dy),
    };
    (enters <= leaves).then(|| (at(enters), at(leaves)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_drawn_where_it_is_inside() {
        let unit = Range { low: 0.0, high: 1.0 };
        let parts = inside(&[(-1.0, 0.5), (0.5, 0.5), (0.5, 3.0), (0.75, 3.0), (0.75, 0.0)], unit, unit);
        assert_eq!(parts, [vec![(0.0, 0.5), (0.5, 0.5), (0.5, 1.0)], vec![(0.75, 1.0), (0.75, 0.0)]]);
        assert!(inside(&[(2.0, 2.0), (3.0, 3.0)], unit, unit).is_empty());
        let broken = inside(&[(0.1, 0.1), (0.2, 0.2), (f64::NAN, 0.0), (0.3, 0.3), (0.4, 0.4)], unit, unit);
        assert_eq!(broken.len(), 2);
    }
}

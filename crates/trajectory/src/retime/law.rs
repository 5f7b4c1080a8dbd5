use super::along::{Along, hermite};
use super::passes::Speeds;

/// Place, speed and acceleration along a path over time, rounded into an S: the mean of the fastest motion over a
/// window of `ramp_s` behind. Averaging a motion whose acceleration jumps gives one whose acceleration is
/// continuous, with jerk at most the jump over the window.
#[derive(Clone, Debug)]
pub(crate) struct TimeLaw {
    cells: Vec<Cell>,
    end: Cell,
    ramp_s: f64,
}

/// A cell in time: s = Σ kᵢ tⁱ from its start on.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    start_s: f64,
    k: [f64; 6],
    /// ∫ s dt up to its start.
    integral: f64,
}

impl TimeLaw {
    pub(super) fn new(s: &[f64], speeds: &Speeds, ramp_s: f64) -> Self {
        let mut law = Self { cells: Vec::with_capacity(speeds.u.len()), end: Cell::default(), ramp_s };
        let (mut time, mut integral) = (0.0, 0.0);
        for (i, &u) in speeds.u.iter().enumerate() {
            let (h, v) = (s[i + 1] - s[i], [speeds.v[i], speeds.v[i + 1]]);
            if h <= 0.0 {
                continue;
            }
            let cell_s = crossing_s(h, v, u);
            let k =
                hermite(Along { s: s[i], v: v[0], a: u[0] }, Along { s: s[i + 1], v: v[1], a: u[1] }, cell_s);
            let cell = Cell { start_s: time, k, integral };
            integral += cell.integral_of(cell_s);
            time += cell_s;
            law.cells.push(cell);
        }
        let at_end = |values: &[f64]| values.last().copied().unwrap_or(0.0);
        law.end = Cell { start_s: time, k: [at_end(s), at_end(&speeds.v), 0.0, 0.0, 0.0, 0.0], integral };
        law
    }

    /// When the last of it, rounded, is over.
    pub(crate) const fn duration_s(&self) -> f64 {
        self.end.start_s + self.ramp_s
    }

    /// When a motion that is under way at its start comes by there; rounding makes it half a ramp late.
    pub(crate) fn start_s(&self) -> f64 {
        let start = self.cells.first().map_or(0.0, |cell| cell.k[0]);
        let (mut low, mut high) = (0.0, self.ramp_s);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.at(middle).s < start { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// The fastest motion and its integral at time `t`; before and after it at the speeds of its ends.
    fn fast(&self, t: f64) -> (f64, Along) {
        let (first, v) = self.cells.first().map_or((0.0, 0.0), |cell| (cell.k[0], cell.k[1]));
        if t <= 0.0 {
            return ((first + 0.5 * v * t) * t, Along { s: first + v * t, v, a: 0.0 });
        }
        let index = self.cells.partition_point(|cell| cell.start_s <= t);
        let cell = if t >= self.end.start_s { &self.end } else { &self.cells[index.max(1) - 1] };
        let since = t - cell.start_s;
        (cell.integral + cell.integral_of(since), cell.at(since))
    }

    /// Arc length, speed and acceleration at time `t`, also before the start and after the end.
    pub(crate) fn at(&self, t: f64) -> Along {
        if self.ramp_s <= 0.0 {
            return self.fast(t).1;
        }
        let (now, then) = (self.fast(t), self.fast(t - self.ramp_s));
        let mean = |a: f64, b: f64| (a - b) / self.ramp_s;
        Along { s: mean(now.0, then.0), v: mean(now.1.s, then.1.s), a: mean(now.1.v, then.1.v) }
    }
}

impl Cell {
    fn at(&self, t: f64) -> Along {
        let k = &self.k;
        Along {
            s: ((((k[5] * t + k[4]) * t + k[3]) * t + k[2]) * t + k[1]) * t + k[0],
            v: (((5.0 * k[5] * t + 4.0 * k[4]) * t + 3.0 * k[3]) * t + 2.0 * k[2]) * t + k[1],
            a: ((20.0 * k[5] * t + 12.0 * k[4]) * t + 6.0 * k[3]) * t + 2.0 * k[2],
        }
    }

    fn integral_of(&self, t: f64) -> f64 {
        let sum = (0..6).rev().fold(0.0, |sum, i| sum * t + self.k[i] / (i + 1) as f64);
        sum * t
    }
}

/// A cell entered and left at rest cannot be crossed. Only a cap of nothing, or a path of one single cell, makes one; it
/// is given a time beyond any job's, ns for each unit of way.
const STANDING: f64 = 1e-9;

/// Gauss and Legendre's three places of a cell, and their weights.
pub(super) const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// How long a cell takes whose acceleration goes in a straight line over s: ∫ ds/v with v² = v₀² + 2u₀s + (u₁−u₀)s²/h.
///
/// The integral is taken over the time θ of the motion with constant acceleration between the same speeds, in which
/// the integrand is smooth also from rest (Gauss–Legendre, three points).
pub(super) fn crossing_s(h: f64, v: [f64; 2], u: [f64; 2]) -> f64 {
    if v[0] + v[1] <= STANDING {
        return h / STANDING;
    }
    let even_s = 2.0 * h / (v[0] + v[1]);
    let share: f64 = GAUSS
        .iter()
        .map(|&(at, weight)| {
            let even_v = v[0] + (v[1] - v[0]) * at;
            let s = even_s * (v[0] + 0.5 * (v[1] - v[0]) * at) * at;
            let square = v[0] * v[0] + s * (2.0 * u[0] + (u[1] - u[0]) * s / h);
            weight * even_v / square.max(1e-4 * even_v * even_v).max(f64::MIN_POSITIVE).sqrt()
        })
        .sum();
    even_s * share
}

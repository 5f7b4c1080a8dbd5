//! What a closed loop with a dead time answers, from dead time to dead time (the method of steps).
//!
//! What comes into the rational part is known one dead time ahead. A dead time is cut into cells; in each the input is the polynomial
//! through its values, and the rational part answers to that exactly, by the exponential of its matrix. Jumps fall between cells.

use super::chain::Chain;
use crate::discretize::exponential;
use crate::transient::Input;
use crate::{LinearError, Matrix};

/// Values of a cell, both ends included.
const NODES: usize = 8;
/// Values in all.
const MOST_VALUES: usize = 800_000;
/// Share of the largest value that a finer run may change.
const ENOUGH: f64 = 1e-9;

/// The output, cell by cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Steps {
    cell_s: f64,
    /// When its first value comes out, s: before it there is nothing.
    late_s: f64,
    /// Area of the impulse that goes straight through at that moment.
    pub(super) impulse: f64,
    /// A cell after the other, so many values each.
    values: Vec<f64>,
    /// Share of the largest value by which a run twice as fine differed.
    pub(super) accuracy: f64,
}

impl Steps {
    /// The closed loop's output from rest, for that long: finer and finer, until it no longer changes.
    ///
    /// # Errors
    /// [`LinearError::Improper`] with more zeros than poles; [`LinearError::Wish`] where a dead time is too short a part of that time.
    pub(super) fn closed(of: &Chain, input: Input, duration_s: f64) -> Result<Self, LinearError> {
        let mut cells = 1;
        let delays = (duration_s / of.round_s).ceil().max(1.0);
        let mut last: Option<Self> = None;
        loop {
            let whole = delays * cells as f64 * NODES as f64;
            if whole > MOST_VALUES as f64 {
                let too_short = || {
                    LinearError::Wish(format!(
                        "a dead time of {} s is too small a part of {duration_s} s: choose a shorter time, or approximate it by pade({}, 3)",
                        of.round_s, of.round_s
                    ))
                };
                return last.ok_or_else(too_short);
            }
            let mut next = Run::new(of, input, cells).run(delays as usize);
            if let Some(last) = &last {
                next.accuracy = next.apart(last);
            }
            if next.accuracy <= ENOUGH {
                return Ok(next);
            }
            last = Some(next);
            cells *= 2;
        }
    }

    /// Moments of all values, s, and these.
    pub(super) fn nodes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.values.iter().enumerate().map(|(i, value)| (self.node_s(i), *value))
    }

    fn node_s(&self, i: usize) -> f64 {
        let (cell, node) = (i / NODES, i % NODES);
        self.late_s + self.cell_s * (cell as f64 + node as f64 / (NODES - 1) as f64)
    }

    /// The output at a moment, s; the last value behind the end. Where it jumps, the value after the jump.
    pub(super) fn at(&self, time_s: f64) -> f64 {
        if time_s < self.late_s {
            return 0.0;
        }
        let cells = self.values.len() / NODES;
        let place = ((time_s - self.late_s) / self.cell_s).max(0.0);
        let cell = (place.floor() as usize).min(cells - 1);
        let at = ((place - cell as f64) * (NODES - 1) as f64).min((NODES - 1) as f64);
        interpolated(&self.values[cell * NODES..(cell + 1) * NODES], at)
    }

    /// How far the values of a run half as fine are from this one, as a share of the largest.
    fn apart(&self, other: &Self) -> f64 {
        let most = self.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        // where it jumps both sides are asked
        let inner = 0..other.values.len();
        let inner = inner.filter(|i| (1..NODES - 1).contains(&(i % NODES)));
        let apart = inner.map(|i| (self.at(other.node_s(i)) - other.values[i]).abs()).fold(0.0, f64::max);
        if most > 0.0 { apart / most } else { 0.0 }
    }
}

/// The polynomial through values at 0, 1, 2 …, at a place: Lagrange's, in the barycentric form.
fn interpolated(values: &[f64], at: f64) -> f64 {
    let nearest = at.round();
    if at == nearest {
        return values[nearest as usize];
    }
    let (mut above, mut below, mut weight) = (0.0, 0.0, 1.0);
    for (k, value) in values.iter().enumerate() {
        let share = weight / (at - k as f64);
        above += share * value;
        below += share;
        weight *= -((values.len() - 1 - k) as f64) / (k + 1) as f64;
    }
    above / below
}

/// The chain, from value to value of a cell.
struct Run<'a> {
    of: &'a Chain,
    cells_per_delay: usize,
    cell_s: f64,
    input: Input,
    /// What is left of the state from one value to the next.
    keeps: Matrix,
    /// For each value but the last of a cell: what each of the cell's values that come round adds to the state until the next.
    adds_round: Vec<Matrix>,
    /// What each of those that come in adds.
    adds_in: Vec<Matrix>,
}

impl<'a> Run<'a> {
    fn new(of: &'a Chain, input: Input, cells_per_delay: usize) -> Self {
        let cell_s = of.round_s / cells_per_delay as f64;
        let step_s = cell_s / (NODES - 1) as f64;
        let (keeps, adds_round) = adds(&of.a, &of.round.b, step_s);
        let (_, adds_in) = adds(&of.a, &of.input.b, step_s);
        Self { of, cells_per_delay, cell_s, input, keeps, adds_round, adds_in }
    }

    fn run(&self, delays: usize) -> Steps {
        let Chain { c, round, input, .. } = self.of;
        let cells = delays * self.cells_per_delay;
        let mut values = Vec::with_capacity(cells * NODES);
        let first = if self.input == Input::Impulse { 1.0 } else { 0.0 };
        let mut state = &input.b * first;
        // the impulse that goes round
        let mut impulse = input.d * first;
        let through = impulse;
        let (mut rounds, mut inputs) = (Matrix::zeros(NODES, 1), Matrix::zeros(NODES, 1));
        for cell in 0..cells {
            if cell % self.cells_per_delay == 0 && cell > 0 {
                impulse *= -self.of.sign;
                state += &round.b * impulse;
                impulse *= round.d;
            }
            for node in 0..NODES {
                inputs[(node, 0)] = self.wanted(cell, node);
                if let Some(before) = cell.checked_sub(self.cells_per_delay) {
                    rounds[(node, 0)] = -self.of.sign * values[before * NODES + node];
                }
            }
            for node in 0..NODES {
                let output = if state.nrows() > 0 { c.row(0).dot(&state.column(0).transpose()) } else { 0.0 };
                values.push(output + round.d * rounds[(node, 0)] + input.d * inputs[(node, 0)]);
                if let (Some(adds_round), Some(adds_in)) = (self.adds_round.get(node), self.adds_in.get(node))
                {
                    state = &self.keeps * &state + adds_round * &rounds + adds_in * &inputs;
                }
            }
        }
        let late_s = self.of.late_s;
        Steps { cell_s: self.cell_s, late_s, impulse: through, values, accuracy: f64::INFINITY }
    }

    /// What comes in.
    fn wanted(&self, cell: usize, node: usize) -> f64 {
        match self.input {
            Input::Step => 1.0,
            Input::Impulse => 0.0,
            Input::Ramp => self.cell_s * (cell as f64 + node as f64 / (NODES - 1) as f64),
        }
    }
}

/// What is left of a state after a step, and for each value but the last what each value of an input adds to it until the next.
fn adds(a: &Matrix, b: &Matrix, step_s: f64) -> (Matrix, Vec<Matrix>) {
    let order = a.nrows();
    // x′ = A x + B Σ uᵢ τⁱ/i!: powers of the time are states that feed each other
    let mut whole = Matrix::zeros(order + NODES, order + NODES);
    whole.view_mut((0, 0), (order, order)).copy_from(&(a * step_s));
    whole.view_mut((0, order), (order, 1)).copy_from(&(b * step_s));
    for i in 0..NODES - 1 {
        whole[(order + i, order + i + 1)] = 1.0;
    }
    let whole = exponential(&whole);
    let keeps = whole.view((0, 0), (order, order)).into_owned();
    // column i: what uᵢ of u = Σ uᵢ τⁱ/i!, τ from 0 to 1, adds
    let moments = whole.view((0, order), (order, NODES)).into_owned();
    let adds = (0..NODES - 1).map(|node| &moments * derivatives(node)).collect();
    (keeps, adds)
}

/// Derivatives at one of the places 0, 1, 2 … of the polynomial through values there: a row each, the value itself first.
fn derivatives(at: usize) -> Matrix {
    // of Π (τ − j) / Π (k − j), j ≠ k, in powers of τ − at
    let mut all = Matrix::zeros(NODES, NODES);
    for k in 0..NODES {
        let mut powers = vec![1.0];
        let mut scale = 1.0;
        for j in (0..NODES).filter(|j| *j != k) {
            let shift = at as f64 - j as f64;
            powers.insert(0, 0.0);
            for i in 0..powers.len() - 1 {
                let above = powers[i + 1];
                powers[i] += shift * above;
            }
            scale *= k as f64 - j as f64;
        }
        let mut factorial = 1.0;
        for (i, power) in powers.iter().enumerate() {
            all[(i, k)] = power / scale * factorial;
            factorial *= (i + 1) as f64;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Delayed, Time, TransferFunction};

    fn steps(text: &str, delay_s: f64, input: Input, duration_s: f64) -> Steps {
        let rational = TransferFunction::parse(text, Time::Continuous).unwrap();
        Steps::closed(&Chain::of(&Delayed::new(rational, delay_s).unwrap()).unwrap(), input, duration_s)
            .unwrap()
    }

    /// y′(t) = k (1 − y(t − T)): from dead time to dead time a polynomial of one degree more.
    #[test]
    fn a_late_integrator_goes_in_polynomials() {
        let found = steps("1.3/s", 0.8, Input::Step, 8.0);
        let exact = |t: f64| -> f64 {
            let mut sum = 0.0;
            for k in 1..=10 {
                let late = t - 0.8 * f64::from(k);
                if late < 0.0 {
                    break;
                }
                let term = (1..=k).fold(1.0, |product, i| product * 1.3 * late / f64::from(i));
                sum += if k % 2 == 1 { term } else { -term };
            }
            sum
        };
        for k in 0..=100 {
            let t = 0.08 * f64::from(k) - 1e-9;
            assert!((found.at(t) - exact(t)).abs() < 1e-8, "{t}: {} {}", found.at(t), exact(t));
        }
        assert!(found.accuracy < ENOUGH);
    }

    #[test]
    fn what_goes_straight_through_comes_round_again() {
        // y(t) = 0.5 (1 − y(t − 1))
        let found = steps("0.5", 1.0, Input::Step, 6.0);
        for (k, value) in [0.0, 0.5, 0.25, 0.375, 0.3125, 0.34375].into_iter().enumerate() {
            assert!((found.at(k as f64 + 0.5) - value).abs() < 1e-15, "{k}");
        }
        // of y′ = −y + e late by 1: e^(−(t−1)), less what that brings
        let found = steps("1/(s+1)", 1.0, Input::Impulse, 3.0);
        let exact = |t: f64| (1.0 - t).exp() - if t > 2.0 { (t - 2.0) * (2.0 - t).exp() } else { 0.0 };
        for t in [1.1, 1.9, 2.3, 2.9] {
            assert!((found.at(t) - exact(t)).abs() < 1e-9, "{t}");
        }
        assert_eq!(found.at(0.7), 0.0);
    }

    #[test]
    fn a_dead_time_that_is_next_to_nothing_is_told() {
        let rational = TransferFunction::parse("1/s", Time::Continuous).unwrap();
        let loops = Delayed::new(rational, 1e-7).unwrap();
        let told = Steps::closed(&Chain::of(&loops).unwrap(), Input::Step, 10.0).unwrap_err();
        assert!(told.to_string().contains("pade(0.0000001, 3)"), "{told}");
    }
}

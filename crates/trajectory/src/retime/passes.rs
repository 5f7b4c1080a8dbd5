use tracelight_rig::{Joint, PanTilt};

use super::limits::{AlongLimits, OF_JOINTS, PathSample, Place, Rows};
use crate::error::PlanError;
use crate::machine::Machine;

/// A stretch between two neighbouring places. The acceleration goes in a straight line over s from one end to the
/// other, and keeps to the limits at both.
#[derive(Clone, Copy)]
struct Cell<'a, const N: usize> {
    /// Length.
    h: f64,
    start: &'a Rows<N>,
    end: &'a Rows<N>,
}

/// The limits along a path. Where a joint turns round, friction jumps: the cell before and the cell after have limits
/// of their own there.
struct Limits<const N: usize> {
    rows: Vec<Rows<N>>,
    /// Of every cell its length and where its start's and its end's limits are.
    cells: Vec<(f64, u32, u32)>,
}

impl<const N: usize> Limits<N> {
    fn cells(&self) -> impl DoubleEndedIterator<Item = Cell<'_, N>> + ExactSizeIterator {
        let rows = |i: u32| &self.rows[i as usize];
        self.cells.iter().map(move |&(h, start, end)| Cell { h, start: rows(start), end: rows(end) })
    }

    fn of(machine: &Machine, samples: &[PathSample], along: Option<&AlongLimits>) -> Result<Self, PlanError> {
        let mut limits = Self {
            rows: Vec::with_capacity(samples.len() + samples.len() / 8),
            cells: Vec::with_capacity(samples.len()),
        };
        let mut last_ways = PanTilt::new(0.0, 0.0);
        let mut place = samples.first().map(|sample| Place::new(machine, sample));
        for pair in samples.windows(2) {
            let ways = PanTilt::from_fn(|j| (pair[0].joints.first[j] + pair[1].joints.first[j]).signum());
            if let (Some(place), true) = (place, ways != last_ways) {
                check_strength(machine, &place, ways)?;
                limits.rows.push(place.rows(machine, ways));
            }
            let next = Place::new(machine, &pair[1]);
            check_strength(machine, &next, ways)?;
            limits.rows.push(next.rows(machine, ways));
            let end = limits.rows.len() as u32 - 1;
            limits.cells.push((pair[1].s - pair[0].s, end - 1, end));
            (place, last_ways) = (Some(next), ways);
        }
        if let Some(along) = along {
            limits.rows.iter_mut().for_each(|rows| rows.bound_along(along));
        }
        Ok(limits)
    }
}

/// Every motor must be able to start its joint anywhere.
fn check_strength(machine: &Machine, place: &Place, ways: PanTilt<f64>) -> Result<(), PlanError> {
    for joint in Joint::BOTH {
        let available_nm = machine.usable_nm(joint);
        let needed_nm = place.starting_nm(machine, joint, ways[joint]).abs();
        if needed_nm >= available_nm {
            return Err(PlanError::TooWeak { joint, needed_nm, available_nm });
        }
    }
    Ok(())
}

/// Speeds at all places, and the accelerations at both ends of every cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Speeds {
    pub(super) v: Vec<f64>,
    pub(super) u: Vec<[f64; 2]>,
}

/// The fastest speeds along samples that keep to all limits, those on the acceleration `along` the path too, from
/// `first` at most at the start to `last` at most.
///
/// A backward pass finds the highest speed at every place from which the rest can still be followed, a forward pass
/// takes the highest acceleration that stays under it (reachability analysis; Pham & Pham, "A new approach to
/// time-optimal path parameterization based on reachability analysis", IEEE T-RO 2018, §III). There u is constant
/// between places, so that it keeps to the limits of one end only, or to both at the cost of speed; here it is
/// linear (the trapezoidal rule: v² + h·u at one end equals v² − h·u at the other), so what is lost to the grid
/// goes with the square of its step. Viscous friction makes limits quadratic in v rather than linear in v²; their
/// roots are taken as they are.
pub(super) fn fastest(
    machine: &Machine,
    samples: &[PathSample],
    ends: [f64; 2],
    along: Option<&AlongLimits>,
) -> Result<Speeds, PlanError> {
    match along {
        None => Ok(within(&Limits::<OF_JOINTS>::of(machine, samples, None)?, ends)),
        Some(_) => Ok(within(&Limits::<{ OF_JOINTS + 1 }>::of(machine, samples, along)?, ends)),
    }
}

fn within<const N: usize>(limits: &Limits<N>, [first, last]: [f64; 2]) -> Speeds {
    let (ceiling, middle) = ceilings(limits, last);
    let mut v = Vec::with_capacity(ceiling.len());
    let mut u = Vec::with_capacity(middle.len());
    v.push(first.min(ceiling[0]));
    for (i, cell) in limits.cells().enumerate() {
        let (next, ends) = cell.onwards(v[i], middle[i], ceiling[i + 1]);
        v.push(next);
        u.push(ends);
    }
    Speeds { v, u }
}

/// For every place the highest speed from which the end can be reached at `last` or less, and for every cell the
/// highest v² + h·u at its start.
fn ceilings<const N: usize>(limits: &Limits<N>, last: f64) -> (Vec<f64>, Vec<f64>) {
    let count = limits.cells.len();
    let mut ceiling = vec![0.0; count + 1];
    let mut middle = vec![0.0; count];
    ceiling[count] = last;
    for (i, cell) in limits.cells().enumerate().rev() {
        let most = ceiling[i + 1].min(cell.end.speed_most);
        ceiling[i + 1] = most;
        if cell.h <= 0.0 {
            (middle[i], ceiling[i]) = (most * most, most.min(cell.start.speed_most));
            continue;
        }
        middle[i] = cell.end.most_before(cell.h, most);
        ceiling[i] = cell.start.slowest_ends_below(cell.h, middle[i]);
    }
    (ceiling, middle)
}

impl<const N: usize> Cell<'_, N> {
    /// The highest speed at the end when it is entered at `v`, and the accelerations at both ends.
    fn onwards(&self, v: f64, middle: f64, ceiling: f64) -> (f64, [f64; 2]) {
        let (low, high) = self.start.range(v);
        if self.h <= 0.0 {
            return (v.min(ceiling), [low.max(0.0).min(high); 2]);
        }
        let z = (v * v + self.h * high).min(middle);
        let next = self.end.fastest_comes_from(self.h, z).min(ceiling);
        let next = self.end.fastest_after(self.h, z, next);
        // any two accelerations with this sum lead from v to next: the two nearest to each other are the smoothest
        let sum = (next * next - v * v) / self.h;
        let (end_low, end_high) = self.end.range(next);
        let (from, to) = (low.max(sum - end_high), high.min(sum - end_low));
        let start = (0.5 * sum).max(from).min(to);
        (next, [start, sum - start])
    }
}

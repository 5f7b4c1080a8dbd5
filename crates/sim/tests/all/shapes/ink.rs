//! Which ink of a plan was drawn, and which twice.

use tracelight_sim::Run;
use tracelight_stroke::Point;
use tracelight_trajectory::Plan;

/// A place on a plan's lit lines counts as drawn if light passed it; they are this far apart, m.
const STEP_M: f64 = 2e-5;
/// Ticks of the plan, before and after the one a tick follows, among which its spot is looked for.
const NEAR_TICKS: usize = 40;

/// What light made of a plan's lines.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ink {
    /// Longest piece of a line that was not drawn, mm.
    pub(crate) missing_mm: f64,
    /// Longest piece that was drawn more than once, mm.
    pub(crate) doubled_mm: f64,
    /// Light was this far off the lines at most, mm.
    pub(crate) off_mm: f64,
}

impl Ink {
    /// The worse of both in each.
    pub(crate) fn or_worse(self, other: &Self) -> Self {
        Self {
            missing_mm: self.missing_mm.max(other.missing_mm),
            doubled_mm: self.doubled_mm.max(other.doubled_mm),
            off_mm: self.off_mm.max(other.off_mm),
        }
    }
}

/// Compares the light of a run with the lines of its plan.
pub(crate) fn ink(plan: &Plan, run: &Run) -> Ink {
    let lines = Lines::of(plan);
    let mut passes = vec![0_u32; (lines.length_m / STEP_M) as usize + 1];
    let mut off_mm = 0.0_f64;
    // where the light is now; a pass goes on while it moves forwards by less than a jump
    for pair in run.ticks.windows(2) {
        if !pair[0].light {
            continue;
        }
        let found = pair.iter().map(|t| lines.nearest(t.spot.unwrap(), t.telemetry.plan_tick as usize));
        let found: Vec<(f64, f64)> = found.collect();
        off_mm = off_mm.max(1e3 * found[0].1);
        let (from, to) = ((found[0].0 / STEP_M).ceil() as usize, (found[1].0 / STEP_M).ceil() as usize);
        if to > from && (to - from) as f64 * STEP_M < 5e-3 {
            passes[from.min(lines.last())..to.min(lines.last())].iter_mut().for_each(|n| *n += 1);
        }
    }
    let longest = |is: &dyn Fn(u32) -> bool| {
        let runs = passes[..lines.last()].chunk_by(|a, b| is(*a) == is(*b)).filter(|run| is(run[0]));
        runs.map(|run| run.len() as f64 * STEP_M * 1e3).fold(0.0, f64::max)
    };
    Ink { missing_mm: longest(&|n| n == 0), doubled_mm: longest(&|n| n > 1), off_mm }
}

/// The lit lines of a plan, one after the other.
struct Lines {
    /// How far along them each tick of the plan is, m; it stands in the dark.
    along_m: Vec<f64>,
    spots: Vec<(Point, bool)>,
    length_m: f64,
}

impl Lines {
    fn of(plan: &Plan) -> Self {
        let mut length_m = 0.0;
        let mut along_m = vec![0.0];
        for pair in plan.points.windows(2) {
            if pair[0].lit {
                length_m += pair[0].spot.distance(pair[1].spot);
            }
            along_m.push(length_m);
        }
        Self { along_m, spots: plan.points.iter().map(|p| (p.spot, p.lit)).collect(), length_m }
    }

    fn last(&self) -> usize {
        (self.length_m / STEP_M) as usize
    }

    /// The place on the lit lines nearest to a spot, as far along as it is, and its distance, m.
    fn nearest(&self, spot: Point, tick: usize) -> (f64, f64) {
        let ticks = tick.saturating_sub(NEAR_TICKS)..(tick + NEAR_TICKS).min(self.spots.len() - 1);
        let steps = ticks.filter(|&i| self.spots[i].1).map(|i| {
            let (from, to) = (self.spots[i].0, self.spots[i + 1].0);
            let way = to - from;
            let share = if way.hypot2() > 0.0 { (spot - from).dot(way) / way.hypot2() } else { 0.0 };
            let share = share.clamp(0.0, 1.0);
            (self.along_m[i] + share * way.hypot(), spot.distance(from + way * share))
        });
        steps.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, f64::INFINITY))
    }
}

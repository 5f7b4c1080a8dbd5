//! What friction does around standstill, where no edge comes: told from when the first edges come after it.
//!
//! From some edges before a joint stopped or turned round, where its speed is known, its equations are stepped through the
//! gap with friction that sticks, for one break-away friction after another; the one after which the first edges come
//! where they came is the joint's.

use tracelight_rig::{Joint, TICK_F64_S, Telemetry};
use tracelight_sim::{Quirks, RigConfig};

use super::edge::Edge;
use super::equations::{Balance, Equations, Surroundings, stribeck};
use super::stretch::{edges, slides};

/// Edges before the gap that tell angle and speed.
const BEFORE: usize = 6;
/// Edges after it that judge.
const AFTER: usize = 3;
/// Longest gap, s: on a longer one every torque counts.
const LONGEST_S: f64 = 0.6;
/// Rounds in which the speed before the gap is found.
const ROUNDS: u32 = 4;
/// Steps in a tick.
const STEPS: f64 = 2.0;
/// What is further off than that counts no more, counts: a joint that does not let go is as wrong later as soon.
const FURTHEST_COUNTS: f64 = 1.0;
/// Break-away frictions that are tried first, shares of Coulomb friction from none on.
const COARSE_SHARES: u32 = 9;
const COARSE_SHARE: f64 = 0.08;
/// Speeds at which it may fall, rad/s, each so many times the one before.
const COARSE_RAD_S: [f64; 4] = [0.006, 0.012, 0.024, 0.048];
const COARSE_RATIO: f64 = 2.0;
/// How often the grid is made finer.
const REFINEMENTS: u32 = 5;
/// Fewest gaps to tell it from.
const FEWEST: usize = 2;

/// A gap between edges in which a joint stood still or turned round.
#[derive(Clone, Debug)]
pub(super) struct Stand<'a> {
    record: &'a [Telemetry],
    before: Vec<Edge>,
    after: Vec<Edge>,
}

/// The gaps of a record.
pub(super) fn stands(record: &[Telemetry], joint: Joint) -> Vec<Stand<'_>> {
    let edges = edges(record, joint);
    let slides: Vec<&[Edge]> = slides(&edges).collect();
    let stand = |pair: &[&[Edge]]| {
        let (from, to) = (pair[0], pair[1]);
        let gap_s = to.first()?.time_s - from.last()?.time_s;
        let before = from.get(from.len().checked_sub(BEFORE)?..)?.to_vec();
        let after = to.get(..AFTER)?.to_vec();
        (gap_s <= LONGEST_S).then_some(Stand { record, before, after })
    };
    slides.windows(2).filter_map(stand).collect()
}

/// Equations with the break-away friction that the gaps show; with none where there are too few.
pub(super) fn broken_away(
    rig: &RigConfig,
    joint: Joint,
    equations: &Equations,
    stands: &[Stand<'_>],
) -> Equations {
    let plain = equations.with_break_away(0.0, Quirks::NONE.break_away_rad_s);
    if stands.len() < FEWEST {
        return plain;
    }
    let at = Surroundings::of(rig, joint, equations);
    let count_rad = rig.model.encoder.count_rad();
    let passes: Vec<Pass> = stands.iter().map(|s| Pass::of(s, equations, &at, count_rad)).collect();
    let off = |(share, speed): (f64, f64)| -> f64 {
        passes.iter().map(|pass| pass.off(equations, share * equations.coulomb(), speed)).sum()
    };
    let best = |tried: &mut dyn Iterator<Item = (f64, f64)>| {
        let judged = tried.map(|one| (off(one), one));
        judged.min_by(|a, b| a.0.total_cmp(&b.0)).map_or((0.0, COARSE_RAD_S[0]), |(_, one)| one)
    };
    // on a coarse grid first, and then finer and finer about the best
    let shares = |speed: f64| (0..COARSE_SHARES).map(move |k| (f64::from(k) * COARSE_SHARE, speed));
    let mut found = best(&mut COARSE_RAD_S.into_iter().flat_map(shares));
    let (mut by, mut times) = (0.5 * COARSE_SHARE, COARSE_RATIO.sqrt());
    for _ in 0..REFINEMENTS {
        let (share, speed) = found;
        let near = [-1.0, 0.0, 1.0].into_iter().flat_map(|k| {
            [1.0 / times, 1.0, times].into_iter().map(move |ratio| ((share + k * by).max(0.0), speed * ratio))
        });
        found = best(&mut near.collect::<Vec<_>>().into_iter());
        (by, times) = (0.5 * by, times.sqrt());
    }
    let (share, speed) = found;
    if share > 0.0 { equations.with_break_away(share * equations.coulomb(), speed) } else { plain }
}

/// A gap with what balances in each of its ticks.
struct Pass<'a> {
    stand: &'a Stand<'a>,
    places_rad: (f64, f64),
    after_rad: Vec<f64>,
    first_tick: usize,
    balances: Vec<Balance>,
    count_rad: f64,
}

impl<'a> Pass<'a> {
    fn of(stand: &'a Stand<'a>, equations: &Equations, at: &Surroundings, count_rad: f64) -> Self {
        let place = |edge: &Edge| equations.place_rad(edge, count_rad);
        let tick = |edge: &Edge| (edge.time_s / TICK_F64_S).max(0.0) as usize;
        let (first, last) = (tick(&stand.before[0]), tick(&stand.after[AFTER - 1]));
        let ticks = stand.record.get(first..=last).unwrap_or_default();
        Self {
            stand,
            places_rad: (place(&stand.before[0]), place(&stand.before[BEFORE - 1])),
            after_rad: stand.after.iter().map(place).collect(),
            first_tick: first,
            balances: ticks.iter().map(|told| equations.balance(at, told)).collect(),
            count_rad,
        }
    }

    /// How far off the first edges after the gap are with a break-away friction, squares summed, counts².
    fn off(&self, equations: &Equations, excess: f64, speed_rad_s: f64) -> f64 {
        let tried = Tried { equations, excess, speed_rad_s };
        let (from, to) = self.places_rad;
        let (first, last) = (&self.stand.before[0], &self.stand.before[BEFORE - 1]);
        let lasted_s = (last.time_s - first.time_s).max(TICK_F64_S);
        // a joint that begins faster by one is further on by the time that passed, as long as it slides
        let mut rate = (to - from) / lasted_s;
        for _ in 0..ROUNDS {
            rate -= (self.go(&tried, (first.time_s, from, rate), last.time_s).1 - to) / lasted_s;
        }
        let mut now = (first.time_s, from, rate);
        let mut sum = 0.0;
        for (edge, place) in self.stand.after.iter().zip(&self.after_rad) {
            now = self.go(&tried, now, edge.time_s);
            let off = ((now.1 - place) / self.count_rad).abs().min(FURTHEST_COUNTS);
            sum += off * off;
        }
        sum
    }

    /// Time, angle and speed at a later time.
    fn go(&self, tried: &Tried<'_>, (from_s, angle, rate): (f64, f64, f64), to_s: f64) -> (f64, f64, f64) {
        let (mut now, mut angle, mut rate) = (from_s, angle, rate);
        while now < to_s - 1e-9 {
            // what is about on a tick's end is in the next
            let tick = (now / TICK_F64_S + 1e-6).floor();
            let Some(balance) = self.balances.get((tick as usize).saturating_sub(self.first_tick)) else {
                break;
            };
            let step = (TICK_F64_S / STEPS).min(to_s - now).min((tick + 1.0) * TICK_F64_S - now).max(1e-9);
            let after = tried.step(balance, rate, step);
            angle += 0.5 * step * (rate + after);
            rate = after;
            now += step;
        }
        (now, angle, rate)
    }
}

/// A break-away friction that is tried, rad/s² at standstill, falling to 1/e at a speed.
struct Tried<'a> {
    equations: &'a Equations,
    excess: f64,
    speed_rad_s: f64,
}

impl Tried<'_> {
    /// Speed a little later: friction sticks, by the same time stepping as the plant's, for a joint of inertia 1.
    fn step(&self, balance: &Balance, rate: f64, step_s: f64) -> f64 {
        let more = self.excess * stribeck(rate / self.speed_rad_s);
        let momentum = rate + step_s * balance.drive;
        let (up, down) = (step_s * (balance.pos + more).max(0.0), step_s * (balance.neg + more).max(0.0));
        let (viscous_pos, viscous_neg) = self.equations.viscous();
        if momentum > up {
            (momentum - up) / (1.0 + step_s * viscous_pos)
        } else if momentum < -down {
            (momentum + down) / (1.0 + step_s * viscous_neg)
        } else {
            0.0
        }
    }
}

//! Stretches of motion in one direction, and what each unknown did to the joint on them.

use tracelight_maths::sin_cos;
use tracelight_rig::{Joint, TICK_F64_S, Telemetry};
use tracelight_sim::RigConfig;

use super::edge::Edge;
use super::equations::{Equations, MECHANICS, RIPPLE_COS, RIPPLE_SIN, Surroundings, friction};

/// Longest time between two edges within a stretch, s: a joint that turns by less than 20 mrad/s may have stood in between.
const LONGEST_GAP_S: f64 = 0.08;
/// Longest stretch, s. On a longer one more is seen of torques, and friction that changes along the way looks more like one.
const LONGEST_S: f64 = 0.4;
/// Shortest one, s,
const SHORTEST_S: f64 = 0.04;
/// and fewest edges.
const FEWEST_EDGES: usize = 8;

/// One edge of a stretch as a line of the least squares: where the joint was, less what is known, is position and speed
/// at the start plus Σ θₖ `columns[k]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Since the stretch began, s.
    pub(super) time_s: f64,
    /// Where the edge ought to be, less what is known of the motion, rad.
    pub(super) angle_rad: f64,
    /// What a unit of each mechanical unknown moved the joint by until then.
    pub(super) columns: [f64; MECHANICS],
    /// Which kind of edge it is.
    pub(super) phase: usize,
    /// Deviation of its place for not knowing its time, rad.
    pub(super) blur_rad: f64,
}

/// Motion in one direction.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    /// One an edge.
    pub(super) rows: Vec<Row>,
    /// The way between them.
    steps: Vec<Step>,
    /// Width of a count, rad.
    pub(super) count_rad: f64,
}

/// A piece of the way within a tick.
#[derive(Clone, Copy, Debug)]
struct Step {
    time_s: f64,
    angle_rad: f64,
    /// What a unit of friction does, rad/s².
    friction: f64,
    /// An edge comes at its end.
    to_edge: bool,
}

impl Stretch {
    /// The same with friction that ripples so many times a turn among the unknowns.
    pub(super) fn rippling(&self, periods: f64) -> Self {
        let mut changed = self.clone();
        if periods == 0.0 {
            return changed;
        }
        let [sines, cosines] = self.ripple(periods);
        for ((row, sin), cos) in changed.rows.iter_mut().zip(sines).zip(cosines) {
            (row.columns[RIPPLE_SIN], row.columns[RIPPLE_COS]) = (sin, cos);
        }
        changed
    }

    /// What friction of sin(nq) and of cos(nq) moved the joint by until each edge.
    pub(super) fn ripple(&self, periods: f64) -> [Vec<f64>; 2] {
        let mut columns = [vec![0.0], vec![0.0]];
        let mut integrals = Integrals::NONE;
        for step in &self.steps {
            let (sin, cos) = sin_cos(periods * step.angle_rad);
            integrals.advance(&[sin * step.friction, cos * step.friction], step.time_s);
            if step.to_edge {
                columns.iter_mut().zip(integrals.twice).for_each(|(column, moved)| column.push(moved));
            }
        }
        columns
    }
}

/// Cuts a record into stretches of one joint, without a ripple of friction among the unknowns.
pub(super) fn stretches(
    rig: &RigConfig,
    record: &[Telemetry],
    joint: Joint,
    believed: &Equations,
) -> Vec<Stretch> {
    let count_rad = rig.model.encoder.count_rad();
    let edges = edges(record, joint);
    let surroundings = Surroundings::of(rig, joint, believed);
    slides(&edges)
        .flat_map(pieces)
        .map(|piece| {
            Path { surroundings: &surroundings, record, believed, edges: piece, count_rad }.stretch()
        })
        .collect()
}

/// Edges of motion in one direction without a stop.
pub(super) fn slides(edges: &[Edge]) -> impl Iterator<Item = &[Edge]> {
    edges.chunk_by(|a, b| a.way == b.way && b.time_s - a.time_s <= LONGEST_GAP_S)
}

/// Pieces of a slide that are neither too long nor too short.
fn pieces(slide: &[Edge]) -> Vec<&[Edge]> {
    let (Some(first), Some(last)) = (slide.first(), slide.last()) else { return Vec::new() };
    let parts = ((last.time_s - first.time_s) / LONGEST_S).ceil().max(1.0);
    let length = (last.time_s - first.time_s) / parts;
    let part = |edge: &Edge| ((edge.time_s - first.time_s) / length).min(parts - 1.0).floor();
    let whole = |piece: &&[Edge]| {
        let lasts = piece[piece.len() - 1].time_s - piece[0].time_s;
        piece.len() >= FEWEST_EDGES && lasts >= SHORTEST_S
    };
    slide.chunk_by(|a, b| part(a) == part(b)).filter(whole).collect()
}

/// Every edge of a joint in a record, one a tick at most: of several in a tick the last is known best.
pub(super) fn edges(record: &[Telemetry], joint: Joint) -> Vec<Edge> {
    let edge = |(tick, pair): (usize, &[Telemetry])| {
        let (before, now) = (pair[0].measured[joint].count, pair[1].measured[joint]);
        let moved = now.count.wrapping_sub(before);
        let part = 1.0 / f64::from(moved.unsigned_abs().max(1));
        let (age, blur) = now.edge_age_ticks.map_or((0.5 * part, part), |age| (f64::from(age), 0.0));
        let count = now.count.wrapping_add(pair[1].lost_counts[joint]);
        (moved != 0).then(|| Edge {
            time_s: ((tick + 1) as f64 - age) * TICK_F64_S,
            number: if moved > 0 { count } else { count.wrapping_add(1) },
            way: f64::from(moved.signum()),
            blur_s: blur * TICK_F64_S,
        })
    };
    record.windows(2).enumerate().filter_map(edge).collect()
}

/// A piece of a record that is about to become a stretch.
struct Path<'a> {
    surroundings: &'a Surroundings,
    record: &'a [Telemetry],
    believed: &'a Equations,
    edges: &'a [Edge],
    count_rad: f64,
}

/// Sums over time: the first and the second integral of N things that act.
#[derive(Clone, Copy)]
struct Integrals<const N: usize> {
    once: [f64; N],
    twice: [f64; N],
}

/// The mechanical unknowns, and what is known.
const ACTS: usize = MECHANICS + 1;

impl<const N: usize> Integrals<N> {
    const NONE: Self = Self { once: [0.0; N], twice: [0.0; N] };

    fn advance(&mut self, acts: &[f64; N], time_s: f64) {
        for (k, act) in acts.iter().enumerate() {
            self.twice[k] += time_s * (self.once[k] + 0.5 * time_s * act);
            self.once[k] += time_s * act;
        }
    }
}

impl Path<'_> {
    fn stretch(&self) -> Stretch {
        let start_s = self.edges[0].time_s;
        let mut rows = Vec::with_capacity(self.edges.len());
        let mut steps = Vec::new();
        let mut integrals = Integrals::NONE;
        rows.push(self.row(&self.edges[0], &integrals, start_s));
        for pair in self.edges.windows(2) {
            self.pass(&pair[0], &pair[1], &mut integrals, &mut steps);
            rows.push(self.row(&pair[1], &integrals, start_s));
        }
        Stretch { rows, steps, count_rad: self.count_rad }
    }

    /// From one edge to the next, tick by tick, on the straight way between them.
    fn pass(&self, from: &Edge, to: &Edge, integrals: &mut Integrals<ACTS>, steps: &mut Vec<Step>) {
        let (from_rad, to_rad) =
            (self.believed.place_rad(from, self.count_rad), self.believed.place_rad(to, self.count_rad));
        let rate = (to_rad - from_rad) / (to.time_s - from.time_s).max(1e-9);
        let mut now = from.time_s;
        loop {
            let tick = (now / TICK_F64_S + 1e-9).floor() as usize;
            let next = ((tick + 1) as f64 * TICK_F64_S).min(to.time_s);
            let angle_rad = from_rad + rate * (0.5 * (now + next) - from.time_s);
            let acts = self.acts(tick, angle_rad, rate);
            let (time_s, to_edge) = (next - now, next >= to.time_s - 1e-12);
            integrals.advance(&acts, time_s);
            steps.push(Step { time_s, angle_rad, friction: friction(&acts), to_edge });
            if to_edge {
                return;
            }
            now = next;
        }
    }

    /// What acts in a tick, a unit of each unknown, and what is known of it; rad/s².
    fn acts(&self, tick: usize, angle_rad: f64, rate_rad_s: f64) -> [f64; ACTS] {
        let Some(told) = self.record.get(tick) else { return [0.0; ACTS] };
        let (columns, known) = self.surroundings.acts(told, (angle_rad, rate_rad_s));
        let mut acts = [known; ACTS];
        acts[..MECHANICS].copy_from_slice(&columns);
        acts
    }

    fn row(&self, edge: &Edge, integrals: &Integrals<ACTS>, start_s: f64) -> Row {
        let mut columns = [0.0; MECHANICS];
        columns.copy_from_slice(&integrals.twice[..MECHANICS]);
        let rate = self.mean_rate();
        Row {
            time_s: edge.time_s - start_s,
            angle_rad: edge.ideal_counts() * self.count_rad - integrals.twice[MECHANICS],
            columns,
            phase: edge.phase(),
            blur_rad: rate * edge.blur_s / 12f64.sqrt(),
        }
    }

    /// rad/s, over the whole piece.
    fn mean_rate(&self) -> f64 {
        let (first, last) = (&self.edges[0], &self.edges[self.edges.len() - 1]);
        let counts = (f64::from(last.number) - f64::from(first.number)).abs();
        counts * self.count_rad / (last.time_s - first.time_s).max(TICK_F64_S)
    }
}

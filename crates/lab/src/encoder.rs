//! What an encoder's own edges say of it, from a joint that turns evenly: where the four kinds of edges lie, a disc beside its axis,
//! edges that were lost.

use std::f64::consts::TAU;

use tracelight_rig::{Actuation, Head, Joint, TICK_F64_S};

use crate::eccentric::{Crossing, eccentricity};
use crate::regression::Uncertain;
use crate::start::come_to_speed;

/// An edge, and when it was crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeTime {
    /// s.
    pub time_s: f64,
    /// Number of the edge: that below count n is n.
    pub edge: i32,
}

/// How a joint is turned to look at its encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    /// Voltage that speeds it up, V,
    pub start_v: f64,
    /// and what holds it there, V.
    pub hold_v: f64,
    /// The speed, rad/s; with a sign.
    pub rate_rad_s: f64,
    /// Width of a count, rad.
    pub count_rad: f64,
    /// Turns to look at.
    pub turns: f64,
}

/// What was found of an encoder.
#[derive(Clone, Debug, PartialEq)]
pub struct EncoderTable {
    /// Edges that were looked at.
    pub edges: usize,
    /// How far the edges below counts n with n mod 4 = 0 … 3 lie beyond their places, counts; their mean is none.
    pub kinds_counts: [Uncertain; PHASES],
    /// Error of the disc over a turn, counts, and at which angle it is largest, rad; `None` if no run has two turns of even motion.
    pub eccentricity: Option<(Uncertain, f64)>,
    /// Where counts were lost, or made up.
    pub lost: Vec<Lost>,
    /// What is left of each edge once all that is taken out, rms counts.
    pub left_counts: f64,
}

/// Counts that are wrong from some moment on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lost {
    /// s.
    pub time_s: f64,
    /// The count by then.
    pub count: i32,
    /// How many are missing in the direction of the motion; negative: too many.
    pub counts: i32,
}

/// Kinds of edges of a quadrature encoder.
const PHASES: usize = 4;
/// Edges on either side by which an edge is judged: a multiple of the kinds.
const REACH: usize = 24;
/// Edges of a run that is worth looking at.
const LEAST_EDGES: usize = 8 * REACH;

/// Spins a joint that may turn on and on, and notes every tick's last edge.
pub fn spin(head: &mut impl Head, joint: Joint, how: &Spin) -> Vec<EdgeTime> {
    let mut last: Option<i32> = None;
    let mut tick = |volts: f64| {
        let mut actuation = Actuation::default();
        actuation.command_v[joint] = volts as f32;
        let seen = head.exchange(&actuation).encoders[joint];
        let moved = last.map_or(0, |count| seen.count.wrapping_sub(count));
        last = Some(seen.count);
        (moved, seen)
    };
    let way = how.count_rad * how.rate_rad_s.signum();
    come_to_speed(|| way * f64::from(tick(how.start_v).0), how.rate_rad_s);
    let ticks = (how.turns * TAU / how.rate_rad_s.abs() / TICK_F64_S).ceil() as usize;
    let mut edges = Vec::new();
    for number in 0..ticks {
        let (moved, seen) = tick(how.hold_v);
        if moved == 0 {
            continue;
        }
        // unstamped: in the middle of its part of the tick
        let age = seen.edge_age_ticks.map_or(0.5 / f64::from(moved.unsigned_abs()), f64::from);
        let time_s = (number as f64 + 1.0 - age) * TICK_F64_S;
        edges
            .push(EdgeTime { time_s, edge: if moved > 0 { seen.count } else { seen.count.wrapping_add(1) } });
    }
    edges
}

/// What edges say of their encoder: of a joint that turned evenly, once or to and fro, each run one way. `None` of too few edges.
/// A smooth motion is laid through the edges about each edge; it lies beside it by where the edge is not in its place. All runs are of one
/// counter, in order: what it lost in one is missing in all that follow. `None` as well of times that do not rise, and of a kind of edge that is
/// never seen.
pub fn encoder_table(runs: &[Vec<EdgeTime>], count_rad: f64) -> Option<EncoderTable> {
    let (mut lost, mut missing) = (Vec::new(), 0);
    let mut runs: Vec<Run> =
        runs.iter().filter_map(|edges| Run::new(edges, &mut missing, &mut lost)).collect();
    // the motion is laid through edges that lie beside their places: again, with what was found
    let mut table = [0.0; PHASES];
    for _ in 0..3 {
        runs.iter_mut().for_each(|run| run.judge(&table));
        table = kinds(&runs)?.map(|kind| kind.value);
    }
    let kinds_counts = kinds(&runs)?;
    let left = runs.iter().flat_map(|run| run.beside.iter().map(|(k, beside)| beside - table[run.kind(*k)]));
    let (count, squares) = left.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v * v));
    Some(EncoderTable {
        edges: runs.iter().map(|run| run.edges.len()).sum(),
        kinds_counts,
        eccentricity: eccentricity(
            &runs.iter().map(|run| run.crossings(&table, count_rad)).collect::<Vec<_>>(),
        ),
        lost,
        left_counts: f64::sqrt(squares / f64::max(count, 1.0)),
    })
}

/// A run one way.
struct Run {
    edges: Vec<EdgeTime>,
    /// How far beyond its place each edge lies that has enough beside it, counts: by its number in `edges`.
    beside: Vec<(usize, f64)>,
}

impl Run {
    /// Counts that were lost are put back, so that edges keep their kinds; `missing` are those that runs before have lost. `None` of too few
    /// edges, or of times that do not rise.
    fn new(edges: &[EdgeTime], missing: &mut i32, lost: &mut Vec<Lost>) -> Option<Self> {
        /// One loss may hide another beside it.
        const PASSES: usize = 4;
        let rising = edges.windows(2).all(|pair| pair[0].time_s < pair[1].time_s);
        if edges.len() < LEAST_EDGES || !rising {
            return None;
        }
        let way = (edges[edges.len() - 1].edge.wrapping_sub(edges[0].edge)).signum();
        let edges = edges.iter().map(|e| EdgeTime { edge: e.edge.wrapping_add(*missing), ..*e }).collect();
        let mut run = Self { edges, beside: Vec::new() };
        let mut table = [0.0; PHASES];
        for _ in 0..PASSES {
            let jumps = run.jumps(&table);
            let (mut more, mut next) = (0_i32, jumps.iter().peekable());
            for (k, edge) in run.edges.iter_mut().enumerate() {
                if let Some((_, counts)) = next.next_if(|(at, _)| *at == k) {
                    more += counts;
                    lost.push(Lost { time_s: edge.time_s, count: edge.edge, counts: counts * way });
                }
                edge.edge = edge.edge.wrapping_add(more);
            }
            *missing += more;
            // what lies beside its place hides what is lost
            run.judge(&table);
            table = kinds(std::slice::from_ref(&run)).map_or(table, |kinds| kinds.map(|kind| kind.value));
        }
        Some(run)
    }

    /// Where counts are missing, and how many: where the motions before and after an edge are furthest apart, by more than times that are
    /// not exact put them.
    fn jumps(&self, table: &[f64; PHASES]) -> Vec<(usize, i32)> {
        const LEAST: f64 = 0.5;
        const DEVIATIONS: f64 = 8.0;
        let all: Vec<f64> = (REACH..self.edges.len() - REACH).map(|k| self.jump(k, table)).collect();
        let mut sizes: Vec<f64> = all.iter().map(|jump| jump.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        // half of what is normally distributed lies within 0.674 deviations
        let deviation = sizes.get(sizes.len() / 2).map_or(0.0, |median| median / 0.674);
        let clear = LEAST.max(DEVIATIONS * deviation);
        let mut found = Vec::new();
        let mut k = 0;
        while k < all.len() {
            if all[k].abs() < clear {
                k += 1;
                continue;
            }
            // it is in the window from here on
            let end = (k + SIDE).min(all.len());
            let at = (k..end).max_by(|&a, &b| all[a].abs().total_cmp(&all[b].abs())).unwrap_or(k);
            found.push((at + REACH, all[at].round() as i32));
            k = at + SIDE;
        }
        found
    }

    /// How many counts are missing from edge k on, by the motions before and after it.
    fn jump(&self, k: usize, table: &[f64; PHASES]) -> f64 {
        let edges = &self.edges;
        let middle_s = 0.5 * (edges[k - 1].time_s + edges[k].time_s);
        let base = edges[k - 1].edge;
        let at = |range: std::ops::Range<usize>| {
            let place = |i: usize| f64::from(edges[i].edge.wrapping_sub(base)) + table[self.kind(i)];
            parabola(range.map(|i| (edges[i].time_s - middle_s, place(i))))
        };
        at(k - SIDE..k).zip(at(k..k + SIDE)).map_or(0.0, |(before, after)| before - after)
    }

    /// Its edges as a disc is judged by them.
    fn crossings(&self, table: &[f64; PHASES], count_rad: f64) -> Vec<Crossing> {
        let first = self.edges.first().map_or(0, |edge| edge.edge);
        let crossing = |(k, edge): (usize, &EdgeTime)| Crossing {
            time_s: edge.time_s,
            angle_rad: f64::from(edge.edge) * count_rad,
            counts: f64::from(edge.edge - first) + table[self.kind(k)],
        };
        self.edges.iter().enumerate().map(crossing).collect()
    }

    fn kind(&self, number: usize) -> usize {
        self.edges[number].edge.rem_euclid(PHASES as i32) as usize
    }

    /// Lays a motion through the edges about each edge, without the edge itself.
    fn judge(&mut self, table: &[f64; PHASES]) {
        let edges = &self.edges;
        let place = |k: usize| f64::from(edges[k].edge - edges[0].edge) + table[self.kind(k)];
        let beside = (REACH..edges.len() - REACH).filter_map(|k| {
            let about = (k - REACH..k).chain(k + 1..=k + REACH);
            let points = about.map(|i| (edges[i].time_s - edges[k].time_s, place(i) - place(k)));
            // where the motion is when this edge is crossed, from its place
            parabola(points).map(|at| (k, at + table[self.kind(k)]))
        });
        self.beside = beside.collect();
    }
}

/// Edges on either side by which a jump is seen.
const SIDE: usize = 12;

/// Where the parabola of least squares through these points is at zero; `None` if they tell none.
fn parabola(points: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let points: Vec<(f64, f64)> = points.collect();
    let size = points.iter().map(|(t, _)| t.abs()).fold(0.0, f64::max);
    // sums of powers, times within ±1
    let (mut s, mut b) = ([0.0; 5], [0.0; 3]);
    for (t, y) in &points {
        let x = t / size;
        let powers = [1.0, x, x * x, x * x * x, x * x * x * x];
        s.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power);
        b.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power * y);
    }
    let matrix = nalgebra::Matrix3::new(s[0], s[1], s[2], s[1], s[2], s[3], s[2], s[3], s[4]);
    let at = matrix.lu().solve(&nalgebra::Vector3::new(b[0], b[1], b[2]))?[0];
    at.is_finite().then_some(at)
}

/// The mean of each kind, and how well it is known; `None` if one is hardly seen.
fn kinds(runs: &[Run]) -> Option<[Uncertain; PHASES]> {
    const LEAST: f64 = 8.0;
    let mut sums = [(0.0, 0.0, 0.0); PHASES];
    for run in runs {
        for (k, beside) in &run.beside {
            let (count, sum, squares) = &mut sums[run.kind(*k)];
            (*count, *sum, *squares) = (*count + 1.0, *sum + beside, *squares + beside * beside);
        }
    }
    if sums.iter().any(|(count, ..)| *count < LEAST) {
        return None;
    }
    let each = sums.map(|(count, sum, squares)| {
        let mean = sum / count;
        let variance = (squares / count - mean * mean).max(0.0);
        Uncertain { value: mean, within: 1.96 * (variance / count).sqrt() }
    });
    let mean = each.iter().map(|kind| kind.value).sum::<f64>() / PHASES as f64;
    Some(each.map(|kind| Uncertain { value: kind.value - mean, ..kind }))
}

#[cfg(test)]
mod tests {
    use tracelight_sim::{Mounting, RigConfig, head_alone};

    use super::*;

    const COUNT_RAD: f64 = TAU / 4096.0;

    /// Edges of a joint that slows down a little, of a known encoder, each jittered by a hundredth of a count.
    fn made(table: [f64; 4], eccentric: f64, direction: f64, way: f64, lost_at: &[usize]) -> Vec<EdgeTime> {
        later(table, (eccentric, direction), way, lost_at, 0)
    }

    /// The same of a counter that has lost some before.
    fn later(
        table: [f64; 4],
        (eccentric, direction): (f64, f64),
        way: f64,
        lost_at: &[usize],
        before: i32,
    ) -> Vec<EdgeTime> {
        let mut dice = oorandom::Rand64::new(7);
        let mut missing = before;
        (0..20_000)
            .map(|number: usize| {
                let edge = (way * number as f64 * 3.0) as i32;
                let beside = table[edge.rem_euclid(4) as usize] + 0.02 * (dice.rand_float() - 0.5);
                let nominal = (f64::from(edge) - 0.5 + beside) * COUNT_RAD;
                // read = angle + e sin(angle + φ)
                let mut angle = nominal;
                for _ in 0..5 {
                    angle = nominal - eccentric * COUNT_RAD * (angle + direction).sin();
                }
                let way_rad = angle * way;
                // 10 rad/s t − 0.02 t²
                let time_s = (10.0 - (100.0 - 0.08 * way_rad).sqrt()) / 0.04;
                missing += way as i32 * i32::from(lost_at.contains(&number));
                EdgeTime { time_s, edge: edge - missing }
            })
            .collect()
    }

    #[test]
    fn a_known_encoder_is_found() {
        let table = [0.08, -0.05, 0.02, -0.05];
        // the way back begins with the two counts that are missing
        let runs = [made(table, 0.3, 1.0, 1.0, &[5000, 12_345]), later(table, (0.3, 1.0), -1.0, &[], 2)];
        let found = encoder_table(&runs, COUNT_RAD).unwrap();
        for (kind, wanted) in found.kinds_counts.iter().zip(table) {
            assert!((kind.value - wanted).abs() < 1e-3, "{kind:?} {wanted}");
            assert!(
                kind.within < 2e-3 && (kind.value - wanted).abs() < 3.0 * kind.within + 3e-4,
                "{found:?}"
            );
        }
        let (amplitude, direction) = found.eccentricity.unwrap();
        assert!((amplitude.value - 0.3).abs() < 3e-3, "{amplitude:?}");
        // most too much where sin(angle + 1) is 1
        assert!((direction - (0.25 * TAU - 1.0)).abs() < 0.02, "{direction}");
        assert_eq!(found.lost.iter().map(|l| l.counts).collect::<Vec<_>>(), [1, 1]);
        let expected = 15_000.0 * COUNT_RAD / 10.0;
        assert!((found.lost[0].time_s - expected).abs() < 0.1, "{:?}", found.lost[0]);
        assert!(found.left_counts < 0.01, "{}", found.left_counts);
    }

    #[test]
    fn a_perfect_encoder_is_perfect_and_few_edges_tell_nothing() {
        let found = encoder_table(&[made([0.0; 4], 0.0, 0.0, 1.0, &[])], COUNT_RAD).unwrap();
        assert!(found.kinds_counts.iter().all(|kind| kind.value.abs() < 1e-3) && found.lost.is_empty());
        assert!(found.eccentricity.unwrap().0.value < 2e-3);
        assert_eq!(encoder_table(&[made([0.0; 4], 0.0, 0.0, 1.0, &[])[..100].to_vec()], COUNT_RAD), None);
        let still = [EdgeTime { time_s: 0.0, edge: 1 }; 400].to_vec();
        assert_eq!(encoder_table(&[still], COUNT_RAD), None, "times that do not rise");
        let halved =
            made([0.0; 4], 0.0, 0.0, 1.0, &[]).into_iter().filter(|edge| edge.edge % 2 == 0).collect();
        assert_eq!(encoder_table(&[halved], COUNT_RAD), None, "two kinds are never seen");
    }

    #[test]
    fn counts_lost_beside_each_other_are_found() {
        let table = [0.08, -0.05, 0.02, -0.05];
        for lost_at in [&[5000, 5001, 5002][..], &[5000, 5040], &[3000, 9000, 9001]] {
            let found = encoder_table(&[made(table, 0.0, 0.0, 1.0, lost_at)], COUNT_RAD).unwrap();
            assert_eq!(
                found.lost.iter().map(|l| l.counts).sum::<i32>() as usize,
                lost_at.len(),
                "{:?} {:?}",
                found.lost,
                found.left_counts
            );
            for (kind, wanted) in found.kinds_counts.iter().zip(table) {
                assert!((kind.value - wanted).abs() < 2e-3, "{lost_at:?}: {kind:?} {wanted}");
            }
        }
    }

    /// The simulated head's own encoder, worn: the same whichever way and however fast it is looked at.
    #[test]
    fn the_simulated_encoder_is_found_at_any_speed() {
        let mut rig = RigConfig::worn();
        rig.truth.wear.lost_counts = 0.0;
        let of = |rate_rad_s: f64, seed| {
            let friction = rig.model.friction.pan;
            let run = |rate_rad_s: f64| {
                let hold_v = friction.torque(rate_rad_s) / rig.model.motors.pan.torque_nm_per_v;
                let how = Spin {
                    start_v: 3.0 * rate_rad_s.signum(),
                    hold_v,
                    rate_rad_s,
                    count_rad: COUNT_RAD,
                    turns: 15.0,
                };
                spin(&mut head_alone(&rig, Joint::Pan, Mounting::Fixture, seed), Joint::Pan, &how)
            };
            encoder_table(&[run(rate_rad_s), run(-rate_rad_s)], COUNT_RAD).unwrap()
        };
        for seed in [1, 2] {
            let (slow, fast) = (of(2.0, seed), of(5.0, seed));
            for (a, b) in slow.kinds_counts.iter().zip(&fast.kinds_counts) {
                assert!((a.value - b.value).abs() < 0.01, "{a:?} {b:?}");
            }
            assert!(slow.kinds_counts.iter().any(|kind| kind.value.abs() > 0.02));
            let (amplitude, _) = fast.eccentricity.unwrap();
            assert!((amplitude.value - 0.1).abs() < 0.03, "{amplitude:?}: a tenth of a count");
            assert!(slow.lost.is_empty() && fast.lost.is_empty());
        }
    }
}

use tracelight_rig::{Joint, PanTilt, RateLimit, Segment};

use crate::headroom::limit_rates;
use crate::machine::Machine;
use crate::plan::PlanPoint;

/// Longest segment, ticks: short enough that a stroke's shape and the tolerance hardly change within.
const LONGEST: usize = 32;

/// How far a segment may leave the plan at a tick, rad: half a micrometre at 1 m.
const DEVIATION_RAD: f64 = 5e-7;

/// A plan's ticks as quintic segments: position, speed and acceleration meet at every joint between two, and every
/// tick within stays within [`DEVIATION_RAD`] of the plan. The gate leads the light by the relay's delays.
pub(crate) fn compress(points: &[PlanPoint], machine: &Machine, tolerance_m: f64) -> Vec<Segment> {
    let gates = lead(points, machine.relay_on_ticks as usize, machine.relay_off_ticks as usize);
    let mut segments = Vec::new();
    let mut start = 0;
    while start + 1 < points.len() {
        let (length, coefficients) = longest(points, &gates, start);
        let angle = points[start].joints.map(|j| j.position_rad);
        segments.push(Segment {
            start_tick: start as u32,
            ticks: length as u16,
            coefficients: coefficients.map(|c| c.map(|v| v as f32)),
            tolerance_rad: machine.joint_tolerance(angle, tolerance_m),
            gate: gates[start],
            rate_limit: RateLimit::PLANNED,
        });
        start += length;
    }
    limit_rates(&mut segments, points, machine);
    segments
}

/// Gate commands that make light fall on exactly the lit ticks: earlier by the delay of each direction.
fn lead(points: &[PlanPoint], on: usize, off: usize) -> Vec<bool> {
    let mut gates = vec![false; points.len()];
    let mut at = 0;
    for run in points.chunk_by(|a, b| a.lit == b.lit) {
        let end = at + run.len();
        if run[0].lit {
            let (first, last) = (at.saturating_sub(on), end.saturating_sub(off));
            gates[first.min(last)..last].fill(true);
        }
        at = end;
    }
    gates
}

/// The longest segment from `start` that keeps to the plan and has one gate: halved until it does.
fn longest(points: &[PlanPoint], gates: &[bool], start: usize) -> (usize, PanTilt<[f64; 6]>) {
    let same_gate = gates[start..].iter().take_while(|&&g| g == gates[start]).count();
    let mut length = LONGEST.min(same_gate).min(points.len() - 1 - start).max(1);
    loop {
        let fit = PanTilt::from_fn(|j| {
            points[start].joints[j].quintic_to(&points[start + length].joints[j], length as f64)
        });
        if length == 1 || keeps_to(&points[start..=start + length], &fit) {
            return (length, fit);
        }
        length /= 2;
    }
}

fn keeps_to(points: &[PlanPoint], fit: &PanTilt<[f64; 6]>) -> bool {
    points.iter().enumerate().all(|(n, p)| {
        Joint::BOTH.iter().all(|&j| {
            let at = fit[j].iter().rev().fold(0.0, |sum, c| sum * n as f64 + c);
            (at - p.joints[j].position_rad).abs() <= DEVIATION_RAD
        })
    })
}

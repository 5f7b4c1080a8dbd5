//! A plan as G-code in joint angles: for a head whose two motors hang on a GRBL board.
//!
//! A board goes from point to point in straight lines of its axes. Each line here stands for some ticks of the plan and
//! takes as long as they do (inverse time, `G93`), so that the joints keep together and lit strokes their speed. How many
//! ticks a line stands for is decided on the wall: the spot stays near where the plan has it at the same time.

use std::fmt::Write;

use tracelight_formats::fixed;
use tracelight_grbl::BoardAxis;
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_stroke::Point;
use tracelight_trajectory::{Plan, PlanPoint};

/// Furthest that a joint may be from the plan where it is dark, rad.
const DARK_RAD: f64 = 3e-4;

/// Most ticks of one line: a second, after which a board can still be halted without a long wait.
const MOST_TICKS: usize = 1000;

/// Decimals of angles in degrees; 0.2 µm of the wall a metre away.
const DECIMALS: usize = 5;

/// Unit of the board's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisUnit {
    /// Degrees: `$100` is steps a degree.
    #[default]
    Degrees,
    /// Radians.
    Radians,
}

/// How a plan becomes G-code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadGcode {
    /// Axis of each joint.
    pub axes: PanTilt<BoardAxis>,
    /// Unit of both.
    pub unit: AxisUnit,
    /// `S` word of full light.
    pub power: f64,
    /// Furthest that the lit spot may be from where the plan has it at the same time, m.
    pub tolerance_m: f64,
}

/// A plan as a program for a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeadProgram {
    /// The G-code.
    pub text: String,
    /// Moves in it.
    pub moves: usize,
    /// Most moves that fall within one second.
    pub most_moves_a_second: usize,
}

/// A move in equal time: to the joints of a tick, over some ticks.
struct Chord {
    to: usize,
    ticks: usize,
    lit: bool,
}

/// Writes a plan for a board. `spot` is where the beam meets the wall at given joint angles (rad), in metres.
#[must_use]
pub fn head_gcode(plan: &Plan, spot: &dyn Fn(PanTilt<f64>) -> Option<Point>, how: &HeadGcode) -> HeadProgram {
    let chords = chords(&plan.points, spot, how.tolerance_m);
    let mut text = header(plan, how);
    let Some(first) = plan.points.first() else {
        text.push_str("M5\nM2\n");
        return HeadProgram { text, moves: 0, most_moves_a_second: 0 };
    };
    let mut place = how.place(first);
    let _ = writeln!(text, "G94\nG0 {place} S0\nG93");
    let mut power = String::from(" S0");
    for chord in &chords {
        let next = how.place(&plan.points[chord.to]);
        let s = chord.ticks as f64 * TICK_F64_S;
        let wanted = if chord.lit { format!(" S{}", fixed(how.power, 3)) } else { " S0".to_owned() };
        let word = if wanted == power { String::new() } else { wanted.clone() };
        if next == place {
            // a board forgets moves that lead nowhere, and their time
            let _ = writeln!(text, "G4 P{}{word}", fixed(s, 3));
        } else {
            let _ = writeln!(text, "G1 {next} F{}{word}", fixed(60.0 / s, 4));
        }
        power = wanted;
        place = next;
    }
    text.push_str("M5\nG94\nM2\n");
    HeadProgram { text, moves: chords.len(), most_moves_a_second: busiest(&chords) }
}

fn header(plan: &Plan, how: &HeadGcode) -> String {
    let (unit, per_rad) = how.unit.named();
    let axis = |joint: Joint| {
        let BoardAxis { letter, reversed } = how.axes[joint];
        format!("{letter} is {}{joint}", if reversed { "minus " } else { "" })
    };
    let most = |of: &dyn Fn(&PlanPoint) -> f64| plan.points.iter().map(of).fold(0.0, f64::max);
    let needs = |joint: Joint| {
        let speed = most(&|p| p.joints[joint].velocity_rad_s.abs()) * per_rad * 60.0;
        let acceleration = most(&|p| p.joints[joint].acceleration_rad_s2.abs()) * per_rad;
        format!(
            "; {joint} needs {} {unit}/min and {} {unit}/s^2",
            fixed(speed.ceil(), 0),
            fixed(acceleration.ceil(), 0)
        )
    };
    format!(
        "; Tracelight: joint angles, {}, {}, in {unit}, {} s\n\
         ; for GRBL in laser mode ($32=1); S{} is full power; the axis settings count steps per {unit}\n\
         {}\n{}\n\
         ; where the light is said to be on it is on at once: a relay's delay is not in it\n\
         G21 G90 G17\nM5\nM4 S0\n",
        axis(Joint::Pan),
        axis(Joint::Tilt),
        fixed(plan.duration_s(), 3),
        fixed(how.power, 3),
        needs(Joint::Pan),
        needs(Joint::Tilt),
    )
}

impl AxisUnit {
    /// Name, and how many there are in a radian.
    const fn named(self) -> (&'static str, f64) {
        match self {
            Self::Degrees => ("deg", 180.0 / std::f64::consts::PI),
            Self::Radians => ("rad", 1.0),
        }
    }
}

impl HeadGcode {
    /// Words of a place.
    fn place(&self, point: &PlanPoint) -> String {
        let (_, per_rad) = self.unit.named();
        let decimals = match self.unit {
            AxisUnit::Degrees => DECIMALS,
            AxisUnit::Radians => DECIMALS + 2,
        };
        let mut words: Vec<String> = Joint::BOTH
            .map(|joint| {
                let BoardAxis { letter, reversed } = self.axes[joint];
                let angle = point.joints[joint].position_rad * per_rad;
                format!("{letter}{}", fixed(if reversed { -angle } else { angle }, decimals))
            })
            .into();
        words.sort();
        words.join(" ")
    }
}

fn chords(
    points: &[PlanPoint],
    spot: &dyn Fn(PanTilt<f64>) -> Option<Point>,
    tolerance_m: f64,
) -> Vec<Chord> {
    let lit = |from: usize| points[from].lit && points[from + 1].lit;
    let last = points.len().saturating_sub(1);
    let (mut from, mut chords) = (0, Vec::new());
    while from < last {
        let is_lit = lit(from);
        let run = (from + 1..last).find(|&at| lit(at) != is_lit).unwrap_or(last);
        let fits = |to: usize| is_near(points, (from, to), spot, tolerance_m);
        let to = furthest(from, run.min(from + MOST_TICKS), fits);
        chords.push(Chord { to, ticks: to - from, lit: is_lit });
        from = to;
    }
    chords
}

/// The last tick that a line from `from` may lead to: doubled while it fits, then halved down to the tick.
fn furthest(from: usize, most: usize, fits: impl Fn(usize) -> bool) -> usize {
    let (mut good, mut step) = (from + 1, 2);
    let mut bad = most + 1;
    while good < most {
        let next = (from + step).min(most);
        if !fits(next) {
            bad = next;
            break;
        }
        good = next;
        step *= 2;
    }
    while bad - good > 1 {
        let middle = good.midpoint(bad);
        if fits(middle) { good = middle } else { bad = middle }
    }
    good
}

/// Whether a straight line in the joints between two ticks keeps near the plan at each tick.
fn is_near(
    points: &[PlanPoint],
    (from, to): (usize, usize),
    spot: &dyn Fn(PanTilt<f64>) -> Option<Point>,
    tolerance_m: f64,
) -> bool {
    let angle = |tick: usize| points[tick].joints.map(|joint| joint.position_rad);
    let (a, b) = (angle(from), angle(to));
    // standing apart from moving: a board waits exactly, and forgets moves that lead nowhere
    let stands = |tick: usize| points[tick].joints.map(|j| j.velocity_rad_s) == PanTilt::new(0.0, 0.0);
    let all_stand = a == b;
    (from + 1..to).all(|tick| {
        let t = (tick - from) as f64 / (to - from) as f64;
        let here = PanTilt::from_fn(|joint| a[joint] + t * (b[joint] - a[joint]));
        let there = angle(tick);
        if !all_stand && stands(tick) && (there == a || there == b) {
            return false;
        }
        match points[tick].lit {
            true => spot(here).is_some_and(|p| p.distance(points[tick].spot) <= tolerance_m),
            false => Joint::BOTH.iter().all(|&joint| (here[joint] - there[joint]).abs() <= DARK_RAD),
        }
    })
}

/// Most moves that begin within one second of each other.
fn busiest(chords: &[Chord]) -> usize {
    let second = (1.0 / TICK_F64_S).round() as usize;
    let mut most = 0;
    let mut first = 0;
    for (i, chord) in chords.iter().enumerate() {
        while chord.to >= chords[first].to + second {
            first += 1;
        }
        most = most.max(i + 1 - first);
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::HeadPose;
    use tracelight_pipeline::{Asked, Driving, request_of};
    use tracelight_sim::RigConfig;
    use tracelight_stroke::{Drawing, Element, Path, Stroke};

    const AXES: PanTilt<BoardAxis> =
        PanTilt::new(BoardAxis { letter: 'X', reversed: false }, BoardAxis { letter: 'Y', reversed: true });

    /// A square and a circle, planned on the usual rig.
    fn planned() -> (Plan, Driving) {
        let rig = RigConfig::report();
        let wishes = request_of(&rig);
        let driving = Driving::new(rig, HeadPose::square_on(0.9144), wishes, Asked::default());
        let corners = [(-0.2, -0.1), (-0.1, -0.1), (-0.1, 0.0), (-0.2, 0.0)].map(Point::from);
        let square = Path::polyline(&corners, true).unwrap();
        let mut circle = Path::new(Point::new(0.2, 0.1));
        circle.push(Element::Arc { centre: Point::new(0.1, 0.1), sweep: 6.0 });
        let drawing = Drawing { strokes: vec![Stroke::new(square), Stroke::new(circle)] };
        let plan = tracelight_trajectory::plan(&drawing, &driving.machine, &driving.request).unwrap();
        (plan, driving)
    }

    /// Joint angles, light and time of a program, as a board has them, a row a move.
    fn played(text: &str) -> Vec<(f64, PanTilt<f64>, bool)> {
        let (mut at, mut power, mut s) = (PanTilt::new(0.0, 0.0), 0.0, 0.0);
        let mut rows = Vec::new();
        for line in text.lines().filter(|line| !line.starts_with(';')) {
            let (mut wait, mut rate) = (0.0, f64::INFINITY);
            for word in line.split(' ') {
                let value = word[1..].parse::<f64>().unwrap_or_default();
                match &word[..1] {
                    "X" => at.pan = value.to_radians(),
                    "Y" => at.tilt = -value.to_radians(),
                    "S" => power = value,
                    "F" => rate = value,
                    "P" => wait = value,
                    _ => {}
                }
            }
            s += wait + 60.0 / rate;
            rows.push((s, at, power > 0.0));
        }
        rows
    }

    #[test]
    fn a_board_that_plays_it_is_where_the_plan_is_at_every_tick() {
        let (plan, driving) = planned();
        let spot = |angle| driving.machine.geometry.spot(&driving.pose, angle);
        let how = HeadGcode { axes: AXES, unit: AxisUnit::Degrees, power: 1000.0, tolerance_m: 5e-5 };
        let program = head_gcode(&plan, &spot, &how);
        let rows = played(&program.text);
        assert!((rows[rows.len() - 1].0 - plan.duration_s()).abs() < 1e-3 * rows.len() as f64);
        let mut row = 0;
        let (mut worst_m, mut lit_ticks) = (0.0_f64, 0);
        for (tick, point) in plan.points.iter().enumerate() {
            let s = tick as f64 * TICK_F64_S;
            while row + 1 < rows.len() && rows[row].0 < s - 1e-6 {
                row += 1;
            }
            let (before, after) = (&rows[row.max(1) - 1], &rows[row]);
            let t = if after.0 > before.0 {
                ((s - before.0) / (after.0 - before.0)).clamp(0.0, 1.0)
            } else {
                1.0
            };
            let at = PanTilt::from_fn(|j| before.1[j] + t * (after.1[j] - before.1[j]));
            if point.lit {
                lit_ticks += 1;
                worst_m = worst_m.max(spot(at).unwrap().distance(point.spot));
            }
        }
        assert!(lit_ticks > 100 && worst_m < 1e-4, "{worst_m} m over {lit_ticks} ticks");
        assert!(program.moves * 3 < plan.points.len(), "{} moves", program.moves);
    }

    #[test]
    fn light_is_on_in_moves_between_lit_ticks_only() {
        let (plan, driving) = planned();
        let spot = |angle| driving.machine.geometry.spot(&driving.pose, angle);
        let how = HeadGcode { axes: AXES, unit: AxisUnit::Degrees, power: 400.0, tolerance_m: 5e-5 };
        let rows = played(&head_gcode(&plan, &spot, &how).text);
        let on: f64 = rows.windows(2).filter(|w| w[1].2).map(|w| w[1].0 - w[0].0).sum();
        let lit = plan.points.windows(2).filter(|w| w[0].lit && w[1].lit).count() as f64 * TICK_F64_S;
        assert!((on - lit).abs() < 0.01 * lit, "{on} s of {lit} s");
        assert!(!rows[rows.len() - 1].2 || on > 0.0);
    }
}

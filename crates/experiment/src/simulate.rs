//! An array of times and angles run through the nonlinear loop: desired, actual and error, as in the 2006 report's simulation.

mod rows;
mod view;

use tracelight_chart::Colour;
use tracelight_linear::Zpk;
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{
    BenchTick, Between, Diagram, LawName, MotionArray, ObserverName, RigConfig, ScopeTick, follow_array,
};
use tracelight_task::{Failure, Task};

use crate::by_hand::ByHand;
use crate::finding::Experiment;
use crate::systems::controller;
use crate::table::Log;

pub use rows::LONGEST_S;

/// A motion, and what it is followed by.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig.
    pub rig: RigConfig,
    /// Where the joints are to be.
    pub motion: Motion,
    /// By what it is followed.
    pub followers: Followers,
    /// Whether angles are seen in counts.
    pub quantizer: bool,
    /// Whether they are seen every millisecond only.
    pub hold: bool,
    /// Largest torque of the motors, N m; if not given, as the rig's amplifiers allow.
    pub cap_nm: Option<f64>,
    /// Rest at the end, s.
    pub rest_s: f64,
    /// Of what differs from head to head, and of a random motion.
    pub seed: u64,
}

/// Where the joints are to be.
#[derive(Clone, Debug)]
pub enum Motion {
    /// A row each `t,pan,tilt`, and what joins the rows.
    Array(Log, Between),
    /// At random within 15° of straight ahead, for so long, s.
    Random(f64),
}

/// By what a motion is followed.
#[derive(Clone, Debug)]
pub struct Followers {
    /// Laws; if there is neither a law nor a controller, the rig's.
    pub laws: Vec<LawName>,
    /// How counts become position and speed; if not given, as each law is meant.
    pub observer: Option<ObserverName>,
    /// A PID that is set by hand.
    pub by_hand: ByHand,
    /// A transfer function for each joint, from error, rad, to torque, N m: formulas in which K11, K22, K11t and K22t are the report's.
    pub controllers: Option<PanTilt<String>>,
}

/// How what it was followed by followed, controllers first.
pub struct Finding {
    of: Request,
    array: MotionArray,
    entries: Vec<Entry>,
}

/// Something the array was followed by, and how.
struct Entry {
    /// A law's name, or each joint's controller.
    by: PanTilt<String>,
    colour: Colour,
    ticks: Vec<ScopeTick>,
    figures: PanTilt<Figures>,
}

/// How a joint followed.
#[derive(Clone, Copy, Debug, Default)]
struct Figures {
    rms_rad: f64,
    max_rad: f64,
    /// Mean over the rest at the end.
    final_rad: f64,
    /// Share of the time that its torque was capped.
    capped: f64,
}

/// Counts a turn of an encoder that hides nothing.
const FINE_COUNTS: u32 = 1_000_000;
/// Of a random motion.
const REACH_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;

impl Experiment for Request {
    type Finding = Finding;

    fn run(mut self, _: Task<'_>) -> Result<Finding, Failure> {
        self.set_up();
        let laws = self.followers.by_hand.apply(&mut self.rig, &Joint::BOTH, &self.followers.laws)?;
        let array = self.array()?;
        let entries = self.entries(&laws, &array)?;
        Ok(Finding { of: self, array, entries })
    }
}

impl Request {
    /// Makes the rig what is to be simulated.
    fn set_up(&mut self) {
        let rig = &mut self.rig;
        for model in [&mut rig.model, &mut rig.truth.model] {
            if !self.quantizer {
                model.encoder.counts_per_rev = FINE_COUNTS;
            }
            if let Some(cap_nm) = self.cap_nm {
                for joint in Joint::BOTH {
                    let motor = &mut model.motors[joint];
                    motor.limit_v = motor.dead_band_v + cap_nm / motor.torque_nm_per_v;
                }
            }
        }
    }

    fn array(&self) -> Result<MotionArray, Failure> {
        let range_rad = self.rig.model.geometry.range_rad;
        match &self.motion {
            Motion::Array(log, between) => rows::read(log, *between, range_rad),
            Motion::Random(length_s) => {
                let reach = range_rad.map(|(lower, upper)| REACH_RAD.min(upper).min(-lower).max(0.0));
                MotionArray::random(self.seed, *length_s, reach)
                    .map_err(|e| Failure::failed("motion-array", e))
            }
        }
    }

    fn entries(&self, laws: &[LawName], array: &MotionArray) -> Result<Vec<Entry>, Failure> {
        let rig = &self.rig;
        let mut runs = Vec::new();
        if let Some(by) = &self.followers.controllers {
            let controllers = PanTilt::new(controller(&by.pan)?, controller(&by.tilt)?);
            runs.push((by.clone(), self.by_controllers(array, controllers)?));
        }
        if !self.hold && (runs.is_empty() || !laws.is_empty()) {
            let message = "--hold off is for a --controller: a law is a program that runs every millisecond";
            return Err(Failure::usage("usage", message));
        }
        let own = [rig.control.law];
        let named = if laws.is_empty() && runs.is_empty() { &own[..] } else { laws };
        for &law in named {
            let mut rig = rig.clone();
            rig.set_law(law, self.followers.observer);
            runs.push((PanTilt::from_fn(|_| law.name().to_owned()), self.by_law(&rig, array)));
        }
        let entry = |((by, ticks), colour): ((PanTilt<String>, Vec<ScopeTick>), Colour)| {
            let figures = PanTilt::from_fn(|j| self.figures(&ticks, j));
            Entry { by, colour, ticks, figures }
        };
        let sound = |tick: &ScopeTick| {
            Joint::BOTH.iter().all(|&j| tick.angle_rad[j].is_finite() && tick.torque_nm[j].is_finite())
        };
        if let Some((by, _)) = runs.iter().find(|(_, ticks)| !ticks.iter().all(sound)) {
            let message =
                format!("{}: the angles grow beyond all numbers: less gain, or a lower --cap", by.pan);
            return Err(Failure::failed("no-such-design", message));
        }
        Ok(runs.into_iter().zip(Colour::in_turn()).map(entry).collect())
    }

    fn by_law(&self, rig: &RigConfig, array: &MotionArray) -> Vec<ScopeTick> {
        let ticks = follow_array(rig, array, self.rest_s, self.seed);
        let torque_nm = |tick: &BenchTick, j| rig.model.motors[j].torque_nm(f64::from(tick.command_v[j]));
        let shown = |(number, tick): (usize, &BenchTick)| ScopeTick {
            set_rad: array.at(number as f64 * TICK_F64_S).map(|motion| motion.position_rad),
            angle_rad: tick.angle_rad,
            torque_nm: PanTilt::from_fn(|j| torque_nm(tick, j)),
        };
        ticks.iter().enumerate().map(shown).collect()
    }

    fn by_controllers(
        &self,
        array: &MotionArray,
        controllers: PanTilt<Zpk>,
    ) -> Result<Vec<ScopeTick>, Failure> {
        let diagram = Diagram {
            head: self.rig.truth.model,
            controllers,
            cap_nm: self.limits_nm(),
            quantum_rad: self.quantizer.then(|| self.rig.truth.model.encoder.count_rad()),
            hold_ticks: self.hold.then_some(1),
        };
        diagram.follow(array, self.rest_s).map_err(|e| {
            Failure::failed(
                "no-such-design",
                format!("--controller: {e}; give a derivative a filter, such as s/(1 + s/50)"),
            )
        })
    }

    /// Largest torques of the motors, N m.
    fn limits_nm(&self) -> PanTilt<f64> {
        self.rig.model.motors.map(|motor| motor.torque_limit_nm())
    }

    fn figures(&self, ticks: &[ScopeTick], joint: Joint) -> Figures {
        let errors = ticks.iter().map(|tick| tick.set_rad[joint] - tick.angle_rad[joint]);
        let (count, cap) = (ticks.len().max(1) as f64, (1.0 - 1e-6) * self.limits_nm()[joint]);
        let rest = (0.5 * self.rest_s / TICK_F64_S).ceil() as usize;
        let last = errors.clone().skip(ticks.len().saturating_sub(rest));
        Figures {
            rms_rad: (errors.clone().map(|e| e * e).sum::<f64>() / count).sqrt(),
            max_rad: errors.map(f64::abs).fold(0.0, f64::max),
            final_rad: last.clone().map(f64::abs).sum::<f64>() / last.count().max(1) as f64,
            capped: ticks.iter().filter(|tick| tick.torque_nm[joint].abs() >= cap).count() as f64 / count,
        }
    }
}

impl Entry {
    /// What it was followed by, in one.
    fn name(&self) -> String {
        let PanTilt { pan, tilt } = &self.by;
        if pan == tilt { pan.clone() } else { format!("{pan} on pan, {tilt} on tilt") }
    }
}

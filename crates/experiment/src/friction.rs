//! Friction as the 2006 report identified it, by voltages held, what is wrong with that, and what the whole of the curves tells.

mod plot;
mod view;

use tracelight_lab::{Curves, Side, Steady, steady, steady_of};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Task};

use crate::finding::{Experiment, Improved};
use crate::trials::{Seen, Subject, Trials};

/// What joints did under voltages, to tell their friction from.
pub struct Request(pub Seen);

/// Friction of each joint.
pub struct Finding {
    trials: Trials,
    /// What was taken for what in logs, a line each.
    said: Vec<String>,
    joints: Vec<Found>,
    better: RigConfig,
}

/// What was found of a joint.
struct Found {
    subject: Subject,
    /// Without points where no voltage was held to its end.
    steady: Steady,
    /// `None` where torques and speeds were given, not motion.
    curves: Option<Curves>,
    /// Share of the speeds' variance that the volts alone explain; of motors that somebody else measured.
    replayed: Option<f64>,
}

/// A direction's friction and inertia by volts and speeds alone.
#[derive(Clone, Copy)]
struct Unscaled {
    /// Speed for each volt beyond what friction takes.
    rad_s_per_v: f64,
    /// Volts that Coulomb friction takes, negative backwards.
    beyond_v: f64,
    /// `None` where its inertia is not told.
    time_constant_s: Option<f64>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let Seen { of: trials, subjects, said } = self.0;
        let joints = subjects
            .into_iter()
            .map(|subject| found(subject, trials.holds()))
            .collect::<Result<Vec<_>, _>>()?;
        let mut better = trials.rig.clone();
        joints.iter().for_each(|one| one.tell(&mut better));
        Ok(Finding { trials, said, joints, better })
    }
}

impl Improved for Finding {
    fn rig(&self) -> &RigConfig {
        &self.trials.rig
    }

    // the rig with the friction that was found
    fn better(&self) -> &RigConfig {
        &self.better
    }
}

fn found(subject: Subject, holds: bool) -> Result<Found, Failure> {
    let trials: Vec<_> = subject.trials.iter().collect();
    let believed = &subject.believed;
    if trials.is_empty() {
        let steady = steady_of(subject.points.clone());
        if steady.pos.is_none() && steady.neg.is_none() {
            let message = format!(
                "{}: three torques at speeds that differ are needed in one direction at least",
                subject.joint
            );
            return Err(Failure::failed("friction", message));
        }
        return Ok(Found { steady, curves: None, subject, replayed: None });
    }
    let held = if holds { trials.as_slice() } else { &[] };
    let steady = steady(held, |volts| believed.torque_nm(volts), believed.count_rad);
    let curves = subject.curves()?;
    let replayed = subject.replayed(&curves);
    Ok(Found { steady, curves: Some(curves), subject, replayed })
}

impl Found {
    /// The best that is known, forwards and backwards.
    fn sides(&self) -> [Option<Side>; 2] {
        match &self.curves {
            Some(curves) => [curves.pos, curves.neg],
            None => self.as_the_report(),
        }
    }

    /// Lines through the last speeds.
    fn as_the_report(&self) -> [Option<Side>; 2] {
        [self.steady.pos, self.steady.neg].map(|line| line.map(|line| line.side()))
    }

    /// Share that is explained.
    fn r2(&self) -> f64 {
        let lines = [self.steady.pos, self.steady.neg].into_iter().flatten();
        self.curves.as_ref().map_or_else(|| lines.map(|l| l.r2).fold(1.0, f64::min), |curves| curves.r2)
    }

    /// What does not depend on the torque per volt that the rig file believes, forwards and backwards; of other people's motors.
    fn unscaled(&self) -> Option<[Option<Unscaled>; 2]> {
        let torque = self.subject.believed.torque_nm_per_v;
        let inertia =
            self.curves.as_ref().and_then(|curves| curves.inertia_kg_m2).map(|inertia| inertia.value);
        let of = |side: Side| Unscaled {
            rad_s_per_v: torque / side.viscous.value,
            beyond_v: side.coulomb_nm.value / torque,
            time_constant_s: inertia.map(|inertia| inertia / side.viscous.value),
        };
        // what may as well be nothing is no slope to divide by
        let told = |side: &Side| side.viscous.value > side.viscous.within;
        self.subject.foreign.then(|| self.sides().map(|side| side.filter(told).map(of)))
    }

    /// Time in which a speed comes to what its voltage allows but for 1/e, s.
    fn time_constant_s(&self) -> Option<f64> {
        let curves = self.curves.as_ref()?;
        let believed = (!self.subject.foreign).then_some(self.subject.believed.inertia_kg_m2);
        let inertia = curves.inertia_kg_m2.map(|inertia| inertia.value).or(believed)?;
        let viscous = [curves.pos, curves.neg].into_iter().flatten().map(|side| side.viscous.value);
        let slowest = viscous.fold(f64::INFINITY, f64::min);
        (slowest > 0.0).then_some(inertia / slowest)
    }

    /// Puts it into a model. Friction that comes out below nothing is nothing.
    fn tell(&self, rig: &mut RigConfig) {
        let joint = self.subject.joint;
        // torques that were measured are the motor's own; volts have its own voltage in what they tell
        let by_volts =
            !self.subject.trials.is_empty() || self.steady.points.iter().any(|point| point.volts.is_some());
        let mut friction = if by_volts { rig.model.felt_friction(joint) } else { rig.model.friction[joint] };
        let [pos, neg] = self.sides();
        if let Some(pos) = pos {
            (friction.viscous_pos, friction.coulomb_pos_nm) =
                (pos.viscous.value.max(0.0), pos.coulomb_nm.value.max(0.0));
        }
        if let Some(neg) = neg {
            (friction.viscous_neg, friction.coulomb_neg_nm) =
                (neg.viscous.value.max(0.0), neg.coulomb_nm.value.min(0.0));
        }
        if by_volts {
            rig.model.set_felt_friction(joint, friction);
        } else {
            rig.model.friction[joint] = friction;
        }
    }
}

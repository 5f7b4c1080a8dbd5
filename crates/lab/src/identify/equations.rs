//! One joint's equation of motion in numbers: what is believed, what was found, and the way between them and a rig.

use tracelight_dynamics::{Friction, Lumped, Motor};
use tracelight_maths::{exp, hypot, ln, powi, sin_cos};
use tracelight_rig::{Joint, Telemetry};
use tracelight_sim::{Cable, Identified, Quirks, RigConfig, Ripple};

use super::edge::{Edge, PHASES};

/// Mechanical unknowns: θ of [`acts`], in that order.
pub(super) const MECHANICS: usize = 12;

/// Places in θ.
const GAIN: usize = 0;
const VISCOUS_POS: usize = 1;
const VISCOUS_NEG: usize = 2;
const COULOMB_POS: usize = 3;
const COULOMB_NEG: usize = 4;
const BREAK_AWAY: usize = 5;
const GRAVITY_C: usize = 6;
const GRAVITY_S: usize = 7;
pub(super) const RIPPLE_SIN: usize = 8;
pub(super) const RIPPLE_COS: usize = 9;
const LOAD: usize = 10;
const SPRING: usize = 11;

/// How well a torque per volt, an inertia and a weight are known before anything was seen, as shares. Counts and volts tell
/// only what they are to each other; what their products leave open is shared out by these. An amplifier's
/// gain is what drifts: the original rig's pan gave a fifth less than its data sheet. Inertia is mostly the rotor's.
const GAIN_DEVIATION: f64 = 0.2;
const INERTIA_DEVIATION: f64 = 0.05;
const WEIGHT_DEVIATION: f64 = 0.05;

/// How far Coulomb friction, and its ripple, may be from what is believed before anything was seen, as shares of it.
const FRICTION_SHARE: f64 = 0.4;
const RIPPLE_SHARE: f64 = 0.1;

/// One joint's equation of motion; everything over its inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Equations {
    /// rad/s² a volt beyond the dead band, 1/s each way, rad/s² each way, rad/s² at standstill, rad/s² of gravity
    /// with cos and sin of tilt, of a ripple with sin and cos, of cables at zero and a radian.
    pub(super) theta: [f64; MECHANICS],
    /// How far each kind of edge lies beyond its place, counts.
    pub(super) edges_counts: [f64; PHASES],
    /// Periods a turn with which friction ripples; zero for none.
    pub(super) periods: f64,
    /// Speed at which the break-away excess has fallen to 1/e, rad/s.
    pub(super) break_away_rad_s: f64,
    /// Deviation of each θ before anything was seen; zero for what the joint has none of.
    pub(super) deviations: [f64; MECHANICS],
    /// Inertia that is believed, kg m².
    inertia_kg_m2: f64,
}

/// What drives a joint, and what Coulomb friction holds either way without break-away; rad/s².
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    pub(super) drive: f64,
    pub(super) pos: f64,
    pub(super) neg: f64,
}

/// What is known of a head wherever it is, for one joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings {
    lumped: Lumped,
    motor: Motor,
    joint: Joint,
    break_away_rad_s: f64,
}

impl Surroundings {
    pub(super) fn of(rig: &RigConfig, joint: Joint, equations: &Equations) -> Self {
        Self {
            lumped: rig.model.bodies.lumped(),
            motor: rig.model.motors[joint],
            joint,
            break_away_rad_s: equations.break_away_rad_s,
        }
    }

    /// What a unit of each unknown does to the joint at an angle and a rate in a tick, and what is known without them; rad/s².
    /// Where the inertia is not what it is straight ahead, torques do more or less. A ripple is friction's affair, whose number of
    /// periods is not asked here.
    pub(super) fn acts(
        &self,
        told: &Telemetry,
        (angle_rad, rate_rad_s): (f64, f64),
    ) -> ([f64; MECHANICS], f64) {
        let (lumped, joint) = (&self.lumped, self.joint);
        let tilt = match joint {
            Joint::Pan => f64::from(told.position_rad.tilt),
            Joint::Tilt => angle_rad,
        };
        let rates = told.setpoint.map(|s| f64::from(s.velocity_rad_s));
        let (mass, bias) = lumped.mass_and_bias(tilt, rates);
        let (sin, cos) = sin_cos(tilt);
        let gravity = -lumped.gravity_c * cos - lumped.gravity_s * sin;
        let (inertia, ahead, other, coriolis) = match joint {
            Joint::Pan => (mass.m11, lumped.m11_fixed + lumped.m11_cc, told.setpoint.tilt, bias.pan),
            Joint::Tilt => (mass.m22, mass.m22, told.setpoint.pan, bias.tilt - gravity),
        };
        let known = -(coriolis + mass.m12 * f64::from(other.acceleration_rad_s2)) / inertia;
        let share = ahead / inertia;
        let way = rate_rad_s.signum();
        let pick = |yes: bool, value: f64| if yes { share * value } else { 0.0 };
        let columns = [
            share * self.motor.beyond_v(f64::from(told.actuation.command_v[joint])),
            pick(way > 0.0, -rate_rad_s),
            pick(way < 0.0, -rate_rad_s),
            pick(way > 0.0, -1.0),
            pick(way < 0.0, 1.0),
            -share * way * stribeck(rate_rad_s / self.break_away_rad_s),
            share * cos,
            share * sin,
            0.0,
            0.0,
            share,
            -share * angle_rad,
        ];
        (columns, known)
    }
}

/// What a unit of Coulomb friction does, whichever way the joint turns.
pub(super) fn friction(acts: &[f64]) -> f64 {
    acts[COULOMB_POS] + acts[COULOMB_NEG]
}

/// Stribeck's curve: what is left of the break-away excess at a speed over the one at which it is 1/e; the controller's
/// own approximation, for which it is identified.
pub(super) fn stribeck(ratio: f64) -> f64 {
    powi(1.0 + 0.125 * ratio * ratio, -8)
}

impl Equations {
    /// As a rig believes them.
    pub(super) fn of(rig: &RigConfig, joint: Joint) -> Self {
        let lumped = rig.model.bodies.lumped();
        let inertia = rig.model.own_inertia_kg_m2()[joint];
        let friction = rig.model.felt_friction(joint);
        let quirks = rig.quirks_of(joint);
        let weighs = joint == Joint::Tilt;
        let weight = |part: f64| if weighs { part / inertia } else { 0.0 };
        let theta = [
            rig.model.motors[joint].torque_nm_per_v / inertia,
            friction.viscous_pos / inertia,
            friction.viscous_neg / inertia,
            friction.coulomb_pos_nm / inertia,
            -friction.coulomb_neg_nm / inertia,
            quirks.break_away_nm / inertia,
            weight(lumped.gravity_c),
            weight(lumped.gravity_s),
            quirks.ripple.sin_nm / inertia,
            quirks.ripple.cos_nm / inertia,
            quirks.cable.load_nm / inertia,
            quirks.cable.spring_nm_per_rad / inertia,
        ];
        let coulomb = rig.model.unknown_nm(joint) / inertia;
        let gravity = 0.1 * hypot(theta[GRAVITY_C], theta[GRAVITY_S]);
        let viscous = theta[VISCOUS_POS].max(theta[VISCOUS_NEG]).max(0.02);
        let part = FRICTION_SHARE * coulomb;
        // cables that pull harder than a part of friction are seen to
        let cable = 0.5 * coulomb;
        let deviations =
            [0.3 * theta[GAIN], viscous, viscous, part, part, 0.0, gravity, gravity, 0.0, 0.0, cable, cable];
        let edges_counts = quirks.edges_counts;
        let break_away_rad_s = quirks.break_away_rad_s;
        Self { theta, edges_counts, periods: 0.0, break_away_rad_s, deviations, inertia_kg_m2: inertia }
            .rippling(quirks.ripple.periods)
    }

    /// The same with friction that ripples so many times a turn, by an amount to be found; zero for none.
    pub(super) fn rippling(&self, periods: f64) -> Self {
        let mut changed = *self;
        changed.periods = periods;
        let part =
            if periods > 0.0 { RIPPLE_SHARE * self.deviations[COULOMB_POS] / FRICTION_SHARE } else { 0.0 };
        (changed.deviations[RIPPLE_SIN], changed.deviations[RIPPLE_COS]) = (part, part);
        if periods != self.periods {
            (changed.theta[RIPPLE_SIN], changed.theta[RIPPLE_COS]) = (0.0, 0.0);
        }
        changed
    }

    /// The same with other numbers.
    pub(super) fn with(&self, theta: [f64; MECHANICS], edges_counts: [f64; PHASES]) -> Self {
        Self { theta, edges_counts, ..*self }
    }

    /// The same with the break-away friction of others.
    pub(super) fn breaking_away(&self, others: &Self) -> Self {
        self.with_break_away(others.theta[BREAK_AWAY], others.break_away_rad_s)
    }

    /// The same with that break-away friction, rad/s², falling at that speed, rad/s.
    pub(super) fn with_break_away(&self, excess: f64, break_away_rad_s: f64) -> Self {
        let mut changed = *self;
        (changed.theta[BREAK_AWAY], changed.break_away_rad_s) = (excess, break_away_rad_s);
        changed
    }

    /// Coulomb friction, the stronger way, rad/s².
    pub(super) fn coulomb(&self) -> f64 {
        self.theta[COULOMB_POS].max(self.theta[COULOMB_NEG])
    }

    /// Viscous friction each way, 1/s.
    pub(super) fn viscous(&self) -> (f64, f64) {
        (self.theta[VISCOUS_POS], self.theta[VISCOUS_NEG])
    }

    /// What balances in a tick, where the joint was taken to be.
    pub(super) fn balance(&self, at: &Surroundings, told: &Telemetry) -> Balance {
        let angle_rad = f64::from(told.position_rad[at.joint]);
        // as if it turned positively, to have friction's share
        let (columns, known) = at.acts(told, (angle_rad, 1.0));
        let theta = &self.theta;
        let part = |k: usize| theta[k] * columns[k];
        let share = -columns[COULOMB_POS];
        let (sin, cos) = sin_cos(self.periods * angle_rad);
        let ripple = share * (theta[RIPPLE_SIN] * sin + theta[RIPPLE_COS] * cos);
        Balance {
            drive: known + [GAIN, GRAVITY_C, GRAVITY_S, LOAD, SPRING].map(part).iter().sum::<f64>(),
            pos: share * theta[COULOMB_POS] + ripple,
            neg: share * theta[COULOMB_NEG] + ripple,
        }
    }

    /// Where an edge lies, rad.
    pub(super) fn place_rad(&self, edge: &Edge, count_rad: f64) -> f64 {
        (edge.ideal_counts() + self.edges_counts[edge.phase()]) * count_rad
    }

    /// Whether a head can be so.
    pub(super) fn is_possible(&self) -> bool {
        let finite = self.theta.iter().chain(&self.edges_counts).all(|value| value.is_finite());
        // friction a little below nothing is nothing; much below is no friction
        let coulomb = self.theta[COULOMB_POS].min(self.theta[COULOMB_NEG]);
        let least = -0.1 * self.deviations[COULOMB_POS];
        // an edge beyond half a count is the next one
        let placed = self.edges_counts.iter().all(|edge| edge.abs() < 0.5);
        finite && placed && self.theta[GAIN] > 0.0 && coulomb > least
    }

    /// Writes into a rig's model what these equations say of it, and into what is identified what its model has no word for.
    ///
    /// θ leaves open one factor common to inertia, torque per volt, friction and weight. It is chosen where
    /// (ln J/J₀)²/σ_J² + (ln k/k₀)²/σ_k² + (ln G/G₀)²/σ_G² is least.
    pub(super) fn tell(&self, rig: &mut RigConfig, joint: Joint, residual_counts: f64) {
        let inertia = self.inertia_kg_m2 * self.scale(rig, joint);
        let theta = self.theta.map(|value| value * inertia);
        let model = &mut rig.model;
        model.motors[joint].torque_nm_per_v = theta[GAIN];
        let felt = Friction {
            viscous_pos: theta[VISCOUS_POS],
            viscous_neg: theta[VISCOUS_NEG],
            coulomb_pos_nm: theta[COULOMB_POS].max(0.0),
            coulomb_neg_nm: -theta[COULOMB_NEG].max(0.0),
        };
        model.set_felt_friction(joint, felt);
        if joint == Joint::Tilt {
            model.set_weight([theta[GRAVITY_C], theta[GRAVITY_S]]);
        }
        model.set_own_inertia(joint, inertia);
        let known = rig.identified.get_or_insert(Identified::NONE);
        known.residual_counts[joint] = residual_counts;
        known.quirks[joint] = Quirks {
            break_away_nm: theta[BREAK_AWAY].max(0.0),
            break_away_rad_s: self.break_away_rad_s,
            edges_counts: self.edges_counts,
            ripple: Ripple { periods: self.periods, sin_nm: theta[RIPPLE_SIN], cos_nm: theta[RIPPLE_COS] },
            cable: Cable { load_nm: theta[LOAD], spring_nm_per_rad: theta[SPRING] },
        };
    }

    /// Inertia over that believed.
    fn scale(&self, rig: &RigConfig, joint: Joint) -> f64 {
        let precision = |deviation: f64| 1.0 / (deviation * deviation);
        let torque_per_volt = rig.model.motors[joint].torque_nm_per_v;
        let gain = ln(self.theta[GAIN] * self.inertia_kg_m2 / torque_per_volt);
        let (mut pull, mut sum) =
            (gain * precision(GAIN_DEVIATION), precision(GAIN_DEVIATION) + precision(INERTIA_DEVIATION));
        let lumped = rig.model.bodies.lumped();
        let believed = hypot(lumped.gravity_c, lumped.gravity_s);
        let found = hypot(self.theta[GRAVITY_C], self.theta[GRAVITY_S]) * self.inertia_kg_m2;
        if joint == Joint::Tilt && believed > 0.0 && found > 0.0 {
            pull += ln(found / believed) * precision(WEIGHT_DEVIATION);
            sum += precision(WEIGHT_DEVIATION);
        }
        exp(-pull / sum)
    }
}

//! Makes the configurations of planner, plant and controller from a rig's.

use tracelight_aim::HeadPose;
use tracelight_control::{
    AxisConfig, Cable, Config, Creep, Drive, Foot, FrictionModel, HeadModel, MotorRating, Quirks, Ripple,
    Sway,
};
use tracelight_dynamics::{Friction, Lumped};
use tracelight_plant::{GyroscopeConfig, PlantConfig, Wear};
use tracelight_rig::{Joint, JointLimits, PanTilt, TICK_F64_S};
use tracelight_trajectory::Machine;

use crate::light_settings::standing_radius_rad;
use crate::{LawName, Model, ObserverName, RigConfig};

/// How far past the end of its range a joint may be before that is a fault, counts.
const RANGE_MARGIN_COUNTS: f64 = 3.0;

/// Factor by which a joint's speed may exceed the planner's limit. Between two ticks a segment
/// goes slightly beyond the planned ticks, and trimming adds a little more.
const MOTION_MARGIN: f64 = 1.1;
/// Factor for the acceleration: a sigmoid begins and ends with a jump of its speed, which a segment spreads over a tick or two.
const ACCELERATION_MARGIN: f64 = 4.0;
/// Share of the speed up to which what a plan may use of a motor's torque turns it, that a plan gives its joint.
const MOST_OF_ALONE: f64 = 0.8;
/// Furthest that a segment may let a joint stray, rad: 0.1 m on a target 1 m away, twice what any rig file may ask for. Routines in the dark
/// ask for half of it.
const TOLERANCE_LIMIT_RAD: f64 = 0.1;

/// A joint hops where fewer edges pass than that, counts/s: in the time from one to the next, 77 ms, one that is slower than its
/// friction lets go would stall.
const CREEP_COUNTS_S: f64 = 13.0;
/// Duration from which a reversal is hopped through, s, each way.
const TURN_S: f32 = 0.02;
/// Duration for an identified head, s: its known friction allows continuous motion for longer.
const KNOWN_TURN_S: f32 = 0.08;
/// Length of a hop, counts: half of it is what a joint that creeps is off, all of it what one that rests may be. 0.04 to 0.1 are alike
/// on heads that differ.
const HOP_COUNTS: f64 = 0.06;
/// What of a motor's torque a hop takes; gravity, friction and a weak supply need the rest.
const HOP_TORQUE_SHARE: f64 = 0.6;

impl RigConfig {
    /// What the planner believes, for a head standing at `pose`.
    pub fn machine(&self, pose: HeadPose) -> Machine {
        Machine {
            lumped: self.model.bodies.lumped(),
            friction: PanTilt::from_fn(|j| self.model.felt_friction(j)),
            motors: self.model.motors,
            torque_share: self.motion.torque_share,
            speed_limit_rad_s: PanTilt::from_fn(|j| self.speed_limit_rad_s(j)),
            acceleration_limit_rad_s2: self.motion.acceleration_limit_rad_s2,
            jerk_limit_rad_s3: self.motion.jerk_limit_rad_s3,
            tolerance_limit_rad: TOLERANCE_LIMIT_RAD,
            geometry: self.model.geometry,
            pose,
            relay_on_ticks: ticks(self.model.relay.on_s),
            relay_off_ticks: ticks(self.model.relay.off_s),
        }
    }

    /// Highest speed that a plan gives a joint, rad/s: not so high that the motor's own voltage leaves its amplifier nothing to brake or hurry it with.
    pub fn speed_limit_rad_s(&self, joint: Joint) -> f64 {
        let motor = &self.model.motors[joint];
        let wished = self.motion.speed_limit_rad_s[joint];
        // infinite where the motor has none
        let alone = motor.most_v() / motor.back_emf_v_s_per_rad;
        wished.min(MOST_OF_ALONE * self.motion.torque_share * alone)
    }

    /// What the controller believes, in its own `f32`.
    pub fn control_config(&self) -> Config {
        Config {
            model: head_model(&self.model.bodies.lumped()),
            drive: self.gentle().map_or(Drive::Volts, Drive::Pulses),
            axes: PanTilt::from_fn(|j| self.axis(j)),
            hold_limit_ticks: ticks(self.control.hold_limit_s),
            laser_on_ticks: ticks(self.model.relay.on_s),
            laser_off_ticks: ticks(self.model.relay.off_s),
            enable_on_ticks: ticks(self.model.enable.on_s),
            enable_off_ticks: ticks(self.model.enable.off_s),
            host_silence_ticks: ticks(self.control.host_silence_s),
            host_lost_ticks: ticks(self.control.host_lost_s),
            lead_ticks: 0,
            standing_ticks: self.light.standing_ticks(),
            standing_radius_rad: self.standing_radius_rad() as f32,
            tolerance_limit_rad: TOLERANCE_LIMIT_RAD as f32,
            foot: Foot {
                jolt_rad_s: self.safety.jolt_rad_s as f32,
                turned_rad: self.safety.turned_rad as f32,
                sway: self.sway(),
            },
            park_rad: self.safety.parked_rad().map(|park| park.map(|angle| angle as f32)),
        }
    }

    /// How what it stands on is believed to give way, if it does.
    fn sway(&self) -> Option<Sway> {
        let foot = &self.model.foot;
        let own = self.model.own_inertia_kg_m2();
        let rotors = &self.model.bodies.rotor_kg_m2;
        (foot.resonance_hz > 0.0).then(|| Sway {
            carried_share: PanTilt::from_fn(|j| ((own[j] - rotors[j]) / foot.inertia_kg_m2) as f32),
            rate_rad_s: (std::f64::consts::TAU * foot.resonance_hz) as f32,
            damping: foot.damping as f32,
        })
    }

    fn standing_radius_rad(&self) -> f64 {
        let counted = standing_radius_rad(self.model.encoder.count_rad(), self.control.observer_in_use());
        counted + self.unseen_rad()
    }

    fn axis(&self, joint: Joint) -> AxisConfig {
        let motor = &self.model.motors[joint];
        // a stroke may be planned up to the very end of the range: the controller forgives what control needs
        let (lower, upper) = self.model.geometry.range_rad[joint];
        let margin = RANGE_MARGIN_COUNTS * self.model.encoder.count_rad();
        let control = &self.control;
        let inertia = self.model.own_inertia_kg_m2()[joint];
        AxisConfig {
            torque_nm_per_v: motor.torque_nm_per_v as f32,
            limit_v: motor.most_v() as f32,
            back_emf_v_s_per_rad: motor.back_emf_v_s_per_rad as f32,
            dead_band_v: motor.dead_band_v as f32,
            count_rad: self.model.encoder.count_rad() as f32,
            friction: friction_model(&self.model.felt_friction(joint)),
            unknown_nm: self.model.unknown_nm(joint) as f32,
            scale_tolerance: control.scale_tolerance as f32,
            quirks: self.quirks(joint),
            observer: control.observer_in_use().config(ticks(control.observer_interval_s).max(1) as usize),
            law: control.law_config(joint, inertia),
            creep: self.creep(joint),
            rating: MotorRating {
                continuous_share: control.motor_continuous as f32,
                heating_s: control.motor_heating_s as f32,
            },
            limits: JointLimits {
                lower_rad: (lower - margin) as f32,
                upper_rad: (upper + margin) as f32,
                speed_rad_s: (MOTION_MARGIN * self.speed_limit_rad_s(joint)) as f32,
                acceleration_rad_s2: (ACCELERATION_MARGIN * self.motion.acceleration_limit_rad_s2[joint])
                    as f32,
            },
        }
    }

    /// Only for a law that knows friction, and with an observer that knows when a joint rests.
    fn creep(&self, joint: Joint) -> Option<Creep> {
        let control = &self.control;
        let can = !self.drive.kind.is_open_loop()
            && control.law == LawName::State
            && control.observer_in_use() == ObserverName::Kalman;
        if !(can && control.hops) {
            return None;
        }
        let motor = &self.model.motors[joint];
        let most_rad_s2 = motor.torque_limit_nm() / self.model.own_inertia_kg_m2()[joint];
        let count_rad = self.model.encoder.count_rad();
        Some(Creep {
            below_rad_s: (CREEP_COUNTS_S * count_rad) as f32,
            turn_s: if self.identified.is_some() { KNOWN_TURN_S } else { TURN_S },
            hop_rad: (HOP_COUNTS * count_rad) as f32,
            acceleration_rad_s2: (HOP_TORQUE_SHARE * most_rad_s2) as f32,
        })
    }

    fn quirks(&self, joint: Joint) -> Quirks {
        let found = self.quirks_of(joint);
        Quirks {
            break_away_nm: found.break_away_nm as f32,
            break_away_rad_s: found.break_away_rad_s as f32,
            edges_counts: found.edges_counts.map(|edge| edge as f32),
            ripple: Ripple {
                periods: found.ripple.periods as f32,
                sin_nm: found.ripple.sin_nm as f32,
                cos_nm: found.ripple.cos_nm as f32,
            },
            cable: Cable {
                load_nm: found.cable.load_nm as f32,
                spring_nm_per_rad: found.cable.spring_nm_per_rad as f32,
            },
        }
    }

    /// What the simulated plant is.
    pub fn plant_config(&self) -> PlantConfig {
        self.truth.model.plant_config(self.truth.gyroscope, self.truth.wear)
    }
}

impl Model {
    /// A plant that is so, with that wear.
    pub(crate) fn plant_config(&self, gyroscope: GyroscopeConfig, wear: Wear) -> PlantConfig {
        PlantConfig {
            bodies: self.bodies,
            friction: PanTilt::from_fn(|j| self.felt_friction(j)),
            motors: self.motors,
            encoder: self.encoder,
            relay: self.relay,
            enable: self.enable,
            foot: self.foot,
            gyroscope,
            wear,
        }
    }
}

fn ticks(time_s: f64) -> u32 {
    (time_s / TICK_F64_S).round() as u32
}

fn head_model(lumped: &Lumped) -> HeadModel {
    HeadModel {
        m11_fixed: lumped.m11_fixed as f32,
        m11_ss: lumped.m11_ss as f32,
        m11_sc: lumped.m11_sc as f32,
        m11_cc: lumped.m11_cc as f32,
        m12_s: lumped.m12_s as f32,
        m12_c: lumped.m12_c as f32,
        m22: lumped.m22 as f32,
        gravity_c: lumped.gravity_c as f32,
        gravity_s: lumped.gravity_s as f32,
    }
}

fn friction_model(friction: &Friction) -> FrictionModel {
    FrictionModel {
        viscous_pos: friction.viscous_pos as f32,
        viscous_neg: friction.viscous_neg as f32,
        coulomb_pos_nm: friction.coulomb_pos_nm as f32,
        coulomb_neg_nm: friction.coulomb_neg_nm as f32,
    }
}

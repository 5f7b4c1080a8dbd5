//! Joints turned by stepper motors, without encoders: what a train of step pulses makes of them.

use std::f64::consts::TAU;

use tracelight_maths::{asin, sin};

/// Full steps between two places in which the rotor rests alike: one electrical cycle of a two-phase motor.
const STEPS_PER_CYCLE: i64 = 4;

/// A two-phase stepper motor with its driver and its gear. Torques and speeds are the motor's, in front of the gear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepperDrive {
    /// Full steps of a turn of the motor; a multiple of four.
    pub full_steps_per_turn: u32,
    /// Microsteps of a full step.
    pub microsteps: u32,
    /// Turns of the motor for one of the joint.
    pub gear_ratio: f64,
    /// Greatest torque against which it holds at rest, N m.
    pub holding_torque_nm: f64,
    /// Speed up to which the driver sends the whole current through the windings, rad/s. Above, the pull-out torque falls as one over the speed.
    pub corner_rad_s: f64,
    /// Greatest speed at which a rotor at rest falls into step, rad/s.
    pub pull_in_rad_s: f64,
    /// Inertia of its rotor, kg m².
    pub rotor_kg_m2: f64,
    /// Furthest that a microstep lies beside its place, as a share of a full step; full steps lie where they should.
    pub microstep_error: f64,
}

/// What the plan asks of a joint in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepperDemand {
    /// Set angle, rad.
    pub position_rad: f64,
    /// Set speed, rad/s.
    pub velocity_rad_s: f64,
    /// Torque that this motion needs at the joint, N m: inertia, friction and weight.
    pub torque_nm: f64,
}

/// The place of a joint behind a [`StepperDrive`], tick by tick.
///
/// In step, the rotor lags the field by the angle at which the motor gives the torque that is asked: T = T₀ sin(p δ), p electrical cycles a turn
/// (Acarnley, *Stepping Motors: A Guide to Theory and Practice*, 4th ed., chapter 3). Asked more than the pull-out torque at its speed, the rotor falls
/// out of step (chapter 4). The torque of a field that runs away from it alternates, so the rotor is taken to stand. As soon as the field is slow
/// enough, the nearest place of rest catches it: what is lost are whole cycles, four full steps each (Faulhaber, *How to prevent step losses with
/// stepper motors*). Left out are resonance, the swing into the place of rest, and a weight that turns a stalled motor backwards.
#[derive(Clone, Copy, Debug)]
pub struct StepperJoint {
    drive: StepperDrive,
    /// Cycles lost so far, positive where the rotor lies behind a field that turned forwards.
    lost_cycles: i64,
    /// Angle at which the rotor stands, rad of the motor, while it is out of step.
    stalled_rad: Option<f64>,
    rotor_rad: f64,
    /// Where the field points, rad of the motor.
    field_rad: f64,
}

impl StepperDrive {
    /// Returns the angle of a full step at the joint, rad.
    pub fn full_step_rad(&self) -> f64 {
        self.motor_step_rad() / self.gear_ratio
    }

    /// Returns the angle of a microstep at the joint, rad.
    pub fn microstep_rad(&self) -> f64 {
        self.full_step_rad() / f64::from(self.microsteps)
    }

    /// Returns the torque beyond which the motor falls out of step at a speed of the joint, N m at the joint, gear losses left out.
    pub fn pull_out_nm(&self, joint_rad_s: f64) -> f64 {
        let speed = (joint_rad_s * self.gear_ratio).abs();
        let share = if speed > self.corner_rad_s { self.corner_rad_s / speed } else { 1.0 };
        self.holding_torque_nm * share * self.gear_ratio
    }

    /// Returns the angle by which a torque at the joint turns a motor at rest from where its pulses put it, rad at the joint; a full step where it
    /// is more than the motor has.
    pub fn load_angle_rad(&self, joint_nm: f64) -> f64 {
        let share = (joint_nm / self.pull_out_nm(0.0)).abs().min(1.0);
        asin(share) / self.cycles_a_turn() / self.gear_ratio
    }

    fn cycles_a_turn(&self) -> f64 {
        f64::from(self.full_steps_per_turn) / STEPS_PER_CYCLE as f64
    }

    fn motor_step_rad(&self) -> f64 {
        TAU / f64::from(self.full_steps_per_turn)
    }

    fn cycle_rad(&self) -> f64 {
        STEPS_PER_CYCLE as f64 * self.motor_step_rad()
    }

    /// Where the field points after the pulses for a joint angle, rad of the motor: a pulse goes out as soon as the set angle is halfway.
    fn field_rad(&self, joint_rad: f64) -> f64 {
        let step_rad = self.motor_step_rad();
        let micro_rad = step_rad / f64::from(self.microsteps);
        let place_rad = (joint_rad * self.gear_ratio / micro_rad).round() * micro_rad;
        place_rad + self.microstep_error * step_rad * sin(TAU * place_rad / step_rad)
    }
}

impl StepperJoint {
    /// Returns a joint in step at angle zero.
    pub const fn new(drive: StepperDrive) -> Self {
        Self { drive, lost_cycles: 0, stalled_rad: None, rotor_rad: 0.0, field_rad: 0.0 }
    }

    /// Returns the same joint in step at an angle zero that is where it is now.
    #[must_use]
    pub const fn anew(&self) -> Self {
        Self::new(self.drive)
    }

    /// Sends the pulses of a tick and returns the true angle of the joint at its end, rad.
    pub fn turn(&mut self, demand: StepperDemand) -> f64 {
        let share = demand.torque_nm / self.drive.pull_out_nm(demand.velocity_rad_s);
        let field_rad = self.drive.field_rad(demand.position_rad);
        self.field_rad = field_rad;
        if share.abs() > 1.0 {
            self.stalled_rad.get_or_insert(self.rotor_rad);
        } else if self.catches(demand.velocity_rad_s) {
            self.catch();
        }
        if self.stalled_rad.is_none() {
            self.rotor_rad = field_rad - self.lost_rad() - asin(share) / self.drive.cycles_a_turn();
        }
        self.rotor_rad / self.drive.gear_ratio
    }

    /// Returns the full steps by which the joint is behind its pulses for good, or would be if it were caught now; negative where it is ahead. No real
    /// head knows this number.
    pub fn lost_steps(&self) -> i64 {
        let cycles = self.stalled_rad.map_or(self.lost_cycles, |rotor_rad| self.cycles_behind(rotor_rad));
        cycles * STEPS_PER_CYCLE
    }

    /// Tells whether the rotor has fallen out of step and stands.
    pub const fn is_stalled(&self) -> bool {
        self.stalled_rad.is_some()
    }

    fn catches(&self, joint_rad_s: f64) -> bool {
        (joint_rad_s * self.drive.gear_ratio).abs() <= self.drive.pull_in_rad_s
    }

    fn catch(&mut self) {
        if let Some(rotor_rad) = self.stalled_rad.take() {
            self.lost_cycles = self.cycles_behind(rotor_rad);
        }
    }

    /// Cycles from a rotor that stands there to the place of rest that is nearest to where the field points.
    fn cycles_behind(&self, rotor_rad: f64) -> i64 {
        ((self.field_rad - rotor_rad) / self.drive.cycle_rad()).round() as i64
    }

    fn lost_rad(&self) -> f64 {
        self.lost_cycles as f64 * self.drive.cycle_rad()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1.8° a step, 1/16, belt 3:1.
    const DRIVE: StepperDrive = StepperDrive {
        full_steps_per_turn: 200,
        microsteps: 16,
        gear_ratio: 3.0,
        holding_torque_nm: 0.4,
        corner_rad_s: 30.0,
        pull_in_rad_s: 6.0,
        rotor_kg_m2: 0.0,
        microstep_error: 0.0,
    };

    fn at(position_rad: f64, velocity_rad_s: f64, torque_nm: f64) -> StepperDemand {
        StepperDemand { position_rad, velocity_rad_s, torque_nm }
    }

    #[test]
    fn an_unloaded_joint_follows_to_half_a_microstep() {
        let mut joint = StepperJoint::new(DRIVE);
        let worst =
            (0..5000).map(|i| f64::from(i) * 1.3e-4).map(|set| (joint.turn(at(set, 0.13, 0.0)) - set).abs());
        let worst = worst.fold(0.0, f64::max);
        let half_rad = 0.5 * DRIVE.microstep_rad();
        assert!(worst <= half_rad * (1.0 + 1e-9) && worst > 0.95 * half_rad, "{worst} rad of {half_rad}");
    }

    #[test]
    fn a_load_turns_the_rotor_by_the_arc_sine_of_its_share() {
        let mut joint = StepperJoint::new(DRIVE);
        // half of the 1.2 N m at the joint: 30° of an electrical cycle, a third of a full step
        let angle = joint.turn(at(0.0, 0.0, 0.6));
        assert!((angle + DRIVE.full_step_rad() / 3.0).abs() < 1e-12, "{angle} rad");
    }

    #[test]
    fn pull_out_torque_halves_at_twice_the_corner_speed() {
        assert_eq!(DRIVE.pull_out_nm(10.0), DRIVE.pull_out_nm(0.0));
        assert!((DRIVE.pull_out_nm(-20.0) - 0.6).abs() < 1e-12);
    }

    #[test]
    fn a_microstep_error_spares_full_steps_and_is_as_large_as_told() {
        let crooked = StepperDrive { microstep_error: 0.05, ..DRIVE };
        let error_of = |micro: f64| {
            let set = micro * crooked.microstep_rad();
            (StepperJoint::new(crooked).turn(at(set, 0.0, 0.0)) - set) / crooked.full_step_rad()
        };
        assert!(error_of(32.0).abs() < 1e-9);
        assert!((error_of(36.0) - 0.05).abs() < 1e-9, "a quarter of a full step on");
    }

    #[test]
    fn a_stalled_motor_loses_whole_cycles_and_only_when_the_field_slows_down() {
        let mut joint = StepperJoint::new(DRIVE);
        let overload = 1.01 * DRIVE.pull_out_nm(5.0);
        let stood = joint.turn(at(0.0, 5.0, 0.0));
        for i in 1..=100 {
            assert_eq!(joint.turn(at(f64::from(i) * 5e-3, 5.0, overload)), stood);
        }
        assert_eq!(
            joint.turn(at(0.5, 5.0, 0.0)),
            stood,
            "15 rad/s of the motor are too fast to fall into step"
        );
        assert!(joint.is_stalled());
        let caught = joint.turn(at(0.5, 0.0, 0.0));
        // 0.5 rad are 47.7 full steps of the motor: 12 cycles of four
        assert_eq!(joint.lost_steps(), 48);
        let field = (0.5 / DRIVE.microstep_rad()).round() * DRIVE.microstep_rad();
        assert!((field - caught - 48.0 * DRIVE.full_step_rad()).abs() < 1e-12, "{caught} rad");
        assert!((caught - stood).abs() <= 2.0 * DRIVE.full_step_rad(), "at the nearest place of rest");
    }

    #[test]
    fn an_overload_shorter_than_half_a_cycle_loses_nothing() {
        let mut joint = StepperJoint::new(DRIVE);
        joint.turn(at(0.0, 1.0, 9.0));
        let set = 1.9 * DRIVE.full_step_rad();
        joint.turn(at(set, 1.0, 9.0));
        assert!((joint.turn(at(set, 1.0, 0.0)) - set).abs() <= 0.5 * DRIVE.microstep_rad());
        assert_eq!(joint.lost_steps(), 0);
    }

    #[test]
    fn a_loss_stays_and_the_next_one_adds_to_it() {
        let mut joint = StepperJoint::new(DRIVE);
        let cycle = 4.0 * DRIVE.full_step_rad();
        let stall = |joint: &mut StepperJoint, to: f64| {
            joint.turn(at(to, 5.0, 9.0));
            joint.turn(at(to, 0.0, 0.0))
        };
        stall(&mut joint, cycle);
        assert_eq!(joint.lost_steps(), 4);
        stall(&mut joint, 3.0 * cycle);
        assert_eq!(joint.lost_steps(), 12);
        stall(&mut joint, 0.0);
        assert_eq!(joint.lost_steps(), 0, "stalled on the way back, it stands where it began");
    }

    #[test]
    fn an_ideal_motor_is_where_the_plan_is() {
        let ideal = StepperDrive { microsteps: 1 << 20, holding_torque_nm: 1e9, ..DRIVE };
        let mut joint = StepperJoint::new(ideal);
        for i in 0..2000 {
            let set = (f64::from(i) * 3e-3).sin();
            assert!((joint.turn(at(set, 3.0, 0.2)) - set).abs() < 1e-7);
        }
    }
}

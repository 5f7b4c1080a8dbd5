//! What turns a rig's joints.

use std::f64::consts::PI;

use tracelight_grbl::BoardAxis;
use tracelight_plant::{ServoDrive, StepperDrive};
use tracelight_rig::PanTilt;

/// The kind of drive of both joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// Motors with amplifiers, encoders and a control law.
    Motor,
    /// Stepper motors that follow pulses, unmeasured.
    Stepper,
    /// Hobby servos that follow pulses; they tell nobody where they are.
    Servo,
}

/// The drive of both joints. Only the table of its kind holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSettings {
    /// Which of them it is.
    pub kind: DriveKind,
    /// Stepper motors, driver and gear.
    pub stepper: StepperDrive,
    /// Axes of a Grbl board on which stepper motors hang.
    pub axes: PanTilt<BoardAxis>,
    /// Hobby servos and the board that sends their pulses.
    pub servo: ServoDrive,
}

impl DriveKind {
    /// Every kind.
    pub const ALL: [Self; 3] = [Self::Motor, Self::Stepper, Self::Servo];

    /// Returns its name in a rig file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Motor => "motor",
            Self::Stepper => "stepper",
            Self::Servo => "servo",
        }
    }

    /// Returns the kind of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Tells whether nothing measures where the joints are.
    pub const fn is_open_loop(self) -> bool {
        !matches!(self, Self::Motor)
    }
}

impl DriveSettings {
    /// Motors with encoders; the other tables hold common parts.
    pub const MOTOR: Self = Self {
        kind: DriveKind::Motor,
        stepper: NEMA_17,
        axes: PanTilt::new(
            BoardAxis { letter: 'X', reversed: false },
            BoardAxis { letter: 'Y', reversed: false },
        ),
        servo: MG996R,
    };

    /// By how much pulses are sent early, s: as long as a servo is behind them on its way at a steady speed, but for its dead band.
    pub(crate) fn lead_s(&self) -> f64 {
        match self.kind {
            DriveKind::Motor | DriveKind::Stepper => 0.0,
            DriveKind::Servo => self.servo.lag_s(),
        }
    }
}

/// A NEMA 17 motor of 42 x 38 mm on 12 V behind a belt of 20 to 60 teeth. Its data sheet (SY42STH38-1684A): 1.8 degrees a step to 5 %,
/// 1.68 A, 2.8 mH, holding torque 0.36 N m, rotor 54 g cm2.
const NEMA_17: StepperDrive = StepperDrive {
    full_steps_per_turn: 200,
    // the finest of the common A4988
    microsteps: 16,
    gear_ratio: 3.0,
    holding_torque_nm: 0.36,
    // where 12 V just drive 1.68 A through 2.8 mH: 12 / (1.68 × 2.8e-3) rad/s of an electrical cycle, 50 of which are a turn
    corner_rad_s: 51.0,
    // some 200 full steps a second, without load
    pull_in_rad_s: 6.0,
    // 54 g cm2
    rotor_kg_m2: 54e-7,
    microstep_error: 0.05,
};

/// A TowerPro MG996R on 4.8 V. Its data sheet: 0.17 s for 60 degrees, stall torque 9.4 kgf cm, dead band 5 us, pulses of 20 ms. Boards set
/// whole microseconds; 500 to 2500 us turn it by 180 degrees.
const MG996R: ServoDrive = ServoDrive {
    range_rad: PI,
    pulse_span_s: 2e-3,
    pulse_resolution_s: 1e-6,
    dead_band_s: 5e-6,
    refresh_s: 0.02,
    speed_rad_s: PI / 3.0 / 0.17,
    // a gear train of such servos comes in within some pulses
    response_s: 0.02,
    // owners of such servos find half a degree to a degree
    play_rad: 0.5 * PI / 180.0,
    stall_torque_nm: 0.92,
};

//! Sensor values and actuation of one tick.

use crate::{Inputs, PanTilt};

/// What one encoder says at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurement {
    /// Signed count: of a head, since power-up; told by a rig that was homed, count 0 is centred on angle zero.
    pub count: i32,
    /// Age of the last edge, ticks before this measurement, in `[0, 1)`; `None` when no edge came in the last
    /// tick or where the hardware does not stamp edges.
    pub edge_age_ticks: Option<f32>,
}

/// What a head says at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensed {
    /// Of each joint's encoder.
    pub encoders: PanTilt<Measurement>,
    /// Whether the laser's switch that the gate drives is closed, where something watches it: a relay's second contact.
    pub laser_on: Option<bool>,
    /// Whether light leaves the head, seen after both switches, where something sees it: a photodiode.
    pub light: Option<bool>,
    /// What its safety inputs say, and which it has.
    pub inputs: Inputs,
    /// How fast what the head stands on turns about the head's x, y and z as it stands (ahead, left, up), rad/s: a gyroscope that is fixed to the foot;
    /// `None` without one.
    pub foot_rad_s: Option<[f32; 3]>,
    /// How long the tick took that ends here, in ticks of its proper length; `None` where the hardware does not measure it.
    pub lasted_ticks: Option<f32>,
}

/// What the controller does to the motors and the laser in one tick. The laser shines through both switches: closed one by one, they are tried
/// in the dark.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuation {
    /// Command at the amplifiers' inputs, V.
    pub command_v: PanTilt<f32>,
    /// Whether the laser's switch is driven on.
    pub gate: bool,
    /// Whether there may be light at all: a second switch, in series with the first (a key relay, the laser's supply, a shutter). It
    /// falls in the tick of every fault, so that a switch that is stuck is no way for light.
    pub enable: bool,
}

impl Actuation {
    /// Whether light is wanted: both switches are driven on.
    pub const fn lights(&self) -> bool {
        self.gate && self.enable
    }
}

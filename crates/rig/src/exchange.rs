//! What a head says, and what is done to it, in a tick.

use crate::PanTilt;

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
    /// Whether the laser's switch is closed, where something watches it: a relay's second contact, a photodiode.
    pub laser_on: Option<bool>,
}

/// What the controller does to the motors and the laser in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuation {
    /// Command at the amplifiers' inputs, V.
    pub command_v: PanTilt<f32>,
    /// Whether the laser's switch is driven on.
    pub gate: bool,
}

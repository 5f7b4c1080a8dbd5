use tracelight_rig::{Joint, JointLimits, PanTilt};

use crate::axis::AxisConfig;
use crate::model::HeadModel;
use crate::watch::Foot;

/// What turns the joints, and tells where they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Motors that a law gives volts, measured by encoders.
    Volts,
    /// Steppers or servos that go where their pulses tell them, unmeasured: the joints are believed to be where they were told to be, and a count is
    /// a step of what they were told. On ways that no plan has, they keep to these bounds.
    Pulses(Gentle),
}

/// What joints surely follow, whatever else acts on them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gentle {
    /// Greatest speed, rad/s.
    pub rate_rad_s: PanTilt<f32>,
    /// Greatest acceleration, rad/s².
    pub acceleration_rad_s2: PanTilt<f32>,
    /// Greatest share of a motor's torque that an acceleration takes.
    pub torque_share: PanTilt<f32>,
}

impl Drive {
    /// Tells whether nothing measures where the joints are.
    pub const fn is_open_loop(&self) -> bool {
        matches!(self, Self::Pulses(_))
    }
}

/// Configuration of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// The model of the head.
    pub model: HeadModel,
    /// What turns both joints.
    pub drive: Drive,
    /// Each axis.
    pub axes: PanTilt<AxisConfig>,
    /// Ticks the head may need to come back to its stroke before that is a fault.
    pub hold_limit_ticks: u32,
    /// From the gate's rise to light, ticks.
    pub laser_on_ticks: u32,
    /// From the gate's fall to dark, ticks.
    pub laser_off_ticks: u32,
    /// From the enable's rise to light, by the second switch, ticks.
    pub enable_on_ticks: u32,
    /// From the enable's fall to dark, by the second switch, ticks.
    pub enable_off_ticks: u32,
    /// Ticks a host that has said it is there may be silent before it is dark and the plan's clock stands.
    pub host_silence_ticks: u32,
    /// Ticks it may be silent before that is a fault.
    pub host_lost_ticks: u32,
    /// So much of a plan must be there before it begins, ticks, unless that is all of it: what comes by a wire is held up now and then.
    pub lead_ticks: u32,
    /// How long light may stand in one place, ticks.
    pub standing_ticks: u32,
    /// Radius of a place as the head sees it, rad.
    pub standing_radius_rad: f32,
    /// Furthest that a segment may let a joint stray, rad.
    pub tolerance_limit_rad: f32,
    /// What the head stands on.
    pub foot: Foot,
    /// Where the joints go, rad, when a switch of the laser does not open; `None` where they stay as with other faults.
    pub park_rad: Option<PanTilt<f32>>,
}

/// How far a joint's end stops may lie beyond its range together, and how far off who tells where it stands may be, rad.
pub(crate) const UNHOMED_RAD: f32 = 0.2;

impl Config {
    /// Whether joints may be there, by what their encoders count. Those that count from where they were left do not know where their ranges end: only how wide they are.
    pub(crate) fn may_be_at(&self, position_rad: PanTilt<f32>, homed: bool) -> bool {
        Joint::BOTH.iter().all(|&j| {
            let (lower, upper) = self.range_rad(j, homed);
            lower <= position_rad[j] && position_rad[j] <= upper
        })
    }

    /// Where a joint may be, by what its encoder counts, rad: not homed, as far as to its end stops from wherever it was powered up.
    pub(crate) fn range_rad(&self, joint: Joint, homed: bool) -> (f32, f32) {
        let JointLimits { lower_rad, upper_rad, .. } = self.axes[joint].limits;
        let width = upper_rad - lower_rad;
        let most = width + UNHOMED_RAD;
        if homed { (lower_rad, upper_rad) } else { (-most, most) }
    }

    /// How fast a joint speeds up by that share of its motor's torque, wherever it is, at least, rad/s².
    pub(crate) fn sped_up_by(&self, joint: Joint, torque_share: f32) -> f32 {
        let axis = &self.axes[joint];
        torque_share * axis.torque_nm_per_v * axis.limit_v / self.model.own_inertia_at_most(joint)
    }
}

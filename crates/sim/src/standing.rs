//! Finds where a plan's light would stand too long, before anything is lit.

use tracelight_control::{Config, LightBudget};
use tracelight_maths::{cos, hypot};
use tracelight_rig::{PanTilt, Segment, TICK_F64_S};
use tracelight_stroke::Point;
use tracelight_trajectory::{Plan, PlanPoint};

use crate::config::RigConfig;

/// Share of the budget that a plan may use: a head that follows it comes back to where it was pushed off, and starts slowly there.
const PLANNED_SHARE: f64 = 0.9;
/// What is told of as one place: half the diagonal of the budget's squares, in radii.
const ABOUT_RADII: f64 = 2.9;

/// Light that would stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Where on the target, m.
    pub spot: Point,
    /// Number of the stroke, from 0; `None` between strokes, through the relay's delay.
    pub stroke: Option<u32>,
    /// Total time of light in this place, s.
    pub stands_s: f64,
    /// Radius of the place as the head sees it, rad.
    pub about_rad: f64,
    /// Time allowed, s.
    pub most_s: f64,
}

/// Finds the first place of a plan where light would stand too long, starting from an unspent budget.
pub fn first_standing(rig: &RigConfig, plan: &Plan) -> Option<Standing> {
    let config = rig.control_config();
    let most_s = PLANNED_SHARE * rig.light.standing_s;
    let config = Config { standing_ticks: (most_s / TICK_F64_S) as u32, ..config };
    let tick = first_spent(&config, &plan.segments)?;
    let point = plan.points.get(tick).or(plan.points.last())?;
    let about_rad = ABOUT_RADII * f64::from(config.standing_radius_rad);
    let is_near = |other: &&PlanPoint| {
        let off = PanTilt::from_fn(|j| other.joints[j].position_rad - point.joints[j].position_rad);
        hypot(off.pan * cos(point.joints.tilt.position_rad), off.tilt) <= about_rad
    };
    let lit = plan.points.iter().filter(|other| other.lit).filter(is_near).count();
    Some(Standing {
        spot: point.spot,
        stroke: point.stroke,
        stands_s: lit as f64 * TICK_F64_S,
        about_rad,
        most_s,
    })
}

/// The first tick in which a controller so configured would be dark by its light budget.
fn first_spent(config: &Config, segments: &[Segment]) -> Option<usize> {
    let mut budget = LightBudget::new();
    let mut gate = false;
    for segment in segments {
        for n in 0..segment.ticks {
            let at = segment.sample(f32::from(n));
            let angle_rad = at.map(|setpoint| setpoint.position_rad);
            budget.tick(config, Some(angle_rad), gate, None);
            gate = segment.gate;
            let rate_rad_s = at.map(|setpoint| setpoint.velocity_rad_s);
            if gate && budget.is_spent(config, Some((angle_rad, rate_rad_s))) {
                return Some(segment.start_tick as usize + usize::from(n));
            }
        }
    }
    None
}

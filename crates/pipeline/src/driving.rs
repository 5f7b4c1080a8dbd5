//! A rig where it stands, and what is asked of it.

use tracelight_aim::{HeadGeometry, HeadPose};
use tracelight_sim::RigConfig;
use tracelight_trajectory::{
    AccelerationDemand, DarkMove, LitSpeed, Machine, Plan, PlanRequest, Ramps, Shape,
};

use crate::distance::DistanceFrom;
use crate::ordering::OrderRequest;

/// 3 ft: where the original rig's camera stood.
pub const DEFAULT_DISTANCE_M: f64 = 0.9144;
/// 1 ft/s: what the original rig was to reach.
pub const DEFAULT_SPEED_M_S: f64 = 0.3048;

/// Where inertia and gravity are taken for remarks on what motors can do: the edge of the original rig's working
/// range, atan(18 in / 36 in).
const WORKING_TILT_RAD: f64 = 0.463_647_609_000_806_1;

/// With what and how a drawing is run: a rig, where it stands, what is asked of it.
#[derive(Clone, Debug)]
pub struct Driving {
    /// What draws.
    pub rig: RigConfig,
    /// Where it stands before the target.
    pub pose: HeadPose,
    /// What the planner believes of it there.
    pub machine: Machine,
    /// What is asked of a plan.
    pub request: PlanRequest,
    /// What of that somebody asked for.
    pub asked: Asked,
    /// In which order strokes are drawn.
    pub order: OrderRequest,
    /// The day of the file that says where it stands, such as 2026-11-23; `None` without one.
    pub head_date: Option<String>,
}

/// What somebody asked for, and did not leave to the rig.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Asked {
    /// A speed of the lit spot.
    pub speed: bool,
    /// An acceleration of the joints.
    pub acceleration: bool,
    /// How far the head stands from the wall.
    pub distance: DistanceFrom,
}

impl Driving {
    /// Of a rig that stands there; strokes come in whatever order saves time.
    #[must_use]
    pub fn new(rig: RigConfig, pose: HeadPose, request: PlanRequest, asked: Asked) -> Self {
        Self {
            machine: rig.machine(pose),
            rig,
            pose,
            request,
            asked,
            order: OrderRequest::default(),
            head_date: None,
        }
    }

    /// The head stands elsewhere than was told.
    pub fn stand(&mut self, pose: HeadPose) {
        self.pose = pose;
        self.machine = self.rig.machine(pose);
    }

    /// The head is built otherwise than was told, and stands elsewhere.
    pub fn believe(&mut self, geometry: HeadGeometry, pose: HeadPose) {
        self.rig.model.geometry = geometry;
        self.stand(pose);
    }

    /// What the user should know about a plan: wishes the motors do not fulfil, and a speed it never reaches.
    #[must_use]
    pub fn remarks(&self, plan: &Plan) -> Vec<String> {
        let wishes = self.machine.impossible_wishes(WORKING_TILT_RAD);
        let asked = wishes.iter().filter(|_| self.asked.acceleration);
        let mut remarks = self.rig.open_loop_remarks(self.pose.distance_m, plan.top_speed_m_s());
        remarks.extend(asked.map(wish_note));
        if let Some(bend) = &plan.tightest {
            // all but straight: it is not the bend that holds it back
            let why = if bend.radius_m < 10.0 {
                format!("bends with a radius of {:.1} mm", 1e3 * bend.radius_m)
            } else {
                "asks most of the joints".to_string()
            };
            remarks.push(format!(
                "lit at {:.4} m/s throughout instead of {:.4}: stroke {} {why} at ({:.1}, {:.1}) mm, and the motors hold no \
                 more there",
                plan.set_speed_m_s,
                self.request.speed_m_s,
                bend.stroke + 1,
                1e3 * bend.point.x,
                1e3 * bend.point.y
            ));
        }
        remarks.extend(unreached(plan));
        remarks
    }
}

/// Says that a plan reaches its speed nowhere, if it does not.
pub(crate) fn unreached(plan: &Plan) -> Option<String> {
    let (set, top) = (plan.set_speed_m_s, plan.top_speed_m_s());
    (top < REACHED * set).then(|| {
        format!("{set:.3} m/s is reached nowhere: the lines are too short or too bent; the fastest is {top:.3} m/s")
    })
}

/// A speed counts as reached from this share of it on.
pub const REACHED: f64 = 0.98;

/// What a rig's own settings ask of a plan; the rest as without any flag.
#[must_use]
pub fn request_of(rig: &RigConfig) -> PlanRequest {
    PlanRequest {
        speed_m_s: DEFAULT_SPEED_M_S,
        lit_speed: LitSpeed::default(),
        travel: DarkMove::Shaped(Shape::Ramped(Ramps::REPORT)),
        ramp_s: rig.motion.ramp_s,
        settle_s: rig.motion.settle_s,
        tolerance_m: rig.control.tolerance_m,
        corner_m: 0.0,
    }
}

fn wish_note(wish: &AccelerationDemand) -> String {
    let AccelerationDemand { joint, asked_rad_s2, needed_v, limit_v, possible_rad_s2 } = wish;
    format!(
        "{asked_rad_s2:.0} rad/s² on {joint} would need {needed_v:.0} V, its amplifier gives {limit_v:.0} V: planned \
         with what the motor has, about {possible_rad_s2:.1} rad/s² against gravity"
    )
}

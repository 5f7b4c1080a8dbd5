use tracelight_rig::{PanTilt, Segment, TICK_F64_S};
use tracelight_stroke::{Point, Vec2};

use crate::binding::Binding;
use crate::error::PlanError;
use crate::motion::JointMotion;

/// Longest job, s: its ticks are kept in memory, planned and run, at about 350 bytes each.
pub const LONGEST_S: f64 = 1800.0;

/// Where everything is to be at one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanPoint {
    /// Planned spot on the target, m.
    pub spot: Point,
    /// Planned joint motion.
    pub joints: PanTilt<JointMotion>,
    /// Torque the motors need for it, as a share of what the amplifiers allow; signed.
    pub torque_fraction: PanTilt<f32>,
    /// The limit the motion comes nearest to; none where it speeds up or slows down softly, passes a small break, or stands.
    pub limit: Option<Binding>,
    /// Whether light is to fall on the target (the gate leads it by the relay's delays).
    pub lit: bool,
    /// Number of the stroke this tick belongs to; `None` between strokes.
    pub stroke: Option<u32>,
}

/// Where the spot comes to rest at a corner or at the end of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegEnd {
    /// Tick of the rest.
    pub tick: u32,
    /// Tick at which the leg began.
    pub start_tick: u32,
    /// Place, m.
    pub point: Point,
    /// Unit vector in which the leg arrives.
    pub tangent: Vec2,
    /// Length of the leg, m.
    pub length_m: f64,
}

/// Where a drawing bends most: what bounds the speed that can be kept throughout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tightest {
    /// Number of the stroke, from 0.
    pub stroke: usize,
    /// Place, m.
    pub point: Point,
    /// Radius of curvature there, m.
    pub radius_m: f64,
    /// Speed it permits, m/s.
    pub speed_m_s: f64,
}

/// Whether a job of that length can be kept in memory.
///
/// # Errors
/// [`PlanError::TooLong`].
pub(crate) fn check_duration(needed_s: f64) -> Result<(), PlanError> {
    if needed_s <= LONGEST_S { Ok(()) } else { Err(PlanError::TooLong { needed_s, most_s: LONGEST_S }) }
}

/// A whole job in time: what is executed is exactly this.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// Segments that the controller is sent.
    pub segments: Vec<Segment>,
    /// Points of every tick, for scoring and plots; the first is tick 0, the last the rest at the end.
    pub points: Vec<PlanPoint>,
    /// Every corner and stroke end where the spot comes to rest, in time order.
    pub leg_ends: Vec<LegEnd>,
    /// Speed that lit strokes are run at where nothing holds them back, m/s.
    pub set_speed_m_s: f64,
    /// What made it less than what was asked, if one speed throughout was.
    pub tightest: Option<Tightest>,
}

impl Plan {
    /// Length of the job, s. This is the time that is executed, to the tick.
    pub fn duration_s(&self) -> f64 {
        self.points.len().saturating_sub(1) as f64 * TICK_F64_S
    }

    /// First and last lit tick of each stroke, by the stroke's number, up to the last one with light; `None` for one without.
    pub fn lit_ticks(&self) -> Vec<Option<[u32; 2]>> {
        let mut lit: Vec<Option<[u32; 2]>> = Vec::new();
        for (tick, point) in (0..).zip(&self.points).filter(|(_, point)| point.lit) {
            let Some(stroke) = point.stroke.map(|stroke| stroke as usize) else { continue };
            if lit.len() <= stroke {
                lit.resize(stroke + 1, None);
            }
            lit[stroke] = Some([lit[stroke].map_or(tick, |[first, _]| first), tick]);
        }
        lit
    }

    /// How much of it is lit, s.
    pub fn lit_s(&self) -> f64 {
        self.points.iter().filter(|p| p.lit).count() as f64 * TICK_F64_S
    }

    /// Total duration of dark moves, s, without rests.
    pub fn travel_s(&self) -> f64 {
        let moving =
            |p: &&PlanPoint| p.joints.pan.velocity_rad_s != 0.0 || p.joints.tilt.velocity_rad_s != 0.0;
        self.points.iter().filter(|p| !p.lit).filter(moving).count() as f64 * TICK_F64_S
    }

    /// Highest speed of the lit spot, m/s.
    pub fn top_speed_m_s(&self) -> f64 {
        let lit = self.points.windows(2).filter(|w| w[0].lit && w[1].lit);
        lit.map(|w| w[0].spot.distance(w[1].spot) / TICK_F64_S).fold(0.0, f64::max)
    }

    /// How much of the lit time each limit holds the spot back, as shares, the largest first; the rest is soft starts
    /// and stops, and small breaks that are passed slowly.
    pub fn limit_shares(&self) -> Vec<(Binding, f64)> {
        let lit: Vec<Option<Binding>> = self.points.iter().filter(|p| p.lit).map(|p| p.limit).collect();
        let count = |limit: Binding| lit.iter().filter(|&&l| l == Some(limit)).count();
        let mut shares: Vec<(Binding, f64)> = Binding::ALL
            .map(|limit| (limit, count(limit) as f64 / lit.len().max(1) as f64))
            .into_iter()
            .filter(|(_, share)| *share > 0.0)
            .collect();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        shares
    }

    /// Largest torque asked of a motor, as a share of its limit.
    pub fn torque_peak_fraction(&self) -> f64 {
        let of = |p: &PlanPoint| p.torque_fraction.pan.abs().max(p.torque_fraction.tilt.abs());
        f64::from(self.points.iter().map(of).fold(0.0, f32::max))
    }
}

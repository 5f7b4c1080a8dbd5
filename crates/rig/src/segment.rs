use crate::PanTilt;

/// Where one joint should be at one instant.
///
/// Produced by [`Segment::sample`]; consumed by the law once per tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Angle, rad; zero is the calibrated straight-ahead pose.
    pub position_rad: f32,
    /// Angular velocity, rad/s.
    pub velocity_rad_s: f32,
    /// Angular acceleration, rad/s².
    pub acceleration_rad_s2: f32,
}

/// A stretch of motion of both joints: one quintic polynomial a joint over a whole number of ticks.
///
/// Coefficients are Taylor-like in ticks since the segment's start, lowest order first:
/// position = Σ cᵢ nⁱ, rad. A segment carries everything the controller needs to judge itself while it runs: how
/// far the joints may stray and whether the laser is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// First tick of the segment, counted from the start of the job.
    pub start_tick: u32,
    /// Length, ticks; at least one.
    pub ticks: u16,
    /// Polynomial coefficients per joint, rad per tickⁱ.
    pub coefficients: PanTilt<[f32; 6]>,
    /// Largest following error at which the laser may stay lit, rad per joint.
    pub tolerance_rad: PanTilt<f32>,
    /// Whether the laser's switch is to be on. The planner shifts it by the relay's delays, so that *light* falls
    /// on the stroke.
    pub gate: bool,
}

impl Segment {
    /// First tick after the segment; the last tick that can be counted where that is later ([`fits`](Self::fits)).
    pub const fn end_tick(&self) -> u32 {
        self.start_tick.saturating_add(self.ticks as u32)
    }

    /// Whether its end is a tick that can be counted.
    pub const fn fits(&self) -> bool {
        self.start_tick.checked_add(self.ticks as u32).is_some()
    }

    /// The setpoint `elapsed_ticks` (fractions allowed) after the segment's start.
    pub fn sample(&self, elapsed_ticks: f32) -> PanTilt<Setpoint> {
        self.coefficients.map(|c| evaluate(&c, elapsed_ticks))
    }
}

/// Horner's rule for a quintic and its first two derivatives; ticks become seconds at the end.
fn evaluate(c: &[f32; 6], n: f32) -> Setpoint {
    let [c0, c1, c2, c3, c4, c5] = *c;
    let position = c0 + n * (c1 + n * (c2 + n * (c3 + n * (c4 + n * c5))));
    let velocity = c1 + n * (2.0 * c2 + n * (3.0 * c3 + n * (4.0 * c4 + n * (5.0 * c5))));
    let acceleration = 2.0 * c2 + n * (6.0 * c3 + n * (12.0 * c4 + n * (20.0 * c5)));
    const TICKS_PER_S: f32 = 1.0 / crate::TICK_S;
    Setpoint {
        position_rad: position,
        velocity_rad_s: velocity * TICKS_PER_S,
        acceleration_rad_s2: acceleration * TICKS_PER_S * TICKS_PER_S,
    }
}

/// What the host may tell a rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Allow light. Without it every gate stays shut. After a fault it is forgotten, the head goes back to where its job
    /// stopped, and on from there: in the dark where the fault [lost counts](crate::Fault::loses_counts), until it was homed again. It changes nothing at all unless it acknowledges
    /// every fault so far, and unless the host has said of late that it is there ([`KeepAlive`](Self::KeepAlive)).
    Arm {
        /// [`Telemetry::fault_number`](crate::Telemetry::fault_number) of what whoever arms has read. What was on its way while a fault came acknowledges another.
        acknowledges: u32,
    },
    /// Forbid light and stop the plan's clock; the head is held where that stands. Armed again, the job goes on from
    /// there; after its end, a new one may begin at tick 0.
    Disarm,
    /// Let light out for so many ticks while nobody is armed, where a job was stopped on a lit stroke and the head rests: a dot, for whoever
    /// looks where it truly is. Whatever else forbids light on a stroke forbids it here; without a host that said of late that it is there it
    /// changes nothing, and it ends when the host falls silent, or before it would stand too long.
    Point(u16),
    /// The joints stand where encoders that know where zero is read these counts; from now on these do. For a head that was just powered up, which has no job yet
    /// and rests wherever it was left. Taken only while nobody is armed and the joints rest, and only of angles within their limits; the job is forgotten, the next one begins where the head
    /// stands ([`Abandon`](Self::Abandon) takes it to zero). Until it was told, and again after a fault that loses counts, a rig is *unhomed*: it moves by counts since power-up, no further than its joints' ranges are wide, and all the light it
    /// lets out are dots ([`Point`](Self::Point), then anywhere, of a second at most, all of them a second in any ten: one for which there is no room is not lit at all), by which somebody who looks finds where it points.
    Home(PanTilt<i32>),
    /// What was told of where the joints stand is not so, or nobody knows any more: be unhomed from now on, and dark.
    Unhome,
    /// Forget the job: forbid light, go back to where both joints are at zero, and be ready for a new one that begins there at
    /// tick 0. A fault stays; arm first.
    Abandon,
    /// Append a segment; it must start where and when the one before it ends, and stay within the joints' limits all along.
    Append(Segment),
    /// The host is there: nothing is armed and no dot is lit without. Who has said so once must go on saying it: silence is a fault.
    KeepAlive,
    /// No further segment will come (one that does is a fault): running out of them is the end of the job, not a fault.
    Finish,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quintic_is_sampled_with_its_derivatives() {
        let c = [0.1, 1e-3, 2e-6, 0.0, 0.0, 0.0];
        let segment = Segment {
            start_tick: 5,
            ticks: 10,
            coefficients: PanTilt::new(c, [0.0; 6]),
            tolerance_rad: PanTilt::default(),
            gate: false,
        };
        let pan = segment.sample(10.0).pan;
        assert!((pan.position_rad - 0.1102).abs() < 1e-6);
        assert!((pan.velocity_rad_s - 1.04).abs() < 1e-5);
        assert!((pan.acceleration_rad_s2 - 4.0).abs() < 1e-4);
        assert_eq!(segment.end_tick(), 15);
    }

    #[test]
    fn a_segment_whose_end_cannot_be_counted_does_not_fit() {
        let coefficients = PanTilt::default();
        let tolerance_rad = PanTilt::default();
        let of = |start_tick| Segment { start_tick, ticks: 10, coefficients, tolerance_rad, gate: false };
        assert!(of(u32::MAX - 10).fits() && of(u32::MAX - 10).end_tick() == u32::MAX);
        assert!(!of(u32::MAX - 9).fits() && of(u32::MAX - 9).end_tick() == u32::MAX);
    }
}

use crate::{Joint, PanTilt, RateLimit, Setpoint, TICK_S, ease_per_s};

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
    /// Fastest that the plan's clock may run along it.
    pub rate_limit: RateLimit,
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

    /// The angle of one joint then, rad.
    pub fn position_rad(&self, joint: Joint, elapsed_ticks: f32) -> f32 {
        let [c0, c1, c2, c3, c4, c5] = self.coefficients[joint];
        let n = elapsed_ticks;
        c0 + n * (c1 + n * (c2 + n * (c3 + n * (c4 + n * c5))))
    }
}

impl Segment {
    /// The square of the fastest rate of the plan's clock, `elapsed_ticks` after the segment's start.
    pub fn rate_limit_squared(&self, elapsed_ticks: f32) -> f32 {
        let RateLimit { start, end } = self.rate_limit;
        let share = (elapsed_ticks / f32::from(self.ticks)).clamp(0.0, 1.0);
        start * start + (end * end - start * start) * share
    }

    /// Square of the rate at the segment's start from which a clock slows down to this rate at its end, if nothing in it turns faster than that.
    pub fn braked_from_squared(&self, end: f32, fastest_rad_s: f32) -> f32 {
        /// The clock is told of it a tick late.
        const SHARE: f32 = 0.8;
        end * end + 2.0 * SHARE * ease_per_s(fastest_rad_s) * f32::from(self.ticks) * TICK_S
    }
}

/// Horner's rule for a quintic and its first two derivatives; ticks become seconds at the end.
fn evaluate(c: &[f32; 6], n: f32) -> Setpoint {
    let [c0, c1, c2, c3, c4, c5] = *c;
    let position = c0 + n * (c1 + n * (c2 + n * (c3 + n * (c4 + n * c5))));
    let velocity = c1 + n * (2.0 * c2 + n * (3.0 * c3 + n * (4.0 * c4 + n * (5.0 * c5))));
    let acceleration = 2.0 * c2 + n * (6.0 * c3 + n * (12.0 * c4 + n * (20.0 * c5)));
    const TICKS_PER_S: f32 = 1.0 / TICK_S;
    Setpoint {
        position_rad: position,
        velocity_rad_s: velocity * TICKS_PER_S,
        acceleration_rad_s2: acceleration * TICKS_PER_S * TICKS_PER_S,
    }
}

/// Commands from the host to the rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Permit light. Without it the gate stays closed.
    ///
    /// Effects after a fault: the fault is cleared, the head returns to where its job stopped, and the job continues. If the fault [lost
    /// counts](crate::Fault::loses_counts), it stays dark until the rig is homed again.
    ///
    /// Ignored unless it acknowledges every fault so far, and unless the host has recently sent [`KeepAlive`](Self::KeepAlive).
    Arm {
        /// Latest [`Telemetry::fault_number`](crate::Telemetry::fault_number) that the sender has read. A command sent before a fault carries an
        /// older number.
        acknowledges: u32,
    },
    /// Clear a fault without permitting light, if it is the latest. Like [`Arm`](Self::Arm) and [`Disarm`](Self::Disarm) at once, but nothing can come between.
    Acknowledge {
        /// Latest [`Telemetry::fault_number`](crate::Telemetry::fault_number) that the sender has read.
        fault: u32,
    },
    /// Forbid light and stop the plan's clock, as soon as light that is still on its way out has fallen on its stroke. The head holds its
    /// position. Armed again, the job continues from there; after its end, a new one may begin at tick 0.
    Disarm,
    /// Disarm at the end of the stroke that is lit: no line is interrupted. In the dark it is the same as [`Disarm`](Self::Disarm), and
    /// [`Arm`](Self::Arm) before that end takes it back.
    Pause,
    /// Run the plan's clock at this share of the plan's own speed, until another is asked for. What is beyond [`SPEED_RANGE`](crate::SPEED_RANGE) counts as its
    /// end; what is not a number changes nothing. The rate eases there, and is never faster than a segment's [`RateLimit`] allows.
    Speed(f32),
    /// Light the laser for this many ticks while disarmed: a dot, with which an observer locates the beam.
    ///
    /// Accepted while a job is stopped on a lit stroke and the head rests. All other reasons for darkness still apply. Ignored without a recent
    /// [`KeepAlive`](Self::KeepAlive). The dot ends early if the host falls silent, or before its light would stand too long.
    Point(u16),
    /// Home: declare that the joints are at these counts. Subsequent counts are relative to it.
    ///
    /// - Accepted only while disarmed, with the joints at rest and the angles within their limits.
    /// - The current job is forgotten; the next one begins where the head is. [`Abandon`](Self::Abandon) moves it to zero.
    /// - Before homing, and after a fault that loses counts, a rig is *unhomed*. It then moves by counts since power-up, over no more than the
    ///   width of the joint ranges.
    /// - An unhomed rig lights dots only ([`Point`](Self::Point), at any place): a second at most each, and a second in any ten altogether. A dot
    ///   that would exceed this is not lit.
    Home(PanTilt<i32>),
    /// Revoke homing, because the position is wrong or unknown. The rig is unhomed and dark from now on.
    Unhome,
    /// Forget the job: forbid light, return both joints to zero, and accept a new job that begins there at tick 0. A fault persists; arm first.
    Abandon,
    /// Append a segment. Its start must join the end of the previous one, and all of it must stay within the joints' limits.
    Append(Segment),
    /// Signal that the host is alive. Nothing is armed and no dot is lit without it. Once sent, it must be repeated:
    /// silence darkens and stops the plan's clock, which goes on by itself once the host is heard again; a long silence is a fault.
    KeepAlive,
    /// Declare that no further segment will come. Running out of segments is then the end of the job; a later segment is a fault.
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
            rate_limit: RateLimit::PLANNED,
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
        let of = |start_tick| Segment {
            start_tick,
            ticks: 10,
            coefficients,
            tolerance_rad,
            gate: false,
            rate_limit: RateLimit::PLANNED,
        };
        assert!(of(u32::MAX - 10).fits() && of(u32::MAX - 10).end_tick() == u32::MAX);
        assert!(!of(u32::MAX - 9).fits() && of(u32::MAX - 9).end_tick() == u32::MAX);
    }

    #[test]
    fn between_its_ends_the_square_is_linear() {
        let segment = Segment {
            start_tick: 0,
            ticks: 10,
            coefficients: PanTilt::new([0.0, 1e-3, 0.0, 0.0, 0.0, 0.0], [0.0; 6]),
            tolerance_rad: PanTilt::default(),
            gate: false,
            rate_limit: RateLimit { start: 2.0, end: 1.0 },
        };
        for (at, squared) in [(-1.0, 4.0), (0.0, 4.0), (5.0, 2.5), (10.0, 1.0), (99.0, 1.0)] {
            assert!((segment.rate_limit_squared(at) - squared).abs() < 1e-6, "{at}");
        }
        // ten milliseconds at 0.8 / 0.4545 s
        assert!((segment.braked_from_squared(1.0, 1.0) - 1.0352).abs() < 1e-4);
    }
}

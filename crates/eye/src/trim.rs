//! A plan's segments, sent to a rig a little ahead of its clock, moved by what joints are known to be off.
//!
//! What is sent are ordinary segments: a trim changes along each of them as smoothly as the motion itself does, and slowly. The loop that runs a
//! thousand times a second knows nothing of a camera.

use tracelight_aim::Correction;
use tracelight_rig::{Joint, PanTilt, Segment, Setpoint, TICK_F64_S};
use tracelight_session::Trim;
use tracelight_trajectory::JointMotion;

/// How far ahead of the plan's clock segments are sent, ticks: a host may be held up for so long.
const AHEAD_TICKS: u32 = 250;
/// Fastest that an offset changes, rad/s, and a scale, 1/s: some two mm/s on a wall a metre away.
const OFFSET_RAD_S: f64 = 2e-3;
const SCALE_S: f64 = 5e-3;
/// Most that is trimmed: what is off by more did not drift.
const MOST_OFFSET_RAD: f64 = 0.02;
const MOST_SCALE: f64 = 0.02;

/// Trims a plan's segments on their way; at first by nothing.
#[derive(Default)]
pub struct Trimmer {
    /// What is to be trimmed from the next segment on, as slowly as that may change.
    pub wanted: Correction,
    /// What is trimmed at the end of the last one that was sent.
    trimmed: Correction,
    /// Each that was sent, as it was planned, and what was taken off, rad per tickⁱ.
    sent: Vec<(Segment, PanTilt<[f64; 6]>)>,
}

impl Trim for Trimmer {
    fn ahead_ticks(&self) -> u32 {
        AHEAD_TICKS
    }

    fn trimmed(&mut self, segment: &Segment) -> Segment {
        let next = nearer(&self.trimmed, &self.wanted, f64::from(segment.ticks) * TICK_F64_S);
        let off = PanTilt::from_fn(|j| between(segment, j, (&self.trimmed, &next)));
        let coefficients = PanTilt::from_fn(|j| {
            std::array::from_fn(|i| (f64::from(segment.coefficients[j][i]) - off[j][i]) as f32)
        });
        self.sent.push((*segment, off));
        self.trimmed = next;
        Segment { coefficients, ..*segment }
    }
}

impl Trimmer {
    /// Where the joints were asked to be before it was trimmed, rad.
    #[must_use]
    pub fn untrimmed(&self, plan_tick: u32, setpoint: &PanTilt<Setpoint>) -> PanTilt<f64> {
        let number = self.sent.partition_point(|(segment, _)| segment.end_tick() <= plan_tick);
        let sent = self.sent.get(number.min(self.sent.len().saturating_sub(1)));
        let off = |j: Joint| {
            sent.map_or(0.0, |(segment, off)| {
                let n = f64::from(plan_tick.saturating_sub(segment.start_tick).min(u32::from(segment.ticks)));
                off[j].iter().rev().fold(0.0, |sum, c| sum * n + c)
            })
        };
        PanTilt::from_fn(|j| f64::from(setpoint[j].position_rad) + off(j))
    }
}

/// As near to what is wanted as one may come in a time.
fn nearer(from: &Correction, wanted: &Correction, time_s: f64) -> Correction {
    let step = |from: f64, wanted: f64, rate: f64, most: f64| {
        from + (wanted.clamp(-most, most) - from).clamp(-rate * time_s, rate * time_s)
    };
    Correction {
        offset_rad: PanTilt::from_fn(|j| {
            step(from.offset_rad[j], wanted.offset_rad[j], OFFSET_RAD_S, MOST_OFFSET_RAD)
        }),
        scale: PanTilt::from_fn(|j| step(from.scale[j], wanted.scale[j], SCALE_S, MOST_SCALE)),
    }
}

/// What is to be taken off a joint along a segment, rad per tickⁱ: the quintic that has angle, speed and acceleration of what is off at either
/// end.
fn between(segment: &Segment, joint: Joint, (from, to): (&Correction, &Correction)) -> [f64; 6] {
    if *from == Correction::default() && *to == Correction::default() {
        return [0.0; 6];
    }
    let n = f64::from(segment.ticks);
    let end = |at: f64, trim: &Correction| {
        let Setpoint { position_rad, velocity_rad_s, acceleration_rad_s2 } = segment.sample(at as f32)[joint];
        JointMotion {
            position_rad: trim.at(joint, f64::from(position_rad)),
            velocity_rad_s: trim.scale[joint] * f64::from(velocity_rad_s),
            acceleration_rad_s2: trim.scale[joint] * f64::from(acceleration_rad_s2),
        }
    };
    end(0.0, from).quintic_to(&end(n, to), n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;
    use tracelight_rig::{Command, Rig, Telemetry};
    use tracelight_session::Feeder;

    /// Takes all it is sent.
    #[derive(Default)]
    struct Wire(VecDeque<Command>);

    impl Rig for Wire {
        fn send(&mut self, command: Command) -> Result<(), Command> {
            self.0.push_back(command);
            Ok(())
        }

        fn next(&mut self) -> Option<Telemetry> {
            None
        }
    }

    /// A sine of 0.3 rad, its quintics by Hermite's ends.
    fn segments() -> Vec<Segment> {
        (0..40_u32)
            .map(|k| {
                let at = |tick: u32| 2e-3 * f64::from(tick);
                let end = |t: f64| JointMotion {
                    position_rad: 0.3 * t.sin(),
                    velocity_rad_s: 0.3 * 2.0 * t.cos(),
                    acceleration_rad_s2: -0.3 * 4.0 * t.sin(),
                };
                let c = end(at(50 * k)).quintic_to(&end(at(50 * (k + 1))), 50.0).map(|v| v as f32);
                Segment {
                    start_tick: 50 * k,
                    ticks: 50,
                    coefficients: PanTilt::new(c, c),
                    tolerance_rad: PanTilt::new(1e-3, 1e-3),
                    gate: true,
                    rate_limit: tracelight_rig::RateLimit::PLANNED,
                }
            })
            .collect()
    }

    fn sent(wire: &Wire) -> Vec<Segment> {
        let all = wire.0.iter();
        all.filter_map(|c| if let Command::Append(segment) = c { Some(*segment) } else { None }).collect()
    }

    #[test]
    fn without_a_trim_segments_are_sent_as_they_are_and_not_too_early() {
        let segments = segments();
        let mut feeder = Feeder::new(&segments, false);
        let (mut trimmer, mut wire) = (Trimmer::default(), Wire::default());
        (0..3).for_each(|_| feeder.feed_trimmed(&mut wire, 0, &mut trimmer));
        assert_eq!(sent(&wire), segments[..6]);
        (0..2000).for_each(|tick| feeder.feed_trimmed(&mut wire, tick, &mut trimmer));
        assert_eq!(sent(&wire), segments);
        assert_eq!(wire.0.back(), Some(&Command::Finish));
        assert_eq!(wire.0.len(), segments.len() + 1);
    }

    #[test]
    fn a_trim_comes_smoothly_and_is_known_afterwards() {
        let segments = segments();
        let mut feeder = Feeder::new(&segments, false);
        let (mut trimmer, mut wire) = (Trimmer::default(), Wire::default());
        let wanted = Correction { offset_rad: PanTilt::new(1e-3, -1.0), scale: PanTilt::new(4e-3, 0.0) };
        trimmer.wanted = wanted;
        (0..2000).for_each(|tick| feeder.feed_trimmed(&mut wire, tick, &mut trimmer));
        let sent = sent(&wire);
        for pair in sent.windows(2) {
            let (end, begin) = (pair[0].sample(50.0), pair[1].sample(0.0));
            for j in Joint::BOTH {
                assert!((end[j].position_rad - begin[j].position_rad).abs() < 1e-6);
                assert!((end[j].velocity_rad_s - begin[j].velocity_rad_s).abs() < 1e-4);
                assert!((end[j].acceleration_rad_s2 - begin[j].acceleration_rad_s2).abs() < 5e-2);
            }
        }
        // in the end all of what is wanted of pan, and of tilt as much as there is time for
        let (last, own) = (sent[39].sample(25.0), segments[39].sample(25.0));
        let pan = f64::from(own.pan.position_rad);
        let off = pan - f64::from(last.pan.position_rad);
        assert!((off - wanted.at(Joint::Pan, pan)).abs() < 1e-6, "{off}");
        let off = f64::from(own.tilt.position_rad - last.tilt.position_rad);
        assert!((off + 2e-3 * 2.0).abs() < 1e-4, "{off}");
        for tick in [0, 77, 1024, 1999] {
            let (k, n) = (tick as usize / 50, (tick % 50) as f32);
            let asked = trimmer.untrimmed(tick, &sent[k].sample(n));
            let own = segments[k].sample(n);
            assert!((asked.pan - f64::from(own.pan.position_rad)).abs() < 1e-6, "{tick}");
            assert!((asked.tilt - f64::from(own.tilt.position_rad)).abs() < 1e-6, "{tick}");
        }
    }

    #[test]
    fn a_dry_run_shuts_every_gate() {
        let segments = segments();
        let (mut feeder, mut wire) = (Feeder::new(&segments, true), Wire::default());
        feeder.feed_trimmed(&mut wire, 0, &mut Trimmer::default());
        assert!(sent(&wire).iter().all(|segment| !segment.gate));
    }
}

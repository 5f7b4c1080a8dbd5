use std::ops::ControlFlow;

use tracelight_maths::sin_cos;
use tracelight_rig::{Actuation, Head, Joint, TICK_F64_S};

use super::{Believed, Sample, Trial};

/// What voltages a joint is given, and for how long.
#[derive(Clone, Debug, PartialEq)]
pub struct Protocol {
    /// Voltages to hold, V, each by itself.
    pub volts: Vec<f64>,
    /// How long each is held, s.
    pub hold_s: f64,
    /// Voltage of the pulse before it, against stiction, V; it has the sign of what is held.
    pub pulse_v: f64,
    /// Its length, s.
    pub pulse_s: f64,
}

/// Between which angles a joint may turn, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// Lowest.
    pub lower_rad: f64,
    /// Highest.
    pub upper_rad: f64,
}

/// Ticks from one sample to the next: 10 ms.
const EVERY_TICKS: usize = 10;
/// A joint that counts nothing for so long stands, ticks.
const STILL_TICKS: usize = 500;
/// The voltage that brakes, as a share of the amplifier's limit.
const BRAKE_SHARE: f64 = 0.5;
/// What it is worth at least, as a share: supply and amplifier may be weaker than believed.
const BRAKE_WORTH: f64 = 0.5;
/// What is kept free of an end, rad, and as a share of the way.
const MARGIN_RAD: f64 = 0.02;
const MARGIN_SHARE: f64 = 0.02;
/// Time over which speed is told while it is driven, ticks.
const SPEED_TICKS: usize = 20;
/// Longest time to brake, ticks.
const LONGEST_BRAKE_TICKS: usize = 20_000;

/// One voltage on a joint that may turn as far as it likes, from rest: a pulse, then the hold.
pub fn free_trial(head: &mut impl Head, joint: Joint, protocol: &Protocol, volts: f64) -> Trial {
    let mut drive = Drive::new(head, joint, f64::INFINITY);
    let ticks = |time_s: f64| (time_s / TICK_F64_S).round() as usize;
    let pulse = ticks(protocol.pulse_s);
    let pulse_v = protocol.pulse_v.copysign(volts);
    for tick in 0..pulse + ticks(protocol.hold_s) {
        drive.tick(if tick < pulse { pulse_v } else { volts });
    }
    drive.trial()
}

/// All voltages on a joint that stays between two angles, going to and fro.
#[derive(Clone, Copy, Debug)]
pub struct Shuttle<'a> {
    /// What it is given; its pulses are as strong as the voltages they come before, at least.
    pub protocol: &'a Protocol,
    /// Where it may be.
    pub travel: Travel,
    /// Tells how soon it must brake, and what balances gravity.
    pub believed: &'a Believed,
    /// The amplifier's limit, V; half of it brakes.
    pub limit_v: f64,
}

impl Shuttle<'_> {
    /// Each voltage until the joint must brake, it stands, or its time is over. Gravity is balanced by what is believed of it, on top of
    /// each voltage, so the angles hold if it is about that. `watch` sees how many voltages are done and may stop.
    pub fn trials(
        &self,
        head: &mut impl Head,
        joint: Joint,
        mut watch: impl FnMut(usize) -> ControlFlow<()>,
    ) -> Vec<Trial> {
        let mut drive = Drive::new(head, joint, self.limit_v);
        let mut trials = Vec::new();
        for (number, volts) in to_and_fro(&self.protocol.volts).into_iter().enumerate() {
            self.run(&mut drive, volts);
            trials.push(drive.trial());
            self.brake(&mut drive);
            drive.forget();
            if watch(number + 1).is_break() {
                break;
            }
        }
        trials
    }
}

/// Every size of voltage forwards and backwards, small ones first.
fn to_and_fro(volts: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = volts.iter().copied().filter(|v| *v != 0.0).collect();
    sorted.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
    sorted
}

/// A joint under a voltage, tick by tick, and what was written down of it.
struct Drive<'a, H> {
    head: &'a mut H,
    joint: Joint,
    /// The amplifier gives no more, V.
    limit_v: f64,
    /// Counts of the last ticks, oldest first; of one turn of [`SPEED_TICKS`].
    counts: Vec<i32>,
    ticks: usize,
    /// Volts since the last sample, summed.
    sum_v: f64,
    samples: Vec<Sample>,
    still: usize,
}

impl<'a, H: Head> Drive<'a, H> {
    fn new(head: &'a mut H, joint: Joint, limit_v: f64) -> Self {
        // nothing is driven before its count is known
        let count = head.exchange(&Actuation::default()).encoders[joint].count;
        let counts = vec![count; SPEED_TICKS + 1];
        Self { head, joint, limit_v, counts, ticks: 0, sum_v: 0.0, samples: Vec::new(), still: 0 }
    }

    fn count(&self) -> i32 {
        self.counts[SPEED_TICKS]
    }

    /// counts a second.
    fn speed(&self) -> f64 {
        f64::from(self.count() - self.counts[0]) / (SPEED_TICKS as f64 * TICK_F64_S)
    }

    fn tick(&mut self, volts: f64) {
        let volts = volts.clamp(-self.limit_v, self.limit_v);
        if self.ticks.is_multiple_of(EVERY_TICKS) {
            self.close_sample();
            let time_s = self.ticks as f64 * TICK_F64_S;
            self.samples.push(Sample { time_s, volts: 0.0, count: f64::from(self.count()) });
        }
        let mut actuation = Actuation::default();
        actuation.command_v[self.joint] = volts as f32;
        let count = self.head.exchange(&actuation).encoders[self.joint].count;
        self.still = if count == self.count() { self.still + 1 } else { 0 };
        self.counts.rotate_left(1);
        self.counts[SPEED_TICKS] = count;
        self.sum_v += f64::from(volts as f32);
        self.ticks += 1;
    }

    /// The last sample's voltage is known once the next one comes.
    fn close_sample(&mut self) {
        if let Some(last) = self.samples.last_mut() {
            let ticks = self.ticks - ((self.ticks - 1) / EVERY_TICKS) * EVERY_TICKS;
            last.volts = self.sum_v / ticks as f64;
        }
        self.sum_v = 0.0;
    }

    /// What was written down so far.
    fn trial(&mut self) -> Trial {
        if self.ticks > 0 {
            self.close_sample();
            let time_s = self.ticks as f64 * TICK_F64_S;
            let volts = self.samples.last().map_or(0.0, |s| s.volts);
            self.samples.push(Sample { time_s, volts, count: f64::from(self.count()) });
        }
        self.ticks = 0;
        Trial { joint: self.joint, samples: std::mem::take(&mut self.samples) }
    }

    /// Begins anew.
    fn forget(&mut self) {
        (self.ticks, self.sum_v, self.still) = (0, 0.0, 0);
        self.samples.clear();
    }
}

impl Shuttle<'_> {
    /// Holds gravity where the joint is, V.
    fn balance_v(&self, count: i32) -> f64 {
        let (sin, cos) = sin_cos(f64::from(count) * self.believed.count_rad);
        let held = self.believed.gravity_nm.map_or(0.0, |[by_cos, by_sin]| by_cos * cos + by_sin * sin);
        -held / self.believed.torque_nm_per_v
    }

    /// Whether it must brake now to stay within.
    fn must_brake<H: Head>(&self, drive: &Drive<'_, H>) -> bool {
        let count_rad = self.believed.count_rad;
        let (angle, rate) = (f64::from(drive.count()) * count_rad, drive.speed() * count_rad);
        let Travel { lower_rad, upper_rad } = self.travel;
        let margin = MARGIN_RAD.max(MARGIN_SHARE * (upper_rad - lower_rad));
        let brake =
            BRAKE_WORTH * self.brake_v() * self.believed.torque_nm_per_v / self.believed.inertia_kg_m2;
        let stops_at = angle + 0.5 * rate * rate.abs() / brake;
        (rate > 0.0 && stops_at > upper_rad - margin) || (rate < 0.0 && stops_at < lower_rad + margin)
    }

    fn brake_v(&self) -> f64 {
        BRAKE_SHARE * self.limit_v
    }

    fn run<H: Head>(&self, drive: &mut Drive<'_, H>, volts: f64) {
        let protocol = self.protocol;
        let pulse = (protocol.pulse_s / TICK_F64_S).round() as usize;
        let all = pulse + (protocol.hold_s / TICK_F64_S).round() as usize;
        let pulse_v = protocol.pulse_v.abs().max(volts.abs()).copysign(volts);
        for tick in 0..all {
            if self.must_brake(drive) || drive.still > STILL_TICKS {
                return;
            }
            drive.tick(self.balance_v(drive.count()) + if tick < pulse { pulse_v } else { volts });
        }
    }

    /// Until it stands.
    fn brake<H: Head>(&self, drive: &mut Drive<'_, H>) {
        for _ in 0..LONGEST_BRAKE_TICKS {
            if drive.still > STILL_TICKS {
                return;
            }
            let slow = 1.5 / (SPEED_TICKS as f64 * TICK_F64_S);
            let speed = drive.speed();
            let brake_v = if speed.abs() > slow { -self.brake_v() * speed.signum() } else { 0.0 };
            drive.tick(self.balance_v(drive.count()) + brake_v);
        }
    }
}

//! The controller's configuration as bytes: words of four, in a fixed order.
//!
//! One function names every field, for both ways, so that what is written is what is read.

use tracelight_control::{
    AxisConfig, Biquad, Cable, Config, Creep, Drive, Feedback, Feedforward, Foot, FrictionModel, Gentle,
    HeadModel, KalmanTuning, LONGEST_INTERVAL_TICKS, LawConfig, LeadLag, MotorRating, ObserverConfig, Pid,
    Quirks, Ripple, StateFeedback, Sway, Unknown,
};
use tracelight_rig::wire::WrongConfiguration;
use tracelight_rig::{JointLimits, PanTilt};

/// Most bytes of a configuration.
pub const MOST_CONFIGURATION: usize = 1024;

/// Longest time that anything in a configuration may take, ticks: ten minutes.
const MOST_TICKS: u32 = 600_000;
/// Longest time that a switch of the laser takes, and that light may stand, ticks.
const MOST_SWITCH_TICKS: u32 = 1000;
const MOST_STANDING_TICKS: u32 = 10_000;
/// Angles of a count, rad: from a thousandth of a count of the finest encoders to a tenth of a turn.
const COUNT_RAD: (f32, f32) = (1e-7, 0.7);
/// Longest silence of a host before it is dark, ticks.
const MOST_SILENCE_TICKS: u32 = 1000;

/// Writes a configuration; how many bytes it is. `None` if they do not fit.
pub fn write_configuration(config: &Config, out: &mut [u8; MOST_CONFIGURATION]) -> Option<usize> {
    let mut writer = Writer { out, at: 0, fits: true };
    visit(&mut config.clone(), &mut writer);
    writer.fits.then_some(writer.at)
}

/// Reads a configuration.
///
/// # Errors
/// What is wrong with it: the word that has a value which it cannot have, or how long it should be.
pub fn read_configuration(bytes: &[u8]) -> Result<Config, WrongConfiguration> {
    let mut config = blank();
    let mut reader = Reader { bytes, at: 0, wrong: None };
    visit(&mut config, &mut reader);
    let length = 4 * reader.at;
    match reader.wrong {
        Some(wrong) => Err(wrong),
        None if length != bytes.len() => {
            Err(WrongConfiguration::Length(u16::try_from(length).unwrap_or(u16::MAX)))
        }
        None => Ok(config),
    }
}

/// What is done with each word in turn: written, or read into its place.
trait Words {
    /// A word that is one of a few, by its number.
    fn choice(&mut self, now: u32, choices: u32) -> u32;
    /// A whole number within its bounds.
    fn between(&mut self, value: &mut u32, bounds: (u32, u32));

    /// A whole number up to a bound.
    fn whole(&mut self, value: &mut u32, most: u32) {
        self.between(value, (0, most));
    }

    /// A number within its bounds.
    fn real(&mut self, value: &mut f32, bounds: (f32, f32));

    /// Any number, but no other bits.
    fn any(&mut self, value: &mut f32) {
        self.real(value, (f32::MIN, f32::MAX));
    }

    /// A number that is not negative.
    fn positive(&mut self, value: &mut f32) {
        self.real(value, (0.0, f32::MAX));
    }

    /// A number that is divided by.
    fn divisor(&mut self, value: &mut f32) {
        self.real(value, (1e-9, f32::MAX));
    }

    fn all(&mut self, values: &mut [f32]) {
        values.iter_mut().for_each(|value| self.any(value));
    }

    fn both(&mut self, values: &mut PanTilt<f32>) {
        self.any(&mut values.pan);
        self.any(&mut values.tilt);
    }

    /// What is there or not.
    fn maybe<T: Copy>(&mut self, value: &mut Option<T>, blank: T, visit: impl FnOnce(&mut Self, &mut T))
    where
        Self: Sized,
    {
        let is_there = self.choice(u32::from(value.is_some()), 2) == 1;
        *value = is_there.then(|| value.unwrap_or(blank));
        if let Some(value) = value {
            visit(self, value);
        }
    }
}

struct Writer<'a> {
    out: &'a mut [u8; MOST_CONFIGURATION],
    at: usize,
    fits: bool,
}

impl Writer<'_> {
    fn put(&mut self, bits: u32) {
        match self.out.get_mut(self.at..).and_then(<[u8]>::first_chunk_mut) {
            Some(place) => *place = bits.to_le_bytes(),
            None => self.fits = false,
        }
        self.at += 4;
    }
}

impl Words for Writer<'_> {
    fn choice(&mut self, now: u32, _: u32) -> u32 {
        self.put(now);
        now
    }

    fn between(&mut self, value: &mut u32, _: (u32, u32)) {
        self.put(*value);
    }

    fn real(&mut self, value: &mut f32, _: (f32, f32)) {
        self.put(value.to_bits());
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    /// Words read so far.
    at: usize,
    /// The first thing that is wrong.
    wrong: Option<WrongConfiguration>,
}

impl Reader<'_> {
    /// The next word, if it is there and fits.
    fn get(&mut self, fits: impl FnOnce(u32) -> bool) -> Option<u32> {
        let bits =
            self.bytes.get(4 * self.at..).and_then(<[u8]>::first_chunk).map(|word| u32::from_le_bytes(*word));
        let word = u16::try_from(self.at).unwrap_or(u16::MAX);
        self.at += 1;
        // what is missing is told by its length
        let bits = bits?;
        if !fits(bits) {
            self.wrong = self.wrong.or(Some(WrongConfiguration::Word { word, bits }));
            return None;
        }
        Some(bits)
    }
}

impl Words for Reader<'_> {
    fn choice(&mut self, now: u32, choices: u32) -> u32 {
        self.get(|bits| bits < choices).unwrap_or(now)
    }

    fn between(&mut self, value: &mut u32, (least, most): (u32, u32)) {
        *value = self.get(|bits| (least..=most).contains(&bits)).unwrap_or(*value);
    }

    fn real(&mut self, value: &mut f32, (lower, upper): (f32, f32)) {
        let fits = |bits| (lower..=upper).contains(&f32::from_bits(bits));
        *value = self.get(fits).map_or(*value, f32::from_bits);
    }
}

/// Every field, in the order of its word.
fn visit(config: &mut Config, words: &mut impl Words) {
    let Config {
        model,
        drive,
        axes,
        hold_limit_ticks,
        laser_on_ticks,
        laser_off_ticks,
        enable_on_ticks,
        enable_off_ticks,
        host_silence_ticks,
        host_lost_ticks,
        lead_ticks,
        standing_ticks,
        standing_radius_rad,
        tolerance_limit_rad,
        foot,
        park_rad,
    } = config;
    words.whole(hold_limit_ticks, MOST_TICKS);
    for ticks in [laser_on_ticks, laser_off_ticks, enable_on_ticks, enable_off_ticks] {
        words.whole(ticks, MOST_SWITCH_TICKS);
    }
    words.whole(host_silence_ticks, MOST_SILENCE_TICKS);
    words.between(host_lost_ticks, (*host_silence_ticks, MOST_TICKS));
    words.whole(lead_ticks, MOST_SILENCE_TICKS);
    words.whole(standing_ticks, MOST_STANDING_TICKS);
    words.divisor(standing_radius_rad);
    words.divisor(tolerance_limit_rad);
    visit_model(model, words);
    visit_drive(drive, words);
    visit_axis(&mut axes.pan, words);
    visit_axis(&mut axes.tilt, words);
    let Foot { jolt_rad_s, turned_rad, sway } = foot;
    words.divisor(jolt_rad_s);
    words.divisor(turned_rad);
    let stiff = Sway { carried_share: PanTilt::new(0.0, 0.0), rate_rad_s: 1.0, damping: 1.0 };
    words.maybe(sway, stiff, |words, Sway { carried_share, rate_rad_s, damping }| {
        words.both(carried_share);
        words.any(rate_rad_s);
        words.any(damping);
    });
    words.maybe(park_rad, PanTilt::new(0.0, 0.0), |words, park| words.both(park));
}

fn visit_model(model: &mut HeadModel, words: &mut impl Words) {
    let HeadModel { m11_fixed, m11_ss, m11_sc, m11_cc, m12_s, m12_c, m22, gravity_c, gravity_s } = model;
    words.divisor(m11_fixed);
    [m11_ss, m11_sc, m11_cc, m12_s, m12_c].into_iter().for_each(|value| words.any(value));
    words.divisor(m22);
    [gravity_c, gravity_s].into_iter().for_each(|value| words.any(value));
}

fn visit_drive(drive: &mut Drive, words: &mut impl Words) {
    let nothing = PanTilt::new(1.0, 1.0);
    let blank = Gentle { rate_rad_s: nothing, acceleration_rad_s2: nothing, torque_share: nothing };
    let mut gentle = match drive {
        Drive::Volts => None,
        Drive::Pulses(gentle) => Some(*gentle),
    };
    words.maybe(&mut gentle, blank, |words, Gentle { rate_rad_s, acceleration_rad_s2, torque_share }| {
        [rate_rad_s, acceleration_rad_s2, torque_share].into_iter().for_each(|both| words.both(both));
    });
    *drive = gentle.map_or(Drive::Volts, Drive::Pulses);
}

fn visit_axis(axis: &mut AxisConfig, words: &mut impl Words) {
    let AxisConfig {
        torque_nm_per_v,
        limit_v,
        back_emf_v_s_per_rad,
        dead_band_v,
        count_rad,
        friction,
        unknown_nm,
        scale_tolerance,
        quirks,
        observer,
        law,
        creep,
        rating,
        limits,
    } = axis;
    [torque_nm_per_v, limit_v].into_iter().for_each(|value| words.divisor(value));
    [back_emf_v_s_per_rad, dead_band_v].into_iter().for_each(|value| words.positive(value));
    words.real(count_rad, COUNT_RAD);
    let FrictionModel { viscous_pos, viscous_neg, coulomb_pos_nm, coulomb_neg_nm } = friction;
    [viscous_pos, viscous_neg, coulomb_pos_nm, coulomb_neg_nm].into_iter().for_each(|value| words.any(value));
    words.positive(unknown_nm);
    words.positive(scale_tolerance);
    let Quirks { break_away_nm, break_away_rad_s, edges_counts, ripple, cable } = quirks;
    words.any(break_away_nm);
    words.divisor(break_away_rad_s);
    words.all(edges_counts);
    let Ripple { periods, sin_nm, cos_nm } = ripple;
    let Cable { load_nm, spring_nm_per_rad } = cable;
    [periods, sin_nm, cos_nm, load_nm, spring_nm_per_rad].into_iter().for_each(|value| words.any(value));
    visit_observer(observer, words);
    visit_law(law, words);
    let slow = Creep { below_rad_s: 0.0, turn_s: 1.0, hop_rad: 1.0, acceleration_rad_s2: 1.0 };
    words.maybe(creep, slow, |words, Creep { below_rad_s, turn_s, hop_rad, acceleration_rad_s2 }| {
        words.positive(below_rad_s);
        [turn_s, hop_rad, acceleration_rad_s2].into_iter().for_each(|value| words.divisor(value));
    });
    let MotorRating { continuous_share, heating_s } = rating;
    words.real(continuous_share, (0.0, 1.0));
    words.divisor(heating_s);
    let JointLimits { lower_rad, upper_rad, speed_rad_s, acceleration_rad_s2 } = limits;
    words.any(lower_rad);
    words.real(upper_rad, (*lower_rad, f32::MAX));
    [speed_rad_s, acceleration_rad_s2].into_iter().for_each(|value| words.divisor(value));
}

fn visit_observer(observer: &mut ObserverConfig, words: &mut impl Words) {
    use ObserverConfig::{Differences, EdgeTimes, Kalman, TrackingLoop, Washout};
    let now = match observer {
        Differences(_) => 0,
        Washout(_) => 1,
        EdgeTimes(_) => 2,
        TrackingLoop(_) => 3,
        Kalman(_) => 4,
    };
    let choice = words.choice(now, 5);
    if choice != now {
        *observer = match choice {
            0 => Differences(1),
            1 => Washout(1.0),
            2 => EdgeTimes(1),
            3 => TrackingLoop(1.0),
            _ => Kalman(KalmanTuning::BELIEVING),
        };
    }
    match observer {
        Differences(interval) | EdgeTimes(interval) => {
            // one less, so that it is one at least
            let mut beyond_one = u32::try_from(interval.saturating_sub(1)).unwrap_or(u32::MAX);
            words.whole(&mut beyond_one, LONGEST_INTERVAL_TICKS as u32 - 1);
            *interval = beyond_one as usize + 1;
        }
        Washout(rate) | TrackingLoop(rate) => words.divisor(rate),
        Kalman(tuning) => {
            let KalmanTuning {
                acceleration_noise,
                edge_noise_counts,
                bound_slack_counts,
                bound_noise_counts,
                load,
                friction,
                friction_change,
                break_away,
                inertia,
            } = tuning;
            [acceleration_noise, edge_noise_counts, bound_slack_counts, bound_noise_counts, friction_change]
                .into_iter()
                .for_each(|value| words.positive(value));
            for Unknown { deviation, drift } in [load, friction, break_away, inertia] {
                words.positive(deviation);
                words.positive(drift);
            }
        }
    }
}

fn visit_law(law: &mut LawConfig, words: &mut impl Words) {
    let LawConfig { feedback, feedforward } = law;
    let now = match feedback {
        Feedback::Pid(_) => 0,
        Feedback::LeadLag(_) => 1,
        Feedback::State(_) => 2,
    };
    let choice = words.choice(now, 3);
    if choice != now {
        *feedback = match choice {
            0 => Feedback::Pid(Pid {
                kp: 0.0,
                ki: 0.0,
                kd: 0.0,
                position_weight: 1.0,
                velocity_weight: 1.0,
                filter_rad_s: 1.0,
                anti_windup: false,
            }),
            1 => Feedback::LeadLag(LeadLag { sections: [Biquad::PASS; 2] }),
            _ => Feedback::State(StateFeedback { bandwidth_rad_s: 1.0, damping: 1.0 }),
        };
    }
    match feedback {
        Feedback::Pid(Pid { kp, ki, kd, position_weight, velocity_weight, filter_rad_s, anti_windup }) => {
            [kp, ki, kd, position_weight, velocity_weight].into_iter().for_each(|value| words.any(value));
            // infinite for none
            words.real(filter_rad_s, (0.0, f32::INFINITY));
            *anti_windup = words.choice(u32::from(*anti_windup), 2) == 1;
        }
        Feedback::LeadLag(LeadLag { sections }) => {
            for Biquad { numerator, denominator } in sections {
                words.all(numerator);
                words.all(denominator);
            }
        }
        Feedback::State(StateFeedback { bandwidth_rad_s, damping }) => {
            words.positive(bandwidth_rad_s);
            words.positive(damping);
        }
    }
    let now = match feedforward {
        Feedforward::None => 0,
        Feedforward::Gravity => 1,
        Feedforward::Model => 2,
        Feedforward::Learned => 3,
    };
    *feedforward = match words.choice(now, 4) {
        0 => Feedforward::None,
        1 => Feedforward::Gravity,
        2 => Feedforward::Model,
        _ => Feedforward::Learned,
    };
}

/// A configuration whose every word is read over.
fn blank() -> Config {
    let axis = AxisConfig {
        torque_nm_per_v: 1.0,
        limit_v: 1.0,
        back_emf_v_s_per_rad: 0.0,
        dead_band_v: 0.0,
        count_rad: 1.0,
        friction: FrictionModel::default(),
        unknown_nm: 0.0,
        scale_tolerance: 0.0,
        quirks: Quirks::NONE,
        observer: ObserverConfig::Kalman(KalmanTuning::BELIEVING),
        law: LawConfig {
            feedback: Feedback::State(StateFeedback { bandwidth_rad_s: 1.0, damping: 1.0 }),
            feedforward: Feedforward::None,
        },
        creep: None,
        rating: MotorRating { continuous_share: 1.0, heating_s: 1.0 },
        limits: JointLimits { lower_rad: 0.0, upper_rad: 0.0, speed_rad_s: 1.0, acceleration_rad_s2: 1.0 },
    };
    Config {
        model: HeadModel::default(),
        drive: Drive::Volts,
        axes: PanTilt::new(axis, axis),
        hold_limit_ticks: 0,
        laser_on_ticks: 0,
        laser_off_ticks: 0,
        enable_on_ticks: 0,
        enable_off_ticks: 0,
        host_silence_ticks: 0,
        host_lost_ticks: 0,
        lead_ticks: 0,
        standing_ticks: 0,
        standing_radius_rad: 1.0,
        tolerance_limit_rad: 1.0,
        foot: Foot { jolt_rad_s: 1.0, turned_rad: 1.0, sway: None },
        park_rad: None,
    }
}

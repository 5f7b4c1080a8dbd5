//! A joint swung by a relay, and a PID from the swing.
//!
//! K. J. Åström and T. Hägglund, "Automatic tuning of simple regulators with specifications on phase and amplitude margins",
//! *Automatica* 20 (1984): a relay with hysteresis in place of the controller makes a stable swing, whose amplitude and period are a
//! point of the plant's frequency response; a PID is chosen that takes this point to the phase margin. What makes the swing of a
//! joint stable is Coulomb friction: each half swing the late relay puts 2 d h of work in, and friction takes 2 a F out.

use std::f64::consts::{PI, TAU};
use std::fmt;

use thiserror::Error;
use tracelight_linear::Complex;
use tracelight_maths::{complex, cos, tan};
use tracelight_rig::{Actuation, Head, Joint, TICK_F64_S};

/// How a joint is swung.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relay {
    /// Voltage either way, V.
    pub level_v: f64,
    /// How far beyond its middle the joint must be for the relay to turn over, rad.
    pub hysteresis_rad: f64,
    /// Voltage that holds the joint there by what is believed of it, V; corrected until it swings evenly.
    pub hold_v: f64,
    /// Largest command of the amplifier, V.
    pub limit_v: f64,
    /// Width of a count, rad.
    pub count_rad: f64,
}

/// A swing that repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct Swing {
    /// Half of what it goes from side to side, rad.
    pub amplitude_rad: f64,
    /// s.
    pub period_s: f64,
    /// By how much the last periods differ, as a share.
    pub unevenness: f64,
    /// Voltage about which the relay was even in the end, V.
    pub hold_v: f64,
    /// All of it, from rest on: volts, and the angle from its middle after them, rad; a tick each.
    pub ticks: Vec<(f64, f64)>,
}

/// A PID as it acts: torque = kp error + ki ∫ error − kd speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelayPid {
    /// N m/rad.
    pub kp: f64,
    /// N m/(rad s).
    pub ki: f64,
    /// N m s/rad.
    pub kd: f64,
}

/// Why a relay told nothing.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RelayError {
    /// It stood.
    Stood(Joint),
    /// It swung further and further.
    Ran(Joint, Degrees),
    /// It swung, but each time otherwise.
    Uneven(Joint, f64),
    /// What holds it and the relay together are more than its amplifier gives.
    Limit(Joint),
    /// No PID of that form has that margin.
    Margin(f64),
}

/// An angle in a message.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degrees(pub f64);

impl fmt::Display for Degrees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1}°", self.0)
    }
}

impl fmt::Display for RelayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stood(joint) => {
                write!(f, "{joint} does not swing: friction is stronger than the relay; give it more volts")
            }
            Self::Ran(joint, reach) => write!(
                f,
                "{joint} swings further than {reach}: too little friction for that relay; give it less --hysteresis or fewer volts"
            ),
            Self::Uneven(joint, share) => write!(
                f,
                "{joint} does not settle to one swing: its last periods differ by {:.0} %; give the relay more --hysteresis, or more volts",
                100.0 * share
            ),
            Self::Limit(joint) => write!(
                f,
                "what holds {joint} and the relay together are more than its amplifier gives; give the relay fewer volts"
            ),
            Self::Margin(degrees) => write!(
                f,
                "no PID with that --integral brings a phase margin of {degrees:.1}°: ask for less, or for a slower integral"
            ),
        }
    }
}

/// Swings that are let pass,
const SETTLING: usize = 12;
/// and those that are measured.
const MEASURED: usize = 8;
/// What they may differ by at most.
const MOST_UNEVEN: f64 = 0.2;
/// Longest half swing, ticks.
const LONGEST_HALF: usize = 5_000;
/// Furthest swing, rad.
const FURTHEST_RAD: f64 = 0.5;

/// Swings a joint that is at rest, about where it is.
pub fn swing(head: &mut impl Head, joint: Joint, relay: &Relay) -> Result<Swing, RelayError> {
    let mut hold_v = relay.hold_v;
    let mut record = Record::default();
    let (mut times, mut ends) = (Vec::new(), Vec::new());
    let mut way = 1.0;
    while times.len() < 2 * (SETTLING + MEASURED) {
        let (ticks, furthest_rad) = half(head, joint, relay, (way, hold_v), &mut record)?;
        times.push(ticks as f64 * TICK_F64_S);
        ends.push(furthest_rad);
        way = -way;
        // an even number of half swings: the last two, up and down, tell which way it is held too weakly
        if let (true, [.., up, down]) = (times.len() % 2 == 0, times.as_slice())
            && times.len() <= 2 * SETTLING
        {
            hold_v += 0.5 * relay.level_v * (up - down) / (up + down);
        }
    }
    let measured = &times[2 * SETTLING..];
    let periods: Vec<f64> = measured.chunks_exact(2).map(|pair| pair[0] + pair[1]).collect();
    let amplitudes: Vec<f64> =
        ends[2 * SETTLING..].chunks_exact(2).map(|pair| 0.5 * (pair[0] - pair[1]).abs()).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let spread = |values: &[f64]| {
        let (low, high) = values.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(*v), h.max(*v)));
        (high - low) / mean(values)
    };
    let unevenness = spread(&periods).max(spread(&amplitudes));
    if unevenness > MOST_UNEVEN {
        return Err(RelayError::Uneven(joint, unevenness));
    }
    Ok(Swing {
        amplitude_rad: mean(&amplitudes),
        period_s: mean(&periods),
        unevenness,
        hold_v,
        ticks: record.ticks,
    })
}

/// What was seen so far.
#[derive(Default)]
struct Record {
    /// Where the joint was first, rad.
    middle_rad: Option<f64>,
    ticks: Vec<(f64, f64)>,
}

/// Half a swing: until the joint is beyond the hysteresis on the side it is driven to. How long it took, and the furthest it was on the
/// other side.
fn half(
    head: &mut impl Head,
    joint: Joint,
    relay: &Relay,
    (way, hold_v): (f64, f64),
    record: &mut Record,
) -> Result<(usize, f64), RelayError> {
    let volts = hold_v + way * relay.level_v;
    if volts.abs() > relay.limit_v {
        return Err(RelayError::Limit(joint));
    }
    let mut actuation = Actuation::default();
    actuation.command_v[joint] = volts as f32;
    let mut furthest_rad = 0.0_f64;
    for tick in 1..=LONGEST_HALF {
        let at_rad = f64::from(head.exchange(&actuation).encoders[joint].count) * relay.count_rad;
        let from_middle = at_rad - *record.middle_rad.get_or_insert(at_rad);
        record.ticks.push((volts, from_middle));
        if from_middle.abs() > FURTHEST_RAD {
            return Err(RelayError::Ran(joint, Degrees(FURTHEST_RAD.to_degrees())));
        }
        if way * from_middle < way * furthest_rad {
            furthest_rad = from_middle;
        }
        if way * from_middle > relay.hysteresis_rad {
            return Ok((tick, furthest_rad));
        }
    }
    Err(RelayError::Stood(joint))
}

impl Swing {
    /// rad/s.
    pub fn rad_s(&self) -> f64 {
        TAU / self.period_s
    }

    /// The plant at that frequency, rad/(N m): −1 over the relay's describing function.
    pub fn response(&self, relay: &Relay, torque_nm_per_v: f64) -> Complex {
        let (a, h) = (self.amplitude_rad, relay.hysteresis_rad.min(self.amplitude_rad));
        let scale = PI / (4.0 * relay.level_v * torque_nm_per_v);
        -scale * Complex::new((a * a - h * h).sqrt(), h)
    }

    /// Inertia, kg m², and Coulomb friction, N m, of a mass that swings so: what the relay puts in by being late, friction takes out over
    /// the amplitude, and both stretches of a half swing, driven and braked, take their time.
    pub fn mass(&self, relay: &Relay, torque_nm_per_v: f64) -> (f64, f64) {
        let torque = relay.level_v * torque_nm_per_v;
        let (a, h) = (self.amplitude_rad, relay.hysteresis_rad.min(self.amplitude_rad));
        let coulomb = torque * h / a;
        let (driven, braked) = (torque - coulomb, torque + coulomb);
        let half_s = 0.5 * self.period_s;
        let turns = 1.0 / driven + 1.0 / braked;
        (half_s * half_s / (2.0 * (a + h) * driven * turns * turns), coulomb)
    }

    /// The PID that takes that point to a phase margin, rad, crossing 1 there; its integral acts `integral` times as slowly as its derivative.
    /// With a frequency, rad/s, it crosses there, where the joint answers as its mass does.
    pub fn pid(
        &self,
        relay: &Relay,
        torque_nm_per_v: f64,
        crossover_rad_s: Option<f64>,
        (margin_rad, integral): (f64, f64),
    ) -> Result<RelayPid, RelayError> {
        let of_mass = |rad_s: f64| {
            let (inertia, _) = self.mass(relay, torque_nm_per_v);
            Complex::new(-1.0 / (inertia * rad_s * rad_s), 0.0)
        };
        let rad_s = crossover_rad_s.unwrap_or(self.rad_s());
        let plant = crossover_rad_s.map_or_else(|| self.response(relay, torque_nm_per_v), of_mass);
        // of −1 the argument is π or −π as its sign of zero is
        let lead = (margin_rad - PI - complex::arg(plant)).rem_euclid(TAU);
        let lead = if lead > PI { lead - TAU } else { lead };
        if lead.abs() >= 0.5 * PI - 1e-3 {
            return Err(RelayError::Margin(margin_rad.to_degrees()));
        }
        let slope = tan(lead);
        let derivative = 0.5 * (slope + (slope * slope + 4.0 / integral).sqrt());
        let kp = cos(lead) / complex::norm(plant);
        let derivative_s = derivative / rad_s;
        Ok(RelayPid { kp, ki: kp / (integral * derivative_s), kd: kp * derivative_s })
    }
}

#[cfg(test)]
mod tests {
    use tracelight_sim::{Mounting, RigConfig, head_alone};

    use super::*;

    fn relay(rig: &RigConfig, joint: Joint) -> Relay {
        let count_rad = rig.model.encoder.count_rad();
        let motor = rig.model.motors[joint];
        Relay {
            level_v: 4.0,
            hysteresis_rad: 4.5 * count_rad,
            hold_v: 0.0,
            limit_v: motor.limit_v,
            count_rad,
        }
    }

    /// The swing of a mass with Coulomb friction between two torques, on paper: what the relay puts in by being late, d h, friction takes
    /// out over the amplitude; and the time of each stretch.
    #[test]
    fn the_swing_is_that_of_a_mass_with_friction() {
        let rig = RigConfig::report();
        for joint in Joint::BOTH {
            let relay = relay(&rig, joint);
            let found = swing(&mut head_alone(&rig, joint, Mounting::Fixture, 1), joint, &relay).unwrap();
            let torque = relay.level_v * rig.truth.model.motors[joint].torque_nm_per_v;
            let friction = &rig.truth.model.friction[joint];
            let coulomb = 0.5 * (friction.coulomb_pos_nm - friction.coulomb_neg_nm);
            let inertia = rig.truth.model.own_inertia_kg_m2()[joint];
            // the count after the one it must pass, seen half a tick late on average
            let h = relay.hysteresis_rad;
            let amplitude = torque * h / coulomb;
            assert!(
                (found.amplitude_rad / amplitude - 1.0).abs() < 0.2,
                "{joint}: {} {amplitude}",
                found.amplitude_rad
            );
            let (mass, _) = found.mass(&relay, rig.truth.model.motors[joint].torque_nm_per_v);
            assert!((mass / inertia - 1.0).abs() < 0.05, "{joint}: {mass}, {inertia}");
            let pid = found
                .pid(&relay, rig.truth.model.motors[joint].torque_nm_per_v, Some(30.0), (1.0, 10.0))
                .unwrap();
            let s = Complex::new(0.0, 30.0);
            let open = (pid.kp + pid.kd * s + pid.ki / s) / (mass * s * s);
            assert!(
                (complex::norm(open) - 1.0).abs() < 1e-9 && (complex::arg(open) + PI - 1.0).abs() < 1e-9,
                "{open}"
            );
        }
    }

    #[test]
    fn a_pid_takes_the_point_to_its_margin() {
        let relay = Relay { level_v: 2.0, hysteresis_rad: 0.01, hold_v: 0.0, limit_v: 10.0, count_rad: 1e-3 };
        let swing =
            Swing { amplitude_rad: 0.05, period_s: 0.4, unevenness: 0.0, hold_v: 0.0, ticks: Vec::new() };
        for margin_deg in [30.0_f64, 50.0, 60.0] {
            let pid = swing.pid(&relay, 0.06, None, (margin_deg.to_radians(), 6.0)).unwrap();
            let s = Complex::new(0.0, swing.rad_s());
            let controller = pid.kp + pid.kd * s + pid.ki / s;
            let open = controller * swing.response(&relay, 0.06);
            assert!((complex::norm(open) - 1.0).abs() < 1e-9);
            assert!((complex::arg(open) + PI - margin_deg.to_radians()).abs() < 1e-9, "{open}");
        }
        assert!(
            swing.pid(&relay, 0.06, None, (2.0, 6.0)).is_err(),
            "115° of margin is more than a PID can lead"
        );
    }

    #[test]
    fn what_does_not_swing_is_said() {
        let rig = RigConfig::report();
        let weak = Relay { level_v: 0.3, ..relay(&rig, Joint::Pan) };
        let of =
            |relay: &Relay| swing(&mut head_alone(&rig, Joint::Pan, Mounting::Fixture, 0), Joint::Pan, relay);
        assert_eq!(of(&weak).map(|s| s.period_s), Err(RelayError::Stood(Joint::Pan)));
        let strong = Relay { level_v: 12.0, ..weak };
        assert_eq!(of(&strong).map(|s| s.period_s), Err(RelayError::Limit(Joint::Pan)));
        let wild = Relay { level_v: 9.0, hysteresis_rad: 0.1, limit_v: 99.0, ..weak };
        assert!(matches!(of(&wild), Err(RelayError::Ran(..))));
    }

    /// On its feet tilt's weight pulls one way; the relay finds what holds it.
    #[test]
    fn weight_is_found_out() {
        let rig = RigConfig::report();
        let relay = Relay { hold_v: -1.5, ..relay(&rig, Joint::Tilt) };
        let found =
            swing(&mut head_alone(&rig, Joint::Tilt, Mounting::Standing, 0), Joint::Tilt, &relay).unwrap();
        let holds = rig.model.bodies.lumped().gravity(0.0).tilt / rig.model.motors.tilt.torque_nm_per_v;
        assert!((found.hold_v / holds - 1.0).abs() < 0.15, "{} {holds}", found.hold_v);
    }
}

//! Keys of the laser and of safety.

use tracelight_sim::{LaserClass, LightSettings, RigConfig};
use tracelight_units::{ANGLES, ANGULAR_SPEEDS, TIMES, Unit};

use crate::keys::{Choice, Key, PURE, Slot, choice, real};

const WAVELENGTHS: &[Unit] = &[("nm", 1.0), ("um", 1e3)];
const POWER: &[Unit] = &[("W", 1.0), ("mW", 1e-3)];
/// The key that follows from `laser.power` where a file does not have it.
pub(crate) const STANDING: &str = "safety.standing";
const PAN: &str = "safety.park_pan";
const TILT: &str = "safety.park_tilt";
/// Further than any joint turns, rad.
const MOST_RAD: f64 = 3.2;

/// Keys of `[laser]` and `[safety]`; of the last two both, or none, are in a file.
pub(crate) const SAFETY_KEYS: [Key<RigConfig>; 10] = [
    choice(
        "laser.class",
        "what its label says",
        Choice {
            names: || LaserClass::ALL.map(LaserClass::name).to_vec(),
            get: |r| r.light.class.name(),
            set: |r, name| r.light.class = LaserClass::named(name).unwrap_or(r.light.class),
        },
    ),
    real("laser.power", POWER, LightSettings::POWER_W, "power of its light", |r| &mut r.light.power_w),
    Key {
        path: "laser.wavelength",
        units: WAVELENGTHS,
        bounds: (200.0, 2000.0),
        meaning: "its wavelength; a real head is not lit without",
        slot: Slot::Maybe(|r| &mut r.light.wavelength_nm),
    },
    Key {
        path: "laser.measured_on",
        units: PURE,
        bounds: (0.0, 0.0),
        meaning: "day on which its power was measured at the aperture; a real head is not lit without",
        slot: Slot::Day(|r| &mut r.light.measured_on),
    },
    choice(
        "laser.operated_class",
        "highest class that whoever operates it answers for; nothing above it is lit with a real head",
        Choice {
            names: || LaserClass::ALL.map(LaserClass::name).to_vec(),
            get: |r| r.light.operated.name(),
            set: |r, name| r.light.operated = LaserClass::named(name).unwrap_or(r.light.operated),
        },
    ),
    real(
        STANDING,
        TIMES,
        LightSettings::STANDING_S,
        "how long light may stand in one place; left out, 1 mJ of laser.power, but a second at most",
        |r| &mut r.light.standing_s,
    ),
    real(
        "safety.jolt",
        ANGULAR_SPEEDS,
        (1e-3, 10.0),
        "how fast what it stands on turns, from which on that is a bump; by its gyroscope",
        |r| &mut r.safety.jolt_rad_s,
    ),
    real(
        "safety.turned",
        ANGLES,
        (5e-5, 0.5),
        "how far that may have turned once it is still again, and count as standing where it stood",
        |r| &mut r.safety.turned_rad,
    ),
    Key {
        path: PAN,
        units: ANGLES,
        bounds: (-MOST_RAD, MOST_RAD),
        meaning: "where the head turns when a switch of the laser does not open; left out, it stays where it is",
        slot: Slot::Maybe(|r| &mut r.safety.park_rad.pan),
    },
    Key {
        path: TILT,
        units: ANGLES,
        bounds: (-MOST_RAD, MOST_RAD),
        meaning: "the same of tilt: both or none",
        slot: Slot::Maybe(|r| &mut r.safety.park_rad.tilt),
    },
];

/// A direction for a laser that does not go dark which is only half told, or which the joints do not reach.
pub(crate) fn impossible_park(config: &RigConfig) -> Option<String> {
    let park = config.safety.park_rad;
    if park.pan.is_some() != park.tilt.is_some() {
        let (given, missing) = if park.pan.is_some() { (PAN, TILT) } else { (TILT, PAN) };
        return Some(format!("{given} without {missing}: give both, or none"));
    }
    let range = config.model.geometry.range_rad;
    let joints = [("pan", PAN, park.pan, range.pan), ("tilt", TILT, park.tilt, range.tilt)];
    joints.into_iter().find_map(|(name, key, angle, (lower, upper))| {
        let beyond = angle.filter(|angle| !(lower..=upper).contains(angle))?;
        Some(format!(
            "{key}: {beyond} rad is outside of what {name} turns, {lower} to {upper} rad: choose another direction, or set \
             model.{name}.range_min and range_max"
        ))
    })
}

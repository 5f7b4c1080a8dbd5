//! Keys of where a head is parked whose laser does not go dark.

use tracelight_sim::RigConfig;
use tracelight_units::ANGLES;

use crate::keys::{Key, Slot};

const PAN: &str = "safety.park_pan";
const TILT: &str = "safety.park_tilt";
/// Further than any joint turns, rad.
const MOST_RAD: f64 = 3.2;

/// Both, or none, are in a file.
pub(crate) const PARK_KEYS: [Key<RigConfig>; 2] = [
    Key {
        path: PAN,
        units: ANGLES,
        bounds: (-MOST_RAD, MOST_RAD),
        meaning: "where the head turns when a switch of the laser does not open; left out, it stays where it is",
        slot: Slot::Maybe(|r| &mut r.light.park_rad.pan),
    },
    Key {
        path: TILT,
        units: ANGLES,
        bounds: (-MOST_RAD, MOST_RAD),
        meaning: "the same of tilt: both or none",
        slot: Slot::Maybe(|r| &mut r.light.park_rad.tilt),
    },
];

/// A direction for a laser that does not go dark which is only half told, or which the joints do not reach.
pub(crate) fn impossible_park(config: &RigConfig) -> Option<String> {
    let park = config.light.park_rad;
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

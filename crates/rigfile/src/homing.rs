//! Keys of homing: where the joints come up against their end stops.

use tracelight_sim::RigConfig;
use tracelight_units::ANGLES;

use crate::keys::{Key, Slot};

/// Further than any joint turns, rad.
const MOST_RAD: f64 = 6.4;

type Maybe = fn(&mut RigConfig) -> &mut Option<f64>;

const fn stop(path: &'static str, bounds: (f64, f64), meaning: &'static str, field: Maybe) -> Key<RigConfig> {
    Key { path, units: ANGLES, bounds, meaning, slot: Slot::Maybe(field) }
}

/// Keys of `[homing]`; all of them, or none, are in a file.
pub(crate) const HOMING_KEYS: [Key<RigConfig>; 4] = [
    stop(
        "homing.pan_stop_min",
        (-MOST_RAD, 0.0),
        "where pan comes up against its end stop, turning negatively; `tracelight home --find-stops` measures it",
        |r| &mut r.stops_rad.pan.0,
    ),
    stop("homing.pan_stop_max", (0.0, MOST_RAD), "turning positively", |r| &mut r.stops_rad.pan.1),
    stop("homing.tilt_stop_min", (-MOST_RAD, 0.0), "the same of tilt: all four or none", |r| {
        &mut r.stops_rad.tilt.0
    }),
    stop("homing.tilt_stop_max", (0.0, MOST_RAD), "turning positively", |r| &mut r.stops_rad.tilt.1),
];

/// The section of a rig file that tells these end stops of pan and of tilt, lower and upper, rad.
#[must_use]
pub fn homing_section(pan_rad: (f64, f64), tilt_rad: (f64, f64)) -> String {
    let ends = [pan_rad.0, pan_rad.1, tilt_rad.0, tilt_rad.1];
    let line = |(key, rad): (&Key<RigConfig>, f64)| {
        let name = key.path.trim_start_matches("homing.");
        format!("{name} = \"{:.3}deg\"\n", rad.to_degrees())
    };
    let lines: String = HOMING_KEYS.iter().zip(ends).map(line).collect();
    format!("[homing]\n{lines}")
}

/// End stops of which only some are told, or within which a joint does not have its range.
pub(crate) fn impossible_stops(config: &RigConfig) -> Option<String> {
    let (stops, range) = (config.stops_rad, config.model.geometry.range_rad);
    let told = [stops.pan.0, stops.pan.1, stops.tilt.0, stops.tilt.1];
    let missing = HOMING_KEYS.iter().zip(told).find(|(_, stop)| stop.is_none()).map(|(key, _)| key.path);
    if let Some(missing) = missing {
        let some = told.iter().any(Option::is_some);
        return some.then(|| format!("{missing} is missing: give all four stops of [homing], or none"));
    }
    let ends = [-range.pan.0, range.pan.1, -range.tilt.0, range.tilt.1];
    let names =
        ["model.pan.range_min", "model.pan.range_max", "model.tilt.range_min", "model.tilt.range_max"];
    HOMING_KEYS.iter().zip(told.into_iter().flatten()).zip(ends.into_iter().zip(names)).find_map(
        |((key, stop), (end, name))| {
            (stop.abs() <= end).then(|| {
                format!(
                    "{}: this stop is at {:.2} degrees, within the range that the joint is said to have: {name} must end before it",
                    key.path,
                    stop.to_degrees()
                )
            })
        },
    )
}

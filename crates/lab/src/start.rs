use tracelight_rig::TICK_F64_S;

/// Ticks over which a speed is watched: a count more or less is a thirtieth of a rad/s.
pub(crate) const OVER_TICKS: usize = 50;
/// Longest time to come to speed, ticks.
const LONGEST_TICKS: usize = 60_000;

/// Lets ticks pass, each of which says how far a joint went the way it should, rad, until it is as fast as that, rad/s; for a minute at most.
pub(crate) fn come_to_speed(mut tick_rad: impl FnMut() -> f64, rate_rad_s: f64) {
    let wanted_rad = rate_rad_s.abs() * OVER_TICKS as f64 * TICK_F64_S;
    for _ in 0..LONGEST_TICKS / OVER_TICKS {
        if (0..OVER_TICKS).map(|_| tick_rad()).sum::<f64>() >= wanted_rad {
            break;
        }
    }
}

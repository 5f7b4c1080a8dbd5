//! What no rig can be, however sound each number is by itself.

use tracelight_sim::{LightSettings, Model, RigConfig};

use crate::drives::impossible_drive;
use crate::homing::impossible_stops;
use crate::safety::impossible_park;

/// Refuses a rig that there cannot be.
///
/// # Errors
/// What is impossible about it.
pub(crate) fn possible(config: &RigConfig) -> Result<(), String> {
    if let Some(trouble) = impossible_laser(config)
        .or_else(|| impossible_park(config))
        .or_else(|| impossible_stops(config))
        .or_else(|| impossible_drive(config))
        .or_else(|| impossible_silence(config))
    {
        return Err(trouble);
    }
    for (half, model) in [("model", &config.model), ("truth", &config.truth.model)] {
        if let Some(trouble) = impossible(model) {
            return Err(format!("[{half}] {trouble}"));
        }
    }
    impossible_belts(config).map_or(Ok(()), |trouble| Err(format!("[truth.wear] {trouble}")))
}

/// A laser whose label does not tell of its power, or one that is not dark as soon as it must be.
fn impossible_laser(config: &RigConfig) -> Option<String> {
    const SHORTEST_S: f64 = 0.01; // a dot that is light at all, and what a relay may take longer
    let LightSettings { class, power_w, standing_s, .. } = config.light;
    if power_w > class.most_w() {
        return Some(format!(
            "[laser] power: {} mW is more than the {} mW of class {}: set laser.class to what its label says",
            1e3 * power_w,
            1e3 * class.most_w(),
            class.name()
        ));
    }
    let relay_s = config.model.relay.off_s;
    (standing_s < relay_s + SHORTEST_S).then(|| {
        format!(
            "[safety] standing: light may stand for {standing_s} s, and this laser's relay takes {relay_s} s to open: it is too slow for \
             that light, or model.relay.off is not its own"
        )
    })
}

/// A host that is lost before it is silent.
fn impossible_silence(config: &RigConfig) -> Option<String> {
    let (silence_s, lost_s) = (config.control.host_silence_s, config.control.host_lost_s);
    (lost_s < silence_s).then(|| {
        format!(
            "[control] host_lost: a host that is silent for {lost_s} s is lost, but it is waited for only after {silence_s} s: host_lost \
             must be no less than host_silence"
        )
    })
}

/// Least inertia that can be stepped, kg m².
const LEAST_KG_M2: f64 = 1e-9;

/// Belts that cannot be stepped.
fn impossible_belts(config: &RigConfig) -> Option<String> {
    const FASTEST: f64 = 1.5e3; // 1/s: what is damped faster than in some steps of 0.1 ms explodes
    let wear = &config.truth.wear;
    let (bodies, resonance) = (&config.truth.model.bodies, wear.belt_resonance_hz);
    if resonance == 0.0 {
        return None;
    }
    let (mass, rotors) = (bodies.lumped().mass(0.0), bodies.rotor_kg_m2);
    let least = rotors.pan.min(rotors.tilt).min(mass.m11 - rotors.pan).min(mass.m22 - rotors.tilt);
    if least < LEAST_KG_M2 {
        return Some(format!(
            "belt_resonance: a belt needs inertia on both sides, {LEAST_KG_M2:e} kgm2 at least, and has {least:e} kgm2: check \
             rotor_inertia and bodies of [truth], or set it to 0Hz"
        ));
    }
    let rate = std::f64::consts::TAU * resonance * (1.0 + 2.0 * wear.belt_damping);
    (rate > FASTEST).then(|| {
        let most = FASTEST / (std::f64::consts::TAU * (1.0 + 2.0 * wear.belt_damping));
        format!(
            "belt_resonance: with that belt_damping at most {most:.0}Hz can be simulated, not {resonance}Hz"
        )
    })
}

/// What no head can be, however sound each number is by itself.
fn impossible(model: &Model) -> Option<String> {
    const STRONGEST_COUPLING: f64 = 0.5; // of M11 and M22: the plant resolves friction joint by joint
    for (joint, motor) in [("pan", &model.motors.pan), ("tilt", &model.motors.tilt)] {
        let (dead_band_v, limit_v) = (motor.dead_band_v, motor.limit_v);
        if dead_band_v >= limit_v {
            return Some(format!(
                "{joint}.motor.dead_band: nothing comes of less than {dead_band_v} V, and the largest command is {limit_v} V: dead_band must be less than \
                 limit"
            ));
        }
    }
    let lumped = model.bodies.lumped();
    for degrees in -180..=180 {
        let mass = lumped.mass(f64::from(degrees).to_radians());
        let least = mass.m11.min(mass.m22);
        if least < LEAST_KG_M2 {
            let what = format!("the inertia at a joint is {least:e} kgm2 at {degrees}° of tilt");
            return Some(format!(
                "{what}, and must be at least {LEAST_KG_M2:e}: give masses, inertias, rotors"
            ));
        }
        if mass.m12.abs() > STRONGEST_COUPLING * least {
            let what = format!("the joints' coupling inertia is {:e} kgm2 at {degrees}° of tilt", mass.m12);
            return Some(format!("{what}, more than half of a joint's own ({least:e}): check the tilt body"));
        }
    }
    None
}

/// Seeded grain of a surface: mean zero, standard deviation about one, the same for equal arguments.
pub(crate) fn grain(u: usize, v: usize, seed: u64) -> f64 {
    let fine = noise(u, v, seed);
    // fibres: wider than high, smooth between lattice points
    let coarse = smooth(u as f64 / 3.5, v as f64 / 2.5, seed + 1);
    0.8 * fine + 0.8 * coarse
}

/// Noise that is smooth between the points of a lattice of side one, mean zero; the same for equal arguments.
pub(crate) fn smooth(x: f64, y: f64, seed: u64) -> f64 {
    let (u, v) = (x.floor(), y.floor());
    let (s, t) = (x - u, y - v);
    let at = |du, dv| noise(u as usize + du, v as usize + dv, seed);
    let row = |dv| at(0, dv) * (1.0 - s) + at(1, dv) * s;
    row(0) * (1.0 - t) + row(1) * t
}

/// Uniform noise of standard deviation one, without memory.
fn noise(u: usize, v: usize, seed: u64) -> f64 {
    let bits = mix(mix(mix(seed) ^ u as u64) ^ v as u64);
    ((bits >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 12_f64.sqrt()
}

/// The finalizer of SplitMix64 (Steele, Lea & Flood, "Fast splittable pseudorandom number generators", 2014).
fn mix(seed: u64) -> u64 {
    let z = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

use std::sync::LazyLock;

/// Light of each level, as a share of the brightest: cameras store it to a power of about 1/2.2.
pub(crate) fn light_of_levels() -> &'static [f32; 256] {
    static LIGHT: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|level| (level as f32 / 255.0).powf(2.2)));
    &LIGHT
}

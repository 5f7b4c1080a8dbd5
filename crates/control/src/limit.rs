/// `value` held within ±`most`. Unlike [`f32::clamp`] it has no way to panic, whatever the bound.
pub(crate) fn within(value: f32, most: f32) -> f32 {
    value.min(most).max(-most)
}

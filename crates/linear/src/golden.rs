//! Search by the golden section.

/// The lowest value between two places, and where: exact of what falls and then rises. Beyond some 45 sections rounding decides.
pub(crate) fn lowest(
    mut value: impl FnMut(f64) -> f64,
    (mut low, mut high): (f64, f64),
    sections: usize,
) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_a, mut at_b) = (value(a), value(b));
    for _ in 0..sections {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - GOLDEN * (high - low);
            at_a = value(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + GOLDEN * (high - low);
            at_b = value(b);
        }
    }
    if at_a < at_b { (a, at_a) } else { (b, at_b) }
}

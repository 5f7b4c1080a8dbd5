/// A number with at most so many decimals, without trailing zeros and without a minus before a zero.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    if text == "-0" { "0".into() } else { text.into() }
}

/// Length of a drawing as remarks say it: in millimetres where the drawing's unit has a size, else in its own unit.
#[must_use]
pub fn length(units: f64, metres_per_unit: Option<f64>) -> String {
    let (value, unit) = metres_per_unit.map_or((units, "units"), |metres| (1e3 * metres * units, "mm"));
    let decimals = if value < 1.0 { 3 } else { usize::from(value < 100.0) };
    format!("{} {unit}", fixed(value, decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_said_in_millimetres_where_that_is_known() {
        assert_eq!(length(12.34, Some(0.001)), "12.3 mm");
        assert_eq!(length(0.01234, None), "0.012 units");
        assert_eq!(length(1234.5, Some(0.0254 / 96.0)), "327 mm");
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        let check = |value: f64, decimals: usize, wanted: &str| assert_eq!(fixed(value, decimals), wanted);
        check(1.5, 4, "1.5");
        check(100.0, 0, "100");
        check(100.0, 3, "100");
        check(-0.00001, 3, "0");
        check(-0.1256, 3, "-0.126");
        check(1e6, 4, "1000000");
    }
}

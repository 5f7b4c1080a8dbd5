/// A number with at most so many decimals, without trailing zeros and without a minus before a zero.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

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

use tracelight_maths::log10;

use crate::number::fixed;

/// Drawings whose longer side is beyond these have another size than was meant, m: nobody draws less than a millimetre,
/// nor on more than a hundred metres of wall.
pub(crate) const MEANT_M: [f64; 2] = [1e-3, 100.0];

/// Whether a drawing of a width and height, m, may be meant to be that large.
pub(crate) fn is_meant([width, height]: [f64; 2]) -> bool {
    (MEANT_M[0]..=MEANT_M[1]).contains(&width.max(height))
}

/// Why a drawing whose file says how large it is, m, cannot be meant so.
pub(crate) fn doubt(size_m: [f64; 2]) -> Option<String> {
    (!is_meant(size_m)).then(|| {
        let size = lengths(size_m);
        format!("its file says that it is {size}, and drawings from 1 mm to 100 m are drawn: say how large it is to be, --width")
    })
}

/// Width and height, m, as people say them.
pub(crate) fn lengths([width, height]: [f64; 2]) -> String {
    let (per_metre, unit) = match width.max(height) {
        m if m < 10.0 => (1e3, "mm"),
        m if m < 10e3 => (1.0, "m"),
        _ => (1e-3, "km"),
    };
    let number = |m: f64| {
        let value = m * per_metre;
        // three digits that count
        let decimals = 2.0 - log10(value.max(1e-3)).floor().clamp(-3.0, 2.0);
        fixed(value, decimals as usize)
    };
    format!("{} × {} {unit}", number(width), number(height))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_three_digits_that_count() {
        let check = |size: [f64; 2], wanted: &str| assert_eq!(lengths(size), wanted);
        check([0.074, 0.06049], "74 × 60.5 mm");
        check([1.8804, 0.0], "1880 × 0 mm");
        check([0.0002, 0.0000123], "0.2 × 0.0123 mm");
        check([12.345, 2.0], "12.3 × 2 m");
        check([2e6, 1e3], "2000 × 1 km");
    }

    #[test]
    fn sizes_that_cannot_be_meant_are_doubted() {
        assert_eq!(doubt([0.001, 0.0]), None);
        assert_eq!(doubt([9.0, 100.0]), None);
        assert!(doubt([2000.0, 1.0]).unwrap().contains("2000 × 1 m"));
        assert!(doubt([0.0002, 0.0001]).unwrap().contains("0.2 × 0.1 mm"));
    }
}

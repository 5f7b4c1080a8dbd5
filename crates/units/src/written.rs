//! Units as people write them: signs, words, capitals, feet and inches together.

/// What is written, and the unit and how many of it that is.
const WRITTEN: &[(&[&str], &str, f64)] = &[
    (&["\"", "″", "”", "''", "in", "inch", "inches"], "in", 1.0),
    (&["'", "′", "’", "ft", "foot", "feet"], "ft", 1.0),
    (&["m", "meter", "meters", "metre", "metres"], "m", 1.0),
    (&["cm", "centimeter", "centimeters", "centimetre", "centimetres"], "cm", 1.0),
    (&["mm", "millimeter", "millimeters", "millimetre", "millimetres"], "mm", 1.0),
    // the micro sign, the Greek letter, and what keyboards have
    (&["µm", "μm", "um"], "mm", 1e-3),
    (&["°", "deg", "degree", "degrees"], "deg", 1.0),
    (&["rad", "radian", "radians"], "rad", 1.0),
    (&["s", "sec", "second", "seconds"], "s", 1.0),
    (&["min", "minute", "minutes"], "min", 1.0),
    (&["s²"], "s2", 1.0),
    (&["s³"], "s3", 1.0),
];

/// Inches of a foot.
const FOOT_IN: f64 = 12.0;

/// The unit that is meant, and how many of it one is; `°/s` is `deg/s`. `None` where it is written in no way that is known here.
pub(crate) fn meant(unit: &str) -> Option<(String, f64)> {
    let Some((above, below)) = unit.split_once('/') else {
        return single(unit).map(|(name, factor)| (name.to_owned(), factor));
    };
    let (above, factor) = single(above)?;
    let (below, _) =
        single(below).or_else(|| ["s2", "s3"].into_iter().find(|&s| s == below).map(|s| (s, 1.0)))?;
    Some((format!("{above}/{below}"), factor))
}

fn single(unit: &str) -> Option<(&'static str, f64)> {
    let unit = unit.trim().to_lowercase();
    let row = WRITTEN.iter().find(|(ways, ..)| ways.contains(&unit.as_str()))?;
    Some((row.1, row.2))
}

/// Whole feet and what is left of inches, as `5'6"`, `5ft 6in` or `5'6`; in inches.
pub(crate) fn feet_and_inches(text: &str) -> Option<f64> {
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    let digits = text.trim_start_matches(['-', '+']);
    let end = digits.find(|c: char| !c.is_ascii_digit())?;
    let feet: f64 = digits[..end].parse().ok()?;
    let rest = digits[end..].trim_start();
    let mark = ["feet", "foot", "ft", "'", "′", "’"].into_iter().find(|mark| rest.starts_with(mark))?;
    let rest = rest[mark.len()..].trim();
    let plain = || {
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        Some((rest[..end].parse().ok()?, &rest[end..]))
    };
    let (inches, unit): (f64, &str) =
        fraction(rest).filter(|_| rest.starts_with(|c: char| c.is_ascii_digit())).or_else(plain)?;
    let is_inches = unit.is_empty() && mark.chars().count() == 1 || single(unit) == Some(("in", 1.0));
    (is_inches && inches < FOOT_IN).then_some(sign * (feet * FOOT_IN + inches))
}

/// A fraction, with a whole number before it or without, and what follows: `5 1/2in`, `5-1/2in` and `1/2 in`. `None` where a text begins with none.
pub(crate) fn fraction(text: &str) -> Option<(f64, &str)> {
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    let (first, rest) = digits(text.strip_prefix(['-', '+']).unwrap_or(text))?;
    let (whole, above, rest) = match rest.strip_prefix('/') {
        Some(rest) => (0.0, first, rest),
        None => {
            let (above, rest) = digits(rest.strip_prefix([' ', '-'])?.trim_start())?;
            (first, above, rest.strip_prefix('/')?)
        }
    };
    let (below, rest) = digits(rest)?;
    (below > 0.0).then(|| (sign * (whole + above / below), rest.trim_start()))
}

/// The digits that a text begins with, as a number, and what follows.
fn digits(text: &str) -> Option<(f64, &str)> {
    let (number, rest) = text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()));
    number.parse().ok().map(|number| (number, rest))
}

/// What was meant by a number with a comma in it, with a point; and without either, where it may part thousands.
pub(crate) fn with_point(text: &str) -> Option<String> {
    let (whole, rest) = text.split_once(',')?;
    let digits = rest.chars().take_while(char::is_ascii_digit).count();
    let number = whole.trim_start_matches(['-', '+']);
    let is_number = !number.is_empty() && number.chars().all(|c| c.is_ascii_digit());
    if !is_number || digits == 0 || rest.contains(',') {
        return None;
    }
    let thousands = if digits == 3 { format!(", or {whole}{rest} for thousands") } else { String::new() };
    Some(format!("{whole}.{rest}{thousands}"))
}

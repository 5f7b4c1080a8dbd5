use tracelight_linear::Complex;

/// Poles on the command line, pairs complete.
#[derive(Clone, Debug)]
pub(super) struct Poles(pub(super) Vec<Complex>);

pub(super) fn poles(text: &str) -> Result<Poles, String> {
    let mut all = Vec::new();
    for part in text.split(',') {
        let part = part.trim().replace('−', "-");
        let wrong = || format!("{part} is no pole; write -30, or -40+20j for a pair");
        let pole = match part.strip_suffix('j') {
            None => Complex::new(part.parse().map_err(|_| wrong())?, 0.0),
            Some(pair) => {
                // the sign that is not at the beginning, and not an exponent's
                let sign = |(i, c): &(usize, char)| {
                    *i > 0 && matches!(c, '+' | '-' | '±') && !pair[..*i].ends_with(['e', 'E'])
                };
                let (at, c) = pair.char_indices().rfind(sign).ok_or_else(wrong)?;
                let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
                Complex::new(number(&pair[..at])?, number(&pair[at + c.len_utf8()..])?.abs())
            }
        };
        if !(pole.re.abs() <= 1e9 && pole.im.abs() <= 1e9) {
            return Err(wrong());
        }
        all.push(pole);
        if pole.im != 0.0 {
            all.push(pole.conj());
        }
    }
    Ok(Poles(all))
}

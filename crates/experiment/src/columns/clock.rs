//! Times as logs have them: dates, times of day, and counters that begin again.

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;
/// How far the counters of 16 and 32 bits go that boards count time with.
const COUNTERS: [f64; 2] = [65_536.0, 4_294_967_296.0];
/// A counter that begins again does so at most so many usual steps after the last row.
const STEPS: f64 = 50.0;

/// A date with a time of day, or a time of day alone, s: `2026-11-28T21:04:05.250`, `28.11.2026 21:04:05`, `21:04:05,25`. Only
/// differences of them are worth something. `None` of what is none.
pub(super) fn of_day(text: &str) -> Option<f64> {
    let text = text.trim();
    if !text.contains(':') {
        return None;
    }
    let Some((date, time)) = text.split_once(['T', ' ']) else { return clock(text) };
    Some(days(date)? * DAY_S + clock(time.trim())?)
}

/// Hours, minutes and seconds, and what they are ahead of Greenwich.
fn clock(text: &str) -> Option<f64> {
    let text = text.trim_end_matches('Z');
    let (time, ahead_s) = match text.rfind(['+', '-']) {
        Some(at) => {
            let zone = &text[at + 1..];
            let (hours, minutes) = zone.split_once(':').or_else(|| zone.split_at_checked(2))?;
            let sign = if text.as_bytes()[at] == b'-' { -1.0 } else { 1.0 };
            let minutes = if minutes.is_empty() { 0 } else { minutes.parse::<u32>().ok()? };
            (&text[..at], sign * f64::from(hours.parse::<u32>().ok()? * 3600 + minutes * 60))
        }
        None => (text, 0.0),
    };
    let mut parts = time.split(':');
    let hours: u32 = parts.next()?.parse().ok()?;
    let minutes: u32 = parts.next()?.parse().ok()?;
    let seconds: f64 = parts.next().map_or(Some(0.0), |s| s.replace(',', ".").parse().ok())?;
    let fits = hours < 24 && minutes < 60 && (0.0..61.0).contains(&seconds) && parts.next().is_none();
    fits.then(|| f64::from(hours * 3600 + minutes * 60) + seconds - ahead_s)
}

/// Days since some day: the year first, with - or /, or last, with points.
fn days(text: &str) -> Option<f64> {
    let split = |mark: char| {
        let parts: Vec<i64> = text.split(mark).map(|part| part.parse().ok()).collect::<Option<_>>()?;
        <[i64; 3]>::try_from(parts).ok()
    };
    let [year, month, day] = match (split('-').or_else(|| split('/')), split('.')) {
        (Some(date), _) => date,
        (None, Some([day, month, year])) => [year, month, day],
        (None, None) => return None,
    };
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) || !(1000..10_000).contains(&year) {
        return None;
    }
    // Howard Hinnant, *chrono-Compatible Low-Level Date Algorithms*, days_from_civil: the year begins in March
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    Some((365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1) as f64)
}

/// Times whose counter began again go on where it stopped: counters of 16 and 32 bits, or times of day at midnight. What falls back
/// otherwise is left. How often one began again.
pub(super) fn unwrapped(times: &mut [f64], of_day: bool) -> usize {
    let mut steps: Vec<f64> =
        times.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    if steps.is_empty() {
        return 0;
    }
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let whole = times.iter().all(|time| time.fract() == 0.0);
    let periods: &[f64] = match (of_day, whole) {
        (true, _) => &[DAY_S],
        (false, true) => &COUNTERS,
        (false, false) => &[],
    };
    let (mut ahead, mut count, mut last) = (0.0, 0, times[0]);
    for time in times.iter_mut().skip(1) {
        let raw = *time;
        if raw < last {
            let lies = |period: &f64| (0.0..=STEPS * usual).contains(&(raw + period - last));
            if let Some(period) = periods.iter().find(|period| lies(period)) {
                ahead += period;
                count += 1;
            } else {
                ahead = 0.0;
            }
        }
        last = raw;
        *time = raw + ahead;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_of_day_are_seconds() {
        let since = |text: &str| of_day(text).unwrap() - of_day("2026-11-28T21:00:00").unwrap();
        assert_eq!(since("2026-11-28 21:04:05.25"), 245.25);
        assert_eq!(since("28.11.2026 21:04:05,25"), 245.25);
        assert_eq!(since("2026/11/28T22:04:05.25+01:00"), 245.25);
        assert_eq!(since("2026-12-01T21:00:00Z"), 3.0 * DAY_S);
        assert_eq!(of_day("0:01:02.5"), Some(62.5));
        for text in ["", "12", "1:2:3:4", "25:00:00", "2026-13-01 10:00", "10:61", "a:b"] {
            assert_eq!(of_day(text), None, "{text}");
        }
    }

    #[test]
    fn counters_go_on_and_restarts_are_left() {
        let mut times = vec![65_500.0, 65_520.0, 4.0, 24.0, 44.0];
        assert_eq!(unwrapped(&mut times, false), 1);
        assert_eq!(times, [65_500.0, 65_520.0, 65_540.0, 65_560.0, 65_580.0]);
        let mut times = vec![4_294_967_290.0, 4_294_967_295.0, 4.0, 9.0];
        assert_eq!(unwrapped(&mut times, false), 1);
        assert_eq!(times[3], 4_294_967_305.0);
        // a minute, and then the board was started again
        let mut times = vec![59_980.0, 60_000.0, 0.0, 20.0];
        assert_eq!(unwrapped(&mut times, false), 0);
        assert_eq!(times[2], 0.0);
        let mut midnight = vec![86_399.5, 86_399.75, 0.0, 0.25];
        assert_eq!(unwrapped(&mut midnight, true), 1);
        assert_eq!(midnight[3], 86_400.25);
    }
}

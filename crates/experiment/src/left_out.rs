//! Measured points that are not trusted: how many, and where.

use serde_json::{Value, json};
use tracelight_linear::FrequencyData;

use crate::numbers::four;
use crate::plant_file::LEAST_COHERENCE;

/// How many points were left out, and where, in words after what is said of the others; nothing where none was.
pub(crate) fn words(data: &FrequencyData) -> String {
    /// So many places are named.
    const MOST: usize = 4;
    let count = data.left_out().len();
    if count == 0 {
        return String::new();
    }
    let runs = runs(data);
    let place = |&(from, to): &(f64, f64)| match from == to {
        true => format!("at {} rad/s", four(from)),
        false => format!("from {} to {} rad/s", four(from), four(to)),
    };
    let places: Vec<String> = runs.iter().take(MOST).map(place).collect();
    let more = if runs.len() > MOST {
        format!(", and in {} other places", runs.len() - MOST)
    } else {
        String::new()
    };
    let (low, high) = data.band();
    let is_between = runs.iter().any(|run| run.0 > low && run.1 < high);
    format!(
        "\n    {count} more {} left out, as the coherence is below {LEAST_COHERENCE}: {}{more}{}",
        if count == 1 { "is" } else { "are" },
        places.join(", "),
        if is_between { "; between its neighbours the response is interpolated" } else { "" }
    )
}

/// First and last frequency, rad/s, of points without a good one between them.
fn runs(data: &FrequencyData) -> Vec<(f64, f64)> {
    let mut all: Vec<f64> = data.left_out().iter().map(|point| point.0).collect();
    all.sort_by(f64::total_cmp);
    let good_below = |w: f64| data.rad_s().partition_point(|good| *good < w);
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for w in all {
        match runs.last_mut() {
            Some(run) if good_below(run.1) == good_below(w) => run.1 = w,
            _ => runs.push((w, w)),
        }
    }
    runs
}

/// The points for scripts; nothing where there are none.
pub(crate) fn json(data: &FrequencyData) -> Value {
    let rad_s: Vec<f64> = data.left_out().iter().map(|point| point.0).collect();
    if rad_s.is_empty() {
        return Value::Null;
    }
    json!({"count": rad_s.len(), "coherence_below": LEAST_COHERENCE, "rad_s": rad_s})
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant_file::{PlantFile, read};
    use crate::table::Log;

    fn data(rows: &[(f64, f64)]) -> Result<FrequencyData, String> {
        let rows =
            rows.iter().map(|(w, coherence)| format!("{w},{},{},{coherence}\n", 1.0 / w, -90.0 - 10.0 * w));
        let text = format!("rad_s,magnitude_rad_per_v,phase_deg,coherence\n{}", rows.collect::<String>());
        let PlantFile::Frequencies(data) =
            read(&Log { name: "own.csv".into(), bytes: text.into_bytes() }, None)
                .map_err(|e| e.message)?
                .system
        else {
            panic!("it is measured");
        };
        Ok(data)
    }

    #[test]
    fn points_of_low_coherence_are_left_out_and_told() {
        let good: Vec<(f64, f64)> = (1..=8).map(|w| (f64::from(w), 0.99)).collect();
        assert_eq!(words(&data(&good).unwrap()), "");
        let mut mixed = good.clone();
        for (i, coherence) in [(2, 0.3), (3, 0.899), (7, 0.0)] {
            mixed[i].1 = coherence;
        }
        let read = data(&mixed).unwrap();
        assert_eq!(read.rad_s(), [1.0, 2.0, 5.0, 6.0, 7.0]);
        let told = words(&read);
        assert!(
            told.contains("3 more are left out") && told.contains("from 3 to 4 rad/s, at 8 rad/s"),
            "{told}"
        );
        assert!(told.contains("interpolated"), "{told}");
        // they go through what is made of the response
        let twice = read.scaled(2.0).unwrap();
        assert_eq!(twice.left_out()[0].0, 3.0);
        assert!((twice.left_out()[0].1.norm_sqr() - 4.0 / 9.0).abs() < 1e-12);
        assert_eq!(json(&read)["count"], 3);
        let bad: Vec<(f64, f64)> = good.iter().map(|(w, _)| (*w, 0.5)).collect();
        assert!(data(&bad).unwrap_err().contains("coherence below 0.9"));
    }

    /// With the noise of its last points the phase would cross −180° where it does not.
    #[test]
    fn a_margin_is_none_of_what_is_noise() {
        let mut rows: Vec<(f64, f64)> = (1..=12).map(|w| (f64::from(w), 0.99)).collect();
        assert!(!data(&rows).unwrap().margins().gain.is_empty());
        rows.iter_mut().skip(8).for_each(|row| row.1 = 0.2);
        assert!(data(&rows).unwrap().margins().gain.is_empty());
    }
}

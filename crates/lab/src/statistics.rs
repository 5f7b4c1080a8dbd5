/// What many values are like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quantiles {
    /// Half of them are not above.
    pub median: f64,
    /// 95 of 100 are not above.
    pub p95: f64,
    /// None is above.
    pub worst: f64,
}

impl Quantiles {
    /// Of these values, in any order; zeros of none. A quantile is the smallest value with at least that share of all
    /// not above it (Hyndman & Fan, *Sample Quantiles in Statistical Packages*, 1996, definition 1).
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (share * sorted.len() as f64).ceil().max(1.0) as usize - 1;
            sorted.get(place).copied().unwrap_or_default()
        };
        Self { median: at(0.5), p95: at(0.95), worst: at(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_that_occurred() {
        let twenty = Quantiles::of((1..=20).rev().map(f64::from));
        assert_eq!(twenty, Quantiles { median: 10.0, p95: 19.0, worst: 20.0 });
        assert_eq!(Quantiles::of([3.0]), Quantiles { median: 3.0, p95: 3.0, worst: 3.0 });
        assert_eq!(Quantiles::of([]), Quantiles::default());
    }
}

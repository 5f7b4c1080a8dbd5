//! What a camera says of itself, and how its images come.

/// What a camera says of itself; as much as it does.
#[derive(Clone, Debug, Default)]
pub(crate) struct About {
    /// What its maker calls it.
    pub(crate) name: Option<String>,
    pub(crate) driver: Option<String>,
    /// What it can send, and which of that it sends: columns and rows, coding, images a second.
    pub(crate) modes: Vec<String>,
    pub(crate) mode: Option<String>,
    /// Shortest and longest exposure, s, of one that can be told.
    pub(crate) exposure_s: Option<[f64; 2]>,
    /// Least, present and greatest gain, in its own units.
    pub(crate) gain: Option<[i64; 3]>,
    /// Whether it focuses by itself, which changes what a lens was calibrated for.
    pub(crate) focuses: bool,
    /// How its images came until now.
    pub(crate) rhythm: Rhythm,
}

/// How images come.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rhythm {
    /// Whole images.
    pub(crate) images: u32,
    /// Those that were counted and never came.
    pub(crate) lost: u32,
    /// Those that came in part.
    pub(crate) broken: u32,
    /// When the first and the last began to be exposed, s.
    pub(crate) between_s: Option<[f64; 2]>,
    /// From the beginning of an exposure to its image's arrival, s.
    pub(crate) late_s: Vec<f64>,
    /// Whether images are stamped with when they began to be exposed; else that is reckoned from when they came.
    pub(crate) is_stamped: bool,
}

impl Rhythm {
    /// Images a second, broken and lost ones, too.
    pub(crate) fn rate_hz(&self) -> Option<f64> {
        let [first, last] = self.between_s?;
        let sent = f64::from(self.images + self.lost + self.broken) - 1.0;
        (last > first && sent > 0.0).then(|| sent / (last - first))
    }

    /// Least, median and greatest latency, s; `None` where it is not known.
    pub(crate) fn latency_s(&self) -> Option<[f64; 3]> {
        let mut late_s = self.late_s.clone();
        late_s.sort_by(f64::total_cmp);
        let (first, last) = (late_s.first()?, late_s.last()?);
        self.is_stamped.then_some([*first, late_s[late_s.len() / 2], *last])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_lost_or_broken_was_sent_all_the_same() {
        let rhythm = Rhythm {
            images: 28,
            lost: 2,
            broken: 1,
            between_s: Some([10.0, 11.0]),
            late_s: vec![0.07, 0.05, 0.06],
            is_stamped: true,
        };
        assert_eq!(rhythm.rate_hz(), Some(30.0));
        assert_eq!(rhythm.latency_s(), Some([0.05, 0.06, 0.07]));
        assert_eq!(Rhythm { is_stamped: false, ..rhythm }.latency_s(), None);
        let none = Rhythm::default();
        assert_eq!((none.rate_hz(), none.latency_s()), (None, None));
    }
}

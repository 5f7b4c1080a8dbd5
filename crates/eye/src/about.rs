//! What a camera says of itself, and how its images come.

/// What a camera says of itself; as much as it does.
#[derive(Clone, Debug, Default)]
pub struct About {
    /// What its maker calls it.
    pub name: Option<String>,
    /// The driver, as the system names it.
    pub driver: Option<String>,
    /// What it can send, and which of that it sends: columns and rows, coding, images a second.
    pub modes: Vec<String>,
    /// How large its images are, how often they come, and how pixels are coded.
    pub mode: Option<String>,
    /// Shortest and longest exposure, s, of one that can be told.
    pub exposure_s: Option<[f64; 2]>,
    /// Least, present and greatest gain, in its own units.
    pub gain: Option<[i64; 3]>,
    /// Whether it focuses by itself, which changes what a lens was calibrated for.
    pub focuses: bool,
    /// How its images came until now.
    pub rhythm: Rhythm,
}

/// How images come.
#[derive(Clone, Debug, Default)]
pub struct Rhythm {
    /// Whole images.
    pub images: u32,
    /// Those that were counted and never came.
    pub lost: u32,
    /// Those that came in part.
    pub broken: u32,
    /// Stamps of the first and the last, s.
    pub between_s: Option<[f64; 2]>,
    /// From an image's stamp until all of it was there, s.
    pub late_s: Vec<f64>,
    /// What its stamps say.
    pub stamps: Stamps,
}

/// What images are stamped with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stamps {
    /// When they began to arrive; some drivers mean, to be exposed.
    Beginning,
    /// When all of them had arrived.
    End,
    /// Nothing: when they began to arrive is reckoned from when they were there.
    #[default]
    None,
}

impl Rhythm {
    /// Images a second, broken and lost ones, too.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        let [first, last] = self.between_s?;
        let sent = f64::from(self.images + self.lost + self.broken) - 1.0;
        (last > first && sent > 0.0).then(|| sent / (last - first))
    }

    /// Least, median and greatest time from an image's stamp until it is there, s; `None` where images have none.
    pub fn latency_s(&self) -> Option<[f64; 3]> {
        let mut late_s = self.late_s.clone();
        late_s.sort_by(f64::total_cmp);
        let (first, last) = (late_s.first()?, late_s.last()?);
        (self.stamps == Stamps::Beginning).then_some([*first, late_s[late_s.len() / 2], *last])
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
            stamps: Stamps::Beginning,
        };
        assert_eq!(rhythm.rate_hz(), Some(30.0));
        assert_eq!(rhythm.latency_s(), Some([0.05, 0.06, 0.07]));
        assert_eq!(Rhythm { stamps: Stamps::None, ..rhythm }.latency_s(), None);
        let none = Rhythm::default();
        assert_eq!((none.rate_hz(), none.latency_s()), (None, None));
    }
}

//! Finds runs of ink on both sides of a rule and pairs those that belong together.

/// A stretch of ink in a row of pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    /// Where it is half as dark as at its darkest, px from the first pixel's centre.
    pub(super) left: f32,
    pub(super) right: f32,
    /// Its most darkness.
    pub(super) peak: f32,
    /// By how much it moves to the right a row towards the rule.
    pub(super) slope: f32,
    /// By how much it gets narrower a row towards the rule, as a bow that touches it does.
    pub(super) narrows: f32,
}

/// A width differs from another by no more than this, as a ratio, and so many px, where both are of one stroke.
const AS_WIDE: f32 = 1.6;
const AS_WIDE_PX: f32 = 1.5;
/// Steepest course along a row that can be told, px a row: 9° from the row.
const FLATTEST: f32 = 6.5;
/// Stretches of two rows hang together if they are no further apart, px.
const TOUCHING_PX: f32 = 1.5;

impl Run {
    pub(super) fn middle(&self) -> f32 {
        0.5 * (self.left + self.right)
    }

    pub(super) fn width(&self) -> f32 {
        self.right - self.left
    }

    pub(super) fn is_as_wide_as(&self, other: &Run) -> bool {
        let (less, more) = (self.width().min(other.width()), self.width().max(other.width()));
        more <= (AS_WIDE * less).max(less + AS_WIDE_PX)
    }

    pub(super) fn shifted(&self, by: f32) -> Run {
        Run { left: self.left + by, right: self.right + by, ..self.clone() }
    }

    /// Takes its slope from the stretch that it is of in a row so far away, on the side away from the rule.
    pub(super) fn lean_on(&mut self, far: &[Run], apart: f32) {
        let reach = FLATTEST * apart;
        let gap = |run: &Run| (run.left - self.right).max(self.left - run.right);
        let near = far.iter().filter(|run| gap(run) <= reach && self.is_as_wide_as(run));
        let nearest = near.min_by(|a, b| {
            let off = |run: &Run| (run.middle() - self.middle()).abs();
            off(a).total_cmp(&off(b))
        });
        if let Some(run) = nearest {
            self.slope = (self.middle() - run.middle()) / apart;
        }
        let beside = far.iter().filter(|run| gap(run) <= reach.min(TOUCHING_PX));
        let (left, right) =
            beside.fold((self.left, self.right), |(l, r), run| (l.min(run.left), r.max(run.right)));
        let wider = (right - left - self.width() - (self.slope * apart).abs()).max(0.0);
        self.narrows = wider / apart;
    }

    /// What is left of it so many rows further on, in the rule; the other way round where that is nothing.
    pub(super) fn carried(&self, rows: f32) -> Run {
        let (moved, narrower) = (self.slope * rows, 0.5 * self.narrows * rows);
        Run { left: self.left + moved + narrower, right: self.right + moved - narrower, ..self.clone() }
    }
}

/// The stretches of a row that are darker than paper by a margin.
pub(super) fn runs(row: &[f32], paper: f32, margin: f32) -> Vec<Run> {
    let mut found = Vec::new();
    let mut x = 0;
    while x < row.len() {
        if row[x] <= paper + margin {
            x += 1;
            continue;
        }
        let len = row[x..].iter().position(|&v| v <= paper + margin).unwrap_or(row.len() - x);
        split(row, x..x + len, paper, &mut found);
        x += len;
    }
    found
}

/// The parts of a stretch that are more than half as dark as its darkest.
fn split(row: &[f32], stretch: std::ops::Range<usize>, paper: f32, found: &mut Vec<Run>) {
    let peak = row[stretch.clone()].iter().copied().fold(0.0, f32::max);
    let half = 0.5 * (paper + peak);
    let mut x = stretch.start;
    while x < stretch.end {
        if row[x] <= half {
            x += 1;
            continue;
        }
        let len = row[x..stretch.end].iter().position(|&v| v <= half).unwrap_or(stretch.end - x);
        let (first, last) = (x, x + len - 1);
        // where the levels pass the half
        let edge = |inner: usize, outer: Option<&f32>| match outer {
            Some(&v) if v < half => (row[inner] - half) / (row[inner] - v),
            _ => 0.5,
        };
        let left = first as f32 - edge(first, first.checked_sub(1).and_then(|k| row.get(k)));
        let right = last as f32 + edge(last, row.get(last + 1));
        found.push(Run { left, right, peak, slope: 0.0, narrows: 0.0 });
        x += len;
    }
}

/// Which stretches above a rule go on below it: those that lead to each other.
pub(super) fn pairs(upper: &[Run], lower: &[Run], height: impl Fn(f32) -> f32) -> Vec<(usize, usize)> {
    let mut near: Vec<(f32, usize, usize)> = Vec::new();
    for (a, above) in upper.iter().enumerate() {
        let h = height(above.middle());
        let reach = FLATTEST * h + above.width();
        let first = lower.partition_point(|run| run.right < above.left - reach);
        for (b, below) in
            lower.iter().enumerate().skip(first).take_while(|(_, r)| r.left < above.right + reach)
        {
            let off = misfit(above, below, h);
            if off <= 1.0 {
                near.push((off, a, b));
            }
        }
    }
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let (mut first, mut second) = (vec![false; upper.len()], vec![false; lower.len()]);
    let mut found = Vec::new();
    for (_, a, b) in near {
        // two strokes may become one within the rule, but a pair needs one that has no better fellow
        if !first[a] || !second[b] {
            found.push((a, b));
            (first[a], second[b]) = (true, true);
        }
    }
    found
}

/// How far two stretches are from where each leads the other, as a share of what is allowed.
fn misfit(above: &Run, below: &Run, height: f32) -> f32 {
    let down = above.shifted(above.slope * height);
    let up = below.shifted(below.slope * height);
    // a narrow one may meet a wide one anywhere
    let off = |moved: &Run, other: &Run| {
        let free = 0.5 * (moved.width() - other.width()).abs();
        ((moved.middle() - other.middle()).abs() - free).max(0.0)
    };
    let steepest = above.slope.abs().max(below.slope.abs());
    let allowed = 0.35 * above.width().min(below.width()) + 0.3 * steepest * height + 0.12 * height + 0.7;
    off(&down, below).min(off(&up, above)).max(0.5 * off(&down, below).max(off(&up, above))) / allowed
}

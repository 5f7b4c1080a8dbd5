//! A line cut into what is seen of it and what is not.

use tracelight_stroke::{Path, Point, Span, Vec2, parts};

use super::crossings::{Edges, Own, Owner};
use super::flat::{Corner, chords};
use super::scene::{Mark, MarkKind, Number};
use super::verdict::{Judge, Place, Reason, Verdict};

/// Stretches shorter than so many times the distance from which lines are looked at are not cut, nor drawn alone.
const LEAST: f64 = 5.0;

/// A middle goes on where it has the colour of what is around it for no longer than so many widths of its band: beyond, a side is drawn instead.
const GAP: f64 = 1.5;

/// Stretches of a band's side shorter than so many times its width belong to the end of its middle.
const CRUMB: f64 = 0.5;

/// A stretch of a chord with one verdict.
#[derive(Clone, Copy)]
struct Stretch {
    chord: usize,
    from: f64,
    to: f64,
    length: f64,
}

/// What became of a line.
pub(crate) struct Judged {
    /// What is seen, each with the item whose looks it has.
    pub(crate) seen: Vec<(Path, Number)>,
    /// Lengths of what is not.
    pub(crate) unseen: Vec<(Reason, f64)>,
    /// Edges and segments looked at.
    pub(crate) work: usize,
}

/// Judges a line all along; its chords lie within `tolerance` of it.
/// `None` if that takes more work than is left.
pub(crate) fn judged(
    judge: &Judge,
    edges: &Edges,
    (mark, path): (Mark, &Path),
    tolerance: f64,
    left: usize,
) -> Option<Judged> {
    let corners = chords(path, tolerance);
    let before = judge.picture.work.get();
    let (runs, met) = runs(judge, edges, mark, &corners, before.saturating_add(left))?;
    let pen = judge.picture.scene.items[mark.item as usize].pen.unwrap_or(0.0);
    let crumb = LEAST * judge.aside;
    let (rest, gap) = match mark.kind {
        MarkKind::Side => (crumb.max(CRUMB * pen), crumb),
        MarkKind::Middle => (crumb, crumb.max(GAP * pen)),
        MarkKind::Edge | MarkKind::Cut(_) => (crumb, crumb),
    };
    let runs = smoothed(runs, Least { crumb, rest, gap }, path.is_closed());
    let mut judged = Judged { seen: Vec::new(), unseen: Vec::new(), work: met };
    let mut items: Vec<Number> = Vec::new();
    for run in &runs {
        match run.verdict {
            Verdict::Seen(item) if !items.contains(&item) => items.push(item),
            Verdict::Unseen(Some(reason)) => judged.unseen.push((reason, run.length())),
            _ => {}
        }
    }
    for item in items {
        let own = runs.iter().filter(|run| run.verdict == Verdict::Seen(item));
        let spans = spans(&corners, own.flat_map(|run| &run.stretches));
        judged.seen.extend(parts(path, &spans).into_iter().map(|path| (path, item)));
    }
    judged.work += judge.picture.work.get() - before;
    Some(judged)
}

/// Stretches that follow each other and share a verdict.
struct Run {
    verdict: Verdict,
    stretches: Vec<Stretch>,
}

impl Run {
    fn length(&self) -> f64 {
        self.stretches.iter().map(|s| s.length).sum()
    }
}

/// Runs of a line so far.
struct Walk<'a> {
    judge: &'a Judge<'a>,
    edges: &'a Edges,
    mark: Mark,
    corners: &'a [Corner],
    runs: Vec<Run>,
    /// Stretches since the last edge that the line met.
    pending: Vec<Stretch>,
    /// What covers these stretches, once that was asked.
    cover: Option<Option<Number>>,
    work: usize,
    /// Work at most, that of looking included.
    most: usize,
}

impl Walk<'_> {
    fn is_spent(&self) -> bool {
        self.work.saturating_add(self.judge.picture.work.get()) > self.most
    }

    fn chord(&mut self, chord: usize, counts: impl Fn(Owner) -> bool, met: &mut Vec<f64>) {
        let ends = [self.corners[chord].point, self.corners[chord + 1].point];
        let length = ends[0].distance(ends[1]);
        let whole = Stretch { chord, from: 0.0, to: 1.0, length };
        if let Some(Some(cover)) = self.cover {
            if self.stays_below(cover, ends) {
                return self.pending.push(whole);
            }
            self.meet();
        }
        if self.judge.picture.is_hidden(self.mark.item, ends) {
            self.meet();
            return self.add(self.judge.hidden(self.mark, ends[0].midpoint(ends[1])), vec![whole]);
        }
        if self.judge.is_stood_for(self.mark, ends) {
            self.meet();
            return self.add(Verdict::Unseen(None), vec![whole]);
        }
        self.work += self.edges.met(ends, Own(self.mark.kind, self.mark.item), counts, met);
        let mut from = 0.0;
        for &to in &*met {
            if self.is_spent() {
                return;
            }
            if to > from {
                self.follow(Stretch { chord, from, to, length: (to - from) * length });
                from = to;
            }
            self.meet();
        }
        if from < 1.0 {
            let rest = Stretch { chord, from, to: 1.0, length: (1.0 - from) * length };
            self.follow(rest);
            if self.cover.is_none() && rest.length >= self.judge.aside {
                self.cover = Some(self.judge.cover(self.mark, middle(self.corners, &rest)));
            }
        }
    }

    /// Goes along a stretch that meets no edge, and looks again where that is long.
    fn follow(&mut self, stretch: Stretch) {
        const MOST: f64 = 1024.0;
        let step = self.judge.step_of(self.mark);
        let parts = (stretch.length / step).ceil().clamp(1.0, MOST);
        let is_long =
            |pending: &[Stretch]| step.is_finite() && pending.iter().map(|s| s.length).sum::<f64>() >= step;
        for i in 0..parts as usize {
            let at = |i: usize| stretch.from + (stretch.to - stretch.from) * i as f64 / parts;
            let [from, to] = [at(i), if i + 1 == parts as usize { stretch.to } else { at(i + 1) }];
            if is_long(&self.pending) {
                self.meet();
            }
            self.pending.push(Stretch { from, to, length: stretch.length / parts, ..stretch });
        }
    }

    /// Whether a chord stays below what covers the stretches before it. Where that is covered itself its edges are not known.
    fn stays_below(&mut self, cover: Number, chord: [Point; 2]) -> bool {
        self.work += 1;
        !self.judge.picture.is_somewhere_hidden(cover, chord) && !self.edges.nears(chord, cover)
    }

    /// Ends the pending stretches where an edge is met, and looks at the longest of them.
    fn meet(&mut self) {
        let cover = self.cover.take();
        let longest = self.pending.iter().max_by(|a, b| a.length.total_cmp(&b.length));
        let Some(longest) = longest else { return };
        let is_short = self.pending.iter().map(|s| s.length).sum::<f64>() < self.judge.aside;
        match self.runs.last_mut() {
            // too short to look at: as what is before it
            Some(before) if is_short => before.stretches.append(&mut self.pending),
            _ => {
                let place = middle(self.corners, longest);
                let verdict = match cover.unwrap_or_else(|| self.judge.cover(self.mark, place)) {
                    Some(_) => self.judge.hidden(self.mark, place.point),
                    None => self.judge.verdict(self.mark, place),
                };
                let stretches = std::mem::take(&mut self.pending);
                self.add(verdict, stretches);
            }
        }
    }

    fn add(&mut self, verdict: Verdict, stretches: Vec<Stretch>) {
        match self.runs.last_mut().filter(|run| run.verdict == verdict) {
            Some(run) => run.stretches.extend(stretches),
            None => self.runs.push(Run { verdict, stretches }),
        }
    }
}

fn runs(
    judge: &Judge,
    edges: &Edges,
    mark: Mark,
    corners: &[Corner],
    most: usize,
) -> Option<(Vec<Run>, usize)> {
    let counts = |owner: Owner| does_count(judge, mark, owner);
    let (runs, pending) = (Vec::new(), Vec::new());
    let mut walk = Walk { judge, edges, mark, corners, runs, pending, cover: None, work: 0, most };
    let mut met = Vec::new();
    for chord in 0..corners.len().saturating_sub(1) {
        walk.chord(chord, counts, &mut met);
        if walk.is_spent() {
            return None;
        }
    }
    walk.meet();
    Some((walk.runs, walk.work))
}

/// Whether what owns an edge could change the verdict on a line.
fn does_count(judge: &Judge, mark: Mark, owner: Owner) -> bool {
    let Owner::Item(number) = owner else { return true };
    if !judge.picture.hides {
        return matches!(mark.kind, MarkKind::Cut(_));
    }
    let items = &judge.picture.scene.items;
    let (item, own) = (&items[number as usize], &items[mark.item as usize]);
    match mark.kind {
        MarkKind::Middle => {
            item.source != own.source && (item.pen.is_none() || item.ink != own.ink || item.pen > own.pen)
        }
        _ => true,
    }
}

fn middle(corners: &[Corner], stretch: &Stretch) -> Place {
    let [a, b] = [corners[stretch.chord].point, corners[stretch.chord + 1].point];
    let along = (b - a) / (b - a).hypot().max(f64::MIN_POSITIVE);
    Place { point: a.lerp(b, 0.5 * (stretch.from + stretch.to)), normal: Vec2::new(-along.y, along.x) }
}

/// What is too short to count.
#[derive(Clone, Copy)]
struct Least {
    /// Of any gap.
    crumb: f64,
    /// Of what is drawn.
    rest: f64,
    /// Of a gap of one colour.
    gap: f64,
}

/// Short gaps closed and short rests left out; round a closed line the last run and the first are one.
fn smoothed(runs: Vec<Run>, least: Least, is_closed: bool) -> Vec<Run> {
    let is_seen = |run: &Run| matches!(run.verdict, Verdict::Seen(_));
    let runs = merged(runs, |run, before, after| {
        let is_one_colour = run.verdict == Verdict::Unseen(Some(Reason::OneColour));
        let shortest = if is_one_colour { least.gap } else { least.crumb };
        let is_gap =
            !is_seen(run) && run.length() < shortest && is_seen(before) && before.verdict == after.verdict;
        is_gap.then_some(before.verdict)
    });
    if runs.len() < 2 {
        return runs;
    }
    let count = runs.len();
    let joined = is_closed && runs[0].verdict == runs[count - 1].verdict;
    let round = if joined { runs[0].length() + runs[count - 1].length() } else { 0.0 };
    let whole = |i: usize| if joined && (i == 0 || i + 1 == count) { round } else { runs[i].length() };
    let is_rest: Vec<bool> = (0..count).map(|i| is_seen(&runs[i]) && whole(i) < least.rest).collect();
    let rests = runs.into_iter().zip(is_rest);
    rests
        .map(|(run, is_rest)| if is_rest { Run { verdict: Verdict::Unseen(None), ..run } } else { run })
        .collect()
}

/// Runs with the verdict of their neighbours where the function, asked of each and those beside it, says so.
fn merged(runs: Vec<Run>, verdict: impl Fn(&Run, &Run, &Run) -> Option<Verdict>) -> Vec<Run> {
    let new: Vec<Option<Verdict>> = (0..runs.len())
        .map(|i| {
            (i > 0 && i + 1 < runs.len()).then(|| verdict(&runs[i], &runs[i - 1], &runs[i + 1])).flatten()
        })
        .collect();
    let mut done: Vec<Run> = Vec::new();
    for (run, new) in runs.into_iter().zip(new) {
        let verdict = new.unwrap_or(run.verdict);
        match done.last_mut().filter(|before| before.verdict == verdict) {
            Some(before) => before.stretches.extend(run.stretches),
            None => done.push(Run { verdict, ..run }),
        }
    }
    done
}

/// Stretches of chords as stretches of the elements that the chords stand for.
fn spans<'a>(corners: &[Corner], stretches: impl Iterator<Item = &'a Stretch>) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for stretch in stretches {
        let (start, end) = (corners[stretch.chord], corners[stretch.chord + 1]);
        let first = if start.element == end.element { start.t } else { 0.0 };
        let at = |u: f64| if u >= 1.0 { end.t } else { first + (end.t - first) * u };
        let (element, from, to) = (end.element as usize, at(stretch.from), at(stretch.to));
        match spans.last_mut().filter(|last| last.element == element && last.to == from) {
            Some(last) => last.to = to,
            None => spans.push(Span { element, from, to }),
        }
    }
    spans
}

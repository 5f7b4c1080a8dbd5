//! Follows thin lines from strip to strip across the page.

use tracelight_image::solve;
use tracelight_maths::powi;

use super::strips::{Peak, Strip, Strips};

/// Steepest rule beside the sheet's sides: 6.5°, as its tangent.
const STEEPEST: f64 = 0.114;
/// A line's place is known to this, px, and its bend to so much per px.
const PLACE: f64 = 1.2;
const BEND: f64 = 0.02;
/// As many of its last points tell where a line goes on.
const REMEMBERED: usize = 8;
/// A page bends its rules usually by this share of their length, and a peak is known to so much, px.
const SAG: f64 = 0.02;
const PEAK_PX: f64 = 0.5;
/// A line's contrast varies by no more than this, as a ratio: where it is more, something lies on it.
const STEADY: f64 = 2.2;
/// Share of the strips in which a line must be seen.
const SEEN: f64 = 0.6;
/// And one that leads from border to border.
const WHOLE: f64 = 0.8;
/// Half of what is printed straight is within this, px.
const STRAIGHT_PX: f64 = 0.6;

/// A line that runs across most of the page.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// Where it crosses each strip; `None` where it is not seen.
    pub(super) points: Vec<Option<Peak>>,
}

impl Track {
    /// Strips in which it is seen.
    pub(super) fn seen(&self) -> usize {
        self.points.iter().flatten().count()
    }

    /// Its usual contrast.
    pub(super) fn contrast(&self) -> f64 {
        let mut contrasts: Vec<f64> = self.points.iter().flatten().map(|peak| peak.contrast).collect();
        contrasts.sort_unstable_by(f64::total_cmp);
        contrasts.get(contrasts.len() / 2).copied().unwrap_or(0.0)
    }

    /// Where it is halfway across the page.
    pub(super) fn middle(&self, strips: &Strips<'_>) -> f64 {
        self.parabola(strips)[0]
    }

    /// Whether it leads from border to border, and as straight as print; in strips that are blind there, by places along and across,
    /// it need not be seen.
    pub(super) fn is_whole(&self, strips: &Strips<'_>, is_blind: impl Fn(f64, f64) -> bool) -> bool {
        let smoothed = self.smoothed(strips);
        let places = self.points.iter().zip(&strips.strips).zip(&smoothed);
        let sees = |((point, strip), at): &((&Option<Peak>, &Strip), &f64)| {
            point.is_some() || strip.has(**at) && !is_blind(strip.at, **at)
        };
        let seeing: Vec<Option<Peak>> = places.filter(sees).map(|((point, _), _)| *point).collect();
        let reaches = [seeing.first(), seeing.last()].iter().all(|end| matches!(end, Some(Some(_))));
        let mut off: Vec<f64> =
            self.points.iter().zip(smoothed).filter_map(|(p, s)| p.map(|p| (p.at - s).abs())).collect();
        off.sort_unstable_by(f64::total_cmp);
        reaches && self.seen() as f64 >= WHOLE * seeing.len() as f64 && off[off.len() / 2] < STRAIGHT_PX
    }

    /// Its course by strip, as a parabola.
    pub(super) fn smoothed(&self, strips: &Strips<'_>) -> Vec<f64> {
        let [c, b, a] = self.parabola(strips);
        let at = |x: f64| c + (b + a * unit(x, strips)) * unit(x, strips);
        strips.strips.iter().map(|strip| at(strip.at)).collect()
    }

    /// The parabola nearest to it, of the way along the page from -1 to 1: its middle, its slope and its bend.
    fn parabola(&self, strips: &Strips<'_>) -> [f64; 3] {
        let places = self.places(strips).into_iter().map(|(x, y)| (unit(x, strips), y));
        nearest(places, 0.0).unwrap_or([0.0; 3])
    }

    /// Where it is seen, along and across.
    pub(super) fn places(&self, strips: &Strips<'_>) -> Vec<(f64, f64)> {
        self.points.iter().zip(&strips.strips).filter_map(|(p, s)| p.map(|p| (s.at, p.at))).collect()
    }

    /// Where it would cross at a place beyond its last points, and how many tell so: along the parabola through them, which
    /// bends no more than they say for sure.
    fn course(&self, strips: &Strips<'_>, at: f64) -> Option<(f64, usize)> {
        let places = self.points.iter().zip(&strips.strips).rev();
        let known = places.filter_map(|(p, s)| p.map(|p| (s.at, p.at))).take(REMEMBERED);
        let known: Vec<(f64, f64)> = known.collect();
        let &(x, y) = known.first()?;
        if known.len() < 3 {
            return Some((y, known.len()));
        }
        let unit = 0.5 * strips.length as f64;
        let places = known.iter().map(|&(px, py)| ((px - x) / unit, py - y));
        // of half the length the square term is the sag
        let stiffness = powi(PEAK_PX / (SAG * strips.length as f64), 2);
        let [c, b, a] = nearest(places, stiffness)?;
        let u = (at - x) / unit;
        Some((y + c + (b + a * u) * u, known.len()))
    }
}

/// How far a place along the page is from its middle, in halves of its length.
fn unit(along: f64, strips: &Strips<'_>) -> f64 {
    2.0 * along / strips.length as f64 - 1.0
}

/// The parabola c + b·u + a·u² nearest to some points, as \[c, b, a\]: by least squares, of which a² by `stiffness` is one.
fn nearest(points: impl Iterator<Item = (f64, f64)>, stiffness: f64) -> Option<[f64; 3]> {
    let (mut normal, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
    for (u, y) in points {
        let basis = [1.0, u, u * u];
        for (k, row) in normal.iter_mut().enumerate() {
            row.iter_mut().zip(basis).for_each(|(cell, b)| *cell += basis[k] * b);
            right[k] += basis[k] * y;
        }
    }
    normal[2][2] += stiffness;
    solve::symmetric(normal, right)
}

/// The lines that are seen in most strips.
pub(super) fn tracks(strips: &Strips<'_>) -> Vec<Track> {
    let count = strips.strips.len();
    let least = (SEEN * count as f64) as usize;
    let mut tracks: Vec<Track> = Vec::new();
    for (number, strip) in strips.strips.iter().enumerate() {
        let taken = matched(&tracks, strips, number);
        let mut is_free = vec![true; strip.peaks.len()];
        for (track, found) in tracks.iter_mut().zip(&taken) {
            if let Some(k) = *found {
                is_free[k] = false;
            }
            track.points.push(found.map(|k| strip.peaks[k]));
        }
        // those that can no longer be seen in enough strips
        tracks.retain(|track| track.seen() + count - track.points.len() >= least);
        if count - number >= least {
            let free = strip.peaks.iter().zip(is_free).filter(|(_, free)| *free);
            tracks.extend(free.map(|(&peak, _)| {
                let mut points = vec![None; number];
                points.push(Some(peak));
                Track { points }
            }));
        }
    }
    tracks
}

/// Which of a strip's lines continues each track: the nearest to where it leads.
fn matched(tracks: &[Track], strips: &Strips<'_>, number: usize) -> Vec<Option<usize>> {
    let strip = &strips.strips[number];
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (t, track) in tracks.iter().enumerate() {
        let Some((expected, known)) = track.course(strips, strip.at) else { continue };
        let last = track.points.iter().rposition(Option::is_some).unwrap_or(0);
        let ahead = strip.at - strips.strips[last].at;
        let contrast = track.contrast();
        let reach = PLACE + ahead * if known < 3 { STEEPEST } else { BEND };
        let first = strip.peaks.partition_point(|peak| peak.at < expected - reach);
        for (k, peak) in strip.peaks.iter().enumerate().skip(first) {
            if peak.at > expected + reach {
                break;
            }
            let ratio = peak.contrast / contrast;
            if (1.0 / STEADY..STEADY).contains(&ratio) {
                pairs.push(((peak.at - expected).abs() / reach, t, k));
            }
        }
    }
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let (mut found, mut is_taken) = (vec![None; tracks.len()], vec![false; strip.peaks.len()]);
    for (_, t, k) in pairs {
        if found[t].is_none() && !is_taken[k] {
            (found[t], is_taken[k]) = (Some(k), true);
        }
    }
    found
}

//! Numbers equally spaced, similar lines across a page as rules.

use super::strips::{Peak, Strips};
use super::track::Track;

/// Fewest rules.
pub(super) const FEWEST: usize = 5;
/// A rule is where it is expected to a share of the spacing, or so many px.
pub(super) const NEAR: f64 = 0.13;
pub(super) const NEAR_PX: f64 = 1.5;
/// Least distance of two rules, px.
pub(super) const LEAST_SPACING: f64 = 6.0;
/// Rules differ in contrast from their fellows by no more than this, as a ratio: each fifth may be printed darker.
const ALIKE: f64 = 2.6;

/// A track and which rule it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub(super) index: i32,
    pub(super) track: usize,
}

/// Whether a line is as dark as rules of some contrast.
pub(super) fn is_alike(peak: &Peak, contrast: f64) -> bool {
    ratio(peak.contrast, contrast) < ALIKE
}

/// How many times the larger of two is the smaller.
pub(crate) fn ratio(a: f64, b: f64) -> f64 {
    (a / b).max(b / a)
}

/// The most tracks that follow each other at equal distances, in the page's middle.
pub(super) fn longest_chain(strips: &Strips<'_>, tracks: &[Track]) -> Option<Vec<Link>> {
    let places: Vec<(f64, usize)> = tracks.iter().enumerate().map(|(k, t)| (t.middle(strips), k)).collect();
    let chains = (0..places.len()).filter_map(|k| {
        // the other side of the paper may shine through: rules look alike
        let contrast = tracks[places[k].1].contrast();
        let is_alike = |p: &&(f64, usize)| ratio(tracks[p.1].contrast(), contrast) < ALIKE;
        let mut alike: Vec<(f64, usize)> = places.iter().filter(is_alike).copied().collect();
        alike.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let from = alike.iter().position(|p| p.1 == places[k].1)?;
        let spacing = alike.get(from + 1)?.0 - alike[from].0;
        (spacing >= LEAST_SPACING).then(|| chain(&alike, from, spacing))
    });
    let whole = |chain: &Vec<Link>| {
        let span = (chain[chain.len() - 1].index - chain[0].index + 1) as f64;
        chain.len() >= FEWEST.min(4) && (span - chain.len() as f64) <= 0.5 * span
    };
    // a line midway between two rules makes each second one of another comb missing
    let missing =
        |chain: &Vec<Link>| (chain[chain.len() - 1].index - chain[0].index + 1) as usize - chain.len();
    chains.filter(whole).max_by_key(|chain| chain.len() as isize - missing(chain) as isize)
}

/// From one track on, both ways, those at a distance that changes slowly.
fn chain(places: &[(f64, usize)], from: usize, spacing: f64) -> Vec<Link> {
    let mut links = vec![Link { index: 0, track: places[from].1 }];
    for way in [1.0, -1.0] {
        let (mut at, mut spacing, mut index) = (places[from].0, spacing, 0);
        'on: loop {
            for skipped in 1..=3 {
                let expected = at + way * f64::from(skipped) * spacing;
                let near = |p: &&(f64, usize)| (p.0 - expected).abs();
                let Some(next) = places.iter().min_by(|a, b| near(a).total_cmp(&near(b))) else { break 'on };
                if near(&next) <= (NEAR * spacing).max(NEAR_PX) {
                    spacing += 0.3 * ((next.0 - at) * way / f64::from(skipped) - spacing);
                    (at, index) = (next.0, index + way as i32 * skipped);
                    links.push(Link { index, track: next.1 });
                    continue 'on;
                }
            }
            break;
        }
    }
    links.sort_unstable_by_key(|link| link.index);
    links.dedup_by_key(|link| link.index);
    links
}

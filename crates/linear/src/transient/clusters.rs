//! Poles in groups.
//!
//! Partial fractions of poles that are close together are large and cancel; taken together they do not. Poles whose distance is a small
//! share of what they decay by, and those whose error discs overlap, are one group, as long as the group stays apart from all others and
//! away from the imaginary axis.

use tracelight_maths::complex;

use crate::Complex;
use crate::roots::Root;

/// Poles that contribute together.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    /// Centre of a disc about them; real if they are their own conjugates.
    pub(super) centre: Complex,
    /// Radius of that disc; 0 of a pole alone.
    pub(super) radius: f64,
    /// How far it is to the nearest other pole.
    pub(super) clearance: f64,
    /// Which poles they are.
    pub(super) members: Vec<usize>,
}

/// A group may fill this share of the way to the nearest other pole, and to the imaginary axis.
const MOST_FILL: f64 = 0.66;
const MOST_REACH: f64 = 0.6;
/// Largest error disc that makes poles one group, as a share of their size.
const LARGEST_DISC: f64 = 0.05;
/// Shares of their decay rate within which poles are taken together: the largest that gives groups that stay apart.
const SHARES: [f64; 8] = [0.3, 0.2, 0.13, 0.09, 0.06, 0.03, 0.01, 0.0];

/// Groups of poles, those above and on the real axis: the others are their conjugates. There are `at_zero` poles at 0 besides.
pub(super) fn clusters(poles: &[Root], at_zero: usize) -> Vec<Cluster> {
    let mut found = Vec::new();
    for share in SHARES {
        found = clusters_within(poles, at_zero, share);
        if found.iter().all(Cluster::stays_apart) {
            break;
        }
    }
    found.retain(|cluster| cluster.centre.im >= 0.0);
    found
}

impl Cluster {
    fn stays_apart(&self) -> bool {
        self.members.len() == 1
            || (self.radius <= MOST_FILL * self.clearance
                && (self.radius <= MOST_REACH * self.centre.re.abs() || self.centre.re >= 0.0))
    }
}

fn clusters_within(poles: &[Root], at_zero: usize, share: f64) -> Vec<Cluster> {
    let apart = |i: usize, j: usize| complex::norm(poles[i].value - poles[j].value);
    let decay = |i: usize| poles[i].value.re.abs();
    // a disc that is larger says nothing
    let reach = |i: usize| poles[i].radius.min(LARGEST_DISC * complex::norm(poles[i].value));
    let is_close =
        |i: usize, j: usize| apart(i, j) <= (share * decay(i).min(decay(j))).max(reach(i) + reach(j));
    let mut group: Vec<usize> = (0..poles.len()).collect();
    for i in 0..poles.len() {
        for j in 0..i {
            if group[i] != group[j] && is_close(i, j) {
                let (from, to) = (group[i], group[j]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
        }
    }
    let members = |g: usize| (0..poles.len()).filter(|&i| group[i] == g).collect::<Vec<_>>();
    let names: Vec<usize> =
        (0..poles.len()).filter(|&i| members(group[i])[0] == i).map(|i| group[i]).collect();
    names.into_iter().map(|name| cluster(poles, &members(name), at_zero)).collect()
}

fn cluster(poles: &[Root], members: &[usize], at_zero: usize) -> Cluster {
    let values = || members.iter().map(|&i| poles[i].value);
    let middle = |part: fn(Complex) -> f64| {
        let (low, high) = values()
            .map(part)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        0.5 * (low + high)
    };
    let is_own_conjugate =
        values().any(|p| p.im == 0.0) || values().any(|p| p.im > 0.0) && values().any(|p| p.im < 0.0);
    let centre = Complex::new(middle(|p| p.re), if is_own_conjugate { 0.0 } else { middle(|p| p.im) });
    let radius = values().map(|p| complex::norm(p - centre)).fold(0.0, f64::max);
    let others = (0..poles.len()).filter(|i| !members.contains(i)).map(|i| poles[i].value);
    let zero = (at_zero > 0).then_some(Complex::ZERO);
    let clearance = others.chain(zero).map(|p| complex::norm(p - centre)).fold(f64::INFINITY, f64::min);
    Cluster { centre, radius, clearance, members: members.to_vec() }
}

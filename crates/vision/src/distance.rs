//! How far each pixel of ink is from the paper.

use crate::plane::Plane;

/// Distance from each ink pixel's centre to the nearest paper pixel's centre, px, exact; 0 on paper. Beyond the
/// image is paper.
///
/// Meijster, Roerdink & Hesselink, "A general algorithm for computing distance transforms in linear time" (2000),
/// within runs of ink: paper further along the row than the run's end is never nearest.
pub(crate) fn to_paper(mask: &Plane<u8>) -> Plane<f32> {
    let columns = along_columns(mask);
    let mut distance = Plane::filled(mask.width, mask.height, 0.0);
    let mut envelope = Envelope::default();
    for y in 0..mask.height {
        let row = columns.row(y);
        let mut x = 0;
        while let Some(from) = row[x..].iter().position(|&g| g != 0).map(|k| x + k) {
            let to = row[from..].iter().position(|&g| g == 0).map_or(row.len(), |k| from + k);
            envelope.fill(&row[from..to], &mut distance.row_mut(y)[from..to]);
            x = to;
        }
    }
    distance
}

/// Distance to the nearest paper in the same column, px.
fn along_columns(mask: &Plane<u8>) -> Plane<u32> {
    let (w, h) = (mask.width, mask.height);
    let mut columns = Plane::filled(w, h, 0u32);
    let mut since = vec![0u32; w];
    for y in 0..h {
        for ((out, s), &m) in columns.row_mut(y).iter_mut().zip(&mut since).zip(mask.row(y)) {
            *s = if m == 0 { 0 } else { *s + 1 };
            *out = *s;
        }
    }
    since.fill(0);
    for y in (0..h).rev() {
        for ((out, s), &m) in columns.row_mut(y).iter_mut().zip(&mut since).zip(mask.row(y)) {
            *s = if m == 0 { 0 } else { *s + 1 };
            *out = (*out).min(*s);
        }
    }
    columns
}

/// The lower envelope of parabolas, one for each pixel of a run and one for the paper at either end.
#[derive(Default)]
struct Envelope {
    /// Position and height² of each parabola of the envelope, and where it takes over.
    parabolas: Vec<(i64, i64, i64)>,
}

impl Envelope {
    fn fill(&mut self, columns: &[u32], out: &mut [f32]) {
        let n = columns.len() as i64;
        self.parabolas.clear();
        self.parabolas.push((-1, 0, -1));
        let inner = columns.iter().enumerate().map(|(x, &g)| (x as i64, i64::from(g) * i64::from(g)));
        inner.chain([(n, 0)]).for_each(|(x, square)| self.add(x, square, n));
        let mut k = 0;
        for (x, out) in out.iter_mut().enumerate() {
            let x = x as i64;
            while k + 1 < self.parabolas.len() && self.parabolas[k + 1].2 <= x {
                k += 1;
            }
            let (at, square, _) = self.parabolas[k];
            *out = (((x - at) * (x - at) + square) as f32).sqrt();
        }
    }

    fn add(&mut self, x: i64, square: i64, n: i64) {
        while let Some(&(at, height, from)) = self.parabolas.last() {
            // first pixel at which the new parabola is not above the last one
            let meet = (x * x - at * at + square - height).div_euclid(2 * (x - at)) + 1;
            if meet > from {
                if meet <= n {
                    self.parabolas.push((x, square, meet));
                }
                return;
            }
            self.parabolas.pop();
        }
        self.parabolas.push((x, square, -1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_distance_is_the_shortest_there_is() {
        let (w, h) = (40isize, 30isize);
        let ink = |x: isize, y: isize| {
            (0..w).contains(&x)
                && (0..h).contains(&y)
                && ((x - 15).pow(2) + (y - 14).pow(2) < 150 || (x * y) % 7 > 2)
        };
        let values = (0..w * h).map(|i| u8::from(ink(i % w, i / w))).collect();
        let found = to_paper(&Plane { width: 40, height: 30, values });
        for y in 0..h {
            for x in 0..w {
                let all = (-1..=h).flat_map(|v| (-1..=w).map(move |u| (u, v)));
                let paper = all.filter(|&(u, v)| !ink(u, v));
                let nearest = paper.map(|(u, v)| (u - x).pow(2) + (v - y).pow(2)).min().unwrap();
                assert!((found.get(x, y) - (nearest as f32).sqrt()).abs() < 1e-4, "({x}, {y})");
            }
        }
    }
}

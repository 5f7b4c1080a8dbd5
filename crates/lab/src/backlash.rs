use tracelight_maths::atan;

use crate::regression::{Uncertain, regression, student};

/// Where the spot was when a joint had come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotPoint {
    /// The joint's angle by its encoder, rad.
    pub angle_rad: f64,
    /// 1 if it came there turning positively, −1 negatively.
    pub way: f64,
    /// Where the spot was along the axis on the target, read off a ruler, m: x for pan, y for tilt, the other joint straight ahead.
    pub spot_m: f64,
}

/// Play between an encoder and its beam, and what else lies between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Backlash {
    /// From one side to the other, rad.
    pub play_rad: Uncertain,
    /// How far the beam is ahead of the encoder in the middle of the play, at the first reading, rad.
    pub zero_rad: Uncertain,
    /// How much further it is at the last one, rad: the encoder slips on its axis, or loses counts.
    pub slip_rad: Uncertain,
    /// What is left, root mean square, rad.
    pub left_rad: f64,
    /// How far the beam was ahead at each reading, from the mean of its place, rad; `None` of a reading that is compared with no other.
    pub beside_rad: Vec<Option<f64>>,
}

/// What readings in their order say of play and slip, the target square-on at a distance, m; `None` if they are too few, or all from one
/// side.
///
/// An encoder says where a joint is to half a count, which is more than most play. But a joint that is sent to a place again and again
/// rests at the same part of its count: so readings are compared with others of their own place, where there are such.
pub fn backlash(points: &[SpotPoint], distance_m: f64) -> Option<Backlash> {
    let beyond: Vec<f64> =
        points.iter().map(|point| atan(-point.spot_m / distance_m) - point.angle_rad).collect();
    let last = points.len().saturating_sub(1).max(1) as f64;
    // coming from below the beam is behind by half the play
    let sides: Vec<f64> = points.iter().map(|point| -0.5 * point.way).collect();
    let times: Vec<f64> = (0..points.len()).map(|k| k as f64 / last).collect();
    let pooled = regression(&[vec![1.0; points.len()], sides.clone(), times.clone()], &beyond)?;
    let &[zero_rad, play_rad, slip_rad] = pooled.factors.as_slice() else { return None };
    let columns = [sides, times];
    // what is apart by more is another place, rad
    const PLACE_RAD: f64 = 8e-3;
    if let Some(found) = within_places(points, &columns, &beyond, PLACE_RAD) {
        // of a place between two counts half the readings are a count beside the others, slipped or not: play is told from one count
        let counts = within_places(points, &columns, &beyond, 0.0);
        let (play_rad, left_rad) =
            counts.map_or((found.play_rad, found.left_rad), |counts| (counts.play_rad, counts.left_rad));
        return Some(Backlash { zero_rad, play_rad, left_rad, ..found });
    }
    let mean = beyond.iter().sum::<f64>() / beyond.len() as f64;
    let beside_rad = beyond.iter().map(|value| Some(value - mean)).collect();
    Some(Backlash { play_rad, zero_rad, slip_rad, left_rad: pooled.left, beside_rad })
}

/// Play, slip and what is left from readings that are compared only with others of the same place, within `place_rad` of each other (Frisch
/// and Waugh: the means of each place are taken out of everything), the beam's lead left out; `None` where too few were come to from both
/// sides.
fn within_places(
    points: &[SpotPoint],
    columns: &[Vec<f64>; 2],
    beyond: &[f64],
    place_rad: f64,
) -> Option<Backlash> {
    const LEAST: usize = 8;
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].angle_rad.total_cmp(&points[b].angle_rad));
    let near = |a: &usize, b: &usize| points[*b].angle_rad - points[*a].angle_rad <= place_rad;
    let both = |group: &&[usize]| {
        let way = |sign: f64| group.iter().any(|&k| points[k].way * sign > 0.0);
        way(1.0) && way(-1.0)
    };
    let groups: Vec<&[usize]> = order.chunk_by(near).filter(both).collect();
    let readings: usize = groups.iter().map(|group| group.len()).sum();
    if readings < LEAST {
        return None;
    }
    let centred = |values: &[f64]| -> Vec<f64> {
        let of = |group: &&[usize]| {
            let mean = group.iter().map(|&k| values[k]).sum::<f64>() / group.len() as f64;
            group.iter().map(|&k| values[k] - mean).collect::<Vec<f64>>()
        };
        groups.iter().flat_map(of).collect()
    };
    let wanted = centred(beyond);
    let found = regression(&[centred(&columns[0]), centred(&columns[1])], &wanted)?;
    let free = readings.checked_sub(groups.len() + 2).filter(|free| *free > 0)? as f64;
    // the means took a degree of freedom for each place
    let (taken, left) = ((readings - 2) as f64, free);
    let wider = (taken / left).sqrt() * student(left) / student(taken);
    let wide = |u: Uncertain| Uncertain { within: wider * u.within, ..u };
    let mut beside_rad = vec![None; points.len()];
    groups
        .iter()
        .flat_map(|group| group.iter())
        .zip(&wanted)
        .for_each(|(&k, value)| beside_rad[k] = Some(*value));
    Some(Backlash {
        play_rad: wide(found.factors[0]),
        slip_rad: wide(found.factors[1]),
        zero_rad: Uncertain::default(),
        left_rad: found.left * (readings as f64 / left).sqrt(),
        beside_rad,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn play_zero_and_slip_are_told_apart() {
        let mut dice = oorandom::Rand64::new(1);
        let (play, zero, slip, distance) = (5e-4, 2e-3, 1.5e-3, 0.9);
        let mut point = |k: u32| {
            let angle = -0.3 + 0.6 * f64::from(k / 2 % 9) / 8.0;
            let way = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            let beam = angle + zero - 0.5 * way * play + slip * f64::from(k) / 71.0;
            // a ruler is read to half a millimetre
            let spot_m = ((-distance * beam.tan() + 2e-4 * (dice.rand_float() - 0.5)) / 5e-4).round() * 5e-4;
            SpotPoint { angle_rad: angle, way, spot_m }
        };
        let points: Vec<SpotPoint> = (0..72).map(&mut point).collect();
        let found = backlash(&points, distance).unwrap();
        for (found, wanted) in [(found.play_rad, play), (found.zero_rad, zero), (found.slip_rad, slip)] {
            assert!((found.value - wanted).abs() < 1.5 * found.within, "{found:?} {wanted}");
        }
        assert!(found.left_rad < 3e-4 && found.play_rad.within < 1.2e-4);
        // where no place is gone to twice, readings are all compared with each other
        let counted: Vec<SpotPoint> = points
            .iter()
            .zip(0..)
            .map(|(p, k)| SpotPoint {
                angle_rad: p.angle_rad + 0.012 * f64::from(k),
                spot_m: -distance * ((-p.spot_m / distance).atan() + 0.012 * f64::from(k)).tan(),
                ..*p
            })
            .collect();
        let pooled = backlash(&counted, distance).unwrap();
        assert!((pooled.play_rad.value - play).abs() < 1.5 * pooled.play_rad.within, "{:?}", pooled.play_rad);
        assert!(pooled.play_rad.within < 4e-4, "{:?}", pooled.play_rad);
        let one_side: Vec<SpotPoint> = points.iter().filter(|p| p.way > 0.0).copied().collect();
        assert_eq!(backlash(&one_side, distance), None);
    }
}

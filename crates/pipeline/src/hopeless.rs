//! A job that is far too long is refused before it is put in order, which takes minutes where strokes are very many.

use std::collections::HashMap;

use tracelight_stroke::{Drawing, Point, StrokeEnd, Travel, least_cost};
use tracelight_task::Failure;
use tracelight_trajectory::{LONGEST_S, LitSpeed, PlanRequest, TravelTime};

use crate::driving::Driving;

/// Fewer strokes are in order within a second, and then it is known how long they take.
const MANY: usize = 4000;

/// A job is hopeless where the least it can take is so many times what a job may take. Moves are taken for up to half as long
/// again as a plan makes them.
const MARGIN: f64 = 2.0;

/// Short strokes are passed slower than was asked for, and moves between them may be quicker for that: the slowest speed that
/// is thought of, m/s.
const SLOWEST_M_S: f64 = 0.03;

/// Ends count as one place within this.
const ONE_PLACE_M: f64 = 1e-6;

/// Refuses a drawing whose light and dark moves cannot be within what a job may take, in whatever order.
///
/// # Errors
/// `too-long`.
pub(crate) fn check(drawing: &Drawing, driving: &Driving) -> Result<(), Failure> {
    if drawing.strokes.len() < MANY {
        return Ok(());
    }
    let least_s = least_s(drawing, driving);
    if least_s <= MARGIN * LONGEST_S {
        return Ok(());
    }
    let message = format!(
        "the drawing would take about {least_s:.0} s or more for its {} strokes, a job may take {LONGEST_S:.0} s; draw it larger \
         and faster, or in parts",
        drawing.strokes.len()
    );
    Err(Failure::failed("too-long", message))
}

/// What a drawing takes at least, in whatever order, s.
fn least_s(drawing: &Drawing, driving: &Driving) -> f64 {
    const TOLERANCE_M: f64 = 1e-4;
    let lit_m: f64 = drawing.strokes.iter().map(|s| s.path.length(TOLERANCE_M)).sum();
    let start = driving.machine.geometry.spot(&driving.pose, Default::default()).unwrap_or(Point::ORIGIN);
    let through =
        Through::of(drawing, speeds(driving.request).map(|r| TravelTime::new(&driving.machine, &r)));
    lit_m / driving.request.speed_m_s + least_cost(drawing, start, &through)
}

/// What is asked, at its own speed and slower ones; at none of them is it asked for that strokes be passed or stopped at.
fn speeds(asked: PlanRequest) -> [PlanRequest; 3] {
    let slowest = asked.speed_m_s.min(SLOWEST_M_S);
    [asked.speed_m_s, (asked.speed_m_s * slowest).sqrt(), slowest].map(|speed_m_s| PlanRequest {
        speed_m_s,
        lit_speed: LitSpeed::Fastest,
        ..asked
    })
}

/// How long dark moves take at the best of some speeds, where an end at which another stroke ends too takes none: they may be drawn through, or turned
/// back in as soon as the shortest stroke allows.
struct Through<'a> {
    times: [TravelTime<'a>; 3],
    /// The stroke that ends in a place; none where there are several.
    ends: HashMap<(i64, i64), Option<usize>>,
}

impl<'a> Through<'a> {
    fn of(drawing: &Drawing, times: [TravelTime<'a>; 3]) -> Self {
        let mut ends: HashMap<_, Option<usize>> = HashMap::new();
        for (number, stroke) in drawing.strokes.iter().enumerate() {
            for end in StrokeEnd::of(&stroke.path) {
                let [cell, ..] = cells(end.point);
                ends.entry(cell)
                    .and_modify(|known| *known = known.filter(|&k| k == number))
                    .or_insert(Some(number));
            }
        }
        Self { times, ends }
    }

    /// Whether several strokes end there.
    fn is_shared(&self, place: Point) -> bool {
        let mut there = cells(place).into_iter().filter_map(|cell| self.ends.get(&cell));
        let first = there.next();
        first.is_some_and(|first| first.is_none() || there.any(|next| next != first))
    }
}

impl<'a> Travel for Through<'a> {
    type Place = ([<TravelTime<'a> as Travel>::Place; 3], bool);

    const IS_DEAR: bool = true;

    fn place(&self, end: StrokeEnd) -> Self::Place {
        (self.times.map(|time| time.place(end)), self.is_shared(end.point))
    }

    fn about(&self, end: StrokeEnd) -> Point {
        self.times[0].about(end)
    }

    fn cost(&self, from: &Self::Place, to: &Self::Place) -> f64 {
        if from.1 || to.1 {
            return 0.0;
        }
        let each = self.times.iter().zip(from.0.iter().zip(&to.0));
        each.map(|(time, (from, to))| time.cost(from, to)).fold(f64::INFINITY, f64::min)
    }
}

/// The cell that a point lies in, first, and those around it.
fn cells(point: Point) -> [(i64, i64); 9] {
    let [x, y] = [point.x, point.y].map(|v| (v / ONE_PLACE_M).round() as i64);
    let around = |k: i64| (x + [0, 1, -1][k as usize % 3], y + [0, 1, -1][k as usize / 3]);
    std::array::from_fn(|k| around(k as i64))
}

#[cfg(test)]
mod tests {
    use tracelight_aim::HeadPose;
    use tracelight_maths::sin_cos;
    use tracelight_sim::RigConfig;
    use tracelight_stroke::{Effort, OrderOptions, Path, Stroke, order};
    use tracelight_trajectory::{DarkMove, plan};

    use super::*;
    use crate::driving::{Asked, DEFAULT_DISTANCE_M, request_of};

    fn driving() -> Driving {
        driven(RigConfig::report(), |_| {})
    }

    fn driven(rig: RigConfig, ask: impl Fn(&mut PlanRequest)) -> Driving {
        let mut request = request_of(&rig);
        ask(&mut request);
        Driving::new(rig, HeadPose::square_on(DEFAULT_DISTANCE_M), request, Asked::default())
    }

    /// Short strokes in rows, of one length and at one distance, along their row or across it.
    fn stipples() -> Vec<(String, Drawing)> {
        let mut all = Vec::new();
        for long in [2e-5, 1e-4, 1e-3, 1e-2] {
            for step in
                [1.2, 2.0, 5.0, 20.0].map(|times| times * long).into_iter().filter(|&step| step < 0.06)
            {
                for is_across in [false, true] {
                    let stipple = |k: usize| {
                        let [x, y] = [k % 14, k / 14].map(|k| step * (k as f64 - 7.0));
                        [(x, y), if is_across { (x, y + long) } else { (x + long, y) }]
                    };
                    let name = format!("{long} m every {step} m, across {is_across}");
                    all.push((name, lines((0..196).map(stipple))));
                }
            }
        }
        all
    }

    #[test]
    fn nor_does_one_of_stipples_however_it_is_driven() {
        let mut asked: Vec<(&str, Driving)> =
            RigConfig::presets().into_iter().map(|rig| ("rig", driven(rig, |_| {}))).collect();
        let report = RigConfig::report;
        asked.push(("optimal", driven(report(), |r| r.travel = DarkMove::Optimal)));
        asked.push(("fast", driven(report(), |r| r.speed_m_s = 3.0)));
        asked.push(("slow", driven(report(), |r| r.speed_m_s = 0.03)));
        asked.push(("stops", driven(report(), |r| r.lit_speed = LitSpeed::Stops)));
        asked.push(("exact", driven(report(), |r| r.lit_speed = LitSpeed::Exact)));
        asked.push((
            "exact fast",
            driven(report(), |r| {
                r.lit_speed = LitSpeed::Exact;
                r.speed_m_s = 3.0;
            }),
        ));
        for (name, driving) in &asked {
            for (drawn, drawing) in stipples() {
                let least_s = least_s(&drawing, driving);
                let takes_s = takes_s(&drawing, driving, Effort::Quick);
                assert!(
                    takes_s.is_nan() || least_s <= 0.75 * MARGIN * takes_s,
                    "{name}, {drawn}: at least {least_s:.2} s, takes {takes_s:.2} s"
                );
            }
        }
    }

    fn takes_s(drawing: &Drawing, driving: &Driving, effort: Effort) -> f64 {
        let time = TravelTime::new(&driving.machine, &driving.request);
        let ordered = order(drawing, Point::ORIGIN, OrderOptions { effort, seed: 0 }, &time);
        plan(&ordered.drawing, &driving.machine, &driving.request).map_or(f64::NAN, |p| p.duration_s())
    }

    fn lines(lines: impl Iterator<Item = [(f64, f64); 2]>) -> Drawing {
        let stroke =
            |ends: [(f64, f64); 2]| Stroke::new(Path::polyline(&ends.map(Point::from), false).unwrap());
        Drawing { strokes: lines.map(stroke).collect() }
    }

    /// Marsaglia's xorshift32, from 0 to 1.
    fn draws() -> impl FnMut() -> f64 {
        let mut state = 2_463_534_242_u32;
        move || {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            f64::from(state) / f64::from(u32::MAX)
        }
    }

    /// A tenth of a millimetre, in rows.
    fn tiny(number: usize, row: usize) -> [(f64, f64); 2] {
        let [x, y] = [number % row, number / row].map(|k| 5e-4 * k as f64 - 0.1);
        [(x, y), (x + 1e-4, y)]
    }

    /// Drawings of some hundred strokes: apart, end to end, there and back, from one place, in rows.
    fn drawings() -> Vec<(&'static str, Drawing)> {
        let mut draw = draws();
        let mut scattered = |n: usize, long: f64| {
            lines(
                (0..n)
                    .map(|_| {
                        let [x, y, dx, dy] = [0; 4].map(|_| draw() - 0.5);
                        [(0.4 * x, 0.4 * y), (0.4 * x + long * dx, 0.4 * y + long * dy)]
                    })
                    .collect::<Vec<_>>()
                    .into_iter(),
            )
        };
        let dash = |k: usize, gap: f64| {
            let from = -0.2 + 1e-3 * k as f64;
            [(from, 0.05), (from + 1e-3 - gap, 0.05)]
        };
        let ray = |k: usize| {
            let (sin, cos) = sin_cos(0.02 * k as f64);
            [(0.0, 0.0), (0.2 * cos, 0.2 * sin)]
        };
        let hatch = |k: usize| [(-0.05, 1e-3 * k as f64), (0.05, 1e-3 * k as f64)];
        vec![
            ("scattered", scattered(300, 0.05)),
            ("short", scattered(400, 0.002)),
            ("dashes", lines((0..400).map(|k| dash(k, 0.0)))),
            ("gaps", lines((0..400).map(|k| dash(k, 3e-4)))),
            ("twice", lines((0..200).flat_map(|k| [dash(k, 0.0); 2]))),
            ("rays", lines((0..300).map(ray))),
            ("hatch", lines((0..150).map(hatch))),
            ("tiny", lines((0..400).map(|k| tiny(k, 20)))),
            ("one place", lines((0..300).map(|_| [(0.1, 0.1), (0.1001, 0.1)]))),
        ]
    }

    #[test]
    fn no_drawing_takes_less_than_it_is_said_to_take_at_least() {
        let driving = driving();
        for (name, drawing) in drawings() {
            let least_s = least_s(&drawing, &driving);
            let takes_s = takes_s(&drawing, &driving, Effort::Best);
            println!("{name}: at least {least_s:.2} s, takes {takes_s:.2} s");
            assert!(
                least_s <= 0.75 * MARGIN * takes_s,
                "{name}: at least {least_s:.2} s, takes {takes_s:.2} s"
            );
        }
    }

    #[test]
    fn a_hopeless_job_is_refused_before_its_order_and_a_long_one_is_not() {
        let driving = driving();
        let short = lines((0..120_000).map(|k| tiny(k, 350)));
        let refused = check(&short, &driving).unwrap_err();
        assert_eq!(refused.code, "too-long");
        assert!(
            refused.message.contains("120000 strokes") && refused.message.contains("1800 s"),
            "{}",
            refused.message
        );
        let dashed = lines((0..20_000).map(|k| {
            let from = -0.2 + 2e-5 * f64::from(k);
            [(from, 0.0), (from + 2e-5, 0.0)]
        }));
        assert_eq!(check(&dashed, &driving).map_err(|failure| failure.message), Ok(()));
    }
}

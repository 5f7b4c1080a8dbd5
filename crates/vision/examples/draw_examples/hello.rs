use tracelight_stroke::{Drawing, Path, Point};

use super::{
    figures::{PEN_PX, curve, pen},
    spline::through,
};

/// Baseline and left edge of the word, pixels.
const ORIGIN: Point = Point::new(68.0, 300.0);

/// Pixels a unit of the letters, whose short ones are about 80 high.
const SCALE: f64 = 1.1;

/// How far the hand leans: right for each unit up.
const LEAN: f64 = 0.28;

/// The word "hello" in cursive with a flourish under it.
pub(crate) fn hello() -> Drawing {
    let flourish = curve(&[(116.0, 384.0), (250.0, 358.0), (390.0, 366.0), (530.0, 342.0)]);
    Drawing { strokes: pen(PEN_PX, [written(HELL), written(O), flourish]) }
}

/// Points right of and above the origin, leaned and scaled as the hand does.
fn written(pairs: &[(f64, f64)]) -> Path {
    let place =
        |&(along, up): &(f64, f64)| Point::new(ORIGIN.x + SCALE * (along + LEAN * up), ORIGIN.y - SCALE * up);
    through(&pairs.iter().map(place).collect::<Vec<_>>(), false)
}

const HELL: &[(f64, f64)] = &[
    // h
    (-28.0, 64.0),
    (4.0, 80.0),
    (36.0, 110.0),
    (56.0, 152.0),
    (54.0, 186.0),
    (40.0, 203.0),
    (26.0, 184.0),
    (21.0, 140.0),
    (19.0, 40.0),
    (14.0, 8.0),
    (2.0, 0.0),
    (-9.0, 15.0),
    (8.0, 40.0),
    (38.0, 68.0),
    (60.0, 77.0),
    (75.0, 60.0),
    (76.0, 28.0),
    (88.0, 4.0),
    (106.0, 10.0),
    // e
    (132.0, 33.0),
    (156.0, 60.0),
    (147.0, 82.0),
    (131.0, 56.0),
    (131.0, 20.0),
    (150.0, 0.0),
    // l
    (178.0, 18.0),
    (200.0, 64.0),
    (223.0, 108.0),
    (234.0, 152.0),
    (230.0, 186.0),
    (216.0, 203.0),
    (202.0, 184.0),
    (197.0, 140.0),
    (195.0, 44.0),
    (202.0, 10.0),
    (220.0, 0.0),
    // l
    (245.0, 18.0),
    (267.0, 64.0),
    (290.0, 108.0),
    (301.0, 152.0),
    (297.0, 186.0),
    (283.0, 203.0),
    (269.0, 184.0),
    (264.0, 140.0),
    (262.0, 44.0),
    (269.0, 10.0),
    (287.0, 0.0),
    (307.0, 16.0),
    (320.0, 36.0),
];

/// Begins and crosses itself in the loop that closes it.
const O: &[(f64, f64)] = &[
    (370.0, 76.0),
    (350.0, 46.0),
    (356.0, 8.0),
    (380.0, -1.0),
    (404.0, 30.0),
    (404.0, 72.0),
    (388.0, 92.0),
    (370.0, 76.0),
    (386.0, 60.0),
    (414.0, 64.0),
    (446.0, 84.0),
];

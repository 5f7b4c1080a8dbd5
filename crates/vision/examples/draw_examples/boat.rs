use tracelight_stroke::{Drawing, Element, Path, Point};

use super::{
    figures::{PEN_PX, curve, line, pen},
    spline::cornered,
};

/// A sailing boat under the moon.
pub(crate) fn boat() -> Drawing {
    let hull = cornered(&[
        &[(150.0, 318.0), (300.0, 326.0), (462.0, 308.0)],
        &[(462.0, 308.0), (434.0, 352.0), (396.0, 376.0)],
        &[(396.0, 376.0), (300.0, 380.0), (204.0, 376.0)],
        &[(204.0, 376.0), (170.0, 352.0), (150.0, 318.0)],
    ]);
    let mast = line(&[(296.0, 326.0), (296.0, 60.0)]);
    let main = cornered(&[
        &[(318.0, 72.0), (390.0, 170.0), (440.0, 284.0)],
        &[(440.0, 284.0), (380.0, 296.0), (318.0, 296.0)],
        &[(318.0, 296.0), (318.0, 72.0)],
    ]);
    let jib = cornered(&[
        &[(274.0, 104.0), (274.0, 292.0)],
        &[(274.0, 292.0), (220.0, 296.0), (166.0, 288.0)],
        &[(166.0, 288.0), (225.0, 200.0), (274.0, 104.0)],
    ]);
    let moon = cornered(&[
        &[(540.0, 60.0), (500.0, 90.0), (510.0, 140.0), (560.0, 150.0)],
        &[(560.0, 150.0), (480.0, 170.0), (460.0, 80.0), (540.0, 60.0)],
    ]);
    let paths = [
        hull,
        mast,
        main,
        jib,
        moon,
        wave(40.0, 410.0, 7),
        wave(120.0, 440.0, 5),
        gull(86.0, 128.0),
        gull(162.0, 82.0),
    ];
    Drawing { strokes: pen(PEN_PX, paths) }
}

/// A wave of so many periods of 80 px from where it rises through its mean level.
fn wave(from: f64, v: f64, periods: usize) -> Path {
    let rise = [0.0, -7.0, 0.0, 7.0];
    let point = |k: usize| (from + 20.0 * k as f64, v + rise[k % 4]);
    curve(&(0..=4 * periods).map(point).collect::<Vec<_>>())
}

/// Two wings that meet in a point.
fn gull(u: f64, v: f64) -> Path {
    let at = |du, dv| Point::new(u + du, v + dv);
    let mut wings = Path::new(at(-38.0, -2.0));
    wings.push(Element::Cubic { c1: at(-28.0, -16.0), c2: at(-12.0, -10.0), to: at(0.0, 6.0) });
    wings.push(Element::Cubic { c1: at(10.0, -12.0), c2: at(24.0, -20.0), to: at(38.0, -10.0) });
    wings
}

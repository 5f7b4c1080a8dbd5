//! The original report's tracer: what it can do, and what it cannot.

use std::f64::consts::{PI, TAU};

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Point, compare_polylines};
use tracelight_vision::{Mode, Options, Traced, VisionError, trace};

use crate::raster::Canvas;

/// A closed polyline in pen on 320 × 240 px.
fn drawn(figures: &[Vec<Point>]) -> Grey {
    let mut canvas = Canvas::new(320, 240);
    figures.iter().for_each(|figure| canvas.pen(figure, 5.0));
    Grey::new(320, 240, canvas.shares().map(|s| (240.0 - 215.0 * s) as u8).collect()).unwrap()
}

fn swept(image: &Grey) -> Result<Traced, VisionError> {
    trace(image, &Options { mode: Mode::Sweep, ..Options::default() })
}

fn round(centre: (f64, f64), radii: (f64, f64)) -> Vec<Point> {
    let at = |k: u32| planar::direction(TAU * f64::from(k) / 400.0);
    (0..=400).map(|k| Point::new(centre.0 + radii.0 * at(k).x, centre.1 + radii.1 * at(k).y)).collect()
}

fn polygon(corners: &[(f64, f64)]) -> Vec<Point> {
    corners.iter().chain(corners.first()).map(|&p| p.into()).collect()
}

fn star() -> Vec<Point> {
    let corner = |k: u32| {
        let radius = if k.is_multiple_of(2) { 100.0 } else { 40.0 };
        let p = planar::direction(TAU * f64::from(k) / 10.0 - PI / 2.0) * radius;
        (160.0 + p.x, 125.0 + p.y)
    };
    polygon(&(0..10).map(corner).collect::<Vec<_>>())
}

#[test]
fn closed_figures_are_walked_in_steps_of_5_px_back_to_the_start() {
    let figures = [
        ("circle", round((160.3, 120.2), (90.0, 90.0))),
        ("ellipse", round((150.0, 118.0), (120.0, 70.0))),
        ("square", polygon(&[(70.4, 40.2), (230.4, 40.2), (230.4, 200.2), (70.4, 200.2)])),
        ("triangle", polygon(&[(160.0, 30.0), (280.0, 200.0), (50.0, 190.0)])),
    ];
    for (name, truth) in figures {
        let traced = swept(&drawn(std::slice::from_ref(&truth))).unwrap();
        let [stroke] = &traced.strokes.strokes[..] else { panic!("{name}: one stroke") };
        assert!(stroke.path.is_closed());
        let steps: Vec<f64> = stroke.path.pieces().map(|p| p.length(1e-6)).collect();
        let (last, walked) = steps.split_last().unwrap();
        assert!(walked.iter().all(|s| (s - 5.0).abs() < 1e-9), "{name}: {walked:?}");
        assert!(*last < 10.0, "{name}: {last} px back to the start");
        let found = compare_polylines(&[stroke.path.flatten(0.1)], &[truth], 4.0).unwrap();
        println!("{name}: {} steps, rms {:.2} px, coverage {:.3}", steps.len(), found.rms, found.coverage);
        assert!(found.coverage > 0.97 && found.max < 4.0, "{name}: {found:?}");
    }
}

#[test]
fn hollows_and_second_figures_defeat_the_sweep_and_not_the_rest() {
    let two = [
        round((90.0, 120.0), (60.0, 60.0)),
        polygon(&[(190.0, 70.0), (290.0, 70.0), (290.0, 180.0), (190.0, 180.0)]),
    ];
    for (name, figures, least) in [("star", vec![star()], 1), ("two figures", two.to_vec(), 2)] {
        let image = drawn(&figures);
        let coverage = |traced: &Traced| {
            let lines: Vec<_> = traced.strokes.strokes.iter().map(|s| s.path.flatten(0.01)).collect();
            compare_polylines(&lines, &figures, 4.0).unwrap().coverage
        };
        let ours = trace(&image, &Options::default()).unwrap();
        assert_eq!(ours.strokes.strokes.len(), least);
        assert!(coverage(&ours) > 0.999, "{name}: {}", coverage(&ours));
        match swept(&image) {
            Ok(traced) => assert!(coverage(&traced) < 0.7, "{name}: the sweep covers {}", coverage(&traced)),
            Err(error) => {
                println!("{name}: {error}");
                assert!(matches!(error, VisionError::SweepEndless { .. } | VisionError::SweepLost { .. }));
            }
        }
    }
}

#[test]
fn an_open_line_is_not_followed_and_does_not_hang() {
    let dash = vec![Point::new(60.0, 60.0), Point::new(260.0, 180.0)];
    match swept(&drawn(std::slice::from_ref(&dash))) {
        Ok(traced) => {
            let line = traced.strokes.strokes[0].path.flatten(0.1);
            assert!(compare_polylines(&[line], &[dash], 4.0).unwrap().coverage < 0.8);
        }
        Err(error) => assert!(error.to_string().contains("--mode auto"), "{error}"),
    }
}

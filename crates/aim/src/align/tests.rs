use super::*;

const WIDE: PanTilt<(f64, f64)> = PanTilt::new((-3.1, 3.1), (-1.6, 1.6));

/// A head 5 mm and 2° from where it was said to be, its beam and axes a little off.
fn truth() -> Alignment {
    let pose = HeadPose {
        distance_m: 0.9194,
        right_m: -0.005,
        up_m: 0.005,
        yaw_rad: 0.035,
        pitch_rad: -0.035,
        roll_rad: 0.035,
    };
    let geometry = HeadGeometry {
        laser_offset_m: [0.0, 0.004, -0.003],
        beam_off_rad: [0.006, -0.009],
        axis_skew_rad: 0.004,
        range_rad: WIDE,
    };
    Alignment { geometry, pose, late_s: 0.004, readout_s: 0.027 }
}

fn belief() -> AlignmentBelief {
    AlignmentBelief::by_eye(HeadGeometry::centred(WIDE), HeadPose::square_on(0.9144))
}

/// Even draws between −1 and 1 (the minimal standard generator, Park & Miller 1988).
struct Dice(u64);

impl Dice {
    fn draw(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 0x7fff_ffff;
        2.0 * self.0 as f64 / f64::from(0x7fff_ffff) - 1.0
    }
}

/// Spots on 25 small circles, each off by noise of this deviation.
fn seen(deviation_m: f64, dice: &mut Dice) -> Vec<SeenSpot> {
    let mut spots = Vec::new();
    for k in 0..25 * 8 {
        let (dot, turn) = (k / 8, f64::from(k % 8) * 0.8);
        let (pan, tilt) = (f64::from(dot % 5 - 2) * 0.15, f64::from(dot / 5 - 2) * 0.1);
        let spot = SeenSpot {
            angle_rad: PanTilt::new(pan + 5e-3 * turn.cos(), tilt + 5e-3 * turn.sin()),
            rate_rad_s: PanTilt::new(-0.08 * turn.sin(), 0.08 * turn.cos()),
            down: 0.5 + 0.2 * f64::from(dot / 5 - 2),
            at: Point::ORIGIN,
            deviation_m,
        };
        let noise = Vec2::new(dice.draw(), dice.draw()) * 3.0_f64.sqrt() * deviation_m;
        spots.push(SeenSpot { at: truth().told(&spot).unwrap() + noise, ..spot });
    }
    spots
}

/// Root mean square and largest distance on the wall between what is found and what is, where the dots were.
fn off_m(found: &Alignment) -> (f64, f64) {
    let mut squares = Vec::new();
    for i in -6..=6 {
        for j in -6..=6 {
            let angle = PanTilt::new(f64::from(i) * 0.05, f64::from(j) * 0.033);
            let [a, b] = [found, &truth()].map(|head| head.geometry.spot(&head.pose, angle).unwrap());
            squares.push(a.distance_squared(b));
        }
    }
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (mean.sqrt(), squares.iter().copied().fold(0.0, f64::max).sqrt())
}

#[test]
fn without_noise_the_wall_is_where_it_is() {
    let found = align(&belief(), &seen(1e-5, &mut Dice(7)).iter().map(exact).collect::<Vec<_>>()).unwrap();
    let (rms, most) = off_m(&found.alignment);
    assert!(rms < 2e-6 && most < 5e-6, "{rms:e} {most:e}");
    assert!((found.alignment.late_s - truth().late_s).abs() < 2e-4, "{:?}", found.alignment);
}

fn exact(spot: &SeenSpot) -> SeenSpot {
    SeenSpot { at: truth().told(spot).unwrap(), ..*spot }
}

#[test]
fn what_is_told_of_the_error_is_what_the_error_is() {
    let (mut told, mut found, mut fits) = (0.0, 0.0, 0.0);
    let runs = 20;
    for seed in 1..=runs {
        let fit = align(&belief(), &seen(1e-4, &mut Dice(seed))).unwrap();
        found += off_m(&fit.alignment).0.powi(2);
        told += fit.deviation_m(PanTilt::new(0.15, -0.1)).unwrap().powi(2);
        fits += fit.rms_m.powi(2);
    }
    let [found, told, fits] = [found, told, fits].map(|sum: f64| (sum / runs as f64).sqrt());
    assert!(found < 4e-5, "{found:e}");
    assert!((0.5..2.0).contains(&(told / found)), "{told:e} {found:e}");
    assert!((fits / 1.4e-4 - 1.0).abs() < 0.1, "{fits:e}");
}

#[test]
fn spots_that_were_reflections_do_not_count() {
    let mut spots = seen(1e-4, &mut Dice(3));
    for spot in spots.iter_mut().step_by(7) {
        spot.at += Vec2::new(0.05, -0.02);
    }
    let fit = align(&belief(), &spots).unwrap();
    assert!(off_m(&fit.alignment).0 < 6e-5, "{:?}", off_m(&fit.alignment));
    assert_eq!(fit.outliers, 200_usize.div_ceil(7));
}

#[test]
fn what_no_head_draws_is_refused() {
    let mut dice = Dice(5);
    let mut spots = seen(1e-4, &mut dice);
    spots.iter_mut().for_each(|spot| spot.at = Point::new(0.3 * dice.draw(), 0.2 * dice.draw()));
    assert!(matches!(align(&belief(), &spots), Err(AlignError::NoFit { .. })));
    assert_eq!(align(&belief(), &spots[..3]).unwrap_err(), AlignError::TooFew { spots: 3 });
}

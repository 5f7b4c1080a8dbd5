use tracelight_maths::planar;

use super::*;

/// What a camera sees of pages that lie so, to a deviation.
fn seen(
    camera: &Camera,
    board: &Board,
    pages: &[(u16, Point, f64)],
    deviation_px: f64,
    dice: &mut oorandom::Rand64,
) -> Vec<SeenTag> {
    let mut normal = || (0..12).map(|_| dice.rand_float()).sum::<f64>() - 6.0;
    let mut all = Vec::new();
    for &(page, middle, turn_rad) in pages {
        let (s, c) = f64::sin_cos(turn_rad);
        let pixel = |p: Point| {
            camera.pixel(Point::new(c * p.x - s * p.y + middle.x, s * p.x + c * p.y + middle.y)).unwrap()
        };
        for number in 0..board.tags() {
            let printed = board.corners(number);
            let (right, down) = (printed[1] - printed[0], printed[3] - printed[0]);
            let place = |k: usize| {
                // the four sides of the border
                let (side, along) = (k / 8, (k % 8) as f64 / 8.0 + 0.0625);
                let on_tag = [(along, 0.0), (1.0, along), (along, 1.0), (0.0, along)]
                    .map(|(x, y)| Point::new(x, y))[side];
                let upright = side % 2 == 1;
                let at = |p: Point| pixel(printed[0] + right * p.x + down * p.y);
                let step = if upright { Vec2::new(0.0, 1e-4) } else { Vec2::new(1e-4, 0.0) };
                let along = at(on_tag + step) - at(on_tag - step);
                let off = across(along / along.hypot()) * (deviation_px * normal());
                SeenPlace { on_tag, upright, black_behind: side == 0 || side == 3, at: at(on_tag) + off }
            };
            let places = (0..32).map(place).collect();
            all.push(SeenTag {
                id: board.id(page, number),
                corners: printed.map(pixel),
                places,
                deviation_px,
            });
        }
    }
    all
}

fn webcam() -> Lens {
    Lens { radial: [-0.1, 0.01, 0.0], centre_px: Point::new(652.0, 351.0), ..Lens::ideal(1280, 720, 1000.0) }
}

fn corners() -> Vec<(u16, Point, f64)> {
    vec![
        (0, Point::ORIGIN, 0.0),
        (1, Point::new(0.72, 0.03), 1.5),
        (2, Point::new(0.70, -0.35), -0.1),
        (5, Point::new(-0.04, -0.31), 0.05),
    ]
}

fn looking(x: f64, y: f64) -> CameraPose {
    CameraPose::looking_at([x, y, 1.2], [0.35, -0.17, 0.0]).unwrap()
}

#[test]
fn a_camera_and_where_pages_lie_are_found_and_how_well_is_known() {
    let (runs, deviation_px) = (30, 0.1);
    let (mut squares, mut ratio) = (0.0, 0.0);
    for seed in 0..runs {
        let mut dice = oorandom::Rand64::new(seed);
        let camera = Camera { lens: webcam(), pose: looking(dice.rand_float() - 0.1, -0.3) };
        let tags = seen(&camera, &Board::FINE, &corners(), deviation_px, &mut dice);
        let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap();
        assert!((found.rms_px / deviation_px - 1.0).abs() < 0.1, "{}", found.rms_px);
        let placed = found.pages[3];
        assert_eq!((placed.board, placed.page), (0, 5));
        assert!(
            placed.middle.distance(Point::new(-0.04, -0.31)) < 3e-4 && (placed.turn_rad - 0.05).abs() < 2e-3
        );
        let told = found.camera(0).unwrap();
        for k in 0..9 {
            let on_wall = Point::new(0.35 * f64::from(k % 3), -0.16 * f64::from(k / 3));
            let got = told.target(camera.pixel(on_wall).unwrap(), &Matrix2::zeros()).unwrap();
            squares += (got.at - on_wall).hypot2() / (9.0 * runs as f64);
            ratio += (got.at - on_wall).hypot2() / got.covariance.trace() / (9.0 * runs as f64);
        }
    }
    assert!(squares.sqrt() < 1.5e-4, "{} m", squares.sqrt());
    assert!((0.6..1.6).contains(&ratio), "errors are {ratio} times as large as told, squared");
}

#[test]
fn straight_ahead_the_focal_length_stays_open_and_the_wall_is_found() {
    let runs = 10;
    let mut chi2 = 0.0;
    for seed in 0..runs {
        let mut dice = oorandom::Rand64::new(seed);
        let camera = Camera { lens: webcam(), pose: looking(0.35 + 0.03 * dice.rand_float(), -0.19) };
        let tags = seen(&camera, &Board::FINE, &corners(), 0.05, &mut dice);
        let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap();
        let focal = found.belief.lens.focal_px[0];
        let deviation = found.belief.covariance[(0, 0)].sqrt() / focal;
        assert!(deviation > 0.05, "{focal} ± {deviation}");
        chi2 += ((focal / 1000.0).ln() / deviation).powi(2) / runs as f64;
        for on_wall in [(0.1, -0.1), (0.6, -0.3)].map(Point::from) {
            let got = found.camera(0).unwrap().camera.target(camera.pixel(on_wall).unwrap()).unwrap();
            assert!(got.distance(on_wall) < 3e-4, "{} m", got.distance(on_wall));
        }
    }
    assert!(chi2 < 2.0, "focal lengths are {} times as far off as told", chi2.sqrt());
}

#[test]
fn several_views_tell_the_lens() {
    let mut dice = oorandom::Rand64::new(7);
    let poses = [(0.35, -0.17), (-0.6, 0.2), (1.2, 0.3), (0.4, -1.0), (0.2, 0.8)];
    let views: Vec<Vec<SeenTag>> = poses
        .iter()
        .map(|&(x, y)| {
            let camera = Camera { lens: webcam(), pose: looking(x, y) };
            seen(&camera, &Board::FINE, &corners(), 0.1, &mut dice)
        })
        .collect();
    let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &views).unwrap();
    let lens = found.belief.lens;
    let deviation = |k: usize| found.belief.covariance[(k, k)].sqrt();
    assert!((lens.focal_px[0] - 1000.0).abs() < 4.0 * deviation(0) && deviation(0) < 1.0);
    assert!((lens.radial[0] + 0.1).abs() < 4.0 * deviation(4) && deviation(4) < 5e-3);
    assert!(lens.centre_px.distance(webcam().centre_px) < 2.0);
    // with the lens known, one view of one page is enough to see the whole wall as it is
    let camera = Camera { lens: webcam(), pose: looking(0.1, -0.6) };
    let one = seen(&camera, &Board::FINE, &corners()[..1], 0.1, &mut dice);
    let known = survey(&found.belief, &Board::ALL, &[one]).unwrap().camera(0).unwrap();
    let far = Point::new(0.7, -0.3);
    let off = known.camera.target(camera.pixel(far).unwrap()).unwrap().distance(far);
    assert!(off < 1.5e-3, "{off} m");
}

#[test]
fn what_can_not_be_surveyed_says_why() {
    let mut dice = oorandom::Rand64::new(1);
    let camera = Camera { lens: webcam(), pose: looking(0.3, 0.0) };
    let view = |pages: &[(u16, Point, f64)], dice: &mut _| seen(&camera, &Board::FINE, pages, 0.1, dice);
    let belief = LensBelief::unknown(1280, 720);
    let check = |views: &[Vec<SeenTag>], error: SurveyError| {
        assert_eq!(survey(&belief, &Board::ALL, views).unwrap_err(), error);
    };
    let (first, last) = (view(&corners()[..1], &mut dice), view(&corners()[3..], &mut dice));
    check(&[first.clone(), vec![]], SurveyError::NoMarkers { view: 2 });
    check(&[first, last], SurveyError::Apart { page: 6 });
    check(&[], SurveyError::NoMarkers { view: 1 });
    // pages that change places between two images
    let mut swapped = corners();
    (swapped[1].1, swapped[2].1) = (swapped[2].1, swapped[1].1);
    let views = [view(&corners(), &mut dice), view(&swapped, &mut dice)];
    assert!(matches!(survey(&belief, &Board::ALL, &views), Err(SurveyError::NoFit { .. })));
}

/// Markers of pages that lie so, one of them in front of the wall and printed larger.
fn seen_askew(
    camera: &Camera,
    which: usize,
    height_m: f64,
    larger: f64,
    dice: &mut oorandom::Rand64,
) -> Vec<SeenTag> {
    let mut tags = seen(camera, &Board::FINE, &corners(), 0.05, dice);
    let (page, middle, turn_rad) = corners()[which];
    let board = Board::FINE.scaled(1.0 + larger);
    let (s, c) = f64::sin_cos(turn_rad);
    let raised = |p: Point| {
        let (x, y) = (c * p.x - s * p.y + middle.x, s * p.x + c * p.y + middle.y);
        camera.pixel_of([x, y, height_m]).unwrap()
    };
    for tag in tags.iter_mut().filter(|tag| Board::FINE.find(tag.id).unwrap().0 == page) {
        let number = Board::FINE.find(tag.id).unwrap().1;
        let (meant, printed) = (Board::FINE.corners(number), board.corners(number));
        let on = |from: [Point; 4], p: Point| from[0] + (from[1] - from[0]) * p.x + (from[3] - from[0]) * p.y;
        let flat = |p: Point| {
            camera.pixel(Point::new(c * p.x - s * p.y + middle.x, s * p.x + c * p.y + middle.y)).unwrap()
        };
        for place in &mut tag.places {
            // as much beside as before
            place.at = raised(on(printed, place.on_tag)) + (place.at - flat(on(meant, place.on_tag)));
        }
        tag.corners = printed.map(raised);
    }
    tags
}

#[test]
fn a_page_that_is_loose_or_printed_otherwise_is_named_and_counted_in() {
    for (height_m, larger) in [(0.0, 0.0), (2e-3, 0.0), (5e-3, 0.0), (0.0, -3e-3), (0.0, 0.02)] {
        let mut dice = oorandom::Rand64::new(5);
        let camera = Camera { lens: webcam(), pose: looking(0.65, -0.35) };
        let tags = seen_askew(&camera, 2, height_m, larger, &mut dice);
        let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap();
        let bad = height_m != 0.0 || larger != 0.0;
        assert_eq!(
            !found.doubts.is_empty(),
            bad,
            "{height_m} {larger}: {:?} {:?}",
            found.doubts,
            found.pages
        );
        // and the wall is about as far off as told, or a warning was given
        let told = found.camera(0).unwrap();
        let on_wall = Point::new(0.35, -0.1);
        let got = told.target(camera.pixel(on_wall).unwrap(), &Matrix2::zeros()).unwrap();
        assert!(bad || got.at.distance(on_wall) < 4.0 * got.deviation());
    }
}

#[test]
fn a_page_that_is_there_twice_is_named() {
    let mut dice = oorandom::Rand64::new(1);
    let camera = Camera { lens: webcam(), pose: looking(0.3, 0.0) };
    let mut pages = corners();
    pages[2].0 = 1;
    let tags = seen(&camera, &Board::FINE, &pages, 0.1, &mut dice);
    let error = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap_err();
    assert_eq!(error, SurveyError::Twice { view: 1, page: 2 });
}

#[test]
fn the_first_page_may_be_behind_a_camera() {
    let mut dice = oorandom::Rand64::new(3);
    // one looks along the wall from beside the first page, which it does not see
    let near = CameraPose::looking_at([0.25, -0.15, 0.3], [0.85, -0.15, 0.0]).unwrap();
    let views: Vec<Vec<SeenTag>> = [looking(0.35, -0.17), looking(-0.4, 0.2), looking(1.1, 0.3)]
        .map(|pose| seen(&Camera { lens: webcam(), pose }, &Board::FINE, &corners(), 0.05, &mut dice))
        .into_iter()
        .chain([seen(
            &Camera { lens: webcam(), pose: near },
            &Board::FINE,
            &corners()[1..3],
            0.05,
            &mut dice,
        )])
        .collect();
    let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &views).unwrap();
    assert!((found.belief.lens.focal_px[0] - 1000.0).abs() < 2.0, "{:?}", found.belief.lens);
    assert!(found.poses[3].place_m().iter().zip([0.25, -0.15, 0.3]).all(|(a, b)| (a - b).abs() < 2e-3));
}

#[test]
fn a_marker_that_was_moved_counts_little() {
    let mut dice = oorandom::Rand64::new(2);
    let camera = Camera { lens: webcam(), pose: looking(0.5, -0.3) };
    let mut tags = seen(&camera, &Board::FINE, &corners(), 0.1, &mut dice);
    for place in &mut tags[7].places {
        place.at += Vec2::new(4.0, -3.0);
    }
    let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap().camera(0).unwrap();
    let on_wall = Point::new(0.3, -0.2);
    assert!(found.camera.target(camera.pixel(on_wall).unwrap()).unwrap().distance(on_wall) < 3e-4);
}

#[test]
fn in_another_frame_a_place_is_as_uncertain() {
    let camera = Camera { lens: webcam(), pose: looking(0.1, -0.3) };
    let mut dice = oorandom::Rand64::new(4);
    let tags = seen(&camera, &Board::FINE, &corners(), 0.1, &mut dice);
    let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap().camera(0).unwrap();
    let frame = planar::rotation(0.4).then_translate(Vec2::new(-0.5, 0.8));
    let moved = found.in_frame(frame);
    for pixel in [(100.0, 80.0), (640.0, 360.0), (1200.0, 700.0)].map(Point::from) {
        let [a, b] = [found, moved].map(|camera| camera.target(pixel, &Matrix2::zeros()).unwrap());
        assert!((frame * a.at).distance(b.at) < 1e-9);
        assert!((a.deviation() / b.deviation() - 1.0).abs() < 1e-6, "{} {}", a.deviation(), b.deviation());
    }
}

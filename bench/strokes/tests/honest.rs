//! The generator does what its README says.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use tracelight_bench_strokes::case::Wanted;
use tracelight_bench_strokes::{
    Case, Degradation, Figure, Kind, Page, Picture, Random, Set, Size, nine, rules,
};
use tracelight_stroke::{Drawing, Point, StrokeKind, Vec2, compare_polylines, score};

const SMALL: Size = Size { width: 320, height: 240 };

fn series(count: usize, kind: Option<Kind>, degradation: Degradation) -> Vec<Case> {
    let wanted = Wanted { kind, degradation: Some(degradation), size: Some(SMALL), ..Wanted::default() };
    Case::series(3, count, &wanted)
}

/// How dark a clean picture is at a point: 0 its paper, 1 its ink.
fn darkness(picture: &Picture) -> impl Fn(Point) -> f64 {
    let (paper, ink) = (*picture.levels.iter().max().unwrap(), *picture.levels.iter().min().unwrap());
    move |at| {
        let level = picture.levels[at.y as usize * picture.width + at.x as usize];
        f64::from(paper - level) / f64::from(paper - ink)
    }
}

#[test]
fn a_seed_draws_the_same_picture_every_time() {
    let wanted = Wanted { size: Some(SMALL), ..Wanted::default() };
    for case in Case::series(9, 34, &wanted) {
        let (one, other) = (case.draw(), case.draw());
        assert!(one.levels == other.levels && one.truth == other.truth, "{case}");
    }
    let seeds =
        Case::series(9, 34, &wanted).iter().map(|c| c.seed).collect::<std::collections::BTreeSet<_>>();
    assert_eq!(seeds.len(), 34);
    assert_ne!(Case::series(10, 1, &wanted)[0].draw().levels, Case::series(9, 1, &wanted)[0].draw().levels);
}

#[test]
fn pen_strokes_lie_on_ink() {
    for case in series(78, None, Degradation::Clean).into_iter().filter(|c| c.kind != Kind::Gaps) {
        let picture = case.draw();
        let dark_at = darkness(&picture);
        let gaps = case.kind == Kind::Mixed;
        let strokes = picture.truth.strokes.iter().filter(|s| s.kind == StrokeKind::Centreline);
        let points: Vec<_> = strokes.flat_map(|s| s.path.flatten(0.01)).collect();
        let pale = points.iter().filter(|p| dark_at(**p) < 0.3).count();
        // a butt cap may cover little of an end's pixel; of these kinds only a page of everything has lines with gaps
        assert!(
            pale <= 2 * picture.truth.strokes.len() || gaps,
            "{case}: {pale} of {} points are not on ink",
            points.len()
        );
    }
}

#[test]
fn there_is_no_ink_away_from_the_truth() {
    for case in series(78, None, Degradation::Clean).into_iter().filter(|c| c.kind != Kind::Filled) {
        let picture = case.draw();
        let dark_at = darkness(&picture);
        if picture.truth.strokes.iter().any(|s| s.kind == StrokeKind::Outline) {
            continue;
        }
        let lines: Vec<_> = picture.truth.strokes.iter().map(|s| s.path.flatten(0.01)).collect();
        let pen = picture.truth.strokes.iter().filter_map(|s| s.pen).fold(0.0, f64::max);
        let centres = (0..picture.levels.len())
            .map(|i| Point::new((i % picture.width) as f64 + 0.5, (i / picture.width) as f64 + 0.5));
        let dark = centres.filter(|&at| dark_at(at) > 0.5);
        let spots: Vec<_> = dark.map(|at| vec![at, at + Vec2::new(1e-3, 0.0)]).collect();
        // a mitre reaches two pens from its corner at most
        let off = compare_polylines(&spots, &lines, 1.0).unwrap().max;
        assert!(off < 2.0 * pen, "{case}: ink {off} px from the truth");
    }
}

#[test]
fn outlines_run_along_edges() {
    for case in series(24, Some(Kind::Filled), Degradation::Clean) {
        let picture = case.draw();
        let dark_at = darkness(&picture);
        let outlines = picture.truth.strokes.iter().filter(|s| s.kind == StrokeKind::Outline);
        let points: Vec<_> = outlines.flat_map(|s| s.path.flatten(0.01)).collect();
        // an edge's pixels are half covered, except where a stick begins and in the tips of corners
        let odd = points.iter().filter(|p| !(0.0..1.0).contains(&dark_at(**p))).count();
        assert!(10 * odd <= 3 * points.len(), "{case}: {odd} of {}", points.len());
    }
}

#[test]
fn pages_keep_the_rules_over_200_seeds() {
    for seed in 0..200 {
        let kind = Kind::of(Set::Plain)[seed % Kind::of(Set::Plain).len()];
        let page = Page::draw(&mut Random::new(seed as u128), kind, SMALL, 1.0);
        let strokes = page.figures.iter().flat_map(|f| f.strokes.clone()).collect();
        let whole = Figure { strokes, ink: vec![] };
        assert!((1..=40).contains(&whole.strokes.len()), "{kind:?}, seed {seed}");
        assert_eq!(rules::broken(&whole, page.pen, page.paper), None, "{kind:?}, seed {seed}");
    }
}

#[test]
fn every_kind_of_figure_gets_onto_a_page() {
    for &kind in Kind::of(Set::Plain) {
        let pages = (0..12).map(|seed| Page::draw(&mut Random::new(seed), kind, SMALL, 1.0));
        let figures: usize = pages.map(|p| p.figures.len()).sum();
        assert!(figures >= 18, "{kind:?}: {figures} figures on 12 pages");
    }
}

#[test]
fn truth_stays_in_the_picture_and_moves_with_the_perspective() {
    for case in series(26, None, Degradation::Perspective) {
        let seen = case.draw().truth;
        for p in seen.strokes.iter().flat_map(|s| s.path.flatten(0.1)) {
            assert!((0.0..320.0).contains(&p.x) && (0.0..240.0).contains(&p.y), "{case}: {p:?}");
        }
        let strokes = case.page().figures.iter().flat_map(|f| f.strokes.clone()).collect();
        let flat = Drawing { strokes };
        let found = score(&seen, &flat, 2.0).unwrap();
        assert!(found.max > 0.2 && found.max < 12.0, "{case}: {found:?}");
    }
}

#[test]
fn degradations_change_what_they_say() {
    let levels =
        |d| Case { degradation: d, ..series(1, Some(Kind::Lines), Degradation::Clean)[0] }.draw().levels;
    let clean = levels(Degradation::Clean);
    for &degradation in Degradation::of(Set::Plain).iter().filter(|&&d| d != Degradation::Clean) {
        assert_ne!(levels(degradation), clean, "{degradation:?}");
    }
    let mean = |levels: &[u8]| levels.iter().map(|&l| f64::from(l)).sum::<f64>() / levels.len() as f64;
    assert!(mean(&levels(Degradation::Inverted)) < 100.0 && mean(&clean) > 200.0);
    let least = |levels: &[u8]| levels.iter().copied().min().unwrap();
    assert!(least(&levels(Degradation::Pencil)) > 120);
}

#[test]
fn the_nine_strokes_are_nine() {
    let picture = nine::picture(SMALL, false, 0);
    assert_eq!(picture.truth.strokes.len(), 9);
    assert_eq!(score(&picture.truth, &picture.truth, 2.0).unwrap().matched, 9);
    let webcam = nine::picture(SMALL, true, 0);
    assert_eq!(webcam.truth, picture.truth);
    // white paper in the lamp's light, and at its darkest corner
    let mean = |x: usize, y: usize| {
        let block = (0..64).map(|i| f64::from(webcam.levels[(y + i / 8) * 320 + x + i % 8]));
        block.sum::<f64>() / 64.0
    };
    assert!((mean(2, 2) - 253.0).abs() < 6.0, "{}", mean(2, 2));
    assert!(mean(308, 230) < 110.0, "{}", mean(308, 230));
}

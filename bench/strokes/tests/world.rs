//! The kinds of the world are what the README says.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use tracelight_bench_strokes::case::Wanted;
use tracelight_bench_strokes::{Case, Degradation, Kind, Page, Picture, Random, Set, Size};
use tracelight_stroke::{Point, StrokeKind, Vec2, compare_polylines};

const SMALL: Size = Size { width: 320, height: 240 };
/// Ink differs from what is around it by so many levels.
const LEAST_CONTRAST: u8 = 10;

fn series(count: usize, degradation: Option<Degradation>) -> Vec<Case> {
    let wanted = Wanted { set: Set::World, kind: None, degradation, size: Some(SMALL) };
    Case::series(4, count, &wanted)
}

/// Grey levels of the pixels around a point.
fn around(picture: &Picture, at: Point, reach: f64) -> impl Iterator<Item = u8> + '_ {
    let range = move |middle: f64, size: usize| {
        ((middle - reach).max(0.0) as usize)..(((middle + reach) as usize + 1).min(size))
    };
    let rows = range(at.y, picture.height);
    rows.flat_map(move |y| range(at.x, picture.width).map(move |x| picture.levels[y * picture.width + x]))
}

#[test]
fn a_seed_draws_the_same_picture_every_time() {
    for case in series(60, None) {
        let (one, other) = (case.draw(), case.draw());
        assert!(one.levels == other.levels && one.truth == other.truth, "{case}");
    }
}

#[test]
fn lines_stand_out_from_what_is_around_them_and_nothing_hides_them() {
    for case in series(120, Some(Degradation::Clean)) {
        let picture = case.draw();
        let lines = picture.truth.strokes.iter().filter(|s| s.kind == StrokeKind::Centreline);
        let (mut points, mut hidden) = (0, 0);
        for stroke in lines {
            let pen = stroke.pen.unwrap();
            for at in stroke.path.flatten(0.01) {
                let darkest = around(&picture, at, 0.5 * pen).min().unwrap();
                let paper = around(&picture, at, 1.5 * pen + 4.0).max().unwrap();
                points += 1;
                hidden += usize::from(paper - darkest < LEAST_CONTRAST);
            }
        }
        assert!(25 * hidden <= points, "{case}: {hidden} of {points} points are not seen");
    }
}

#[test]
fn there_is_no_ink_away_from_the_truth() {
    use Kind::{Coloured, Crayon, Dotted, Graphite, Retouched, Ruled, Sketched, Squared, Table};
    let patterned = [Ruled, Squared, Dotted, Table, Graphite, Crayon, Retouched, Sketched, Coloured];
    let clean = series(120, Some(Degradation::Clean));
    for case in clean.into_iter().filter(|c| !patterned.contains(&c.kind)) {
        let picture = case.draw();
        if picture.truth.strokes.iter().any(|s| s.kind == StrokeKind::Outline) {
            continue;
        }
        let lines: Vec<_> = picture.truth.strokes.iter().map(|s| s.path.flatten(0.01)).collect();
        let (paper, ink) = (*picture.levels.iter().max().unwrap(), *picture.levels.iter().min().unwrap());
        let dark = (0..picture.levels.len()).filter(|&i| picture.levels[i] < paper - (paper - ink) / 4);
        let centre = |i| Point::new((i % picture.width) as f64 + 0.5, (i / picture.width) as f64 + 0.5);
        let spots: Vec<_> = dark.map(centre).map(|at| vec![at, at + Vec2::new(1e-3, 0.0)]).collect();
        let off = compare_polylines(&spots, &lines, 1.0).unwrap().max;
        let most = 0.5 * case.page().widest().unwrap() + 1.0;
        assert!(off < most, "{case}: ink {off} px from the truth, at most {most} px are a pen's half");
    }
}

#[test]
fn truth_stays_in_the_picture_also_on_a_tilted_sheet() {
    for case in series(60, None).into_iter().chain(series(60, Some(Degradation::Photo))) {
        for p in case.draw().truth.strokes.iter().flat_map(|s| s.path.flatten(0.1)) {
            assert!((0.0..320.0).contains(&p.x) && (0.0..240.0).contains(&p.y), "{case}: {p:?}");
        }
    }
}

#[test]
fn every_kind_has_figures_on_every_size() {
    for &kind in Kind::of(Set::World) {
        for &(size, _) in Size::of(kind) {
            // seen from aside, a page of a table needs 1.6 times the room
            let roomy = if kind == Kind::Table { 1.6 } else { 1.08 };
            let figures = (0..4).map(|seed| {
                let page = Page::of(&mut Random::new(seed), kind, size, roomy);
                page.unwrap_or_else(|| panic!("{kind:?} does not fit on {size}, seed {seed}")).figures.len()
            });
            assert!(figures.sum::<usize>() >= 4, "{kind:?}, {size}");
        }
    }
}

#[test]
fn pages_have_as_many_strokes_as_a_person_draws() {
    for (seed, &kind) in (0..100).zip(Kind::of(Set::World).iter().cycle()) {
        let page = Page::draw(&mut Random::new(seed), kind, SMALL, 1.0);
        let strokes = page.figures.iter().map(|f| f.strokes.len()).sum::<usize>();
        assert!((1..=121).contains(&strokes), "{kind:?}, seed {seed}: {strokes}");
    }
}

#[test]
fn each_kind_is_of_one_set() {
    assert_eq!((Kind::of(Set::Plain).len(), Kind::of(Set::World).len()), (13, 26));
    for set in [Set::Plain, Set::World] {
        assert!(Kind::of(set).iter().all(|k| k.set() == set));
    }
}

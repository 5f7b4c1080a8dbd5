use std::time::Instant;

use tracelight_aim::{Board, LensBelief, SeenPlace, SeenTag, Survey, survey};
use tracelight_image::Grey;
use tracelight_markers::{Tag, TagPlace, find_tags};
use tracelight_plant::Image;
use tracelight_stroke::Point;

use crate::scene::{Dice, Scene, save};

/// What many images come to.
#[derive(Default)]
struct Tally {
    there: usize,
    found: usize,
    wrong: usize,
    corners: usize,
    /// Sum of the squared distances of corners, px².
    squares: f64,
    find_ms: Vec<f64>,
    survey_ms: Vec<f64>,
    rms_mm: Vec<f64>,
    max_mm: Vec<f64>,
    told_mm: Vec<f64>,
}

/// Finds markers and the wall in scenes from seeds 0 on; leaves the images with what is true in a folder.
pub(crate) fn score(board: &Board, seeds: u64, folder: Option<&str>) {
    let mut tally = Tally::default();
    for seed in 0..seeds {
        let scene = Scene::with_pages(&mut Dice::new(seed), board);
        let image = scene.image(seed);
        if let Some(folder) = folder {
            save(&format!("{folder}/{seed}.png"), &image);
            std::fs::write(format!("{folder}/{seed}.csv"), scene.truth()).expect("writes");
        }
        let image = grey(&image);
        let started = Instant::now();
        let tags = find_tags(&image);
        tally.find_ms.push(started.elapsed().as_secs_f64() * 1e3);
        tally.compare(&scene, &tags);
        let seen: Vec<SeenTag> = tags.iter().map(seen).collect();
        let belief = LensBelief::unknown(image.width(), image.height());
        let started = Instant::now();
        match survey(&belief, &[*board], &[seen]) {
            Ok(surveyed) => {
                if !surveyed.doubts.is_empty() {
                    println!("seed {seed}: {:?}", surveyed.doubts);
                }
                tally.survey_ms.push(started.elapsed().as_secs_f64() * 1e3);
                tally.measure(&scene, &surveyed);
            }
            Err(error) => println!("seed {seed}: {error}"),
        }
    }
    tally.print();
}

fn grey(image: &Image) -> Grey {
    Grey::new(image.width, image.height, image.luma()).expect("an image")
}

fn seen(tag: &Tag) -> SeenTag {
    let place = |p: &TagPlace| SeenPlace {
        on_tag: (p.cell.to_vec2() / 8.0).to_point(),
        upright: p.upright,
        black_behind: p.black_behind,
        at: p.at,
    };
    SeenTag {
        id: tag.id,
        corners: tag.corners,
        places: tag.places.iter().map(place).collect(),
        deviation_px: tag.deviation_px,
    }
}

impl Tally {
    fn compare(&mut self, scene: &Scene, tags: &[Tag]) {
        let truth = scene.corners();
        self.there += truth.iter().filter(|known| !known.drowned).count();
        for tag in tags {
            let own = truth.iter().find(|known| known.id == tag.id);
            let Some(own) = own.filter(|own| own.corners[0].distance(tag.corners[0]) < 3.0) else {
                self.wrong += 1;
                continue;
            };
            self.found += usize::from(!own.drowned);
            self.corners += 4;
            self.squares +=
                own.corners.iter().zip(&tag.corners).map(|(a, b)| a.distance_squared(*b)).sum::<f64>();
        }
    }

    /// Where a field of 26 × 14 in on the wall is, held against where it should be.
    fn measure(&mut self, scene: &Scene, surveyed: &Survey) {
        let camera = surveyed.camera(0).expect("a camera");
        let (mut squares, mut most, mut count, mut told) = (0.0, 0.0_f64, 0, 0.0);
        for k in 0..27 * 15 {
            let on_wall = Point::new(0.0254 * f64::from(k % 27 - 13), 0.0254 * f64::from(k / 27 - 7));
            let pixel = scene.camera.pixel(on_wall).filter(|p| scene.camera.is_in_sight(*p));
            let Some(got) = pixel.and_then(|pixel| camera.target(pixel, &Default::default())) else {
                continue;
            };
            let off = (scene.wall_from_page() * got.at).distance(on_wall);
            (squares, most) = (squares + off * off, most.max(off));
            (told, count) = (told + got.covariance.trace(), count + 1);
        }
        self.rms_mm.push((squares / f64::from(count)).sqrt() * 1e3);
        self.told_mm.push((told / f64::from(count)).sqrt() * 1e3);
        self.max_mm.push(most * 1e3);
    }

    fn print(&mut self) {
        let rms_px = (self.squares / self.corners.max(1) as f64).sqrt();
        println!(
            "markers: {} of {} found, {} wrong; corners {rms_px:.3} px rms",
            self.found, self.there, self.wrong
        );
        let both = |of: &mut Vec<f64>| {
            of.sort_by(f64::total_cmp);
            let worst = of.last().copied().unwrap_or(f64::NAN);
            (of.get(of.len() / 2).copied().unwrap_or(f64::NAN), worst)
        };
        for (name, of) in [
            ("to find them, ms", &mut self.find_ms),
            ("to survey, ms", &mut self.survey_ms),
            ("wall, rms, mm", &mut self.rms_mm),
            ("wall, largest, mm", &mut self.max_mm),
            ("wall, rms as told, mm", &mut self.told_mm),
        ] {
            let (median, worst) = both(of);
            println!("{name}: median {median:.3}, worst {worst:.3}");
        }
    }
}

/// How long markers take to be found: none, sixteen, eighty in sight.
pub(crate) fn time() {
    let image = |board: &Board| grey(&Scene::with_pages(&mut Dice::new(0), board).image(0));
    let mut dice = Dice::new(1);
    let empty = (0..1280 * 720).map(|_| dice.between(140.0, 160.0) as u8).collect();
    let images = [
        (0, Grey::new(1280, 720, empty).expect("an image")),
        (16, image(&Board::COARSE)),
        (80, image(&Board::FINE)),
    ];
    for (count, image) in images {
        let mut ms: Vec<f64> = (0..101)
            .map(|_| {
                let started = Instant::now();
                std::hint::black_box(find_tags(&image));
                started.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        ms.sort_by(f64::total_cmp);
        println!("{count} markers: {:.2} ms", ms[50]);
    }
}

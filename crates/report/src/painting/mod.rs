//! The light-painting: what a long exposure of the wall would show, beside the picture.
//!
//! A dark room, a plastered wall, a lamp on the sheet with the picture, and the laser's spot with the shutter open:
//! every lit tick leaves its energy where the true spot was, so a slow spot burns brighter and a wrong one is seen.

mod captions;
mod film;
mod layout;
mod lettering;
mod light;
mod plane;
mod sheet;
mod wall;

use tracelight_chart::LIGHT_LINEAR;
use tracelight_maths::single;
use tracelight_picture::Raster;
use tracelight_stroke::Vec2;

use self::film::Film;
use self::layout::{Layout, WIDTH};
use self::light::Exposure;
use self::plane::Plane;
use self::sheet::Sheet;
use self::wall::Wall;
use crate::finished::Finished;

/// What is left of the day in the room, and its colour.
const ROOM: [f32; 3] = [0.050, 0.057, 0.068];
/// The lamp on the sheet, where it shines brightest.
const LAMP: [f32; 3] = [0.78, 0.62, 0.45];
/// Share of light that dark plaster sends back.
const PLASTER: f32 = 0.34;
const CHALK: [f32; 3] = [0.34, 0.33, 0.31];

/// Paints a job.
#[must_use]
pub fn paint(job: &Finished<'_>) -> Raster {
    let layout = Layout::new(job);
    let scene = Scene {
        light: Exposure::new(job, &layout),
        wall: Wall::new(WIDTH as usize, layout.height as usize),
        sheet: Sheet::new(job, &layout),
        chalk: captions::captions(job, &layout),
        film: Film::new(),
        layout,
    };
    Raster::from_rows(WIDTH, scene.layout.height, |y, row| {
        for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
            pixel.copy_from_slice(&scene.film.develop(scene.seen(x, y as usize)));
        }
    })
}

/// All that reflects or shines.
struct Scene {
    layout: Layout,
    light: Exposure,
    wall: Wall,
    sheet: Sheet,
    chalk: Plane,
    film: Film,
}

impl Scene {
    /// Linear light of a pixel.
    fn seen(&self, x: usize, y: usize) -> [f32; 3] {
        let light = self.light.at(x, y);
        let texture = self.wall.at(x, y);
        let cover = self.sheet.at(x, y);
        let (lamp, room) = (self.lamp(x, y), self.vignette(x, y));
        let (share, unshadowed) = cover.as_ref().map_or((0.0, 1.0), |c| (c.share, c.unshadowed));
        let chalk = self.chalk.row(y)[x] * (0.72 + 0.28 * texture) * (1.0 - share);
        std::array::from_fn(|c| {
            let falls = LAMP[c] * lamp * unshadowed + ROOM[c] * room + LIGHT_LINEAR[c] * light.wall;
            let wall = PLASTER * texture * falls;
            let on_sheet = LAMP[c] * lamp + ROOM[c] * room + LIGHT_LINEAR[c] * light.wall;
            let sheet = cover.as_ref().map_or(0.0, |cover| cover.albedo[c] * on_sheet);
            let written = CHALK[c] * (0.3 + 0.7 * room) * chalk;
            let matter = wall * (1.0 - share) + sheet * share;
            matter * (1.0 - chalk) + written + LIGHT_LINEAR[c] * light.lens
        })
    }

    /// Light of the lamp: a pool about the sheet.
    fn lamp(&self, x: usize, y: usize) -> f32 {
        let longest = self.layout.sheet_size.x.max(self.layout.sheet_size.y);
        let middle = self.layout.sheet_middle - Vec2::new(0.05, 0.1) * longest;
        let (dx, dy) = self.away(x, y, middle.x, middle.y);
        // a small sheet still hangs in a pool of light
        let reach = (longest * 0.66).max(110.0) as f32;
        let square = (dx * dx + dy * dy) / (reach * reach);
        1.0 / (1.0 + square * (0.55 + square * 0.9))
    }

    /// Light of the room, less towards the corners.
    fn vignette(&self, x: usize, y: usize) -> f32 {
        let (w, h) = (f64::from(WIDTH) / 2.0, f64::from(self.layout.height) / 2.0);
        let (dx, dy) = self.away(x, y, w * 1.15, h * 0.95);
        let square = single::powi(dx / w as f32, 2) * 0.55 + single::powi(dy / h as f32, 2) * 0.45;
        1.15 / (1.0 + 1.3 * square * square + 0.5 * square)
    }

    fn away(&self, x: usize, y: usize, cx: f64, cy: f64) -> (f32, f32) {
        (x as f32 + 0.5 - cx as f32, y as f32 + 0.5 - cy as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use tracelight_sim::{LightFrom, Origin};

    fn red_at(painting: &Raster, job: &Finished<'_>, number: usize) -> [u8; 3] {
        let layout = Layout::new(job);
        let tick = job.run.ticks.iter().filter(|t| t.light).nth(number).unwrap();
        let p = layout.pixel_from_target * tick.spot.unwrap();
        painting.pixel(p.x as i64, p.y as i64)
    }

    #[test]
    fn the_trace_glows_red_to_white_on_a_dark_wall() {
        let fixture = fixture::star();
        let job = fixture.job();
        let painting = paint(&job);
        for number in [100, 1500, 3000] {
            let [r, g, b] = red_at(&painting, &job, number);
            assert!(r == 255 && g < r && b < r, "{r} {g} {b}");
        }
        let corner = painting.pixel(1590, 10);
        assert!(corner.iter().all(|&v| v < 60), "{corner:?}");
    }

    #[test]
    fn the_same_job_paints_the_same_bytes() {
        let fixture = fixture::star();
        assert_eq!(paint(&fixture.job()), paint(&fixture.job()));
    }

    #[test]
    fn who_tells_where_the_spot_was_stands_above_the_trace_and_nothing_else_changes() {
        let fixture = fixture::star();
        let simulated = paint(&fixture.job());
        let mut job = fixture.job();
        job.origin = Origin { simulated: false, light_from: LightFrom::Encoders };
        let (real, layout) = (paint(&job), Layout::new(&job));
        let mut written = 0;
        for y in 0..i64::from(real.height()) {
            for x in 0..i64::from(WIDTH) {
                if simulated.pixel(x, y) == real.pixel(x, y) {
                    continue;
                }
                written += 1;
                let above = layout.wall.0.y - y as f64;
                assert!((20.0..60.0).contains(&above) && x as f64 > layout.wall.0.x - 2.0, "{x}, {y}");
            }
        }
        assert!(written > 200, "{written} pixels");
    }

    #[test]
    fn odd_jobs_are_painted_too() {
        let empty = fixture::nothing();
        assert_eq!(paint(&empty.job()).width(), WIDTH);
        let mut wild = fixture::star();
        wild.raster = Raster::new(3000, 2, vec![128; 18_000]);
        wild.run.ticks[50].spot = Some(tracelight_stroke::Point::new(f64::NAN, 1e300));
        wild.run.ticks[51].spot = Some(tracelight_stroke::Point::new(-1e12, 4.0));
        assert_eq!(paint(&wild.job()).width(), WIDTH);
    }
}

use std::fmt::Write;

use tracelight_aim::{Board, Camera, CameraPose, Lens};
use tracelight_markers::tag_cells;
use tracelight_maths::planar;
use tracelight_plant::{CameraConfig, Image, Lamp, Laser, Poster, SimulatedCamera, Wall};
use tracelight_stroke::{Affine, Point, Vec2};

/// Draws from a seed.
pub(crate) struct Dice(oorandom::Rand64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(oorandom::Rand64::new(u128::from(seed)))
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.rand_float()
    }
}

/// Pixels of a printed page, m: a quarter of a millimetre.
const PRINT_M: f64 = 0.25e-3;

/// Exposure, as a share of the one at which a white wall in full light is full.
const EXPOSURE: f64 = 0.9;

/// A marker as it is.
pub(crate) struct Known {
    pub(crate) id: u16,
    /// Its corners, px.
    pub(crate) corners: [Point; 4],
    /// Whether a lamp's reflection leaves cells of it that nobody can tell apart.
    pub(crate) drowned: bool,
}

/// A wall with pages on it and a camera in front.
pub(crate) struct Scene {
    pub(crate) camera: Camera,
    config: CameraConfig,
    wall: Wall,
    board: Board,
    /// Where the pages' middles are, m, and how they are turned.
    pages: Vec<Affine>,
}

impl Scene {
    /// Four pages at the corners of a field of 26 × 14 in, seen from 50 in by a webcam that is turned by up to 30°.
    pub(crate) fn with_pages(dice: &mut Dice, board: &Board) -> Self {
        let (pan, tilt) = (dice.between(-0.52, 0.52), dice.between(-0.15, 0.15));
        let at = [1.27 * pan.sin() * tilt.cos(), 1.27 * tilt.sin(), 1.27 * pan.cos() * tilt.cos()];
        let pose = CameraPose::looking_at(at, [dice.between(-0.01, 0.01), dice.between(-0.01, 0.01), 0.0])
            .expect("a pose");
        let lens = Lens {
            centre_px: Point::new(640.0 + dice.between(-15.0, 15.0), 360.0 + dice.between(-10.0, 10.0)),
            radial: [-0.1, 0.0, 0.0],
            ..Lens::ideal(1280, 720, 1000.0)
        };
        let camera = Camera { lens, pose: pose.moved([0.0, 0.0, dice.between(-0.1, 0.1)], [0.0; 3]) };
        let corners = [(-0.40, 0.16), (0.40, 0.16), (0.40, -0.16), (-0.40, -0.16)];
        let pages: Vec<Affine> = corners
            .iter()
            .map(|&(x, y)| {
                let middle = Vec2::new(x + dice.between(-0.03, 0.03), y + dice.between(-0.02, 0.02));
                planar::rotation(1.57 + dice.between(-0.1, 0.1)).then_translate(middle)
            })
            .collect();
        let posters = pages.iter().enumerate().map(|(page, place)| poster(board, page as u16, *place));
        let wall = Wall { plain: [0.55, 0.53, 0.5], posters: posters.collect() };
        let lamp = Lamp {
            at: Point::new(dice.between(200.0, 1080.0), dice.between(100.0, 620.0)),
            size_px: 25.0,
            brightness: 1.5,
        };
        let light = if dice.between(0.0, 1.0) < 0.5 { [1.0, 0.45] } else { [0.45, 1.0] };
        let config = CameraConfig { lamp: Some(lamp), light, ..CameraConfig::webcam() };
        Self { camera, config, wall, board: *board, pages }
    }

    pub(crate) fn image(&self, seed: u64) -> Image {
        let mut camera = SimulatedCamera::new(&self.config, &self.camera, &self.wall, seed);
        camera.expose(0.0, EXPOSURE * self.config.sensor.reference_s, &[])
    }

    /// The camera, with a laser of that speckle.
    pub(crate) fn eye(&self, seed: u64, speckle: f64) -> SimulatedCamera {
        let laser = Laser { speckle, ..self.config.laser };
        SimulatedCamera::new(&CameraConfig { laser, ..self.config }, &self.camera, &self.wall, seed)
    }

    /// Whether a lamp's reflection fills pixels there, whatever else is.
    pub(crate) fn is_under_lamp(&self, at: Point) -> bool {
        self.config.lamp.is_some_and(|lamp| at.distance(lamp.at) < 3.0 * lamp.size_px)
    }

    /// The wall from the first page's frame.
    pub(crate) fn wall_from_page(&self) -> Affine {
        self.pages[0]
    }

    /// Every marker that is all in sight.
    pub(crate) fn corners(&self) -> Vec<Known> {
        let mut all = Vec::new();
        for (page, place) in self.pages.iter().enumerate() {
            for number in 0..self.board.tags() {
                let seen = self.board.corners(number).map(|p| self.camera.pixel(*place * p));
                let inside = |p: &Option<Point>| {
                    p.is_some_and(|p| (8.0..1272.0).contains(&p.x) && (8.0..712.0).contains(&p.y))
                };
                if seen.iter().all(inside) {
                    let corners = seen.map(Option::unwrap_or_default);
                    let drowned = self.is_drowned(corners);
                    all.push(Known { id: self.board.id(page as u16, number), corners, drowned });
                }
            }
        }
        all
    }

    /// Whether black is full somewhere on a marker, and white therefore no brighter.
    fn is_drowned(&self, [a, b, c, d]: [Point; 4]) -> bool {
        let Some(lamp) = self.config.lamp else { return false };
        let place = |k: usize| (k % 9) as f64 / 8.0;
        (0..81).any(|k| {
            let at = a.lerp(b, place(k)).lerp(d.lerp(c, place(k)), place(k / 9));
            let off = at.distance(lamp.at) / lamp.size_px;
            EXPOSURE * lamp.brightness * (-0.5 * off * off).exp() >= 1.0
        })
    }

    /// What another program needs to know: marker, corner, where on the wall, where in the image.
    pub(crate) fn truth(&self) -> String {
        let mut text = "id,corner,x_m,y_m,u_px,v_px\n".to_owned();
        for Known { id, corners, .. } in self.corners().into_iter().filter(|known| !known.drowned) {
            let (page, number) = self.board.find(id).expect("one of them");
            for (k, (px, at)) in corners.iter().zip(self.board.corners(number)).enumerate() {
                let at = self.pages[usize::from(page)] * at;
                writeln!(text, "{id},{k},{},{},{},{}", at.x, at.y, px.x, px.y).expect("a string");
            }
        }
        text
    }
}

/// A page of A4 as it is printed.
fn poster(board: &Board, page: u16, place: Affine) -> Poster {
    let (width, height) = (840, 1188);
    let mut pixels = vec![[240u8; 3]; width * height];
    for number in 0..board.tags() {
        let cells = tag_cells(board.id(page, number)).expect("an id");
        let corner = board.corners(number)[0];
        let (left, top) = (width as f64 / 2.0 + corner.x / PRINT_M, height as f64 / 2.0 - corner.y / PRINT_M);
        let cell = board.tag_m / 8.0 / PRINT_M;
        for y in 0..(8.0 * cell).round() as usize {
            for x in 0..(8.0 * cell).round() as usize {
                let (row, column) = ((y as f64 / cell) as usize, (x as f64 / cell) as usize);
                if cells[row][column] {
                    pixels[(top.round() as usize + y) * width + left.round() as usize + x] = [30; 3];
                }
            }
        }
    }
    let page_from_pixel = Affine::scale_non_uniform(PRINT_M, -PRINT_M)
        .then_translate(Vec2::new(-PRINT_M * width as f64 / 2.0, PRINT_M * height as f64 / 2.0));
    Poster::new(width, &pixels, place * page_from_pixel).expect("a page")
}

pub(crate) fn save(path: &str, image: &Image) {
    let file = std::fs::File::create(path).expect("creates");
    let mut encoder =
        png::Encoder::new(std::io::BufWriter::new(file), image.width as u32, image.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().and_then(|mut w| w.write_image_data(&image.rgb)).expect("writes");
}

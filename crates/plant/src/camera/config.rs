use tracelight_stroke::Point;

/// What a camera's sensor and its electronics are like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Electrons at which a pixel is full.
    pub full_well: f64,
    /// Noise of reading, electrons.
    pub read_noise: f64,
    /// Exposure at which a white wall in full light fills a pixel, s.
    pub reference_s: f64,
    /// From the first row's start to the last one's, s: a rolling shutter. Zero is a global one.
    pub readout_s: f64,
    /// Exponent of the curve from light to levels, as 1/2.2 of usual ones. One is a straight line.
    pub gamma: f64,
    /// Whether each pixel sees one colour only (red and green in even rows, green and blue in odd ones).
    pub bayer: bool,
}

/// What a lamp's or a window's reflection adds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Where in the image, px.
    pub at: Point,
    /// Standard deviation of its round patch, px.
    pub size_px: f64,
    /// Brightness in its middle: one is a white wall in full light.
    pub brightness: f64,
}

/// The laser's spot on the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laser {
    /// Standard deviation of the beam across, m.
    pub radius_m: f64,
    /// Light of the spot in its middle, red, green and blue: one is a white wall in full light.
    pub brightness: [f64; 3],
    /// Contrast of its speckle as the lens has it: deviation over mean.
    pub speckle: f64,
}

/// A camera as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraConfig {
    /// Standard deviation of the blur, px.
    pub blur_px: f64,
    /// Light that is lost in the corners, as a share.
    pub vignetting: f64,
    /// Light at the image's left and right ends, as a share of the fullest: shadow from one side.
    pub light: [f64; 2],
    /// A lamp's reflection.
    pub lamp: Option<Lamp>,
    /// The laser.
    pub laser: Laser,
    /// Sensor and electronics.
    pub sensor: Sensor,
    /// From an image to the next, s.
    pub period_s: f64,
    /// Least and most that an image takes from the end of its reading to the host, s.
    pub delay_s: [f64; 2],
}

impl CameraConfig {
    /// A webcam of usual make: rolling shutter, one colour a pixel, a little out of focus.
    pub fn webcam() -> Self {
        Self {
            blur_px: 0.8,
            vignetting: 0.3,
            light: [1.0, 0.5],
            lamp: None,
            // 5 mW on 4 mm are ten times as bright as an indoor wall
            laser: Laser { radius_m: 1e-3, brightness: [12.0, 1.0, 0.4], speckle: 0.2 },
            sensor: Sensor {
                full_well: 8000.0,
                read_noise: 6.0,
                reference_s: 0.02,
                readout_s: 0.025,
                gamma: 1.0 / 2.2,
                bayer: true,
            },
            period_s: 1.0 / 30.0,
            delay_s: [0.03, 0.13],
        }
    }

    /// The report's camera: a USB one of 2006, with few pixels, large and noisy.
    pub fn report() -> Self {
        let webcam = Self::webcam();
        let sensor = Sensor { full_well: 20_000.0, read_noise: 30.0, ..webcam.sensor };
        Self { blur_px: 0.6, light: [1.0, 0.7], sensor, ..webcam }
    }
}

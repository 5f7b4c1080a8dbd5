use super::{MILLI, Places, command, own, text};
use crate::chapter::{Chapter, Part, Run};
use crate::given;

impl Places<'_> {
    pub(super) fn images(&self) -> Chapter {
        let [upright, level, star] =
            ["ruler-upright.png", "ruler-level.png", "star.png"].map(|name| self.path("pictures", name));
        let ruler = command(
            "Figures 22 and 23: a ruler with two tapes 4 in apart, upright and level",
            &["calibrate", "ruler", &upright, &level, "--marks", "4in", "--wish", "3ft,3ft"],
        )
        .scaled(
            "scale, level",
            12.0,
            "/across_px_per_in",
            (1.0, "px/in"),
            "48 px for 4 in; ours is told between pixels",
        )
        .scaled("scale, upright", 12.0, "/upwards_px_per_in", (1.0, "px/in"), "")
        .scaled(
            "field's width",
            28.0,
            "/field_m/0",
            (1.0 / 0.0254, "in"),
            "the report's 2'4\" is a slip: 320 px / 12 px/in = 26.67 in",
        )
        .scaled(
            "field's height",
            20.0,
            "/field_m/1",
            (1.0 / 0.0254, "in"),
            "240 px / 12 px/in: 1'8\" is right",
        )
        .scaled(
            "distance from which 3 ft × 3 ft is seen",
            None,
            "/wish_distance_m",
            (1.0 / 0.3048, "ft"),
            "the proposal's target, which this camera sees whole only from there",
        );
        let ring = self.path("pictures", "ring.png");
        let strokes = |caption: &str, picture: &str, more: &[&str], name: &str| {
            Part::Run(command(caption, &[&["strokes", picture], more].concat()).drawn(self, name))
        };
        let sweep = ["--mode", "sweep"];
        Chapter {
            title: "2.7 Image processing",
            parts: vec![
                text(
                    "Grey, histogram, threshold, the first white pixel, then from point to point at a radius of 5 px, sweeping clockwise from the last direction: \
                     the report's tracer, which stands here as --mode sweep, follows one closed figure without breaks or crossings. Where a figure turns the other \
                     way, a sweep that is clockwise finds the line it came on before the one that goes on, and turns back: it is for figures that bend one way. \
                     Ours finds lines, shapes, corners and crossings between pixels.",
                ),
                Part::Run(ruler),
                text(
                    "A histogram says whether a picture has enough contrast, else another is taken; a threshold takes away what is not ink. Here the threshold is where ink \
                     and paper lie furthest apart (Otsu), once uneven light is taken out, and a picture that is refused is refused with the figure that failed and its bound.",
                ),
                Part::Run(self.stages(&ring)),
                strokes(
                    "Figures 26 and 27: the first pixel, then from point to point, on the same circle",
                    &ring,
                    &sweep,
                    "swept-ring.svg",
                ),
                strokes("The same circle, as it is traced here", &ring, &[], "traced-ring.svg"),
                Part::Drawing("A figure with corners both ways".into(), given::star_shown()),
                strokes("The report's tracer on it", &star, &sweep, "swept-star.svg"),
                strokes("As it is traced here", &star, &[], "traced-star.svg"),
            ],
        }
    }

    /// A picture becomes ink.
    fn stages(&self, picture: &str) -> Run {
        let mut stages = command(
            "Figures 24 to 27, the first steps they wire up: grey, histogram and threshold, ink, on a circle of 320 × 240 px",
            &["strokes", picture],
        );
        let shown = self.path("figures", "stages.svg");
        stages.arguments.extend(["--stages".to_owned(), shown.clone()]);
        stages.figure = Some(shown.into());
        stages
    }

    pub(super) fn laser(&self) -> Chapter {
        let preset = tracelight_sim::RigConfig::report().model;
        Chapter {
            title: "2.8 Laser control",
            parts: vec![
                text(
                    "A 650 nm pointer of 4.5 V and about 50 mA, switched by a relay with a 5 V coil from a supply of 5 V and 0.2 A. The digital output gives at most \
                      2 mA, and no such coil needs so little: a driver transistor must stand between them. The relay closes 5 ms and opens 3 ms after its gate here, \
                      and each lit stroke is run up to and out of, so that the light is where it should be when it comes.",
                ),
                Part::Facts(
                    "Encoder",
                    vec![
                        own(
                            "count of the encoder",
                            None,
                            MILLI * preset.encoder.count_rad(),
                            "mrad",
                            "2π/4096",
                        ),
                        own(
                            "the same on the target at 3 ft",
                            None,
                            MILLI * 0.9144 * preset.encoder.count_rad(),
                            "mm",
                            "the light is held to a thirtieth of it",
                        ),
                    ],
                ),
            ],
        }
    }
}

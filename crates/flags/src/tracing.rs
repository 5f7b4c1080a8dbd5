//! How pixels become strokes: the flags of every command that takes a picture.

use std::ops::RangeInclusive;

use clap::{Args, ValueEnum};
use tracelight_pipeline::{LeastLength, Paper, Straighten, Tracing, clockwise};
use tracelight_stroke::Point;
use tracelight_units as units;
use tracelight_units::{Angle, LENGTHS, PIXELS};
use tracelight_vision::{Mode, Options};

/// How pixels become strokes. Without a flag, what the picture itself says.
#[derive(Args, Clone, Debug)]
pub struct TracingArgs {
    /// How pixels become strokes
    #[arg(long, value_enum, default_value_t)]
    pub mode: ModeName,
    /// Smallest contrast of ink, as a percentage of the paper's brightness, such as 30. On dark paper: as a percentage of the difference
    /// between paper and white
    #[arg(long, value_name = "auto|PERCENT", default_value = "auto", allow_hyphen_values = true, value_parser = threshold)]
    pub threshold: OrAuto,
    /// Smallest patch of ink that is kept, in square pixels, such as 20. With 0 everything is kept; repeated pencil lines are not merged
    #[arg(long, value_name = "auto|AREA", default_value = "auto", allow_hyphen_values = true, value_parser = despeckle)]
    pub despeckle: OrAuto,
    /// Drop strokes shorter than this, in the picture (8px) or on the target (5mm, 0.2in)
    #[arg(long, value_name = "LENGTH", default_value = "0px", allow_hyphen_values = true, value_parser = least_length)]
    pub min_length: LeastLength,
    /// Furthest a stroke may be from the ink's middle or edge
    #[arg(long, value_name = "LENGTH", default_value = "0.35px", allow_hyphen_values = true, value_parser = tolerance)]
    pub tolerance: Pixels,
    /// Corner angle: bends of at least this angle stay sharp corners
    #[arg(long, value_name = "ANGLE", default_value = "25deg", allow_hyphen_values = true, value_parser = corner_angle)]
    pub corner_angle: Angle,
    /// Do not trace the edges of sheets of paper in the picture, as in a photograph of a wall or a table
    #[arg(long)]
    pub sheets: bool,
    /// Trace the whole picture, also outside a detected sheet of paper
    #[arg(long)]
    pub whole: bool,
    /// Correct the perspective of a sheet photographed at an angle: auto finds its corners; off leaves the picture as it is; or four
    /// corners in pixels from the picture's upper left, such as "52,19 583,6 599,368 100,447"
    #[arg(long, value_name = "auto|off|X,Y …", default_value = "auto", allow_hyphen_values = true, value_parser = straighten)]
    pub straighten: Straighten,
    /// Size of the sheet; the drawing keeps its true size on it unless --width or --height is given
    #[arg(long, value_enum, value_name = "SIZE")]
    pub paper: Option<PaperName>,
    /// Trace also a photograph or a screenshot that looks like no drawing
    #[arg(long)]
    pub force: bool,
}

/// How pixels become strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ModeName {
    /// Each part by its width: pen lines as centrelines, shapes as outlines
    #[default]
    Auto,
    /// The middle of every line
    Centreline,
    /// The edge of all ink
    Outline,
    /// The 2006 report's radial sweep round one closed figure, for comparison
    Sweep,
}

impl From<ModeName> for Mode {
    fn from(name: ModeName) -> Self {
        match name {
            ModeName::Auto => Mode::Auto,
            ModeName::Centreline => Mode::Centreline,
            ModeName::Outline => Mode::Outline,
            ModeName::Sweep => Mode::Sweep,
        }
    }
}

/// Sizes of paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PaperName {
    /// 148 × 210 mm
    A5,
    /// 210 × 297 mm
    A4,
    /// 297 × 420 mm
    A3,
    /// 8.5 × 11 in
    Letter,
    /// 8.5 × 14 in
    Legal,
}

impl PaperName {
    const fn paper(self) -> Paper {
        match self {
            Self::A5 => Paper::A5,
            Self::A4 => Paper::A4,
            Self::A3 => Paper::A3,
            Self::Letter => Paper::LETTER,
            Self::Legal => Paper::LEGAL,
        }
    }
}

/// A number, or what the picture itself says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OrAuto(pub Option<f64>);

/// Pixels of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixels(pub f64);

impl TracingArgs {
    /// What they mean.
    pub fn tracing(&self) -> Tracing {
        Tracing {
            mode: self.mode.into(),
            tolerance_px: self.tolerance.0,
            corner_rad: self.corner_angle.0,
            threshold_percent: self.threshold.0,
            despeckle_px2: self.despeckle.0,
            min_length: self.min_length,
            sheets: self.sheets,
            whole: self.whole,
            straighten: self.straighten,
            paper: self.paper.map(PaperName::paper),
            force: self.force,
        }
    }

    /// What was set by hand, flag and value.
    pub fn settings(&self) -> Vec<(&'static str, String)> {
        let least = match self.min_length {
            LeastLength::Pixels(px) => format!("{px} px"),
            LeastLength::Metres(m) => format!("{:.1} mm", m * 1e3),
        };
        let or_auto = |set: OrAuto, unit| set.0.map_or_else(|| "auto".to_owned(), |v| format!("{v} {unit}"));
        vec![
            ("mode", format!("{:?}", self.mode).to_lowercase()),
            ("threshold", or_auto(self.threshold, "%")),
            ("despeckle", or_auto(self.despeckle, "px²")),
            ("shortest stroke", least),
            ("tolerance of the tracing", format!("{} px", self.tolerance.0)),
            ("corners from", format!("{:.1}°", self.corner_angle.0.to_degrees())),
            ("what is looked at", if self.whole { "all of the picture" } else { "its sheet" }.to_owned()),
            ("edges of paper", if self.sheets { "left out" } else { "traced" }.to_owned()),
        ]
    }
}

fn straighten(text: &str) -> Result<Straighten, String> {
    match text.trim() {
        word if word.eq_ignore_ascii_case("auto") => return Ok(Straighten::Auto),
        word if word.eq_ignore_ascii_case("off") => return Ok(Straighten::Off),
        _ => {}
    }
    let parts =
        text.split(|c: char| c == ',' || c == ';' || c.is_whitespace()).filter(|part| !part.is_empty());
    let numbers: Vec<f64> = parts
        .map(|part| part.parse().ok().filter(|v: &f64| v.is_finite()).ok_or(part))
        .collect::<Result<_, _>>()
        .map_err(|part| format!("{part} is no number of pixels; give auto, off, or \"X,Y X,Y X,Y X,Y\""))?;
    let [a, b, c, d, e, f, g, h] = numbers[..] else {
        return Err(format!(
            "{} numbers are not four corners; give \"X,Y X,Y X,Y X,Y\", in pixels",
            numbers.len()
        ));
    };
    Ok(Straighten::By(clockwise([(a, b), (c, d), (e, f), (g, h)].map(Point::from))))
}

fn threshold(text: &str) -> Result<OrAuto, String> {
    or_auto(text, "%", Options::THRESHOLD_PERCENT, "% of the paper's brightness")
}

fn despeckle(text: &str) -> Result<OrAuto, String> {
    let squared = ["px2", "px²"].into_iter().find_map(|unit| text.strip_suffix(unit));
    or_auto(squared.unwrap_or(text), "px", Options::DESPECKLE_PX2, "px²")
}

/// `auto`, or a number with or without its unit.
fn or_auto(text: &str, unit: &str, (least, most): (f64, f64), unit_name: &str) -> Result<OrAuto, String> {
    let number = text.trim();
    if number.eq_ignore_ascii_case("auto") {
        return Ok(OrAuto(None));
    }
    let number = number.strip_suffix(unit).unwrap_or(number).trim_end();
    let value: f64 =
        number.parse().map_err(|_| format!("{text} is neither auto nor a number ({unit_name})"))?;
    within(text, value, least..=most, unit_name).map(|value| OrAuto(Some(value)))
}

fn within(text: &str, value: f64, bounds: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    match bounds.contains(&value) {
        true => Ok(value),
        false => Err(format!("{text} is not between {} and {} {unit}", bounds.start(), bounds.end())),
    }
}

fn tolerance(text: &str) -> Result<Pixels, String> {
    let value = units::parse(text, PIXELS).map_err(|e| e.to_string())?;
    let (least, most) = Options::TOLERANCE_PX;
    within(text, value, least..=most, "px").map(Pixels)
}

fn corner_angle(text: &str) -> Result<Angle, String> {
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    let (least, most) = Options::CORNER_RAD;
    // a bound as it is typed is within it, whatever the last digit of its radians
    match (least - 1e-9..=most + 1e-9).contains(&angle.0) {
        true => Ok(Angle(angle.0.clamp(least, most))),
        false => {
            Err(format!("{text} is not between {:.0} and {:.0} deg", least.to_degrees(), most.to_degrees()))
        }
    }
}

fn least_length(text: &str) -> Result<LeastLength, String> {
    const MOST_M: f64 = 1e3;
    if text.trim_end().ends_with("px") {
        let value = units::parse(text, PIXELS).map_err(|e| e.to_string())?;
        let (least, most) = Options::MIN_LENGTH_PX;
        return within(text, value, least..=most, "px").map(LeastLength::Pixels);
    }
    let value =
        units::parse(text, LENGTHS).map_err(|e| format!("{e}; or pixels of the picture, such as 8px"))?;
    within(text, value, 0.0..=MOST_M, "m").map(LeastLength::Metres)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_take_their_units_and_name_their_bounds() {
        assert_eq!(threshold("auto"), Ok(OrAuto(None)));
        assert_eq!(threshold("30 %"), Ok(OrAuto(Some(30.0))));
        assert_eq!(despeckle("0"), Ok(OrAuto(Some(0.0))));
        for text in ["25", "25px", "25px2", "25 px²"] {
            assert_eq!(despeckle(text), Ok(OrAuto(Some(25.0))), "{text}");
        }
        assert_eq!(despeckle("12"), Ok(OrAuto(Some(12.0))));
        assert_eq!(least_length("8px"), Ok(LeastLength::Pixels(8.0)));
        assert_eq!(least_length("5mm"), Ok(LeastLength::Metres(5e-3)));
        assert_eq!(tolerance("0.5px"), Ok(Pixels(0.5)));
        assert!(threshold("100").unwrap_err().contains("100 is not between 0.4 and 99.6 %"));
        assert!(despeckle("-1").unwrap_err().contains("px²"));
        assert!(tolerance("0.35").unwrap_err().contains("no unit"));
        assert!(tolerance("11px").unwrap_err().contains("between 0.05 and 10 px"));
        assert!(least_length("5").unwrap_err().contains("8px"));
        assert!(least_length("nanpx").is_err() && threshold("nan").is_err() && despeckle("inf").is_err());
        let corners = [(10.0, 20.0), (600.0, 30.0), (590.0, 420.0), (15.0, 400.0)].map(Point::from);
        assert_eq!(straighten("590,420 10,20 15,400 600,30"), Ok(Straighten::By(corners)));
        assert_eq!(straighten("OFF"), Ok(Straighten::Off));
        assert!(straighten("1,2 3,4").unwrap_err().contains("4 numbers are not four corners"));
        assert!(straighten("1,2 3,4 5,x 7,8").unwrap_err().contains("x is no number"));
        for (angle, ok) in
            [("5deg", true), ("90deg", true), ("4.9deg", false), ("91deg", false), ("30", false)]
        {
            assert_eq!(corner_angle(angle).is_ok(), ok, "{angle}");
        }
    }

    #[test]
    fn what_nobody_sets_is_what_the_tracer_takes_by_itself() {
        use clap::Parser;
        #[derive(Parser)]
        struct Line {
            #[command(flatten)]
            tracing: TracingArgs,
        }
        assert_eq!(Line::parse_from(["line"]).tracing.tracing(), Tracing::default());
        assert_eq!(Tracing::default().options(1.0), Options::default());
    }
}

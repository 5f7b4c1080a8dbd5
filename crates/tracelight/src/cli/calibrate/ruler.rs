use clap::Args;
use tracelight_picture::Source;
use tracelight_task::Failure;
use tracelight_units::{Length, Offset};

use crate::cli::answer::{Answer, Voice};
use crate::named;
use tracelight_flags::positive_length;

/// Scale of a camera, from two pictures of a ruler with two marks: one upright, one level
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight calibrate ruler examples/ruler-upright.png examples/ruler-level.png --marks 4in \
                  --wish 3ft,3ft"
)]
pub(super) struct RulerArgs {
    /// Picture of the upright ruler
    upright: String,
    /// Picture of the level ruler
    level: String,
    /// Distance between the two marks
    #[arg(long, value_name = "LENGTH", default_value = "4in", allow_hyphen_values = true, value_parser = positive_length)]
    marks: Length,
    /// Distance from the camera to the target
    #[arg(long, value_name = "LENGTH", default_value = "3ft", allow_hyphen_values = true, value_parser = positive_length)]
    distance: Length,
    /// Width and height of an area that the camera should see, such as 3ft,3ft: prints the distance this needs
    #[arg(long, value_name = "WIDTH,HEIGHT", allow_hyphen_values = true, value_parser = field)]
    wish: Option<Offset>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// What two ruler pictures say.
struct Scale {
    /// Pixels per metre across, from the level ruler.
    across_px_m: f64,
    /// Pixels per metre upwards, from the upright ruler.
    upwards_px_m: f64,
    /// What the camera sees at this distance, m.
    field_m: (f64, f64),
    /// Distance from which the wished field is seen whole, m.
    wish_distance_m: Option<f64>,
}

pub(super) fn run(args: &RulerArgs) -> Result<Answer, Failure> {
    let scale = measure(args)?;
    Ok(Answer::new(text(args, &scale), json(args, &scale)))
}

fn measure(args: &RulerArgs) -> Result<Scale, Failure> {
    let (upright_px, _) = marks_px(&args.upright)?;
    let (level_px, size) = marks_px(&args.level)?;
    let (across_px_m, upwards_px_m) = (level_px / args.marks.0, upright_px / args.marks.0);
    let field_m = (size.0 / across_px_m, size.1 / upwards_px_m);
    // a square-on camera's field grows with its distance
    let wish_distance_m =
        args.wish.map(|Offset(w, h)| args.distance.0 * (w.0 / field_m.0).max(h.0 / field_m.1));
    Ok(Scale { across_px_m, upwards_px_m, field_m, wish_distance_m })
}

fn field(text: &str) -> Result<Offset, String> {
    let (width, height) = text.split_once(',').unwrap_or((text, ""));
    Ok(Offset(positive_length(width)?, positive_length(height)?))
}

/// Distance of the two marks, and the picture's size, px.
fn marks_px(path: &str) -> Result<(f64, (f64, f64)), Failure> {
    let Source::Pixels(pixels) = named::picture(path)? else {
        return Err(Failure::usage(
            "not-a-picture",
            format!("{path} is a drawing; give a picture of a ruler"),
        ));
    };
    let marks = tracelight_vision::find_two_marks(&pixels.grey)
        .map_err(|e| Failure::failed("marks-not-found", format!("{path}: {e}")))?;
    let size = (f64::from(pixels.colour.width()), f64::from(pixels.colour.height()));
    Ok((marks.a.distance(marks.b), size))
}

/// Pixels per metre to pixels per inch.
const INCH_M: f64 = 0.0254;
const FOOT_M: f64 = 0.3048;

fn text(args: &RulerArgs, scale: &Scale) -> String {
    let inches = |m: f64| m / INCH_M;
    let mut text = format!(
        "scale:  {:.3} px/in across, {:.3} px/in upwards\nfield:  {:.2} × {:.2} in at {:.3} ft",
        scale.across_px_m * INCH_M,
        scale.upwards_px_m * INCH_M,
        inches(scale.field_m.0),
        inches(scale.field_m.1),
        args.distance.0 / FOOT_M,
    );
    if let Some(distance) = scale.wish_distance_m {
        text += &format!("\nwish:   seen whole from {:.3} ft", distance / FOOT_M);
    }
    let skew = scale.across_px_m / scale.upwards_px_m - 1.0;
    if skew.abs() > 0.01 {
        text += &format!(
            "\nwarning: the two scales differ by {:.1} %: the camera is not square-on, or its pixels are not square",
            100.0 * skew
        );
    }
    text + "\nA ruler sees neither a turned camera nor a bent lens: square it up by hand, or let `tracelight calibrate markers` see both."
}

fn json(args: &RulerArgs, scale: &Scale) -> String {
    serde_json::json!({
        "across_px_per_in": scale.across_px_m * INCH_M,
        "upwards_px_per_in": scale.upwards_px_m * INCH_M,
        "field_m": [scale.field_m.0, scale.field_m.1],
        "distance_m": args.distance.0,
        "wish_distance_m": scale.wish_distance_m,
    })
    .to_string()
}

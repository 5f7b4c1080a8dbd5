use std::f64::consts::PI;
use std::fmt::Write;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Curve, Figure, Guide, Key, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::{Complex, DampedGains, Mode, RootLocus, Time, TransferFunction};
use tracelight_task::{Failure, Stop};

use super::bode::system_json;
use super::systems::{Named, SystemArgs, bounded, four, pairs, place, pole_lines};
use super::{OutFile, out_file, write_all};
use crate::cli::{Answer, Voice};

/// Where the poles of the closed loop go as the open loop's gain rises; which gain makes it as damped as asked
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab locus \"K11 G11\" --damping 0.7 -o locus.svg\n\n\
                  Crosses are the open loop's poles, rings its zeros, dots the closed loop's poles with the gain as it is, or with \
                  --gain, or with the one --damping finds.")]
pub(crate) struct LocusArgs {
    #[command(flatten)]
    pub(super) plane: PlaneArgs,
    /// Factor on the open loop whose closed poles are marked
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true, conflicts_with = "damping", value_parser = finite)]
    gain: Option<f64>,
    /// Find the largest factor that leaves every closed pole at least so damped, 0 to 1
    #[arg(long, value_name = "DAMPING", value_parser = damping)]
    damping: Option<f64>,
    /// How many gains at least
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    points: u32,
}

/// Poles and zeros in the complex plane, natural frequency and damping of each
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab pzmap \"K11 G11\" --closed -o poles.svg")]
pub(crate) struct PzmapArgs {
    #[command(flatten)]
    pub(super) plane: PlaneArgs,
}

/// Systems in the complex plane, and where that goes.
#[derive(Args, Debug)]
pub(super) struct PlaneArgs {
    #[command(flatten)]
    systems: SystemArgs,
    /// Show so far from zero, in 1/s (of samples: of z) [default: all poles and zeros, and the unit circle]
    #[arg(long, value_name = "REACH", value_parser = positive)]
    reach: Option<f64>,
    /// Plot into an SVG or PNG, or write a row a gain (the first system), or a pole or zero, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1e-9..=1e9).contains(&value) => Ok(value),
        _ => Err(format!("{text} is no number between 1e-9 and 1e9")),
    }
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("{text} is no factor")),
    }
}

fn damping(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1.0).contains(&value) => Ok(value),
        _ => Err(format!("{text} is no damping between 0 and 1")),
    }
}

/// A loop and where its poles go.
struct Entry {
    named: Named,
    locus: RootLocus,
    /// The gain whose poles are marked, and those.
    gain: f64,
    closed: Vec<Complex>,
}

pub(crate) fn run(args: &LocusArgs, stop: &Stop) -> Result<Answer, Failure> {
    let systems = args.plane.systems.systems()?;
    let order = |named: &Named| named.system.denominator().degree().max(named.system.numerator().degree());
    bounded(args.points, systems.iter().map(order).sum())?;
    let mut entries = Vec::new();
    for named in systems {
        stop.check()?;
        entries.push(entry(args, named)?);
    }
    write_all(&args.plane.out, || figure(args, &entries), || Ok(csv(&entries)))?;
    Ok(Answer::either(args.plane.voice, || text(args, &entries), || json(&entries)))
}

fn entry(args: &LocusArgs, named: Named) -> Result<Entry, Failure> {
    let gain = match (args.gain, args.damping) {
        (Some(gain), _) => gain,
        (None, Some(damping)) => damped_gain(&named, damping)?,
        (None, None) => 1.0,
    };
    let locus = named.system.root_locus(named.system.locus_gains(args.points as usize));
    let closed = named.system.closed_at(gain).root_values();
    Ok(Entry { named, locus, gain, closed })
}

fn damped_gain(named: &Named, damping: f64) -> Result<f64, Failure> {
    let name = &named.name;
    let message = match named.system.damped_gains(damping) {
        DampedGains::UpTo(gain) => return Ok(gain),
        DampedGains::None => {
            format!("{name}: no factor leaves every closed pole with a damping of {damping}")
        }
        DampedGains::Beyond(from) => format!(
            "{name}: every factor above {} leaves every closed pole with a damping of {damping}, so there is no largest; choose one \
             with --gain",
            four(from)
        ),
    };
    Err(Failure::failed("no-such-gain", message))
}

fn text(args: &LocusArgs, entries: &[Entry]) -> String {
    let mut text = String::new();
    for Entry { named, gain, closed, .. } in entries {
        let system = &named.system;
        // writing to a String cannot fail
        let _ = writeln!(text, "{} = {}", named.name, system.zpk());
        for apart in system.breakaways().iter().filter(|b| b.pole.im >= 0.0) {
            let _ = writeln!(
                text,
                "    branches meet at {} for a factor of {}",
                place(apart.pole),
                four(apart.gain)
            );
        }
        for (factor, rad_s) in system.oscillating_gains().iter().filter(|(_, w)| *w > 0.0) {
            let _ = writeln!(
                text,
                "    it oscillates with {} rad/s for a factor of {}",
                four(*rad_s),
                four(*factor)
            );
        }
        if let Some(far) = system.asymptotes() {
            let angles: Vec<String> =
                far.angles_rad.iter().map(|a| format!("{}°", four(a.to_degrees()))).collect();
            let _ = writeln!(
                text,
                "    {} branches go far away from {} at {}",
                angles.len(),
                four(far.centre),
                angles.join(", ")
            );
        }
        let why =
            args.damping.map_or(String::new(), |d| format!(", the largest that leaves a damping of {d},"));
        let _ = writeln!(text, "    with a factor of {}{why} the closed poles are", four(*gain));
        let _ = writeln!(text, "{}", pole_lines(closed, system.time()));
    }
    text.trim_end().to_owned()
}

fn json(entries: &[Entry]) -> String {
    let one = |entry: &Entry| {
        let system = &entry.named.system;
        let mut object = system_json(&entry.named.name, system);
        object["gain"] = entry.gain.into();
        object["closed_poles"] = pairs(&entry.closed).into_iter().map(|z| json!(z)).collect();
        object["breakaways"] = system
            .breakaways()
            .iter()
            .map(|b| json!({"pole": [b.pole.re, b.pole.im], "gain": b.gain}))
            .collect();
        object["oscillating"] =
            system.oscillating_gains().iter().map(|(gain, w)| json!({"gain": gain, "rad_s": w})).collect();
        object["gains"] = entry.locus.gains.iter().copied().collect();
        object["branches"] = entry.locus.poles.iter().map(|poles| json!(pairs(poles))).collect();
        object
    };
    json!({"systems": entries.iter().map(one).collect::<Vec<_>>()}).to_string()
}

fn csv(entries: &[Entry]) -> String {
    let Some(Entry { locus, .. }) = entries.first() else { return String::new() };
    let mut text = String::from("gain");
    for number in 1..=locus.poles.first().map_or(0, Vec::len) {
        let _ = write!(text, ",re_{number},im_{number}");
    }
    for (gain, poles) in locus.gains.iter().zip(&locus.poles) {
        let _ = write!(text, "\n{gain:.9e}");
        for pole in poles {
            // no number where a branch is infinitely far away
            let _ = match pole.re.is_finite() {
                true => write!(text, ",{:.9e},{:.9e}", pole.re, pole.im),
                false => write!(text, ",,"),
            };
        }
    }
    text + "\n"
}

const SIZE: (i32, i32) = (820, 640);

fn figure(args: &LocusArgs, entries: &[Entry]) -> Result<String, Failure> {
    let mut panel = plane(entries.iter().map(|e| (&e.named.system, &e.closed[..])), args.plane.reach);
    for entry in entries {
        let colour = entry.named.colour;
        let branches = entry.locus.poles.first().map_or(0, Vec::len);
        for branch in 0..branches {
            let points = entry.locus.poles.iter().map(|poles| (poles[branch].re, poles[branch].im));
            panel.curves.push(Curve { colour, pen: Pen::Solid, points: points.collect() });
        }
        panel.marks.extend(signs(&entry.named));
        panel.marks.extend(entry.closed.iter().map(|z| Mark { colour, sign: Sign::Dot, at: (z.re, z.im) }));
    }
    let key = |e: &Entry| Key {
        colour: e.named.colour,
        name: format!("{}, dots: gain times {}", e.named.name, four(e.gain)),
    };
    draw("Root locus", entries.iter().map(key).collect(), panel, args.plane.systems.theme())
}

fn draw(
    title: &str,
    legend: Vec<Key>,
    panel: Panel,
    theme: tracelight_chart::Theme,
) -> Result<String, Failure> {
    let figure = Figure { title: title.into(), legend, panels: vec![panel], columns: 1, panel: SIZE, theme };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}

/// Crosses and rings.
fn signs(named: &Named) -> Vec<Mark> {
    let mark = |sign: Sign| move |z: Complex| Mark { colour: named.colour, sign, at: (z.re, z.im) };
    let poles = named.system.poles().into_iter().map(mark(Sign::Cross));
    poles.chain(named.system.zeros().into_iter().map(mark(Sign::Ring))).collect()
}

/// The plane with a grid of damping and natural frequency, as large as poles and zeros ask for.
fn plane<'a>(
    systems: impl Iterator<Item = (&'a TransferFunction, &'a [Complex])>,
    reach: Option<f64>,
) -> Panel {
    let mut most = 0.0_f64;
    let mut time = Time::Continuous;
    for (system, closed) in systems {
        time = system.time();
        let all = system.poles().into_iter().chain(system.zeros()).chain(closed.iter().copied());
        most = most.max(all.map(|z| z.norm()).filter(|size| size.is_finite()).fold(0.0, f64::max));
    }
    let sampled = time != Time::Continuous;
    let all = match (sampled, most) {
        (true, most) => 1.2 * most.max(1.0),
        (false, 0.0) => 1.0,
        (false, most) => 1.25 * most,
    };
    let up = reach.unwrap_or(all);
    let across = up * f64::from(SIZE.0 - 90) / f64::from(SIZE.1 - 54);
    // what is stable has the larger part
    let (left, right) = if sampled { (-across, across) } else { (-1.6 * across, 0.4 * across) };
    let guides = if let Time::Sampled(period_s) = time { sampled_grid(period_s) } else { grid(up, left) };
    Panel {
        x_title: if sampled { "real part".into() } else { "real part, 1/s".into() },
        y_title: if sampled { "imaginary part".into() } else { "imaginary part, rad/s".into() },
        levels: vec![0.0],
        scale: Scale::Even,
        guides,
        view: Some([(left, right), (-up, up)]),
        ..Panel::default()
    }
}

/// Rays of even damping and half circles of even natural frequency.
fn grid(up: f64, left: f64) -> Vec<Guide> {
    const DAMPINGS: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.85, 0.95];
    let far = 2.0 * up.max(-left);
    let ray = |(damping, sign): (f64, f64)| {
        let (cos, sin) = (damping, (1.0 - damping * damping).sqrt());
        Guide {
            points: vec![(0.0, 0.0), (-far * cos, sign * far * sin)],
            label: if sign > 0.0 { format!("{damping}") } else { String::new() },
        }
    };
    let rays = DAMPINGS.into_iter().flat_map(|d| [(d, 1.0), (d, -1.0)]).map(ray);
    let step = round_step(far / 8.0);
    let ring = |k: i32| {
        let radius = step * f64::from(k);
        let at = |i: i32| PI * (0.5 + f64::from(i) / 90.0);
        // its label stands below, those of the rays above
        let points = (0..=90).map(|i| (radius * at(i).cos(), radius * at(i).sin())).collect();
        Guide { points, label: format!("{} rad/s", four(radius)) }
    };
    rays.chain((1..=8).map(ring)).collect()
}

/// 1, 2 or 5 times a power of ten, the nearest not below.
fn round_step(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|f| f * power).find(|step| *step >= value * 0.999).unwrap_or(power)
}

/// The unit circle, and in it the lines of even damping.
fn sampled_grid(period_s: f64) -> Vec<Guide> {
    const DAMPINGS: [f64; 6] = [0.0, 0.1, 0.3, 0.5, 0.7, 0.9];
    let line = |(damping, sign): (f64, f64)| {
        let root = (1.0 - damping * damping).sqrt();
        let at = |k: i32| {
            let turn = PI * f64::from(k) / 90.0;
            let z = Complex::from_polar((-damping / root * turn).exp(), sign * turn);
            (z.re, z.im)
        };
        let label = if sign > 0.0 && damping > 0.0 { format!("{damping}") } else { String::new() };
        // the label stands at the last point: the lines come from within
        Guide { points: (0..=90).rev().map(at).take(if damping > 0.0 { 80 } else { 91 }).collect(), label }
    };
    debug_assert!(period_s > 0.0, "a period is positive");
    DAMPINGS.into_iter().flat_map(|d| [(d, 1.0), (d, -1.0)]).map(line).collect()
}

pub(crate) fn run_pzmap(args: &PzmapArgs) -> Result<Answer, Failure> {
    let systems = args.plane.systems.systems()?;
    let plot = || {
        let mut panel = plane(systems.iter().map(|named| (&named.system, &[][..])), args.plane.reach);
        systems.iter().for_each(|named| panel.marks.extend(signs(named)));
        let legend =
            systems.iter().map(|named| Key { colour: named.colour, name: named.name.clone() }).collect();
        draw("Poles (crosses) and zeros (rings)", legend, panel, args.plane.systems.theme())
    };
    write_all(&args.plane.out, plot, || Ok(pzmap_csv(&systems)))?;
    let json = || {
        let all: Vec<_> = systems.iter().map(|named| system_json(&named.name, &named.system)).collect();
        json!({ "systems": all }).to_string()
    };
    Ok(Answer::either(args.plane.voice, || pzmap_text(&systems), json))
}

fn pzmap_text(systems: &[Named]) -> String {
    let mut text = String::new();
    for Named { name, system, .. } in systems {
        let zeros: Vec<String> = system.zeros().iter().filter(|z| z.im >= 0.0).map(|z| place(*z)).collect();
        // writing to a String cannot fail
        let _ = writeln!(text, "{name} = {}\n    = {}", system.zpk(), system);
        let _ = writeln!(
            text,
            "    zeros: {}",
            if zeros.is_empty() { "none".to_owned() } else { zeros.join(", ") }
        );
        let _ = writeln!(text, "{}", pole_lines(&system.poles(), system.time()));
    }
    text.trim_end().to_owned()
}

fn pzmap_csv(systems: &[Named]) -> String {
    let mut text = String::from("system,kind,re,im,natural_rad_s,damping\n");
    for (number, named) in (1..).zip(systems) {
        let all = named.system.poles().into_iter().map(|z| ("pole", z));
        for (kind, z) in all.chain(named.system.zeros().into_iter().map(|z| ("zero", z))) {
            let Mode { natural_rad_s, damping, .. } = Mode::of(z, named.system.time());
            let _ =
                writeln!(text, "{number},{kind},{:.9e},{:.9e},{natural_rad_s:.9e},{damping:.9}", z.re, z.im);
        }
    }
    text
}

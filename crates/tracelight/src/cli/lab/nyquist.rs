use std::f64::consts::TAU;
use std::fmt::Write;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Guide, Key, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::{Complex, Margins, decibels};
use tracelight_task::Failure;

use super::bode::{FrequencyArgs, margin_lines, margins_json, summary, system_json};
use super::systems::Named;
use super::write_all;
use crate::cli::Answer;

/// The open loop's values over all frequencies in the complex plane, how often they turn round −1, and what is left of stability
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab nyquist \"K11 G11\" -o nyquist.svg")]
pub(crate) struct NyquistArgs {
    #[command(flatten)]
    pub(super) over: FrequencyArgs,
}

/// Amplification over phase of the open loop, with lines of what it is closed
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab nichols \"K11 G11\" -o nichols.svg")]
pub(crate) struct NicholsArgs {
    #[command(flatten)]
    pub(super) over: FrequencyArgs,
}

/// A loop and what is known of it.
struct Entry {
    named: Named,
    rad_s: Vec<f64>,
    values: Vec<Complex>,
    phases_deg: Vec<f64>,
    margins: Margins,
    /// Poles of the open loop that grow, and of the closed one.
    open_unstable: usize,
    closed_unstable: Option<usize>,
}

impl Entry {
    fn of(named: Named, rad_s: &[f64]) -> Self {
        let response = named.system.frequency_response(rad_s.to_vec());
        Self {
            rad_s: response.rad_s.clone(),
            phases_deg: response.phases_deg().collect(),
            values: response.values,
            margins: named.system.margins(),
            open_unstable: named.system.growing_poles(),
            closed_unstable: named.system.closed().ok().map(|closed| closed.growing_poles()),
            named,
        }
    }
}

fn entries(args: &FrequencyArgs) -> Result<Vec<Entry>, Failure> {
    let (systems, rad_s) = args.read()?;
    Ok(systems.into_iter().map(|named| Entry::of(named, &rad_s)).collect())
}

pub(crate) fn run(args: &NyquistArgs) -> Result<Answer, Failure> {
    let entries = entries(&args.over)?;
    write_all(&args.over.out, || nyquist(args, &entries), || Ok(csv(&entries)))?;
    Ok(Answer::either(args.over.voice, || text(&entries), || json(&entries)))
}

pub(crate) fn run_nichols(args: &NicholsArgs) -> Result<Answer, Failure> {
    let entries = entries(&args.over)?;
    write_all(&args.over.out, || nichols(args, &entries), || Ok(csv(&entries)))?;
    Ok(Answer::either(args.over.voice, || text(&entries), || json(&entries)))
}

fn text(entries: &[Entry]) -> String {
    let mut text = String::new();
    for entry in entries {
        // writing to a String cannot fail
        let _ =
            writeln!(text, "{} = {}\n{}", entry.named.name, entry.named.system, margin_lines(&entry.margins));
        let open = entry.open_unstable;
        let _ = match entry.closed_unstable {
            Some(closed) => writeln!(
                text,
                "    growing poles: {open} open, {closed} closed: it turns {} times {}clockwise round −1\n",
                closed.abs_diff(open),
                if closed < open { "counter" } else { "" }
            ),
            None => writeln!(text, "    growing poles: {open} open; closed it is not defined\n"),
        };
    }
    text.trim_end().to_owned()
}

fn json(entries: &[Entry]) -> String {
    let one = |entry: &Entry| {
        let mut object = system_json(&entry.named.name, &entry.named.system);
        object["margins"] = margins_json(&entry.margins);
        object["open_unstable"] = entry.open_unstable.into();
        object["closed_unstable"] = entry.closed_unstable.into();
        object["values"] = entry.values.iter().map(|z| json!([z.re, z.im])).collect();
        object
    };
    let rad_s = entries.first().map(|entry| &entry.rad_s);
    json!({"rad_s": rad_s, "systems": entries.iter().map(one).collect::<Vec<_>>()}).to_string()
}

fn csv(entries: &[Entry]) -> String {
    let mut text = String::from("rad_s");
    for number in 1..=entries.len() {
        let _ = write!(text, ",re_{number},im_{number}");
    }
    let rad_s = entries.first().map(|entry| entry.rad_s.as_slice()).unwrap_or_default();
    for (row, w) in rad_s.iter().enumerate() {
        let _ = write!(text, "\n{w:.9e}");
        for entry in entries {
            let _ = write!(text, ",{:.9e},{:.9e}", entry.values[row].re, entry.values[row].im);
        }
    }
    text + "\n"
}

fn circle(centre: (f64, f64), radius: f64) -> Vec<(f64, f64)> {
    let at = |k: i32| TAU * f64::from(k) / 180.0;
    (0..=180).map(|k| (centre.0 + radius * at(k).cos(), centre.1 + radius * at(k).sin())).collect()
}

fn nyquist(args: &NyquistArgs, entries: &[Entry]) -> Result<String, Failure> {
    const SIZE: (i32, i32) = (760, 640);
    let mut curves = Vec::new();
    let mut marks = vec![Mark { colour: Colour::Black, sign: Sign::Cross, at: (-1.0, 0.0) }];
    for entry in entries {
        let colour = entry.named.colour;
        let half = |pen: Pen, sign: f64| Curve {
            colour,
            pen,
            points: entry.values.iter().map(|z| (z.re, sign * z.im)).collect(),
        };
        curves.extend([half(Pen::Solid, 1.0), half(Pen::Dashed, -1.0)]);
        let at = |rad_s: f64| entry.named.system.at(entry.named.system.time().at_frequency(rad_s));
        let crossings = entry.margins.least_phase().map(|m| m.rad_s).into_iter();
        let crossings = crossings.chain(entry.margins.least_gain().map(|m| m.rad_s));
        marks.extend(crossings.map(at).map(|z| Mark { colour, sign: Sign::Dot, at: (z.re, z.im) }));
    }
    let reach = reach(entries);
    // a unit is as long on both axes
    let across = reach * f64::from(SIZE.0 - 90) / f64::from(SIZE.1 - 54);
    let panel = Panel {
        x_title: "real part".into(),
        y_title: "imaginary part".into(),
        curves,
        levels: vec![0.0],
        scale: Scale::Even,
        guides: vec![Guide { points: circle((0.0, 0.0), 1.0), label: String::new() }],
        marks,
        view: Some([(-0.5 - across, -0.5 + across), (-reach, reach)]),
        ..Panel::default()
    };
    draw(
        "Nyquist plot: solid from low frequencies up, dashed its mirror",
        entries,
        panel,
        SIZE,
        args.over.systems.theme(),
    )
}

/// How far about −1 is shown: all of what stays near, of what goes far away only the near part.
fn reach(entries: &[Entry]) -> f64 {
    const LEAST: f64 = 1.5;
    const MOST: f64 = 2.2;
    let far = entries.iter().flat_map(|entry| &entry.values).map(|z| z.norm()).filter(|r| r.is_finite());
    (1.1 * far.fold(0.0, f64::max)).clamp(LEAST, MOST)
}

fn draw(
    title: &str,
    entries: &[Entry],
    panel: Panel,
    size: (i32, i32),
    theme: tracelight_chart::Theme,
) -> Result<String, Failure> {
    let key = |e: &Entry| Key { colour: e.named.colour, name: summary(&e.named.name, &e.margins) };
    let figure = Figure {
        title: title.into(),
        legend: entries.iter().map(key).collect(),
        panels: vec![panel],
        columns: 1,
        panel: size,
        theme,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}

fn nichols(args: &NicholsArgs, entries: &[Entry]) -> Result<String, Failure> {
    let curve = |entry: &Entry| Curve {
        colour: entry.named.colour,
        pen: Pen::Solid,
        points: entry
            .phases_deg
            .iter()
            .copied()
            .zip(entry.values.iter().map(|z| decibels(z.norm())))
            .collect(),
    };
    let phases = || entries.iter().flat_map(|entry| entry.phases_deg.iter().copied());
    // whole half turns, −180° at least among them
    let low = (phases().fold(-200.0, f64::min) / 90.0).floor() * 90.0;
    let high = (phases().fold(-90.0, f64::max) / 90.0).ceil() * 90.0;
    let mut marks = vec![Mark { colour: Colour::Black, sign: Sign::Cross, at: (-180.0, 0.0) }];
    for entry in entries {
        let crossings = entry.margins.least_phase().map(|m| m.rad_s).into_iter();
        let crossings = crossings.chain(entry.margins.least_gain().map(|m| m.rad_s).filter(|w| *w > 0.0));
        let system = &entry.named.system;
        let at = |w: f64| {
            (system.phase(w).to_degrees(), decibels(system.at(system.time().at_frequency(w)).norm()))
        };
        marks.extend(crossings.map(|w| Mark { colour: entry.named.colour, sign: Sign::Dot, at: at(w) }));
    }
    let panel = Panel {
        x_title: "phase of the open loop, °".into(),
        y_title: "amplification of the open loop, dB".into(),
        curves: entries.iter().map(curve).collect(),
        levels: vec![0.0],
        guides: closed_lines((low, high)),
        marks,
        view: Some([(low, high), (-40.0, 40.0)]),
        y_step: Some(10.0),
        ..Panel::default()
    };
    draw(
        "Nichols chart: faint, what the closed loop amplifies",
        entries,
        panel,
        (820, 600),
        args.over.systems.theme(),
    )
}

/// Where the closed loop amplifies by so many dB, once a turn (Hall's circles in other coordinates).
fn closed_lines((low, high): (f64, f64)) -> Vec<Guide> {
    const LEVELS: [f64; 9] = [-20.0, -12.0, -6.0, -3.0, -1.0, 0.5, 3.0, 6.0, 12.0];
    let mut guides = Vec::new();
    let turns = (low / 360.0).floor() as i32..=(high / 360.0).ceil() as i32;
    for turn in turns {
        for level in LEVELS {
            let m = 10_f64.powf(level / 20.0);
            // L = T / (1 − T) for T on a circle of that radius
            let at = |k: i32| {
                let t = Complex::from_polar(m, TAU * (f64::from(k) + 0.5) / 720.0);
                let open = t / (1.0 - t);
                let phase = open.arg().to_degrees();
                let phase = if phase > 0.0 { phase - 360.0 } else { phase };
                (phase + 360.0 * f64::from(turn), decibels(open.norm()))
            };
            let mut points: Vec<(f64, f64)> = Vec::new();
            for k in 0..720 {
                let point = at(k);
                // the phase begins again where a turn is over
                if points.last().is_some_and(|last| (last.0 - point.0).abs() > 180.0) {
                    points.push((f64::NAN, f64::NAN));
                }
                points.push(point);
            }
            guides.push(Guide { points, label: format!("{level} dB").replace('-', "−") });
        }
    }
    guides
}

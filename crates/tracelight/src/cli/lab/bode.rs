use std::fmt::Write;

use clap::Args;
use serde_json::{Value, json};
use tracelight_chart::{Curve, Figure, Key, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::{FrequencyResponse, Margins, Stability, TransferFunction, decibels, logspace};
use tracelight_task::Failure;
use tracelight_units::ANGULAR_SPEEDS;

use super::systems::{Named, SystemArgs, bounded, four, pairs};
use super::{OutFile, above_zero, out_file, write_all};
use crate::cli::{Answer, Voice};

/// Amplification and phase over frequency, gain, phase, delay and modulus margins
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab bode \"K11 G11\" \"K11t G11\" -o loop.svg\n\n\
                  Margins are of the open loop as it stands, closed by negative feedback. Crossings are computed, not read from the \
                  curve; the plot marks them.")]
pub(crate) struct BodeArgs {
    #[command(flatten)]
    pub(super) over: FrequencyArgs,
}

/// Systems over frequencies, and where that goes.
#[derive(Args, Debug)]
pub(super) struct FrequencyArgs {
    #[command(flatten)]
    pub(super) systems: SystemArgs,
    #[command(flatten)]
    band: BandArgs,
    /// Plot into an SVG or PNG, or write a row a frequency to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    pub(super) out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Which frequencies.
#[derive(Args, Debug)]
struct BandArgs {
    /// From this frequency [default: a decade below the slowest pole or zero]
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    from: Option<f64>,
    /// To this frequency [default: a decade above the fastest]
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    to: Option<f64>,
    /// How many, evenly on a logarithmic scale
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    points: u32,
}

pub(super) fn frequency(text: &str) -> Result<f64, String> {
    above_zero(text, ANGULAR_SPEEDS)
}

impl FrequencyArgs {
    /// All systems, and frequencies for them together, rad/s.
    pub(super) fn read(&self) -> Result<(Vec<Named>, Vec<f64>), Failure> {
        let systems = self.systems.systems()?;
        bounded(self.band.points, systems.len())?;
        let (low, high) = systems
            .iter()
            .map(|named| named.system.band())
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            .unwrap_or((0.1, 10.0));
        // a bound that is typed moves the other, if that is not typed
        let (from, to) = match (self.band.from, self.band.to) {
            (Some(from), Some(to)) => (from, to),
            (Some(from), None) => {
                let end =
                    systems.iter().map(|n| n.system.time().nyquist_rad_s()).fold(f64::INFINITY, f64::min);
                (from, high.max(100.0 * from).min(end))
            }
            (None, Some(to)) => (low.min(to / 100.0), to),
            (None, None) => (low, high),
        };
        if from >= to {
            return Err(Failure::usage("usage", format!("--from {from} rad/s is not below --to {to} rad/s")));
        }
        Ok((systems, logspace((from, to), self.band.points as usize)))
    }
}

/// A system and all that is known of it.
struct Entry {
    named: Named,
    response: FrequencyResponse,
    margins: Margins,
    /// What its closed loop does; none where that is not defined.
    closed: Option<Stability>,
}

pub(crate) fn run(args: &BodeArgs) -> Result<Answer, Failure> {
    let (systems, rad_s) = args.over.read()?;
    let entry = |named: Named| Entry {
        response: named.system.frequency_response(rad_s.clone()),
        margins: named.system.margins(),
        closed: named.system.closed().ok().map(|closed| closed.stability()),
        named,
    };
    let entries: Vec<Entry> = systems.into_iter().map(entry).collect();
    write_all(&args.over.out, || figure(args, &entries), || Ok(csv(&entries)))?;
    Ok(Answer::either(args.over.voice, || text(&entries), || json(&entries)))
}

fn text(entries: &[Entry]) -> String {
    let mut text = String::new();
    for Entry { named, margins, closed, .. } in entries {
        // writing to a String cannot fail
        let _ = writeln!(text, "{} = {}", named.name, named.system);
        let _ = writeln!(text, "{}", margin_lines(margins));
        let closed = match closed {
            Some(Stability::Stable) => "is stable",
            Some(Stability::Marginal) => {
                "is at the edge of stability, or nearer to it than rounding lets tell"
            }
            Some(Stability::Growing) => "is not stable",
            None => "is not defined: 1 + G is zero at infinite frequency",
        };
        let _ = writeln!(text, "    closed by negative feedback it {closed}\n");
    }
    text.trim_end().to_owned()
}

/// Margins for people, a line each.
pub(super) fn margin_lines(margins: &Margins) -> String {
    let mut lines = Vec::new();
    lines.push(match margins.least_gain() {
        Some(margin) => format!(
            "    gain margin     {} dB (factor {}) at {} rad/s",
            four(decibels(margin.factor)),
            four(margin.factor),
            four(margin.rad_s)
        ),
        None if margins.is_always_real => {
            "    gain margin     none: it is real at every frequency".to_owned()
        }
        None => "    gain margin     none: it is nowhere real and negative".to_owned(),
    });
    lines.push(match margins.least_phase() {
        Some(margin) => {
            format!("    phase margin    {}° at {} rad/s", four(margin.degrees()), four(margin.rad_s))
        }
        None if margins.is_always_one => {
            "    phase margin    none: its gain is 1 at every frequency".to_owned()
        }
        None => "    phase margin    none: its gain is nowhere 1".to_owned(),
    });
    if let Some(margin) = margins.least_delay() {
        lines.push(format!(
            "    delay margin    {} ms at {} rad/s",
            four(1e3 * margin.delay_s),
            four(margin.rad_s)
        ));
    }
    if let Some(margin) = margins.modulus {
        lines.push(format!(
            "    modulus margin  {} at {} rad/s: sensitivity at most {}",
            four(margin.distance),
            four(margin.rad_s),
            four(1.0 / margin.distance)
        ));
    }
    lines.join("\n")
}

/// Margins for scripts.
pub(super) fn margins_json(margins: &Margins) -> Value {
    let gain = |m: &tracelight_linear::GainMargin| json!({"rad_s": m.rad_s, "factor": m.factor, "db": decibels(m.factor)});
    let phase = |m: &tracelight_linear::PhaseMargin| json!({"rad_s": m.rad_s, "deg": m.degrees(), "delay_s": m.delay_s});
    let modulus = margins.modulus.map(|m| {
        // JSON has no infinity
        json!({"rad_s": m.rad_s.is_finite().then_some(m.rad_s), "distance": m.distance})
    });
    json!({
        "gain": margins.least_gain().as_ref().map(gain),
        "phase": margins.least_phase().as_ref().map(phase),
        "delay_s": margins.least_delay().map(|m| m.delay_s),
        "modulus": modulus,
        "every_gain": margins.gain.iter().map(gain).collect::<Vec<_>>(),
        "every_phase": margins.phase.iter().map(phase).collect::<Vec<_>>(),
    })
}

/// A system for scripts.
pub(super) fn system_json(name: &str, system: &TransferFunction) -> Value {
    let (gain, stability) = (system.dc_gain(), system.stability());
    json!({
        "name": name,
        "num": system.numerator().coefficients(),
        "den": system.denominator().coefficients(),
        "zeros": pairs(&system.zeros()),
        "poles": pairs(&system.poles()),
        "dc_gain": gain.is_finite().then_some(gain),
        "stable": stability == Stability::Stable,
        "stability": stability_name(stability),
    })
}

pub(super) const fn stability_name(stability: Stability) -> &'static str {
    match stability {
        Stability::Stable => "stable",
        Stability::Marginal => "marginal",
        Stability::Growing => "growing",
    }
}

fn json(entries: &[Entry]) -> String {
    let one = |entry: &Entry| {
        let mut object = system_json(&entry.named.name, &entry.named.system);
        object["margins"] = margins_json(&entry.margins);
        object["closed_stable"] = entry.closed.map(|closed| closed == Stability::Stable).into();
        object["closed_stability"] = entry.closed.map(stability_name).into();
        object["bandwidth_rad_s"] = entry.named.system.bandwidth().into();
        object["magnitude_db"] = entry.response.magnitudes_db().collect();
        object["phase_deg"] = entry.response.phases_deg().collect();
        object
    };
    let rad_s = entries.first().map(|entry| &entry.response.rad_s);
    json!({"rad_s": rad_s, "systems": entries.iter().map(one).collect::<Vec<_>>()}).to_string()
}

fn csv(entries: &[Entry]) -> String {
    let mut text = String::from("rad_s");
    for number in 1..=entries.len() {
        let _ = write!(text, ",magnitude_db_{number},phase_deg_{number}");
    }
    let columns: Vec<(Vec<f64>, Vec<f64>)> = entries
        .iter()
        .map(|e| (e.response.magnitudes_db().collect(), e.response.phases_deg().collect()))
        .collect();
    let rad_s = entries.first().map(|entry| entry.response.rad_s.as_slice()).unwrap_or_default();
    for (row, w) in rad_s.iter().enumerate() {
        let _ = write!(text, "\n{w:.9e}");
        for (magnitudes, phases) in &columns {
            let _ = write!(text, ",{:.6},{:.6}", magnitudes[row], phases[row]);
        }
    }
    text + "\n"
}

fn figure(args: &BodeArgs, entries: &[Entry]) -> Result<String, Failure> {
    let curve = |entry: &Entry, values: Vec<f64>| Curve {
        colour: entry.named.colour,
        pen: Pen::Solid,
        points: entry.response.rad_s.iter().copied().zip(values).collect(),
    };
    let panel = |title: &str, level: f64, step: f64, curves: Vec<Curve>| Panel {
        x_title: "frequency, rad/s".into(),
        y_title: title.into(),
        curves,
        levels: vec![level],
        scale: Scale::LogX,
        y_step: Some(step),
        ..Panel::default()
    };
    let mut magnitude = panel(
        "amplification, dB",
        0.0,
        20.0,
        entries.iter().map(|e| curve(e, e.response.magnitudes_db().collect())).collect(),
    );
    let mut phase = panel(
        "phase, °",
        -180.0,
        45.0,
        entries.iter().map(|e| curve(e, e.response.phases_deg().collect())).collect(),
    );
    for entry in entries {
        mark(entry, &mut magnitude, &mut phase);
    }
    let figure = Figure {
        title: "Bode plot, margins marked".into(),
        legend: entries
            .iter()
            .map(|e| Key { colour: e.named.colour, name: summary(&e.named.name, &e.margins) })
            .collect(),
        panels: vec![magnitude, phase],
        columns: 1,
        panel: (820, 300),
        theme: args.over.systems.theme(),
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}

/// A name with its margins.
pub(super) fn summary(name: &str, margins: &Margins) -> String {
    let phase = margins.least_phase().map(|m| format!("{}° of phase", four(m.degrees())));
    let gain = margins.least_gain().map(|m| format!("{} dB of gain", four(decibels(m.factor))));
    let both: Vec<String> = phase.into_iter().chain(gain).collect();
    if both.is_empty() { name.to_owned() } else { format!("{name}: {}", both.join(", ")) }
}

/// Lines from the levels to the curves where the margins are.
fn mark(entry: &Entry, magnitude: &mut Panel, phase: &mut Panel) {
    let colour = entry.named.colour;
    let rad_s = &entry.response.rad_s;
    let band = rad_s.first().copied().unwrap_or(0.0)..=rad_s.last().copied().unwrap_or(0.0);
    let line = |panel: &mut Panel, rad_s: f64, from: f64, to: f64| {
        if !band.contains(&rad_s) {
            return;
        }
        panel.curves.push(Curve { colour, pen: Pen::Dashed, points: vec![(rad_s, from), (rad_s, to)] });
        panel.marks.push(Mark { colour, sign: Sign::Dot, at: (rad_s, to) });
    };
    if let Some(margin) = entry.margins.least_gain().filter(|margin| margin.rad_s > 0.0) {
        line(magnitude, margin.rad_s, 0.0, -decibels(margin.factor));
    }
    if let Some(margin) = entry.margins.least_phase() {
        // −180°, or that a whole number of turns further
        let shown = entry.named.system.phase(margin.rad_s).to_degrees();
        line(phase, margin.rad_s, shown - margin.degrees(), shown);
    }
}

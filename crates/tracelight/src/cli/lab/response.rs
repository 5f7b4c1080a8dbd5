use std::fmt::Write;

use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use tracelight_chart::{Curve, Figure, Key, Mark, Panel, Pen, Sign};
use tracelight_linear::{LinearError, Polynomial, Response, StepInfo, Time, TransferFunction};
use tracelight_task::Failure;
use tracelight_units::TIMES;

use super::systems::{Named, SystemArgs, bounded, four, percent, seconds};
use super::{OutFile, above_zero, out_file, over_time, write_all};
use crate::cli::{Answer, Voice};

/// What transfer functions answer to a step, an impulse or a ramp: overshoot, rise, settling
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab response \"K11 G11\" \"K11t G11\" --closed -o steps.svg\n\n\
                  This is of systems on paper; lab step is of a rig, with friction, counts and limits.")]
pub(crate) struct ResponseArgs {
    #[command(flatten)]
    systems: SystemArgs,
    /// What comes in, from rest at time 0
    #[arg(long, value_enum, default_value = "step")]
    input: Input,
    /// For how long [default: until the slowest that dies out has done so]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    duration: Option<f64>,
    /// How many values, evenly over that time; of samples each of them counts instead
    #[arg(long, value_name = "N", default_value_t = 2001, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    points: u32,
    /// Plot into an SVG or PNG, or write a row a moment to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// What comes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Input {
    /// 1 from then on
    Step,
    /// All at once, its integral over time 1; of samples one sample of 1
    Impulse,
    /// Rising by 1 a second
    Ramp,
}

fn duration(text: &str) -> Result<f64, String> {
    above_zero(text, TIMES)
}

/// A system and its answer.
struct Entry {
    named: Named,
    response: Response,
    /// Of a step.
    info: Option<StepInfo>,
}

pub(crate) fn run(args: &ResponseArgs) -> Result<Answer, Failure> {
    let systems = args.systems.systems()?;
    bounded(args.points, systems.len())?;
    let own = systems.iter().map(|named| named.system.settling_horizon_s()).fold(0.0, f64::max);
    let duration_s = args.duration.unwrap_or(own);
    let entries: Vec<Entry> =
        systems.into_iter().map(|named| entry(args, named, duration_s)).collect::<Result<_, _>>()?;
    write_all(&args.out, || figure(args, &entries), || Ok(csv(&entries)))?;
    Ok(Answer::either(args.voice, || text(args, &entries), || json(&entries)))
}

fn entry(args: &ResponseArgs, named: Named, duration_s: f64) -> Result<Entry, Failure> {
    let failed = |message: String| Failure::failed("no-such-system", format!("{}: {message}", named.name));
    let count = match named.system.time() {
        Time::Continuous => f64::from(args.points),
        Time::Sampled(period_s) => (duration_s / period_s).floor() + 1.0,
    };
    if !(2.0..=100_000.0).contains(&count) {
        return Err(failed(format!(
            "{duration_s} s are {count} samples; between 2 and 100000 of them are shown: choose another --duration"
        )));
    }
    let step_s = duration_s / f64::from(args.points - 1);
    let response =
        answer(&named.system, args.input, step_s, count as usize).map_err(|e| failed(e.to_string()))?;
    // within this share of the goal it is settled
    const BAND: f64 = 0.02;
    let info = (args.input == Input::Step).then(|| response.step_info(Some(named.system.dc_gain()), BAND));
    Ok(Entry { named, response, info })
}

fn answer(
    system: &TransferFunction,
    input: Input,
    step_s: f64,
    count: usize,
) -> Result<Response, LinearError> {
    let variable = Polynomial::new([1.0, 0.0]);
    match (system.time(), input) {
        (_, Input::Step) => system.step_response(step_s, count),
        // an impulse is a step's slope, a ramp its integral
        (Time::Continuous, Input::Impulse) => {
            let slope = TransferFunction::new(variable, Polynomial::one(), Time::Continuous)?;
            system.series(&slope)?.step_response(step_s, count)
        }
        (Time::Continuous, Input::Ramp) => {
            let integral = TransferFunction::new(Polynomial::one(), variable, Time::Continuous)?;
            system.series(&integral)?.step_response(step_s, count)
        }
        (Time::Sampled(_), Input::Impulse) => {
            let first: Vec<f64> = (0..count).map(|k| if k == 0 { 1.0 } else { 0.0 }).collect();
            system.response(step_s, &first)
        }
        (Time::Sampled(period_s), Input::Ramp) => {
            let rising: Vec<f64> = (0..count).map(|k| k as f64 * period_s).collect();
            system.response(step_s, &rising)
        }
    }
}

fn text(args: &ResponseArgs, entries: &[Entry]) -> String {
    let mut text = String::new();
    for Entry { named, response, info } in entries {
        // writing to a String cannot fail
        let _ = writeln!(text, "{} = {}", named.name, named.system);
        if let Some(info) = info {
            let _ = writeln!(
                text,
                "    comes to {}, overshoots by {}, undershoots by {}, rises in {}, is within 2 % {}",
                if info.final_value.is_nan() { "no value".to_owned() } else { four(info.final_value) },
                percent(info.overshoot_percent),
                percent(info.undershoot_percent),
                seconds(info.rise_s),
                info.settle_s.map_or("at no time shown".to_owned(), |s| format!("after {} s", four(s)))
            );
        }
        let (most, at_s) = response.peak();
        let last = response.values.last().copied().unwrap_or_default();
        let end_s = response.step_s * (response.values.len().saturating_sub(1)) as f64;
        let _ = writeln!(
            text,
            "    largest {} at {} s, {} at the end of {} s\n",
            four(most),
            four(at_s),
            four(last),
            four(end_s)
        );
    }
    if args.input != Input::Step {
        let _ = writeln!(text, "(answers to {})", words(args.input));
    }
    text.trim_end().to_owned()
}

const fn words(input: Input) -> &'static str {
    match input {
        Input::Step => "a step",
        Input::Impulse => "an impulse",
        Input::Ramp => "a ramp",
    }
}

fn json(entries: &[Entry]) -> String {
    let one = |Entry { named, response, info }: &Entry| -> Value {
        let finite = |value: f64| value.is_finite().then_some(value);
        json!({
            "name": named.name,
            "step_s": response.step_s,
            "values": response.values,
            "final": info.and_then(|info| finite(info.final_value)),
            "overshoot_percent": info.and_then(|info| info.overshoot_percent),
            "undershoot_percent": info.and_then(|info| info.undershoot_percent),
            "rise_s": info.and_then(|info| info.rise_s),
            "settle_s": info.and_then(|info| info.settle_s),
            "peak": response.peak().0,
            "peak_s": response.peak().1,
        })
    };
    json!({"systems": entries.iter().map(one).collect::<Vec<_>>()}).to_string()
}

/// A time and a value for each, since samples have their own times.
fn csv(entries: &[Entry]) -> String {
    let mut text = String::new();
    for number in 1..=entries.len() {
        let comma = if number > 1 { "," } else { "" };
        let _ = write!(text, "{comma}t_s_{number},output_{number}");
    }
    let rows = entries.iter().map(|e| e.response.values.len()).max().unwrap_or(0);
    for row in 0..rows {
        text += "\n";
        for (i, Entry { response, .. }) in entries.iter().enumerate() {
            let comma = if i > 0 { "," } else { "" };
            let _ = match response.values.get(row) {
                Some(value) => write!(text, "{comma}{:.9e},{value:.9e}", row as f64 * response.step_s),
                None => write!(text, "{comma},"),
            };
        }
    }
    text + "\n"
}

fn figure(args: &ResponseArgs, entries: &[Entry]) -> Result<String, Failure> {
    let curve = |Entry { named, response, .. }: &Entry| {
        let times = (0..).map(|k| f64::from(k) * response.step_s);
        let points: Vec<(f64, f64)> = match named.system.time() {
            Time::Continuous => times.zip(response.values.iter().copied()).collect(),
            // a sample holds until the next
            Time::Sampled(period_s) => {
                times.zip(&response.values).flat_map(|(t, &y)| [(t, y), (t + period_s, y)]).collect()
            }
        };
        Curve { colour: named.colour, pen: Pen::Solid, points }
    };
    let settled = |Entry { named, response, info }: &Entry| {
        let at_s = info.and_then(|info| info.settle_s)?;
        let value = response.values.get((at_s / response.step_s).round() as usize)?;
        Some(Mark { colour: named.colour, sign: Sign::Dot, at: (at_s, *value) })
    };
    let key = |Entry { named, info, .. }: &Entry| {
        let more = info.and_then(|info| Some((info.overshoot_percent?, info.settle_s?)));
        let more = more.map_or(String::new(), |(over, s)| {
            format!(": {} % over, settled after {} s", four(over), four(s))
        });
        Key { colour: named.colour, name: format!("{}{more}", named.name) }
    };
    let goals =
        entries.iter().filter_map(|e| e.info).map(|info| info.final_value).filter(|goal| goal.is_finite());
    let mut levels: Vec<f64> = goals.collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * b.abs());
    let figure = Figure {
        title: match args.input {
            Input::Step => "Step responses; dots: within 2 % from here on".into(),
            other => format!("Answers to {}", words(other)),
        },
        legend: entries.iter().map(key).collect(),
        panels: vec![Panel {
            marks: entries.iter().filter_map(settled).collect(),
            ..over_time("output", levels, entries.iter().map(curve).collect())
        }],
        columns: 1,
        panel: (820, 420),
        theme: args.systems.theme(),
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}

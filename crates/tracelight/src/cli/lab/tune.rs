use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Mark, Panel, Pen, Scale, Sign, Theme};
use tracelight_files as files;
use tracelight_lab::{Demand, Setting, around, coarse};
use tracelight_pipeline::Driving;
use tracelight_rig::{PanTilt, Phase};
use tracelight_sim::{LawName, RigConfig, SimulatedRig, Spread, score};
use tracelight_task::{Failure, Stop, Task, on_all_cores};
use tracelight_trajectory::Plan;
use tracelight_units::{ANGULAR_SPEEDS, TIMES};

use super::shape::ShapeArgs;
use super::{above_zero, make_folder, rig_out};
use crate::bar::Bar;
use crate::cli::laws::law;
use crate::cli::{Answer, Voice};

/// Pick the control law of a rig and how fast its loops are: the smallest error on heads that differ, of all that bear what is asked
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab tune --laws state,pid-ff --gain-margin 1.3\n\n\
                  Every law at every bandwidth must first bear the demand: draw the shape, without once stopping to find its way back, \
                  with motors that give --gain-margin times what is believed of them, and with motors that give as much less; and with \
                  currents that come --lag late. Those that do draw it on --plants heads that differ as heads of one kind do \
                  (see `tracelight lab montecarlo`); the one whose largest error, on 95 of 100 of them (of fewer than 20, on all), is smallest is picked, and \
                  tried with each joint a quarter faster and slower.\n\n\
                  The folder gets tune.svg and rig.toml; --save writes law and bandwidths into one's own rig file, comments kept.")]
pub(crate) struct TuneArgs {
    #[command(flatten)]
    shape: ShapeArgs,
    /// Laws to choose from
    #[arg(long, value_name = "LAW,…", value_delimiter = ',', default_value = "state,pid-ff,pid,lead-lag", value_parser = law())]
    laws: Vec<LawName>,
    /// By how much motors may be stronger, and weaker, than what is believed
    #[arg(long, value_name = "FACTOR", default_value_t = 1.5, value_parser = factor)]
    gain_margin: f64,
    /// By how much currents may lag
    #[arg(long, value_name = "TIME", default_value = "1ms", value_parser = lag)]
    lag: f64,
    /// Slowest loop
    #[arg(long, value_name = "SPEED", default_value = "10rad/s", value_parser = bandwidth)]
    slowest: f64,
    /// Fastest loop
    #[arg(long, value_name = "SPEED", default_value = "240rad/s", value_parser = bandwidth)]
    fastest: f64,
    /// How many heads that differ
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    plants: u32,
    /// Seed of the first head; the others have the numbers after it
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/tune")]
    out: PathBuf,
    /// Write what was picked into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Of fewer heads the largest error is that of the worst.
const FEW: u32 = 20;
/// Bandwidths of each law that are tried first.
const BANDWIDTHS: usize = 12;

fn factor(text: &str) -> Result<f64, String> {
    let factor: f64 = text.parse().map_err(|_| format!("{text} is no number"))?;
    if (1.0..=5.0).contains(&factor) { Ok(factor) } else { Err(format!("{text} is not between 1 and 5")) }
}

fn lag(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    if time_s <= 0.1 {
        Ok(time_s)
    } else {
        Err(format!("{text} is more than 0.1s, the most that a rig file takes"))
    }
}

fn bandwidth(text: &str) -> Result<f64, String> {
    let rad_s = above_zero(text, ANGULAR_SPEEDS)?;
    if (0.1..=500.0).contains(&rad_s) {
        Ok(rad_s)
    } else {
        Err(format!("{text} is not between 0.1 and 500 rad/s"))
    }
}

/// A setting, and how it did.
struct Tried {
    setting: Setting,
    /// How many of the demands it bore,
    borne: usize,
    /// and, if it bore all, its largest error on 95 of 100 heads, mm, and rms on the middle one.
    errors_mm: Option<Errors>,
}

#[derive(Clone, Copy)]
struct Errors {
    max_p95: f64,
    rms_median: f64,
}

impl Tried {
    fn worst_mm(&self) -> f64 {
        self.errors_mm.map_or(f64::INFINITY, |errors| errors.max_p95)
    }
}

pub(crate) fn run(args: &TuneArgs, stop: &Stop) -> Result<Answer, Failure> {
    let driving = args.shape.resolve()?;
    let rig_name = args.shape.rig();
    rig_out::may_save(rig_name, args.save)?;
    if args.slowest >= args.fastest {
        return Err(Failure::usage("usage", "--slowest must be below --fastest"));
    }
    let bench = Bench { args, driving: &driving, plan: args.shape.plan(&driving)? };
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    task.stage("laws", 1);
    let mut tried = bench.try_all(coarse(&args.laws, (args.slowest, args.fastest), BANDWIDTHS), task)?;
    let had = bench.try_all(vec![Setting::of(&driving.rig)], task)?.remove(0);
    task.stage("joints", 1);
    let middle = best(&tried).ok_or_else(|| nothing_bears(args))?.setting;
    let mut near = around(middle);
    let within = args.slowest..=args.fastest;
    near.retain(|s| within.contains(&s.bandwidth_rad_s.pan) && within.contains(&s.bandwidth_rad_s.tilt));
    tried.extend(bench.try_all(near, task)?);
    tried.sort_by(|a, b| a.setting.bandwidth_rad_s.pan.total_cmp(&b.setting.bandwidth_rad_s.pan));
    let picked = best(&tried).ok_or_else(|| nothing_bears(args))?;
    let better = picked.setting.apply(&driving.rig);
    make_folder(&args.out, "--out")?;
    files::write(
        &args.out.join("tune.svg").display().to_string(),
        figure(args, &driving.rig, &tried, picked)?,
    )?;
    let written = rig_out::write(&args.out, rig_name, args.save, (&driving.rig, &better))?;
    let text = || text(args, &driving.rig, &tried, (&had, picked)) + &written;
    Ok(Answer::either(args.voice, text, || json(&tried, (&had, picked))))
}

/// Where settings are tried.
struct Bench<'a> {
    args: &'a TuneArgs,
    driving: &'a Driving,
    plan: Plan,
}

impl Bench<'_> {
    fn demand(&self) -> Demand {
        Demand { gain: self.args.gain_margin, lag_s: self.args.lag }
    }

    /// Tries settings, on all cores.
    fn try_all(&self, settings: Vec<Setting>, task: Task<'_>) -> Result<Vec<Tried>, Failure> {
        task.stage("settings", settings.len() as u64);
        let tried = on_all_cores(settings.len(), task, |number| self.tried(settings[number]));
        task.check()?;
        Ok(tried)
    }

    fn tried(&self, setting: Setting) -> Tried {
        let rig = setting.apply(&self.driving.rig);
        let demands = self.demand().heads(&rig);
        // the first that is not borne is enough to know
        let borne = demands.iter().take_while(|head| self.bears(head)).count();
        if borne < demands.len() {
            return Tried { setting, borne, errors_mm: None };
        }
        let heads = u64::from(self.args.plants);
        let on_head = |number: u64| {
            self.errors_mm(&Spread::USUAL.draw(&rig, self.args.seed.wrapping_add(number)), number)
        };
        let all: Option<Vec<(f64, f64)>> = (0..heads).map(on_head).collect();
        let errors_mm = all.map(|all| Errors {
            max_p95: tracelight_lab::Quantiles::of(all.iter().map(|e| e.0)).p95,
            rms_median: tracelight_lab::Quantiles::of(all.iter().map(|e| e.1)).median,
        });
        Tried { setting, borne, errors_mm }
    }

    /// Whether a head draws the shape without ever leaving its way.
    fn bears(&self, head: &RigConfig) -> bool {
        let mut simulated = SimulatedRig::new(head, self.driving.pose, self.args.seed);
        let run = tracelight_sim::run(&mut simulated, &self.plan, false, |_, tick| {
            let lost = matches!(tick.telemetry.phase, Phase::Holding | Phase::Faulted);
            if lost { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        run.is_done()
    }

    /// Largest and rms error on a head, mm; `None` if it does not finish.
    fn errors_mm(&self, head: &RigConfig, number: u64) -> Option<(f64, f64)> {
        let mut simulated = SimulatedRig::new(head, self.driving.pose, self.args.seed.wrapping_add(number));
        let run = tracelight_sim::run(&mut simulated, &self.plan, false, |_, _| ControlFlow::Continue(()));
        let tracking = score(&self.plan, &run, self.plan.set_speed_m_s);
        run.is_done().then_some((tracking.max_mm, tracking.rms_mm))
    }
}

/// The one with the smallest error of those that bear the demand.
fn best(tried: &[Tried]) -> Option<&Tried> {
    let bear = tried.iter().filter(|t| t.errors_mm.is_some());
    bear.min_by(|a, b| a.worst_mm().total_cmp(&b.worst_mm()))
}

fn nothing_bears(args: &TuneArgs) -> Failure {
    let message = format!(
        "no law at any bandwidth draws the shape with motors {0} times as strong and as weak as believed and currents {1} ms late; \
         ask for a smaller --gain-margin or --lag, or draw more slowly",
        args.gain_margin,
        1e3 * args.lag
    );
    Failure::failed("no-such-design", message)
}

fn bandwidths(setting: &Setting) -> String {
    let PanTilt { pan, tilt } = setting.bandwidth_rad_s;
    if (pan - tilt).abs() < 1e-9 { format!("{pan:.1}") } else { format!("{pan:.1}, {tilt:.1}") }
}

fn text(args: &TuneArgs, rig: &RigConfig, tried: &[Tried], (had, picked): (&Tried, &Tried)) -> String {
    let mut text = format!(
        "{} on rig {}; motors ×{m} and ÷{m}, currents {} ms late; {} heads that differ\n\n{:14} {:>18} {:>24} {:>22}",
        args.shape.shape,
        rig.name,
        1e3 * args.lag,
        args.plants,
        "",
        "bandwidth, rad/s",
        if args.plants < FEW { "at most, mm" } else { "at most on 95 %, mm" },
        "rms, middle one, mm",
        m = args.gain_margin
    );
    // of a law that bears nothing no bandwidth is better than another
    let of = |name: &str, tried: &Tried| match tried.errors_mm {
        None if name == tried.setting.law.name() => "any".to_owned(),
        _ => bandwidths(&tried.setting),
    };
    let mut row = |name: &str, tried: &Tried| {
        let error = |value: fn(Errors) -> f64| {
            tried.errors_mm.map_or("bears not what is asked".to_owned(), |e| format!("{:.3}", value(e)))
        };
        let rms = tried.errors_mm.map_or(String::new(), |e| format!("{:.3}", e.rms_median));
        let line = format!("\n{name:14} {:>18} {:>24} {rms:>22}", of(name, tried), error(|e| e.max_p95));
        text += line.trim_end();
    };
    for &law in &args.laws {
        let of_law = tried.iter().filter(|t| t.setting.law == law && is_even(&t.setting));
        let shown = of_law.min_by(|a, b| a.worst_mm().total_cmp(&b.worst_mm()));
        shown.into_iter().for_each(|tried| row(law.name(), tried));
    }
    row("as it was", had);
    row("picked", picked);
    let PanTilt { pan, tilt } = picked.setting.bandwidth_rad_s;
    text + &format!(
        "\n\ncontrol.law = {:?}, control.pan_bandwidth = \"{pan:.1}rad/s\", control.tilt_bandwidth = \"{tilt:.1}rad/s\"",
        picked.setting.law.name()
    )
}

/// Whether both joints have the same bandwidth.
fn is_even(setting: &Setting) -> bool {
    (setting.bandwidth_rad_s.pan - setting.bandwidth_rad_s.tilt).abs() < 1e-9
}

fn json(tried: &[Tried], (had, picked): (&Tried, &Tried)) -> String {
    let one = |tried: &Tried| {
        json!({
            "law": tried.setting.law.name(),
            "pan_bandwidth_rad_s": tried.setting.bandwidth_rad_s.pan,
            "tilt_bandwidth_rad_s": tried.setting.bandwidth_rad_s.tilt,
            "bears": tried.errors_mm.is_some(),
            "max_mm_p95": tried.errors_mm.map(|e| e.max_p95),
            "rms_mm_median": tried.errors_mm.map(|e| e.rms_median),
            "demands_borne": tried.borne,
        })
    };
    json!({
        "picked": one(picked),
        "was": one(had),
        "tried": tried.iter().map(one).collect::<Vec<_>>(),
    })
    .to_string()
}

/// Errors over the bandwidth.
fn figure(args: &TuneArgs, rig: &RigConfig, tried: &[Tried], picked: &Tried) -> Result<String, Failure> {
    let colours = Colour::in_turn();
    let of_law = |law: LawName| tried.iter().filter(move |t| t.setting.law == law && is_even(&t.setting));
    let curves = args.laws.iter().zip(colours.clone()).map(|(&law, colour)| {
        // a gap where the demand is not borne
        let points =
            of_law(law).map(|t| (t.setting.bandwidth_rad_s.pan, t.errors_mm.map_or(f64::NAN, |e| e.max_p95)));
        Curve { colour, pen: Pen::Solid, points: points.collect() }
    });
    let marks = args.laws.iter().zip(colours.clone()).flat_map(|(&law, colour)| {
        let bear = of_law(law).filter(|t| t.errors_mm.is_some());
        bear.map(move |t| Mark { colour, sign: Sign::Dot, at: (t.setting.bandwidth_rad_s.pan, t.worst_mm()) })
    });
    let PanTilt { pan, tilt } = picked.setting.bandwidth_rad_s;
    let chosen =
        Mark { colour: Colour::Black, sign: Sign::Ring, at: ((pan * tilt).sqrt(), picked.worst_mm()) };
    let mut legend: Vec<Key> =
        args.laws.iter().zip(colours).map(|(law, colour)| Key { colour, name: law.name().into() }).collect();
    legend.push(Key { colour: Colour::Black, name: "ring: picked; gaps: what is asked is not borne".into() });
    let figure = Figure {
        title: format!(
            "{} on rig {}: largest error on heads that differ, over the loops' bandwidth",
            args.shape.shape, rig.name
        ),
        legend,
        panels: vec![Panel {
            x_title: "bandwidth, rad/s".into(),
            y_title: "largest error, mm".into(),
            curves: curves.collect(),
            marks: marks.chain([chosen]).collect(),
            scale: Scale::LogX,
            ..Panel::default()
        }],
        columns: 1,
        panel: (820, 420),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}

//! Heads that other programs of this computer drive: made dark, and watched.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};
use tracelight_flags::each;
use tracelight_port::{darken, darkened_json, darkened_text, seen_text, watch};
use tracelight_task::{Failure, Stop};

use crate::cli::answer::{Answer, Voice, print, watched};
use crate::named;

/// Make heads dark that other programs on this computer drive
///
/// Every board that a program of Tracelight's on this computer has in hand is disarmed, whoever started it, in whatever terminal. A program that is asked to stop so ends its job, which
/// `resume` goes on with. This is no safety device: the switch in the laser's supply is.
#[derive(Args, Debug)]
#[command(after_help = "Examples: tracelight stop\n          tracelight stop /dev/ttyACM0")]
pub(crate) struct StopArgs {
    /// Only the head at this port [default: all]
    #[arg(value_name = "PORT")]
    port: Option<String>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

/// Show what a head does that another program on this computer drives
#[derive(Args, Debug)]
#[command(
    after_help = "Examples: tracelight watch\n          tracelight watch /dev/ttyACM0 --for 10s --json\n\n\
                        It waits until a program drives one. A line whenever phase, gate or fault change, and with --json also 20 times a second."
)]
pub(crate) struct WatchArgs {
    /// Port of the head [default: the only one that is driven]
    #[arg(value_name = "PORT")]
    port: Option<String>,
    /// How long, such as 30s [default: until that program is done, or Ctrl-C]
    #[arg(long = "for", value_name = "TIME", value_parser = each)]
    lasts_s: Option<f64>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

fn port(name: Option<&String>) -> Option<PathBuf> {
    name.map(|name| named::port(name))
}

pub(crate) fn stop(args: &StopArgs) -> Result<Answer, Failure> {
    let all = darken(port(args.port.as_ref()).as_deref())?;
    let is_known = all.iter().all(|one| one.within_s.is_some());
    let unknown =
        || Failure::failed("not-dark", "a head did not say that it is disarmed: take its laser's power");
    let answer = Answer::new(darkened_text(&all), json!({ "heads": darkened_json(&all) }).to_string());
    Ok(Answer { failure: (!is_known).then(unknown), ..answer })
}

pub(crate) fn run_watch(args: &WatchArgs, stop: &Stop) -> Result<Answer, Failure> {
    let (mut failure, mut before, mut lines) = (Ok(()), Value::Null, 0_u32);
    let show = |seen: &Value| {
        let text = if args.voice.json { seen.to_string() } else { seen_text(&before, seen) };
        (before, lines) = (seen.clone(), lines + 1);
        failure = print(&text);
        if failure.is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let port = port(args.port.as_ref());
    watched(args.voice, stop, |task| watch(port.as_deref(), args.lasts_s, show, task))?;
    failure?;
    let text = if lines == 0 { "nobody drove a head meanwhile" } else { "over" };
    Ok(Answer::new(text, json!({ "over": true, "lines": lines }).to_string()))
}

//! The report's compensators on its linear model, and on both of its sets of masses.

use super::{Places, command, text};
use crate::chapter::{Chapter, Done, Joined, Part, Run};
use crate::table::{Cell, Table};

/// A joint, its loop in both readings, and the report's figures of it.
const LOOPS: [(&str, [&str; 2], [&str; 2]); 2] =
    [("pan", ["K11 G11", "K11t G11"], ["8", "9"]), ("tilt", ["K22 G22", "K22t G22"], ["10", "11"])];
const SETS: [&str; 2] = ["A", "B"];
const READINGS: [&str; 2] = ["as typeset", "time constants"];

impl Places<'_> {
    pub(super) fn loops(&self) -> Chapter {
        let mut parts = vec![text(
            "K11 = 281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177)) and K22 = 144 (s + 31.5)(s + 33.4) / ((s + 194)(s + 83.5)) can be read in two ways: as \
             poles and zeros, as they are typeset, or as the time constants that the design tool of the time showed, 281 (1 + s/32.9) … . The report prints no numbers \
             beside these figures. On set A, whose G11 and G22 it prints, a step overshoots by half if they are read as typeset, and the poles are well damped \
             if they are read as time constants.",
        )];
        for (joint, loops, figures) in LOOPS {
            let caption =
                format!("Figure {}: root locus of {joint}, both readings, one on the other", figures[0]);
            let locus = command(&caption, &["lab", "locus", loops[0], loops[1]])
                .drawn(self, &format!("locus-{joint}.svg"));
            let all =
                [locus, self.bode(joint, loops, figures[1]), self.closed_step(joint, loops, figures[1])];
            parts.extend(all.map(Part::Run));
            if joint == "pan" {
                parts.push(text(
                    "Both readings have the same poles and zeros and differ by a gain: their loci lie on each other, and only the dots, the closed loop's poles at \
                     a gain of 1, tell them apart.",
                ));
            }
        }
        parts.push(text(
            "On set B the same compensators meet a plant some twenty times lighter. There it is the other way round: read as typeset they are well damped, and read as time \
             constants they have hardly any phase left, and a delay margin below the tick of 1 ms: such a loop is unstable as soon as it is sampled. So the sets decide between the readings, and the report does not say which set its compensators were drawn for: its \
             figures show G11 and G22 of set A, its simulation ran set B.",
        ));
        parts.push(Part::Joined(both_sets()));
        for (set, name) in [("A", ""), ("B", "-b")] {
            parts.extend(["pan", "tilt"].map(|joint| Part::Run(self.step_on_the_rig(joint, set, name))));
        }
        Chapter { title: "2.5 Controller design", parts }
    }

    fn bode(&self, joint: &str, loops: [&str; 2], figure: &str) -> Run {
        let caption = format!("Figure {figure}: Bode plot of {joint}");
        command(&caption, &["lab", "bode", loops[0], loops[1]]).drawn(self, &format!("bode-{joint}.svg"))
    }

    fn closed_step(&self, joint: &str, loops: [&str; 2], figure: &str) -> Run {
        let caption = format!("Figure {figure}: step response of {joint}, the loop closed");
        command(&caption, &["lab", "response", loops[0], loops[1], "--closed"])
            .drawn(self, &format!("step-{joint}.svg"))
    }

    fn step_on_the_rig(&self, joint: &str, set: &str, name: &str) -> Run {
        let caption = format!("The same on the nonlinear head of set {set}, and ours: {joint} sent to 15°");
        // as time constants the loops of set B are unstable at a tick of 1 ms
        let laws: &[(&str, &str)] = match set {
            "A" => &[("report-zpk", "as typeset"), ("report-tc", "time constants"), ("state", "ours")],
            _ => &[("report-zpk", "as typeset"), ("state", "ours")],
        };
        let names: Vec<&str> = laws.iter().map(|(law, _)| *law).collect();
        let line = ["lab", "step", "--axis", joint, "--law", &names.join(","), "--set", set];
        let mut run = command(&caption, &line).drawn(self, &format!("rig-step-{joint}{name}.svg"));
        for (k, (law, words)) in laws.iter().enumerate() {
            let why = match *law {
                "report-zpk" => "the motor's limit, friction, gravity on tilt",
                "report-tc" => "from limit to limit: a count is several N m",
                _ => "the goal was none: a reference within the motors' reach, and feedforward",
            };
            let at = |figure: &str| format!("/laws/{k}/{figure}");
            run = run
                .scaled(&format!("overshoot, {words}"), None, &at("overshoot_percent"), (1.0, "%"), why)
                .scaled(
                    &format!("error at rest, {words}"),
                    None,
                    &at("final_error_mm"),
                    (1.0, "mm"),
                    "at 3 ft",
                );
        }
        run
    }
}

/// Margins and steps of each loop on each set.
fn both_sets() -> Joined {
    let mut runs = Vec::new();
    for (_, loops, _) in LOOPS {
        for set in SETS {
            runs.push(command("", &["lab", "bode", loops[0], loops[1], "--set", set]));
            runs.push(command("", &["lab", "response", loops[0], loops[1], "--closed", "--set", set]));
        }
    }
    Joined { caption: "K11 and K22 in both readings on both sets, linear", runs, show: Box::new(table) }
}

fn table(done: &[Done]) -> Table {
    let heads = [
        "loop",
        "set",
        "read as",
        "phase margin",
        "delay margin",
        "distance from −1",
        "overshoot",
        "within 2 % after",
    ];
    let mut rows = Vec::new();
    let names = LOOPS.iter().flat_map(|(joint, ..)| SETS.map(|set| (joint, set)));
    for ((joint, set), pair) in names.zip(done.chunks(2)) {
        for (k, reading) in READINGS.into_iter().enumerate() {
            let of = |which: usize, pointer: &str| {
                pair.get(which)
                    .and_then(|(answer, _)| answer.pointer(&format!("/systems/{k}{pointer}"))?.as_f64())
            };
            let mut row = [*joint, set, reading].map(Cell::words).to_vec();
            row.extend([
                Cell::number(of(0, "/margins/phase/deg"), "°"),
                Cell::number(of(0, "/margins/delay_s").map(|s| 1e3 * s), "ms"),
                Cell::number(of(0, "/margins/modulus/distance"), ""),
                Cell::number(of(1, "/overshoot_percent"), "%"),
                Cell::number(of(1, "/settle_s"), "s"),
            ]);
            rows.push(row);
        }
    }
    Table { heads: heads.map(str::to_owned).to_vec(), rows, finding: String::new() }
}

//! A lesson's examples as curves, and an answer on top of them.

use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Theme};
use tracelight_lab::{Experiment, Graded, Lesson, Quantity};
use tracelight_rig::TICK_F64_S;

use crate::panels::over_time;

/// What one set of values did, under its name.
struct Entry {
    name: String,
    colour: Colour,
    experiments: Vec<Experiment>,
}

/// A lesson's examples, and an answer on top of them.
pub(super) fn figure(lesson: &Lesson, graded: Option<&Graded>) -> Figure {
    let mut colours = Colour::in_turn();
    // blue is the answer's, whether there is one or not
    let mine = colours.next().unwrap_or(Colour::Violet);
    let mut entries: Vec<Entry> = lesson
        .examples
        .iter()
        .zip(colours)
        .map(|((name, values), colour)| Entry {
            name: (*name).to_owned(),
            colour,
            experiments: lesson.experiments(values),
        })
        .collect();
    if let Some(graded) = graded {
        let name = if graded.is_right() { "your answer: right" } else { "your answer: not yet" };
        entries.push(Entry { name: name.into(), colour: mine, experiments: graded.experiments.clone() });
    }
    Figure {
        title: format!("Lesson {}: {}", lesson.number, lesson.title),
        legend: entries.iter().map(|entry| Key::new(entry.colour, &entry.name)).collect(),
        panels: lesson.panels.iter().map(|(number, quantity)| panel(&entries, *number, *quantity)).collect(),
        columns: 1,
        panel: (820, 230),
        theme: Theme::Light,
    }
}

fn panel(entries: &[Entry], number: usize, quantity: Quantity) -> Panel {
    let of = |entry: &Entry| {
        let experiment = entry.experiments.get(number)?;
        Some(Curve { colour: entry.colour, pen: Pen::Solid, points: points(experiment, quantity) })
    };
    let first = entries.first().and_then(|entry| entry.experiments.get(number));
    let name = first.map_or("", |experiment| &experiment.name);
    let levels = match (quantity, first.and_then(|experiment| Some((experiment, experiment.ticks.last()?)))) {
        (Quantity::Angle, Some((experiment, last))) => {
            vec![f64::from(last.setpoint[experiment.joint].position_rad).to_degrees()]
        }
        (Quantity::Error, _) => vec![0.0],
        _ => Vec::new(),
    };
    let mut panel = over_time(quantity.title(), levels, entries.iter().filter_map(of).collect());
    panel.x_title = format!("time, s ({name})");
    panel
}

/// As many points as a panel shows.
fn points(experiment: &Experiment, quantity: Quantity) -> Vec<(f64, f64)> {
    const POINTS: usize = 1500;
    let every = experiment.ticks.len().div_ceil(POINTS).max(1);
    let value = |(number, tick)| (number as f64 * TICK_F64_S, quantity.of(tick, experiment.joint));
    experiment.ticks.iter().enumerate().step_by(every).map(value).collect()
}

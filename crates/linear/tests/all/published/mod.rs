//! Figures that the tests of other projects assert, asked of this crate: python-control, scipy, ControlSystems.jl, Octave's control
//! package, harold.
//!
//! `goldens/published/figures.tsv` has a row a figure: the system as a formula (or the name of one in `systems.jsonl`) and what is done
//! to it after each arrow, the question, the figure as it was published, how far off its source lets it be (or half a digit of those it
//! prints), the source. Numbers alone are taken from there. Where a published figure is rounded beyond that, or is another thing, the
//! last two columns have what is true and why: such a row is explained, and ours has to be the true one.

mod ask;
mod ask_states;
mod system;

use std::collections::BTreeMap;

use tracelight_linear::Complex;
use tracelight_maths::complex;

use ask::answers;
use system::{Library, System, numbers};

/// How near ours is to a true figure, relatively, where the published one is not.
const TRUE: f64 = 1e-9;

struct Row<'a> {
    system: &'a str,
    question: &'a str,
    published: &'a str,
    within: f64,
    source: &'a str,
    truth: &'a str,
    note: &'a str,
}

fn rows() -> Vec<Row<'static>> {
    let lines = include_str!("../../goldens/published/figures.tsv").lines().skip(1);
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.split('\t').collect();
        let [system, question, published, within, source, truth, note] = cells[..] else { panic!("{line}") };
        Row { system, question, published, within: within.parse().unwrap(), source, truth, note }
    };
    lines.map(row).collect()
}

/// How far the nearest of these answers is from a figure: 0 of `none` where there is no answer, or of `inf` where it is infinite.
fn off(answers: &[Complex], figure: &str) -> f64 {
    let is_infinite = |value: &Complex| value.re.is_infinite();
    let right = match figure {
        "none" => answers.is_empty(),
        "inf" => answers.iter().any(is_infinite),
        _ => {
            let figure = numbers(figure)[0];
            let apart = answers.iter().map(|value| complex::norm(value - figure));
            return apart.fold(f64::INFINITY, f64::min);
        }
    };
    if right { 0.0 } else { f64::INFINITY }
}

enum Verdict {
    Right,
    Explained,
    Off(f64),
}

fn verdict(row: &Row<'_>, answers: &[Complex]) -> Verdict {
    if row.truth.is_empty() {
        let off = off(answers, row.published);
        return if off <= row.within { Verdict::Right } else { Verdict::Off(off) };
    }
    assert!(!row.note.is_empty(), "{}, {}: why is {} not true?", row.system, row.question, row.published);
    let off = off(answers, row.truth);
    let allowed = TRUE * complex::norm(numbers(row.truth)[0]);
    if off <= allowed { Verdict::Explained } else { Verdict::Off(off) }
}

#[test]
#[allow(
    clippy::print_stdout,
    reason = "the table's outcome is what the test is run for: --nocapture shows it"
)]
fn what_other_projects_assert_is_what_we_answer() {
    let library = Library::read();
    let (mut counts, mut wrong) = (BTreeMap::<&str, [usize; 3]>::new(), Vec::new());
    let rows = rows();
    for row in &rows {
        let answers = answers(&System::made(row.system, &library), row.question);
        let count = counts.entry(row.source.split(' ').next().unwrap()).or_default();
        match verdict(row, &answers) {
            Verdict::Right => count[0] += 1,
            Verdict::Explained => count[1] += 1,
            Verdict::Off(by) => {
                count[2] += 1;
                wrong.push(format!(
                    "{}: {}: {answers:?}, {} by {}: off by {by:.2e}",
                    row.system, row.question, row.published, row.source
                ));
            }
        }
    }
    for (project, [right, explained, off]) in &counts {
        println!("{project}: {right} right, {explained} explained, {off} off");
    }
    println!("{} figures, {} off", rows.len(), wrong.len());
    assert!(rows.len() >= 400 && counts.len() >= 3, "{} figures of {} projects", rows.len(), counts.len());
    assert!(wrong.is_empty(), "{} of {} are off:\n{}", wrong.len(), rows.len(), wrong.join("\n"));
}

#[test]
fn a_wrong_figure_is_found() {
    let system = System::made("1/(s+1)", &Library::read());
    let row = |question, published, truth| Row {
        system: "1/(s+1)",
        question,
        published,
        within: 1e-6,
        source: "nobody",
        truth,
        note: "a test",
    };
    for (question, published, truth) in [
        ("gain at rest", "1.1", ""),
        ("gain at rest", "none", ""),
        ("gain margin", "2", ""),
        ("pole", "-1+0.1j", ""),
        ("gain at rest", "1.1", "1.01"),
    ] {
        let row = row(question, published, truth);
        assert!(
            matches!(verdict(&row, &answers(&system, question)), Verdict::Off(_)),
            "{question} {published}"
        );
    }
    let explained = row("gain at rest", "1.1", "1");
    assert!(matches!(verdict(&explained, &answers(&system, "gain at rest")), Verdict::Explained));
}

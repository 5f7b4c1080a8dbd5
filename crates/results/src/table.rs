//! The list of runs for people.

use tracelight_task::counted;
use unicode_width::UnicodeWidthStr;

use crate::listed::ListedRun;

/// What a line of the table says.
fn cells(run: &ListedRun) -> [String; 5] {
    let mm = |m: f64| 1e3 * m;
    let [width, height] = run.asked.size_m;
    let time = run.summary["run"]["duration_s"].as_f64();
    [
        // to the minute
        run.asked.begun.chars().take(16).collect(),
        format!("{:.0} × {:.0} mm", mm(width), mm(height)),
        time.map_or_else(|| "–".to_owned(), |s| format!("{s:.1} s")),
        run.rms_mm().map_or_else(|| "–".to_owned(), |mm| format!("{mm:.3} mm")),
        format!("{}: {}", run.dir.display(), run.how_far()),
    ]
}

/// A table of runs for people, as wide as it needs to be.
#[must_use]
pub fn table(runs: &[ListedRun]) -> String {
    let head = ["begun (UTC)", "size", "time", "rms error", "run, and how far it came"].map(str::to_owned);
    let lines: Vec<[String; 5]> = std::iter::once(head).chain(runs.iter().map(cells)).collect();
    let widths: [usize; 5] =
        std::array::from_fn(|i| lines.iter().map(|line| line[i].width()).max().unwrap_or_default());
    let shown = |line: &[String; 5]| {
        let cells = line.iter().zip(widths).map(|(cell, width)| {
            // by what it takes on a screen
            format!("{cell}{}", " ".repeat(width - cell.width()))
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let left = runs.iter().filter(|run| run.is_left()).count();
    let hint = match left {
        0 => String::new(),
        _ => format!("\n{} not finished: tracelight resume FOLDER goes on with one", counted(left, "run")),
    };
    let simulated = if runs.iter().all(|run| run.summary["simulated"] != false) {
        "\nall of them on the simulated rig"
    } else {
        ""
    };
    lines.iter().map(shown).collect::<Vec<_>>().join("\n") + simulated + &hint
}

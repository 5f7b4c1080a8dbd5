//! Many verdicts in a table.

use crate::verdict::Verdict;
use crate::{Case, Degradation};

/// A case and what became of it.
pub type Judged = (Case, Verdict);

/// Heads of the columns of [`row`].
pub const HEAD: &str = "| | pictures | exact | ±2 | matched | right | rms median | rms p95 | missed | false | doubled | length | refused | flying px | as outline |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|";

/// One row: how the pictures of a group fared. Shares in %, rms in px; a refused picture is wrong and misses all its
/// ink. Flying light is px a picture.
pub fn row(name: &str, group: &[&Judged]) -> String {
    let n = group.len().max(1) as f64;
    let share =
        |test: &dyn Fn(&Verdict) -> bool| 100.0 * group.iter().filter(|(_, v)| test(v)).count() as f64 / n;
    // summed from zero: the sum of no floats is −0
    let mean = |of: &dyn Fn(&Verdict) -> f64| group.iter().fold(0.0, |sum, (_, v)| sum + of(v)) / n;
    let scores = || group.iter().filter_map(|(_, v)| v.score);
    let mut rms: Vec<f64> = scores().map(|s| s.rms).collect();
    rms.sort_by(f64::total_cmp);
    let strokes: usize = group.iter().map(|(_, v)| v.truth).sum();
    let matched: usize = scores().map(|s| s.matched).sum();
    let mut lengths: Vec<f64> = scores().map(|s| s.length_ratio).collect();
    lengths.sort_by(f64::total_cmp);
    format!(
        "| {name} | {} | {:.1} | {:.1} | {:.1} | {:.1} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.3} | {:.1} | {:.1} | {:.1} |",
        group.len(),
        share(&|v| v.surplus() == 0),
        share(&|v| v.surplus().abs() <= 2 && v.refused.is_none()),
        100.0 * matched as f64 / strokes.max(1) as f64,
        share(&|v| v.score.is_some_and(|s| s.is_right())),
        quantile(&rms, 0.5),
        quantile(&rms, 0.95),
        mean(&|v| 100.0 * v.score.map_or(1.0, |s| s.missed)),
        mean(&|v| 100.0 * v.score.map_or(0.0, |s| s.stray)),
        mean(&|v| 100.0 * v.score.map_or(0.0, |s| s.doubled)),
        quantile(&lengths, 0.5),
        share(&|v| v.refused.is_some()),
        mean(&|v| v.astray.flying_px),
        mean(&|v| 100.0 * v.astray.outlined),
    )
}

fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = (share * sorted.len() as f64) as usize;
    sorted.get(at.min(sorted.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

/// Everything: all, by kind, by degradation, by size, and kinds × degradations.
pub fn tables(judged: &[Judged]) -> String {
    let mut lines = vec![HEAD.to_owned(), row("**all**", &judged.iter().collect::<Vec<_>>())];
    let mut add = |name: String, test: &dyn Fn(&Case) -> bool| {
        let group: Vec<_> = judged.iter().filter(|(case, _)| test(case)).collect();
        if !group.is_empty() {
            lines.push(row(&name, &group));
        }
    };
    seen(judged, |c| c.kind).iter().for_each(|&k| add(k.name(), &|c| c.kind == k));
    seen(judged, |c| c.degradation).iter().for_each(|&d| add(d.name(), &|c| c.degradation == d));
    seen(judged, |c| c.size).iter().for_each(|&s| add(s.to_string(), &|c| c.size == s));
    lines.push(String::new());
    lines.push(matrix(judged));
    lines.join("\n")
}

/// What the cases have of something, each once, in order.
fn seen<T: Ord>(judged: &[Judged], of: impl Fn(&Case) -> T) -> Vec<T> {
    let mut all: Vec<T> = judged.iter().map(|(case, _)| of(case)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Share of pictures with exactly the true number of strokes, %, kinds down and degradations across.
fn matrix(judged: &[Judged]) -> String {
    let across: Vec<Degradation> = seen(judged, |c| c.degradation);
    let names: Vec<_> = across.iter().map(|d| d.name()).collect();
    let mut lines = vec![
        format!("| exact, % | {} |", names.join(" | ")),
        format!("|---{}|", "|---".repeat(across.len())),
    ];
    for kind in seen(judged, |c| c.kind) {
        let cell = |&d: &Degradation| {
            let group = judged.iter().filter(|(c, _)| c.kind == kind && c.degradation == d);
            let exact: Vec<bool> = group.map(|(_, v)| v.surplus() == 0).collect();
            let count = exact.iter().filter(|&&e| e).count();
            if exact.is_empty() { "–".to_owned() } else { format!("{}", 100 * count / exact.len()) }
        };
        let cells: Vec<_> = across.iter().map(cell).collect();
        lines.push(format!("| {} | {} |", kind.name(), cells.join(" | ")));
    }
    lines.join("\n")
}

/// A line for each picture, comma-separated, with a head.
pub fn csv(judged: &[Judged]) -> String {
    let head = "case,kind,degradation,width,height,truth,drawn,matched,rms_px,max_px,missed,stray,doubled,length_ratio,\
                trace_ms,flying_px,outlined,refused\n";
    let line = |(case, v): &Judged| {
        let figures = v.score.map_or_else(
            || ",,,,,,".to_owned(),
            |s| {
                format!(
                    "{},{:.4},{:.3},{:.5},{:.5},{:.5},{:.5}",
                    s.matched, s.rms, s.max, s.missed, s.stray, s.doubled, s.length_ratio
                )
            },
        );
        format!(
            "{case},{},{},{},{},{},{},{figures},{:.2},{:.1},{:.4},\"{}\"\n",
            case.kind.name(),
            case.degradation.name(),
            case.size.width,
            case.size.height,
            v.truth,
            v.found.strokes.len(),
            1e3 * v.took.as_secs_f64(),
            v.astray.flying_px,
            v.astray.outlined,
            v.refused.as_deref().unwrap_or("").replace('"', "'"),
        )
    };
    judged.iter().map(line).fold(head.to_owned(), |all, line| all + &line)
}

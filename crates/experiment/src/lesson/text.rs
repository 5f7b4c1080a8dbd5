//! The lessons' texts: one source for terminal and `docs/lessons`.

use tracelight_lab::Lesson;

/// A lesson as it stands in `docs/lessons`.
pub(super) const fn markdown(number: usize) -> &'static str {
    match number {
        1 => include_str!("../../../../docs/lessons/1.md"),
        2 => include_str!("../../../../docs/lessons/2.md"),
        3 => include_str!("../../../../docs/lessons/3.md"),
        4 => include_str!("../../../../docs/lessons/4.md"),
        5 => include_str!("../../../../docs/lessons/5.md"),
        6 => include_str!("../../../../docs/lessons/6.md"),
        7 => include_str!("../../../../docs/lessons/7.md"),
        8 => include_str!("../../../../docs/lessons/8.md"),
        _ => "",
    }
}

/// A line with the words of its links alone.
fn unlinked(line: &str) -> String {
    let mut text = line.to_owned();
    while let Some((before, rest)) = text.split_once('[')
        && let Some((words, rest)) = rest.split_once("](")
        && let Some((_, after)) = rest.split_once(')')
    {
        text = format!("{before}{words}{after}");
    }
    text
}

/// The same for a terminal: without pictures, fences and marks.
pub(super) fn plain(lesson: &Lesson) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut fenced = false;
    for line in markdown(lesson.number).lines() {
        if line.starts_with("```") {
            fenced = !fenced;
        } else if line.starts_with("![") {
            lines.push(format!("(Plot: tracelight lab lesson {0} -o lesson-{0}.svg)", lesson.number));
        } else if fenced {
            lines.push(format!("    {line}"));
        } else if let Some(heading) = line.strip_prefix("## ") {
            lines.push(heading.to_uppercase());
        } else if let Some(title) = line.strip_prefix("# ") {
            lines.push(title.to_owned());
            lines.push("=".repeat(title.chars().count()));
        } else {
            lines.push(unlinked(line).replace("**", ""));
        }
    }
    lines.join("\n")
}

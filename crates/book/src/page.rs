//! The book as one page.

use std::fmt::Write;

use serde_json::Value;
use tracelight_chart::page_colours;
use tracelight_maths::log10;
use tracelight_report::html::escaped;

use crate::chapter::{Chapter, Compared, Fact, Part, Run};

/// The page, from chapters and what their commands came to, in order.
pub(crate) fn page(chapters: &[Chapter], done: &[(Value, Option<String>)]) -> String {
    let mut done = done.iter();
    let mut body = String::new();
    let mut contents = String::new();
    for (number, chapter) in chapters.iter().enumerate() {
        // writing to a String cannot fail
        let _ = write!(contents, "<li><a href=\"#c{number}\">{}</a></li>", escaped(chapter.title));
        let _ = write!(body, "<h2 id=\"c{number}\">{}</h2>", escaped(chapter.title));
        for part in &chapter.parts {
            body += &match part {
                Part::Text(text) => format!("<p>{}</p>", escaped(text)),
                Part::Drawing(caption, svg) => figure(caption, None, svg),
                Part::Facts(facts) => table(chapter.title, facts),
                Part::Run(run) => done
                    .next()
                    .map_or(String::new(), |(answer, figure)| shown(run, answer, figure.as_deref())),
            };
        }
    }
    format!(
        include_str!("page.html"),
        style = page_colours() + include_str!("style.css"),
        contents = contents,
        body = body,
        version = env!("CARGO_PKG_VERSION"),
    )
}

/// Every number that is compared, in order, with its figure and its command.
pub(crate) fn all_compared(
    chapters: &[Chapter],
    done: &[(Value, Option<String>)],
) -> Vec<(String, String, Compared)> {
    let mut done = done.iter();
    let mut all = Vec::new();
    for chapter in chapters {
        for part in &chapter.parts {
            match part {
                Part::Run(run) => {
                    let answer = done.next();
                    let one = |(fact, answer): (&Fact, &Value)| {
                        (run.caption.clone(), command_of(run), fact.compared(answer))
                    };
                    all.extend(
                        answer
                            .into_iter()
                            .flat_map(|(answer, _)| run.facts.iter().map(move |f| one((f, answer)))),
                    );
                }
                Part::Facts(facts) => {
                    all.extend(
                        facts.iter().map(|fact| (chapter.title.to_owned(), String::new(), fact.clone())),
                    );
                }
                Part::Text(_) | Part::Drawing(..) => {}
            }
        }
    }
    all
}

fn shown(run: &Run, answer: &Value, svg: Option<&str>) -> String {
    let command =
        format!("tracelight {}", run.arguments.iter().map(|a| quoted(a)).collect::<Vec<_>>().join(" "));
    let facts: Vec<Compared> = run.facts.iter().map(|fact| fact.compared(answer)).collect();
    let facts = if facts.is_empty() { String::new() } else { table(&run.caption, &facts) };
    // a figure is part of the page: what stands before its root element is of files
    let inner = svg.map_or(String::new(), |svg| {
        svg[svg.find("<svg").unwrap_or(0)..].replace(" id=\"stroke-", " data-id=\"stroke-")
    });
    figure(&run.caption, Some(&command), &inner) + &facts
}

/// As it is typed.
fn command_of(run: &Run) -> String {
    format!("tracelight {}", run.arguments.iter().map(|a| quoted(a)).collect::<Vec<_>>().join(" "))
}

fn figure(caption: &str, command: Option<&str>, svg: &str) -> String {
    let command = command.map_or(String::new(), |command| format!("<code>{}</code>", escaped(command)));
    let picture = if svg.is_empty() { String::new() } else { framed(caption, svg) };
    format!("<figure><figcaption>{}{command}</figcaption>{picture}</figure>", escaped(caption))
}

/// What of its own width a figure keeps, so that its smallest letters, 12 high, are never below 11; what is wider than the page scrolls.
const LEAST: f64 = 11.0 / 12.0;

/// A drawing in a box of its own, which the keyboard reaches. A plot is in the page's colours; what has none of its own for the dark
/// hangs on white.
fn framed(caption: &str, svg: &str) -> String {
    let is_plot = svg.contains("class=\"blocks\"") || svg.contains("prefers-color-scheme");
    let class = if is_plot { "plot" } else { "plot light-wall" };
    let width = width_px(svg).filter(|_| is_plot);
    let sizes = width.map_or(String::new(), |px| {
        format!(" style=\"--least:{:.0}px;--most:{:.0}px\"", (px * LEAST).ceil(), px * 1.2)
    });
    let caption = escaped(caption);
    format!(
        "<div class=\"{class}\"{sizes} tabindex=\"0\" role=\"group\" aria-label=\"{caption}, drawn\">{svg}</div>"
    )
}

/// How wide a drawing is by itself, if it says so in pixels.
fn width_px(svg: &str) -> Option<f64> {
    let root = svg.split_once('>')?.0;
    let value = root.split_once(" width=\"")?.1.split_once('"')?.0;
    value.parse().ok()
}

/// An argument as a shell takes it.
fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+".contains(c);
    if argument.chars().all(plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', "'\\''"))
    }
}

/// The report's number, ours, by how much they differ, why; ours alone where the report has none.
fn table(caption: &str, facts: &[Compared]) -> String {
    let with_report = facts.iter().any(|fact| fact.report.is_some());
    let of = if with_report { &["report", "here", "difference"][..] } else { &["here"] };
    let heads: String = of.iter().map(|head| format!("<th scope=\"col\" class=\"n\">{head}</th>")).collect();
    let mut text = format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{}, in numbers\"><table>\
         <tr><th scope=\"col\">number</th>{heads}<th scope=\"col\">why</th></tr>",
        escaped(caption)
    );
    for fact in facts {
        let cell =
            |text: Option<String>| format!("<td class=\"n\">{}</td>", text.unwrap_or_else(|| "–".to_owned()));
        let number = |value: Option<f64>| value.map(|v| format!("{} {}", digits(v), escaped(fact.unit)));
        let numbers = if with_report {
            cell(number(fact.report)) + &cell(number(fact.ours)) + &cell(difference(fact))
        } else {
            cell(number(fact.ours))
        };
        let (what, why) = (escaped(&fact.what), escaped(&fact.why));
        // writing to a String cannot fail
        let _ = write!(text, "<tr><td>{what}</td>{numbers}<td>{why}</td></tr>");
    }
    text + "</table></div>"
}

/// By how much ours is more than the report's.
fn difference(fact: &Compared) -> Option<String> {
    let (report, ours) = fact.report.zip(fact.ours)?;
    if report == 0.0 {
        return Some(digits(ours));
    }
    let percent = 100.0 * (ours / report - 1.0);
    Some(match percent.abs() {
        p if p < 0.005 => "0.00 %".to_owned(),
        p if p < 10.0 => format!("{percent:+.2} %").replace('-', "−"),
        _ => format!("{percent:+.0} %").replace('-', "−"),
    })
}

/// Five digits, without idle zeros.
fn digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let whole = log10(value.abs()).floor() as i32;
    let after = (4 - whole).clamp(0, 8) as usize;
    let text = format!("{value:.after$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_differences_read_well() {
        assert_eq!(digits(0.000_900_14), "0.00090014");
        assert_eq!(digits(-13.160_448), "−13.16");
        assert_eq!(digits(281.0), "281");
        let of = |report: f64, ours: f64| Compared {
            what: String::new(),
            report: Some(report),
            ours: Some(ours),
            unit: "",
            why: String::new(),
        };
        assert_eq!(difference(&of(2.0, 2.1)), Some("+5.00 %".to_owned()));
        assert_eq!(difference(&of(1.0, 3.4)), Some("+240 %".to_owned()));
        assert_eq!(difference(&of(13.16, 13.1603)), Some("0.00 %".to_owned()));
        assert_eq!(difference(&of(0.0, 0.5)), Some("0.5".to_owned()));
    }

    #[test]
    fn a_plot_keeps_its_letters_and_a_drawing_its_paper() {
        let plot =
            framed("A step", "<svg width=\"1200\" height=\"2\"><style>prefers-color-scheme</style></svg>");
        assert!(plot.contains("--least:1100px") && plot.contains("tabindex=\"0\""), "{plot}");
        let drawing = framed("A star", "<svg width=\"609.6mm\" viewBox=\"0 0 1 1\"></svg>");
        assert!(drawing.contains("light-wall") && !drawing.contains("--least"), "{drawing}");
    }

    #[test]
    fn a_command_can_be_pasted() {
        assert_eq!(quoted("K11 G11"), "'K11 G11'");
        assert_eq!(quoted("--out"), "--out");
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}

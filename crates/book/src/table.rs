//! Tables of a page, and how numbers read in them.

use std::fmt::Write;

use tracelight_maths::log10;
use tracelight_report::html::escaped;

/// A number of the report beside ours.
#[derive(Clone)]
pub(crate) struct Compared {
    pub(crate) what: String,
    pub(crate) report: Option<f64>,
    pub(crate) ours: Option<f64>,
    pub(crate) unit: &'static str,
    pub(crate) why: String,
}

/// Rows of text under heads, and what follows from them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub(crate) heads: Vec<String>,
    pub(crate) rows: Vec<Vec<Cell>>,
    /// A sentence or two.
    pub(crate) finding: String,
}

/// A place in a table.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) text: String,
    pub(crate) kind: Kind,
}

/// What stands in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Words,
    Number,
    /// Something that fits what is asked,
    Fits,
    /// or does not.
    Misses,
}

impl Cell {
    pub(crate) fn words(text: impl Into<String>) -> Self {
        Self { text: text.into(), kind: Kind::Words }
    }

    /// Five digits and a unit; a dash for none.
    pub(crate) fn number(value: Option<f64>, unit: &str) -> Self {
        let text = value.map_or_else(|| "–".to_owned(), |v| format!("{} {unit}", digits(v)));
        Self { text: text.trim_end().to_owned(), kind: Kind::Number }
    }

    fn html(&self) -> String {
        let (class, mark) = match self.kind {
            Kind::Words => ("", ""),
            Kind::Number => (" class=\"n\"", ""),
            Kind::Fits => (" class=\"fits\"", "✓ "),
            Kind::Misses => (" class=\"misses\"", "✗ "),
        };
        format!("<td{class}>{mark}{}</td>", escaped(&self.text))
    }
}

impl Table {
    pub(crate) fn html(&self, caption: &str) -> String {
        let head = |(column, head): (usize, &String)| {
            let number =
                self.rows.first().and_then(|row| row.get(column)).is_some_and(|c| c.kind == Kind::Number);
            let class = if number { " class=\"n\"" } else { "" };
            format!("<th scope=\"col\"{class}>{}</th>", escaped(head))
        };
        let heads: String = self.heads.iter().enumerate().map(head).collect();
        let row = |row: &Vec<Cell>| format!("<tr>{}</tr>", row.iter().map(Cell::html).collect::<String>());
        let rows: String = self.rows.iter().map(row).collect();
        let finding = if self.finding.is_empty() {
            String::new()
        } else {
            format!("<p>{}</p>", escaped(&self.finding))
        };
        format!("{}<table class=\"wide\"><tr>{heads}</tr>{rows}</table></div>{finding}", scroll(caption))
    }
}

fn scroll(caption: &str) -> String {
    format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{}, in numbers\">",
        escaped(caption)
    )
}

/// The report's number, ours, by how much they differ, why; ours alone where the report has none.
pub(crate) fn compared(caption: &str, facts: &[Compared]) -> String {
    let with_report = facts.iter().any(|fact| fact.report.is_some());
    let of = if with_report { &["report", "here", "difference"][..] } else { &["here"] };
    let heads: String = of.iter().map(|head| format!("<th scope=\"col\" class=\"n\">{head}</th>")).collect();
    let mut text = format!(
        "{}<table><tr><th scope=\"col\">number</th>{heads}<th scope=\"col\">why</th></tr>",
        scroll(caption)
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
pub(crate) fn digits(value: f64) -> String {
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
    fn a_cell_says_whether_it_fits_without_its_colour() {
        let cell = |kind| Cell { text: "a < b".into(), kind }.html();
        assert!(cell(Kind::Fits).contains("✓ a &lt; b") && cell(Kind::Misses).contains("✗ "));
        assert_eq!(Cell::number(None, "mm").text, "–");
    }
}

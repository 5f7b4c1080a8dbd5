//! What became of the pictures, as a table of 80 columns.

use std::fmt::Write;

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::row::{Outcome, Row, Totals, time};

/// A terminal's width where nobody changed it.
const COLUMNS: usize = 80;
/// Headings of the columns after the picture's, and their widths.
const HEADINGS: [(&str, usize); 6] =
    [("strokes", 7), ("closed", 6), ("length", 10), ("missed", 6), ("time", 6), ("verdict", 7)];
/// Between columns.
const GAP: usize = 2;

/// A row a picture, then two lines of totals.
pub(crate) fn text(rows: &[Row], totals: &Totals) -> String {
    let rest: usize = HEADINGS.iter().map(|(_, width)| GAP + width).sum();
    let longest = rows.iter().map(|row| plain(&row.picture).width()).max().unwrap_or(0);
    let width = longest.clamp("picture".len(), COLUMNS - rest);
    let mut text = String::new();
    let headings = HEADINGS.map(|(heading, _)| heading.to_owned());
    line(&mut text, &padded("picture", width), &headings);
    for row in rows {
        let name = padded(&shortened(&row.picture, width), width);
        match &row.outcome {
            Outcome::Done { .. } => line(&mut text, &name, &cells(row)),
            Outcome::Failed(failure) => failed(&mut text, &name, width, &failure.message),
        }
    }
    text + &totals.text()
}

fn line(text: &mut String, name: &str, cells: &[String; 6]) {
    text.push_str(name);
    let (verdict, figures) = (&cells[5], &cells[..5]);
    for (cell, (_, width)) in figures.iter().zip(HEADINGS) {
        let _ = write!(text, "{:GAP$}{cell:>width$}", ""); // writing to a String cannot fail
    }
    let _ = writeln!(text, "{:GAP$}{verdict}", "");
}

fn cells(row: &Row) -> [String; 6] {
    let Outcome::Done { figures, timing_ms, kept, .. } = &row.outcome else { return Default::default() };
    let verdict = match (kept, &figures.doubt, &figures.quality) {
        (true, ..) => "kept",
        (false, Some(_), _) => "look",
        (false, None, Some(quality)) => &quality.verdict,
        (false, None, None) => "ok",
    };
    [
        figures.strokes.to_string(),
        figures.closed.to_string(),
        format!("{:.0} {}", figures.length, figures.unit.name()),
        figures.missed_ink.map_or_else(|| "-".to_owned(), |share| format!("{:.1} %", 100.0 * share)),
        time(*timing_ms),
        verdict.to_owned(),
    ]
}

/// A row whose columns are taken by the reason, on as many lines as it needs.
fn failed(text: &mut String, name: &str, width: usize, message: &str) {
    let mut lead = name;
    let blank = " ".repeat(width);
    for part in wrapped(&plain(&format!("failed: {message}")), COLUMNS - width - GAP) {
        let _ = writeln!(text, "{lead}{:GAP$}{part}", ""); // writing to a String cannot fail
        lead = &blank;
    }
}

/// Lines of at most `width` columns, broken at spaces; a word that is longer stays whole, to be copied.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.width() + 1 + word.width() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A name in at most `width` columns: its middle gives way, since folders and numbers stand at its ends.
pub(crate) fn shortened(name: &str, width: usize) -> String {
    let name = plain(name);
    if name.width() <= width {
        return name;
    }
    let head = fitting(name.chars(), width / 2);
    let tail: String =
        fitting(name.chars().rev(), width.saturating_sub(head.width() + 1)).chars().rev().collect();
    format!("{head}…{tail}")
}

/// As many characters as fit into `width` columns.
fn fitting(characters: impl Iterator<Item = char>, width: usize) -> String {
    let mut used = 0;
    let fits = |c: &char| {
        used += c.width().unwrap_or(0);
        used <= width
    };
    characters.take_while(fits).collect()
}

/// Without what would move a terminal's cursor.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { '\u{FFFD}' } else { c }).collect()
}

fn padded(name: &str, width: usize) -> String {
    format!("{name}{}", " ".repeat(width.saturating_sub(name.width())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::{Figures, Unit};
    use tracelight_task::Failure;

    fn done(picture: &str, kept: bool, doubt: Option<&str>) -> Row {
        let figures = Figures {
            strokes: 9,
            closed: 2,
            length: 1234.4,
            sheet: (600.0, 400.0),
            unit: Unit::Mm,
            missed_ink: doubt.map(|_| 0.031),
            doubt: doubt.map(str::to_owned),
            quality: None,
        };
        Row { picture: picture.to_owned(), outcome: Outcome::Done { figures, timing_ms: 12.3, kept } }
    }

    fn failed(picture: &str, message: &str) -> Row {
        let outcome = Outcome::Failed(Failure::usage("malformed", message));
        Row { picture: picture.to_owned(), outcome }
    }

    #[test]
    fn the_table_is_aligned_and_ends_with_totals() {
        let rows =
            [done("a.png", false, None), done("long name.png", true, None), failed("b.png", "is broken")];
        let totals = Totals::of(&rows, 2000.0);
        let expected = "\
picture        strokes  closed      length  missed    time  verdict
a.png                9       2     1234 mm       -   12 ms  ok
long name.png        9       2     1234 mm       -   12 ms  kept
b.png          failed: is broken
3 pictures: 1 traced, 1 kept, 1 failed
18 strokes; 2.0 s, 1.0 pictures a second";
        assert_eq!(text(&rows, &totals), expected);
    }

    #[test]
    fn no_row_is_wider_than_a_terminal() {
        let long = "photographs/of the summer/Ελλάδα 猫猫猫猫猫猫 2025-08-13 12.45.01\n(copy).jpeg";
        let reason =
            "it is none of PNG, JPEG, WebP, BMP, GIF, PNM, TIFF, SVG, JSON or CSV; save it again ".repeat(3);
        let rows = [done(long, false, Some("lines run together")), failed(long, &reason)];
        let table = text(&rows, &Totals::of(&rows, 1.0));
        assert!(table.lines().count() > 6 && table.contains("look") && table.contains('…'), "{table}");
        for line in table.lines() {
            assert!(line.width() <= COLUMNS, "{} columns: {line}", line.width());
        }
    }

    #[test]
    fn a_long_name_loses_its_middle() {
        assert_eq!(shortened("photos/holiday/IMG_0001.jpg", 15), "photos/…001.jpg");
        assert_eq!(shortened("photos/IMG.jpg", 14), "photos/IMG.jpg");
        assert_eq!(shortened("猫猫猫猫猫猫", 7), "猫…猫猫");
    }
}

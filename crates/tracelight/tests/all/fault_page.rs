//! `docs/faults.md`: its two tables are printed from `rig`'s, and what it compares us with names only codes that exist.

use tracelight_rig::{Darkness, Fault, Measure};

use crate::support;

/// A table of Markdown.
fn table(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let head: Vec<String> = head.iter().map(|&cell| cell.to_owned()).collect();
    let mut text = line(&head) + &format!("|{}\n", "---|".repeat(head.len()));
    rows.for_each(|cells| text += &line(&cells));
    text
}

fn faults() -> String {
    let head = [
        "fault",
        "number",
        "when it is seen",
        "how soon",
        "what is measured",
        "what is done",
        "how it clears",
    ];
    let rows = Fault::TABLE.iter().map(|row| {
        let lost = if row.loses_counts { ", and counts may be lost" } else { "" };
        vec![
            format!("`{}`", row.code),
            row.number.to_string(),
            row.seen.to_owned(),
            row.soon.to_string(),
            match row.measure {
                Measure::NONE => "–".to_owned(),
                Measure { unit, what, .. } => format!("{unit} {what}"),
            },
            format!("dark; {}{lost}", row.motors.words()),
            row.clears.words().to_owned(),
        ]
    });
    table(&head, rows)
}

fn darknesses() -> String {
    let rows = Darkness::TABLE.iter().map(|row| {
        let what = row.what.replace("[`Fault`](crate::Fault)", "fault");
        vec![format!("`{}`", row.code), row.bit.to_string(), what, row.advice.to_owned()]
    });
    table(&["reason", "bit", "when it holds", "what to do"], rows)
}

/// The page with what stands between `<!-- NAME -->` and `<!-- end -->` printed anew.
fn renewed(page: &str, name: &str, table: &str) -> String {
    let begin = format!("<!-- {name} -->\n");
    let (before, rest) = page.split_once(&begin).unwrap();
    let (_, after) = rest.split_once("<!-- end -->").unwrap();
    format!("{before}{begin}{table}<!-- end -->{after}")
}

#[test]
fn the_page_on_faults_is_printed_from_their_tables() {
    let path = support::root().join("docs/faults.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let new = renewed(&renewed(&page, "faults", &faults()), "darknesses", &darknesses());
    if std::env::var_os("RENEW_DOCS").is_none() {
        assert_eq!(new, page, "RENEW_DOCS=1 prints it anew");
    } else if new != page {
        std::fs::write(path, new).unwrap();
    }
}

#[test]
fn the_page_on_faults_compares_by_codes_that_exist() {
    let page = std::fs::read_to_string(support::root().join("docs/faults.md")).unwrap();
    let (_, others) = page.split_once("## What other controllers watch").unwrap();
    let codes: Vec<&str> = others.split('`').skip(1).step_by(2).collect();
    assert!(codes.len() > 15, "only {} codes", codes.len());
    for code in codes {
        assert!(Fault::from_code(code).is_some() || Darkness::from_code(code).is_some(), "`{code}`");
    }
}

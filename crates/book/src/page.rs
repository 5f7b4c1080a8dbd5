//! The book as one page.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};
use tracelight_chart::page_colours;
use tracelight_report::html::escaped;
use tracelight_task::quoted;

use crate::chapter::{Chapter, Done, Fact, Joined, Part, Run};
use crate::table::{self, Cell, Compared};

/// The page, from chapters and what their commands came to, in order.
pub(crate) fn page(book: &Path, chapters: &[Chapter], done: &[Done]) -> String {
    let mut page = Page { book, left: done, figures: 0, body: String::new() };
    let mut contents = String::new();
    for (number, chapter) in chapters.iter().enumerate() {
        // writing to a String cannot fail
        let _ = write!(contents, "<li><a href=\"#c{number}\">{}</a></li>", escaped(chapter.title));
        let _ = write!(page.body, "<h2 id=\"c{number}\">{}</h2>", escaped(chapter.title));
        chapter.parts.iter().for_each(|part| page.add(part));
    }
    format!(
        include_str!("page.html"),
        style = page_colours() + include_str!("style.css"),
        contents = contents,
        body = page.body,
        version = env!("CARGO_PKG_VERSION"),
    )
}

/// A page that is being filled.
struct Page<'a> {
    book: &'a Path,
    /// What the commands came to that are still to be shown.
    left: &'a [Done],
    /// How many can be enlarged.
    figures: usize,
    body: String,
}

impl Page<'_> {
    fn add(&mut self, part: &Part) {
        let (done, left) = self.left.split_at(part.runs().len().min(self.left.len()));
        self.left = left;
        let shown = match part {
            Part::Text(text) => format!("<p>{}</p>", escaped(text)),
            Part::Drawing(caption, svg) => self.figure(caption, "", svg),
            Part::Facts(caption, facts) => {
                format!("<h3>{}</h3>{}", escaped(caption), table::compared(caption, facts))
            }
            Part::List(items) => list(items),
            Part::Run(run) => done.first().map_or(String::new(), |done| self.run(run, done)),
            Part::Joined(joined) => self.joined(joined, done),
        };
        self.body += &shown;
    }

    fn run(&mut self, run: &Run, (answer, file): &Done) -> String {
        let facts: Vec<Compared> = run.facts.iter().map(|fact| fact.compared(answer)).collect();
        let facts = if facts.is_empty() { String::new() } else { table::compared(&run.caption, &facts) };
        // a figure is part of the page: what stands before its root element is of files
        let inner = file.as_deref().and_then(|text| text.find("<svg").map(|at| &text[at..]));
        // titles name files as their command does
        let folder = format!("{}/", self.book.display());
        let inner = inner.map_or(String::new(), |svg| {
            svg.replace(" id=\"stroke-", " data-id=\"stroke-").replace(&folder, "")
        });
        self.figure(&run.caption, &shown_command(self.book, run), &inner) + &facts
    }

    fn joined(&self, joined: &Joined, done: &[Done]) -> String {
        let commands: String = joined.runs.iter().map(|run| shown_command(self.book, run)).collect();
        let count = match joined.runs.len() {
            1 => "1 command".to_owned(),
            many => format!("{many} commands"),
        };
        format!(
            "<figure><figcaption>{}</figcaption><details><summary>{count}</summary>{commands}</details>{}</figure>",
            escaped(joined.caption),
            (joined.show)(done).html(joined.caption)
        )
    }

    fn figure(&mut self, caption: &str, command: &str, svg: &str) -> String {
        let picture = if svg.is_empty() {
            String::new()
        } else {
            self.figures += 1;
            let id = self.figures;
            let what = escaped(caption);
            format!(
                "<input type=\"checkbox\" class=\"larger\" id=\"f{id}\" aria-label=\"enlarge: {what}\"><label for=\"f{id}\" \
                 aria-hidden=\"true\"></label>{}",
                framed(caption, svg)
            )
        };
        format!("<figure><figcaption>{}{command}</figcaption>{picture}</figure>", escaped(caption))
    }
}

fn list(items: &[(&str, &str)]) -> String {
    let one = |(what, why): &(&str, &str)| format!("<dt>{}</dt><dd>{}</dd>", escaped(what), escaped(why));
    format!("<dl>{}</dl>", items.iter().map(one).collect::<String>())
}

/// Every number that is compared, in order, with its figure and its command.
pub(crate) fn all_compared(
    book: &Path,
    chapters: &[Chapter],
    done: &[Done],
) -> Vec<(String, String, Compared)> {
    let mut left = done;
    let mut all = Vec::new();
    for part in chapters.iter().flat_map(|chapter| &chapter.parts) {
        let (of_part, rest) = left.split_at(part.runs().len().min(left.len()));
        left = rest;
        match part {
            Part::Run(run) => {
                let Some((answer, _)) = of_part.first() else { continue };
                let one = |fact: &Fact| (run.caption.clone(), command(book, run), fact.compared(answer));
                all.extend(run.facts.iter().map(one));
            }
            Part::Facts(caption, facts) => {
                all.extend(facts.iter().map(|fact| ((*caption).to_owned(), String::new(), fact.clone())));
            }
            _ => {}
        }
    }
    all
}

/// Every table that several commands fill, for scripts.
pub(crate) fn all_tables(book: &Path, chapters: &[Chapter], done: &[Done]) -> Vec<Value> {
    let mut left = done;
    let mut all = Vec::new();
    for part in chapters.iter().flat_map(|chapter| &chapter.parts) {
        let (of_part, rest) = left.split_at(part.runs().len().min(left.len()));
        left = rest;
        if let Part::Joined(joined) = part {
            let table = (joined.show)(of_part);
            let row = |row: &Vec<Cell>| row.iter().map(|cell| cell.text.clone()).collect::<Vec<_>>();
            all.push(json!({
                "caption": joined.caption,
                "commands": joined.runs.iter().map(|run| command(book, run)).collect::<Vec<_>>(),
                "heads": table.heads,
                "rows": table.rows.iter().map(row).collect::<Vec<_>>(),
                "finding": table.finding,
            }));
        }
    }
    all
}

/// As it is typed in the book's own folder.
fn command(book: &Path, run: &Run) -> String {
    let words = run.arguments.iter().map(|argument| {
        let inside = Path::new(argument).strip_prefix(book).ok().filter(|_| !book.as_os_str().is_empty());
        quoted(&inside.map_or_else(|| argument.clone(), |path| path.display().to_string()))
    });
    format!("tracelight {}", words.collect::<Vec<_>>().join(" "))
}

fn shown_command(book: &Path, run: &Run) -> String {
    format!("<code>{}</code>", escaped(&command(book, run)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_keeps_its_letters_and_a_drawing_its_paper() {
        let plot =
            framed("A step", "<svg width=\"1200\" height=\"2\"><style>prefers-color-scheme</style></svg>");
        assert!(plot.contains("--least:1100px") && plot.contains("tabindex=\"0\""), "{plot}");
        let drawing = framed("A star", "<svg width=\"609.6mm\" viewBox=\"0 0 1 1\"></svg>");
        assert!(drawing.contains("light-wall") && !drawing.contains("--least"), "{drawing}");
    }

    #[test]
    fn a_command_is_typed_in_the_books_own_folder() {
        let arguments = ["lab", "simulate", "/a b/book/arrays/circle.csv", "--controller", "2 s"];
        let run = Run { arguments: arguments.map(str::to_owned).to_vec(), ..Run::default() };
        assert_eq!(
            command(Path::new("/a b/book"), &run),
            "tracelight lab simulate arrays/circle.csv --controller '2 s'"
        );
    }

    #[test]
    fn a_command_can_be_pasted() {
        assert_eq!(quoted("K11 G11"), "'K11 G11'");
        assert_eq!(quoted("--out"), "--out");
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}

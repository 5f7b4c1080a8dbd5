//! How wide text is set, and whether it is coloured.

use std::ffi::OsString;
use std::io::IsTerminal;

use clap::ColorChoice;
use clap::builder::styling::{AnsiColor, Style, Styles};
use unicode_width::UnicodeWidthStr;

/// Columns where there is no terminal to ask.
const USUAL: usize = 80;
/// Beyond this lines are hard to read, however wide the terminal.
const WIDEST: usize = 100;
/// Narrower than this nothing can be set.
const NARROWEST: usize = 20;

/// What the terminal is like, and what the user wants of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terminal {
    colour: ColorChoice,
}

impl Terminal {
    /// Takes `--color auto|always|never` out of a command line, wherever it stands: `--color red` of the commands that draw stays, as no colour
    /// has these names. The first argument is the program.
    pub(crate) fn of(arguments: Vec<OsString>) -> (Self, Vec<OsString>) {
        let mut colour = ColorChoice::Auto;
        let mut kept = Vec::with_capacity(arguments.len());
        let mut all = arguments.into_iter().peekable();
        while let Some(argument) = all.next() {
            if argument == "--" {
                kept.push(argument);
                break;
            }
            let behind = argument.to_str().and_then(|text| text.strip_prefix("--color="));
            let wish = if argument == "--color" { all.peek().and_then(|next| next.to_str()) } else { behind };
            let Some(wish) = wish.and_then(|name| name.parse().ok()) else {
                kept.push(argument);
                continue;
            };
            if argument == "--color" {
                all.next();
            }
            colour = wish;
        }
        kept.extend(all);
        (Self { colour }, kept)
    }

    /// Whether what goes to standard output is coloured.
    pub(crate) fn colours_output(self) -> bool {
        self.colours(std::io::stdout().is_terminal())
    }

    /// The same of standard error.
    pub(crate) fn colours_errors(self) -> bool {
        self.colours(std::io::stderr().is_terminal())
    }

    fn colours(self, is_terminal: bool) -> bool {
        let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        match self.colour {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => {
                is_terminal && !is_set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|t| t != "dumb")
            }
        }
    }

    /// A word of an error, as its kind is shown.
    pub(crate) fn alarm(self, word: &str) -> String {
        if !self.colours_errors() {
            return word.to_owned();
        }
        let style = STYLES.get_error();
        format!("{style}{word}{style:#}")
    }
}

/// How help and errors are coloured.
pub(crate) const STYLES: Styles = Styles::styled()
    .header(Style::new().bold())
    .usage(Style::new().bold())
    .literal(AnsiColor::Cyan.on_default())
    .error(AnsiColor::Red.on_default().bold())
    .valid(AnsiColor::Cyan.on_default())
    .invalid(AnsiColor::Yellow.on_default());

/// Columns that are told: those of the terminal, or else of `COLUMNS`.
fn told() -> Option<usize> {
    let terminal = terminal_size::terminal_size().map(|(width, _)| usize::from(width.0).min(WIDEST));
    let columns = || std::env::var("COLUMNS").ok()?.parse().ok();
    terminal.or_else(columns).map(|width: usize| width.max(NARROWEST))
}

/// Columns that help is set in.
pub(crate) fn width_of_help() -> usize {
    told().unwrap_or(USUAL)
}

/// An answer as a terminal shows it; one that goes to a file or another program keeps its lines.
pub(crate) fn shown(text: &str) -> String {
    let is_shown = std::io::stdout().is_terminal() || std::env::var_os("COLUMNS").is_some();
    match told().filter(|_| is_shown) {
        Some(width) => folded(text, width),
        None => text.to_owned(),
    }
}

/// Sentences folded between words, under where they began behind their name; rows of a table stay whole.
fn folded(text: &str, width: usize) -> String {
    let lines: Vec<_> = text.split('\n').map(|line| folded_line(line, width)).collect();
    lines.join("\n")
}

fn folded_line(line: &str, width: usize) -> String {
    let start = line.len() - line.trim_start().len();
    let mut gaps = line[start..].match_indices("  ");
    // a name, a gap, and a sentence
    let hang = match gaps.next() {
        None => start,
        Some((at, _)) => {
            let rest = &line[start + at..];
            line.len() - rest.trim_start().len()
        }
    };
    if line.width() <= width || line[hang..].contains("  ") || 2 * line[..hang].width() > width {
        return line.to_owned();
    }
    let indent = " ".repeat(line[..hang].width());
    let (mut done, mut last) = (String::new(), line[..hang].to_owned());
    for word in line[hang..].split(' ') {
        let is_first = last.width() <= indent.width();
        if !is_first && last.width() + 1 + word.width() > width {
            done += &last;
            done.push('\n');
            last.clone_from(&indent);
        } else if !is_first {
            last.push(' ');
        }
        last += word;
    }
    done + &last
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(line: &str) -> (ColorChoice, String) {
        let words = line.split_whitespace().map(OsString::from).collect();
        let (terminal, kept) = Terminal::of(words);
        let kept: Vec<_> = kept.iter().map(|word| word.to_string_lossy()).collect();
        (terminal.colour, kept.join(" "))
    }

    #[test]
    fn when_to_colour_is_told_anywhere_and_colours_of_strokes_are_left_alone() {
        for (typed, colour, kept) in [
            ("tracelight trace a.png", ColorChoice::Auto, "tracelight trace a.png"),
            ("tracelight --color never trace a.png", ColorChoice::Never, "tracelight trace a.png"),
            ("tracelight trace a.png --color=always", ColorChoice::Always, "tracelight trace a.png"),
            ("tracelight trace a.svg --color red", ColorChoice::Auto, "tracelight trace a.svg --color red"),
            ("tracelight trace --color", ColorChoice::Auto, "tracelight trace --color"),
            ("tracelight trace -- --color never", ColorChoice::Auto, "tracelight trace -- --color never"),
        ] {
            assert_eq!(told(typed), (colour, kept.to_owned()), "{typed}");
        }
    }

    #[test]
    fn a_sentence_is_folded_between_words_and_a_row_of_a_table_is_not() {
        for (line, wanted) in [
            ("one two three four five six", "one two three four\nfive six"),
            ("name   one two three four", "name   one two three\n       four"),
            ("  one two three four five", "  one two three four\n  five"),
            ("law   1.25   3.5   4.75   19", "law   1.25   3.5   4.75   19"),
            ("https://a.very.long/word/alone", "https://a.very.long/word/alone"),
            ("short", "short"),
            ("", ""),
        ] {
            assert_eq!(folded(line, 20), wanted, "{line}");
        }
    }
}

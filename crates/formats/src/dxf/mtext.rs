//! MTEXT: its codes, its lines, its words.

use tracelight_letters::{Faces, LINE_SPACING, Run};
use tracelight_stroke::{Affine, Vec2};

use super::codes;
use super::groups::Record;
use super::styles::{Styles, slanted};
use crate::FormatError;

/// What an MTEXT says of its place and form.
#[derive(Debug)]
pub(super) struct Lines {
    /// 1 to 9: top left, top middle, …, bottom right.
    attachment: i64,
    /// Longest line, 0 for no bound.
    width: f64,
    /// Of the usual distance of lines.
    spacing: f64,
    style: String,
}

/// How some words look.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Form {
    height: f64,
    width: f64,
    oblique_rad: f64,
}

/// A word, or the blank between two.
#[derive(Debug, PartialEq)]
struct Word {
    text: String,
    form: Form,
}

impl Word {
    fn is_blank(&self) -> bool {
        self.text.chars().all(|c| c == ' ')
    }
}

/// A word in its face, with its width on the drawing.
struct SetWord {
    run: Run,
    form: Form,
    width: f64,
    is_blank: bool,
}

impl Lines {
    pub(super) fn of(record: &Record) -> Result<Self, FormatError> {
        let spacing = record.number_or(44, 1.0)?;
        Ok(Self {
            attachment: record.whole_or(71, 1)?.clamp(1, 9),
            width: record.number_or(41, 0.0)?.max(0.0),
            spacing: if spacing > 0.0 { spacing } else { 1.0 },
            style: record.key(7),
        })
    }

    /// The words, each with the map from its em to the text's own frame: the point of attachment at the origin, lines along x.
    pub(super) fn set(&self, text: &str, height: f64, faces: &Faces, styles: &Styles) -> Vec<(Run, Affine)> {
        let (width, oblique_rad) = styles.get(&self.style);
        let paragraphs = paragraphs(text, Form { height, width, oblique_rad });
        let em = 1.0 / faces.capital_height();
        let set = |word: Word| {
            let run = faces.run(&word.text);
            let width = run.advance * em * word.form.height * word.form.width;
            SetWord { is_blank: word.is_blank(), form: word.form, run, width }
        };
        let mut lines: Vec<Vec<SetWord>> = Vec::new();
        for paragraph in paragraphs {
            lines.extend(self.broken(paragraph.into_iter().map(set).collect()));
        }
        self.placed(lines, height, em)
    }

    /// A paragraph as lines that are no longer than they may be; a single word may be.
    fn broken(&self, words: Vec<SetWord>) -> Vec<Vec<SetWord>> {
        let mut lines = vec![Vec::new()];
        let mut length = 0.0;
        for word in words {
            let is_full = self.width > 0.0 && length > 0.0 && length + word.width > self.width * (1.0 + 1e-6);
            if is_full && !word.is_blank {
                lines.push(Vec::new());
                length = 0.0;
            }
            length += word.width;
            if let Some(line) = lines.last_mut() {
                line.push(word);
            }
        }
        lines
    }

    fn placed(&self, lines: Vec<Vec<SetWord>>, height: f64, em: f64) -> Vec<(Run, Affine)> {
        let tallest = |line: &[SetWord]| line.iter().map(|word| word.form.height).fold(0.0, f64::max);
        let tall: Vec<f64> =
            lines.iter().map(|line| tallest(line)).map(|h| if h > 0.0 { h } else { height }).collect();
        let below = |h: f64| LINE_SPACING * self.spacing * h;
        let whole =
            tall.first().copied().unwrap_or(0.0) + tall.iter().skip(1).map(|&h| below(h)).sum::<f64>();
        let top = match (self.attachment - 1) / 3 {
            0 => 0.0,
            1 => 0.5 * whole,
            _ => whole,
        };
        let (mut placed, mut y) = (Vec::new(), top);
        for (i, line) in lines.into_iter().enumerate() {
            y -= if i == 0 { tall[i] } else { below(tall[i]) };
            let blank =
                line.iter().rev().take_while(|word| word.is_blank).map(|word| word.width).sum::<f64>();
            let length = line.iter().map(|word| word.width).sum::<f64>() - blank;
            let mut x = match (self.attachment - 1) % 3 {
                0 => 0.0,
                1 => -0.5 * length,
                _ => -length,
            };
            for word in line {
                let Form { height, width, oblique_rad } = word.form;
                let place = Affine::translate(Vec2::new(x, y))
                    * slanted(oblique_rad)
                    * Affine::scale_non_uniform(em * height * width, em * height);
                x += word.width;
                placed.push((word.run, place));
            }
        }
        placed
    }
}

/// Words and blanks of each paragraph, their codes obeyed or left out.
fn paragraphs(text: &str, form: Form) -> Vec<Vec<Word>> {
    let mut reader =
        Reader { form, around: Vec::new(), word: String::new(), paragraphs: vec![Vec::new()], initial: form };
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let used = match c {
            '\\' => reader.escape(&rest[1..]) + 1,
            '{' => {
                reader.around.push(reader.form);
                1
            }
            '}' => {
                let form = reader.around.pop();
                reader.change(form.unwrap_or(reader.form));
                1
            }
            _ => {
                reader.push(c);
                c.len_utf8()
            }
        };
        rest = rest.get(used..).unwrap_or_default();
    }
    reader.end_word();
    reader.paragraphs
}

struct Reader {
    form: Form,
    /// Forms of the braces that are open.
    around: Vec<Form>,
    word: String,
    paragraphs: Vec<Vec<Word>>,
    /// Of the whole text.
    initial: Form,
}

impl Reader {
    fn push(&mut self, c: char) {
        let is_blank = c == ' ';
        if self.word.chars().next().is_some_and(|first| (first == ' ') != is_blank) {
            self.end_word();
        }
        self.word.push(c);
    }

    fn end_word(&mut self) {
        if !self.word.is_empty() {
            let text = codes::plain(&std::mem::take(&mut self.word));
            let form = self.form;
            self.paragraphs
                .last_mut()
                .into_iter()
                .for_each(|words| words.push(Word { text: text.clone(), form }));
        }
    }

    fn change(&mut self, form: Form) {
        if form != self.form {
            self.end_word();
            self.form = form;
        }
    }

    /// Obeys what follows a backslash, and returns how many bytes of it that was.
    fn escape(&mut self, rest: &str) -> usize {
        let Some(c) = rest.chars().next() else { return 0 };
        let argument = rest[c.len_utf8()..].split(';').next().unwrap_or_default();
        let with_argument = (c.len_utf8() + argument.len() + 1).min(rest.len());
        match c {
            'P' | 'X' | 'N' => {
                self.end_word();
                self.paragraphs.push(Vec::new());
                1
            }
            '~' => {
                self.push('\u{a0}');
                1
            }
            'L' | 'l' | 'O' | 'o' | 'K' | 'k' => 1,
            'S' => {
                stacked(argument).chars().for_each(|c| self.push(c));
                with_argument
            }
            'H' | 'W' | 'Q' => {
                self.change(self.with(c, argument));
                with_argument
            }
            'A' | 'C' | 'c' | 'f' | 'F' | 'p' | 'T' => with_argument,
            // a brace, a backslash, or what is no code
            _ => {
                self.push(c);
                c.len_utf8()
            }
        }
    }

    /// The form with another height, width or slant; `2x` is a factor.
    fn with(&self, code: char, argument: &str) -> Form {
        let is_factor = argument.ends_with(['x', 'X']);
        let number = argument.trim_end_matches(['x', 'X']).trim().parse::<f64>().ok();
        let Some(number) = number.filter(|n| n.is_finite() && n.abs() <= 1e9) else { return self.form };
        let sound = |value: f64, before: f64| if value > 0.0 && value.is_finite() { value } else { before };
        let form = self.form;
        match (code, is_factor) {
            ('H', true) => Form { height: sound(number * form.height, form.height), ..form },
            ('H', false) => Form { height: sound(number, form.height), ..form },
            ('W', true) => Form { width: sound(number * self.initial.width, form.width), ..form },
            ('W', false) => Form { width: sound(number, form.width), ..form },
            _ => Form { oblique_rad: number.to_radians(), ..form },
        }
    }
}

/// A fraction or tolerance as one line: `1/2`.
fn stacked(argument: &str) -> String {
    let parts: Vec<&str> = argument.splitn(2, ['^', '#', '/']).map(str::trim).collect();
    match parts[..] {
        [only] => only.to_owned(),
        [upper, ""] => upper.to_owned(),
        ["", lower] => lower.to_owned(),
        [upper, lower, ..] => format!("{upper}/{lower}"),
        [] => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_obeyed_or_left_out() {
        let form = Form { height: 2.0, width: 1.0, oblique_rad: 0.0 };
        let check = |text: &str, expected: &str| {
            let lines = paragraphs(text, form).into_iter();
            let words = lines.map(|words| words.into_iter().map(|word| word.text).collect::<String>());
            assert_eq!(words.collect::<Vec<_>>().join("|"), expected, "{text}");
        };
        check("one\\Ptwo", "one|two");
        check("{\\fArial|b0|i0|c0|p34;Pump} 2", "Pump 2");
        check("\\A1;\\C3;red \\Lunder\\l", "red under");
        check("\\S1/2; \\S+0.1^-0.2; \\S3#4;", "1/2 +0.1/-0.2 3/4");
        check("a\\~b \\\\ \\{x\\}", "a\u{a0}b \\ {x}");
        check("%%c20\\P45%%d", "Ø20|45°");
        check("\\H0.5x;small\\H", "small");
        check("\\", "");
        check("\\f", "");
        check("}}{{", "");
    }

    #[test]
    fn a_height_holds_to_the_end_of_its_braces() {
        let form = Form { height: 2.0, width: 1.0, oblique_rad: 0.0 };
        let words = paragraphs("a{\\H3;b\\H0.5x;c}d", form).remove(0);
        let heights: Vec<f64> = words.iter().map(|word| word.form.height).collect();
        assert_eq!(heights, [2.0, 3.0, 1.5, 2.0]);
    }
}

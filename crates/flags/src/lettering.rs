//! Words to be drawn in place of a picture.

use clap::{Args, ValueEnum};
use tracelight_formats::{ReadOptions, lettering};
use tracelight_letters::{Align, slug};
use tracelight_picture::Source;
use tracelight_task::Failure;
use tracelight_units::Length;

use crate::placing::positive_length;

/// Words in place of a picture.
#[derive(Args, Clone, Debug)]
pub struct LetteringArgs {
    /// Draw these words in place of a picture, as outlines unless --letters line; \n begins a new line
    #[arg(long, value_name = "WORDS", allow_hyphen_values = true, value_parser = words)]
    text: Option<Words>,
    /// Height of the capitals of --text, as sign painters measure letters, such as 20cm [default: what --width, --height or 24in make it]
    #[arg(long, value_name = "LENGTH", requires = "text", conflicts_with_all = ["width", "height"], allow_hyphen_values = true,
          value_parser = positive_length)]
    text_height: Option<Length>,
    /// Where the lines of --text begin
    #[arg(long, value_enum, default_value_t, requires = "text")]
    text_align: TextAlignName,
}

/// Words, and what their results are called.
#[derive(Clone, Debug)]
struct Words {
    words: String,
    name: String,
}

/// Where lines begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum TextAlignName {
    /// Below each other
    #[default]
    Left,
    /// With their middles below each other
    Centre,
    /// With their ends below each other
    Right,
}

impl LetteringArgs {
    /// What the results are called, if there are words.
    pub fn name(&self) -> Option<&str> {
        self.text.as_ref().map(|text| text.name.as_str())
    }

    /// The words as strokes, if there are any.
    ///
    /// # Errors
    /// Words without a letter, and a font that is none.
    pub fn source(&self, options: &ReadOptions) -> Result<Option<Source>, Failure> {
        let Some(text) = &self.text else { return Ok(None) };
        let align = match self.text_align {
            TextAlignName::Left => Align::Left,
            TextAlignName::Centre => Align::Centre,
            TextAlignName::Right => Align::Right,
        };
        let capitals_m = self.text_height.map(|height| height.0);
        let drawn = lettering::draw(&text.words, capitals_m, align, options);
        drawn
            .map(|reading| Some(Source::Strokes(reading)))
            .map_err(|e| Failure::usage("text", format!("--text: {e}")))
    }
}

/// Words as they are typed in a shell.
fn words(text: &str) -> Result<Words, String> {
    let words = text.replace("\\n", "\n");
    if words.trim().is_empty() {
        return Err("there is nothing to draw in it".to_owned());
    }
    Ok(Words { name: slug(&words), words })
}

//! Somebody at the wall who is at no terminal: what he asks, in words, and what he is told.

use serde_json::Value;
use tracelight_job::{Ask, Step};
use tracelight_session::{Request, When};

/// Where somebody sits who attends a job from elsewhere, such as a page.
pub trait Seat: Sync {
    /// What is asked for next, if anything is. Never waits.
    fn wish(&self) -> Option<Wish>;

    /// Told what happens, as one JSON object: those of `--events`, and the progress some 25 times a second. Never waits.
    fn tell(&self, event: &Value);
}

/// What somebody at the wall asks for, as the keys of a terminal do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wish {
    /// Dark at the end of this stroke.
    Pause,
    /// Dark at once.
    PauseNow,
    /// Begin, or go on.
    GoOn,
    /// Dark at once; what goes on then is armed anew.
    Stop,
    /// Allow light, for ten seconds until something begins.
    Arm,
    /// Take that back.
    Disarm,
    /// The next stroke or point; of a frame, the drawing.
    Next,
    /// The one before.
    Previous,
    /// The next one, and this one is left as it is.
    Skip,
    /// The fault was read.
    Clear,
    /// The job is over.
    End,
    /// The plan's clock runs at that multiple of its own speed.
    Speed(f32),
}

/// Wishes that are a word alone.
const WORDS: [(&str, Wish); 11] = [
    ("pause", Wish::Pause),
    ("pause-now", Wish::PauseNow),
    ("go-on", Wish::GoOn),
    ("stop", Wish::Stop),
    ("arm", Wish::Arm),
    ("disarm", Wish::Disarm),
    ("next", Wish::Next),
    ("previous", Wish::Previous),
    ("skip", Wish::Skip),
    ("clear", Wish::Clear),
    ("end", Wish::End),
];

impl Wish {
    /// From its word: `pause`, `speed=0.5`; `None` if it is none.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        if let Some(speed) = text.strip_prefix("speed=") {
            return speed.parse().ok().filter(|speed: &f32| speed.is_finite()).map(Self::Speed);
        }
        WORDS.into_iter().find(|(word, _)| *word == text).map(|(_, wish)| wish)
    }

    /// Words of wishes that are one, for messages.
    pub fn words() -> impl Iterator<Item = &'static str> {
        WORDS.into_iter().map(|(word, _)| word)
    }

    /// What it asks of a job.
    pub(crate) const fn ask(self) -> Ask {
        Ask::Request(match self {
            Self::Next => return Ask::Step(Step::Next),
            Self::Previous => return Ask::Step(Step::Previous),
            Self::Skip => return Ask::Step(Step::Skip),
            Self::Pause => Request::Pause(When::AfterStroke),
            Self::PauseNow => Request::Pause(When::AtOnce),
            Self::GoOn => Request::Resume,
            Self::Stop | Self::End => Request::Stop,
            Self::Arm => Request::Arm,
            Self::Disarm => Request::Disarm,
            Self::Clear => Request::Clear,
            Self::Speed(speed) => Request::Speed(speed),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wishes_are_words() {
        for (word, wish) in WORDS {
            assert_eq!(Wish::read(word), Some(wish));
        }
        assert_eq!(Wish::words().count(), WORDS.len());
        assert_eq!(Wish::read("speed=0.5"), Some(Wish::Speed(0.5)));
        for none in ["", "Pause", "speed=", "speed=fast", "speed=inf", "speed=NaN", "light"] {
            assert_eq!(Wish::read(none), None, "{none}");
        }
    }
}

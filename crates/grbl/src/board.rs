//! What a board is and how it is set, by its own word, and whether a head can be driven by that.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use tracelight_rig::{Joint, PanTilt};

use crate::axis::BoardAxis;
use crate::said::numbers;
use crate::trouble::{Setting, Trouble};

/// Moves and characters that a board holds which does not tell.
const USUAL_MOVES: usize = 15;
const USUAL_CHARACTERS: usize = 128;
/// Work coordinates in which angle zero is kept: whoever selected them since the board was reset knows where the head points.
pub(crate) const ZERO: &str = "G59";
/// Their number where they are set.
pub(crate) const ZERO_NUMBER: u8 = 6;
const DEGREE_RAD: f64 = PI / 180.0;
const MINUTE_S: f64 = 60.0;

/// A board that was asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// Its version, as it says it.
    pub version: String,
    /// Moves that it plans ahead.
    pub moves: usize,
    /// Characters that it holds.
    pub characters: usize,
    /// Whether a door can be wired to it.
    pub has_door: bool,
    /// What turns with each of its settings.
    pub settings: BTreeMap<u16, f64>,
    /// Places of its axes in machine coordinates, in its units.
    pub(crate) machine: Vec<f64>,
    /// What the work coordinates in use begin at, in its units.
    pub(crate) begins: Vec<f64>,
    /// Likewise those that are in use after a reset.
    pub(crate) plain: Vec<f64>,
    /// Whether angle zero is known.
    pub is_homed: bool,
    /// Whether an alarm has locked it.
    pub is_locked: bool,
}

/// What a joint's axis can do, in angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    /// A step, rad.
    pub step_rad: f64,
    /// Highest speed, rad/s.
    pub speed_rad_s: f64,
    /// Highest acceleration, rad/s².
    pub acceleration_rad_s2: f64,
}

impl Board {
    /// Whether it is known to move nothing: a simulation says so.
    #[must_use]
    pub fn is_simulated(&self) -> bool {
        self.version.contains("simulated")
    }

    /// `S` word of full light.
    #[must_use]
    pub fn full_power(&self) -> f64 {
        self.settings.get(&30).copied().unwrap_or(1000.0)
    }

    /// By how much it lets a corner be cut, in its units: what its speed at corners follows from.
    #[must_use]
    pub fn junction(&self) -> f64 {
        self.settings.get(&11).copied().unwrap_or(0.01)
    }

    /// What the axis of each joint can do. Its units are degrees.
    ///
    /// # Errors
    /// Its settings do not say, or are none to drive a head with.
    pub fn limits(&self, axes: PanTilt<BoardAxis>) -> Result<PanTilt<AxisLimits>, Trouble> {
        let of = |joint: Joint| {
            let at = |base: u16| base + axes[joint].index() as u16;
            let steps = self.positive(at(100), "steps a degree of the joint")?;
            Ok(AxisLimits {
                step_rad: DEGREE_RAD / steps,
                speed_rad_s: self.positive(at(110), "degrees a minute")? * DEGREE_RAD / MINUTE_S,
                acceleration_rad_s2: self.positive(at(120), "degrees a second, a second")? * DEGREE_RAD,
            })
        };
        Ok(PanTilt::new(of(Joint::Pan)?, of(Joint::Tilt)?))
    }

    fn positive(&self, number: u16, means: &'static str) -> Result<f64, Trouble> {
        let value = self.settings.get(&number).copied();
        let wants = Setting { number, value, means };
        value.filter(|value| *value > 0.0).ok_or(Trouble::Unset(wants))
    }

    /// Refuses settings with which light or motion would not be what is asked for.
    ///
    /// # Errors
    /// Which one, and what it has to be.
    pub fn check(&self) -> Result<(), Trouble> {
        let wrong = [
            (32, 1.0, "laser mode: without it light stays on where the head stands"),
            (13, 0.0, "reports in millimetres, which stand for degrees here"),
            (
                20,
                0.0,
                "no soft limits: they allow machine coordinates below zero alone, and the rig file's range holds anyway",
            ),
        ];
        for (number, wanted, why) in wrong {
            // what a board does not have is off
            let value = self.settings.get(&number).copied().unwrap_or(0.0);
            if (value != 0.0) != (wanted != 0.0) {
                return Err(Trouble::Wrong { number, value, wanted, why });
            }
        }
        Ok(())
    }
}

/// What a board has said of itself so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Told {
    version: Option<String>,
    moves: Option<usize>,
    characters: Option<usize>,
    has_door: bool,
    pub(crate) settings: BTreeMap<u16, f64>,
    /// Where work coordinates begin, by their names.
    offsets: BTreeMap<String, Vec<f64>>,
    /// Those that are in use.
    in_use: Option<String>,
}

impl Told {
    /// Takes what is in brackets.
    pub(crate) fn hear(&mut self, head: &str, rest: &str) {
        match head {
            "VER" => self.version = Some(rest.trim_end_matches(':').to_owned()),
            "OPT" => {
                let mut parts = rest.split(',');
                self.has_door = parts.next().is_some_and(|options| options.contains('+'));
                self.moves = parts.next().and_then(|count| count.trim().parse().ok());
                self.characters = parts.next().and_then(|count| count.trim().parse().ok());
            }
            "GC" => {
                let is_offset = |word: &&str| {
                    let number = word.strip_prefix('G').and_then(|number| number.parse::<f64>().ok());
                    number.is_some_and(|number| (54.0..60.0).contains(&number))
                };
                self.in_use = rest.split_whitespace().find(is_offset).map(str::to_owned);
            }
            _ if head.starts_with("G5") || head == "G92" => {
                self.offsets.insert(head.to_owned(), numbers(rest));
            }
            _ => {}
        }
    }

    /// The board, once everything was asked; places are those of its last report.
    pub(crate) fn board(&self, version: &str, (place, is_machine): (&[f64], bool), is_locked: bool) -> Board {
        let offset = |name: &str| self.offsets.get(name).cloned().unwrap_or_default();
        let in_use = self.in_use.as_deref().unwrap_or("G54");
        let begins = sum(&offset(in_use), &offset("G92"));
        let machine = if is_machine { place.to_vec() } else { sum(place, &begins) };
        Board {
            version: self.version.clone().unwrap_or_else(|| version.to_owned()),
            // numbers that no board has are a slip of the line
            moves: self.moves.filter(|count| (4..=1000).contains(count)).unwrap_or(USUAL_MOVES),
            characters: self
                .characters
                .filter(|count| (64..=65536).contains(count))
                .unwrap_or(USUAL_CHARACTERS),
            has_door: self.has_door,
            settings: self.settings.clone(),
            machine,
            begins,
            plain: sum(&offset("G54"), &offset("G92")),
            is_homed: in_use == ZERO && !is_locked,
            is_locked,
        }
    }
}

/// Number by number; what one does not have is 0.
fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    let of = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
    (0..a.len().max(b.len())).map(|i| of(a, i) + of(b, i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: PanTilt<BoardAxis> =
        PanTilt::new(BoardAxis { letter: 'X', reversed: false }, BoardAxis { letter: 'Y', reversed: true });

    fn told(settings: &[(u16, f64)]) -> Told {
        let mut told = Told { settings: settings.iter().copied().collect(), ..Told::default() };
        told.hear("VER", "1.1h.20190825:");
        told.hear("OPT", "V+,15,128");
        told.hear("GC", "G1 G59 G17 G21 G90 G93 M4 M9 T0 F0 S0");
        told.hear("G54", "1.000,1.000,0.000");
        told.hear("G59", "10.000,-20.000,0.000");
        told.hear("G92", "0.500,0.000,0.000");
        told
    }

    const USUAL: [(u16, f64); 8] = [
        (100, 90.0),
        (101, 45.0),
        (110, 3000.0),
        (111, 3000.0),
        (120, 4000.0),
        (121, 4000.0),
        (32, 1.0),
        (13, 0.0),
    ];

    #[test]
    fn a_board_is_what_it_says() {
        let board = told(&USUAL).board("Grbl 1.1h", (&[11.0, -20.0, 0.0], true), false);
        assert_eq!((board.version.as_str(), board.moves, board.characters), ("1.1h.20190825", 15, 128));
        assert_eq!((board.begins.as_slice(), board.is_homed), (&[10.5, -20.0, 0.0][..], true));
        assert!(board.has_door && board.check().is_ok());
        let limits = board.limits(AXES).unwrap_or_else(|e| unreachable!("{e}"));
        assert!((limits.tilt.step_rad - DEGREE_RAD / 45.0).abs() < 1e-12);
        assert!((limits.pan.speed_rad_s - 50.0 * DEGREE_RAD).abs() < 1e-9);
        // a place of the work is one of the machine with what it begins at
        let board = told(&USUAL).board("Grbl 1.1h", (&[0.5, 0.0], false), true);
        assert_eq!((board.machine[0], board.is_homed), (11.0, false));
        assert!(!board.is_simulated());
    }

    #[test]
    fn settings_are_refused_that_would_let_light_stand_or_mean_something_else() {
        let with = |number, value| {
            let mut settings = USUAL.to_vec();
            settings.push((number, value));
            told(&settings).board("Grbl 1.1h", (&[0.0], true), false)
        };
        assert!(with(32, 0.0).check().is_err_and(|why| why.to_string().contains("$32=1")));
        assert!(with(13, 1.0).check().is_err() && with(20, 1.0).check().is_err());
        assert!(with(101, 0.0).limits(AXES).is_err_and(|why| why.to_string().contains("$101")));
        let none = told(&[(32, 1.0)]).board("Grbl 1.1h", (&[], true), false);
        assert!(none.limits(AXES).is_err());
    }
}

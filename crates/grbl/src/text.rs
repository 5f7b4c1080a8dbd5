//! Moves as lines of G-code.

use std::fmt::Write as _;

use tracelight_rig::{Joint, PanTilt};

use crate::axis::{BoardAxis, LETTERS};
use crate::moves::{Item, SHORTEST_REST};
use crate::said::Status;

/// Decimals of a place, in degrees: a step of a fine machine is a thousandth.
const DECIMALS: usize = 4;
const TICK_S: f64 = 1e-3;

/// How places of a head are written for its board.
#[derive(Clone, Debug)]
pub(crate) struct Writer {
    pub(crate) axes: PanTilt<BoardAxis>,
    /// Units of a step.
    pub(crate) units: PanTilt<f64>,
    /// Where the work coordinates begin, in machine coordinates, units.
    pub(crate) begins: PanTilt<f64>,
    /// `S` word of full light.
    pub(crate) full_power: f64,
    /// What the board has been told last.
    place: Option<PanTilt<i64>>,
    lit: bool,
}

impl Writer {
    pub(crate) fn new(
        axes: PanTilt<BoardAxis>,
        units: PanTilt<f64>,
        begins: PanTilt<f64>,
        full_power: f64,
    ) -> Self {
        Self { axes, units, begins, full_power, place: None, lit: false }
    }

    /// What makes a board ready for moves: degrees for millimetres, absolute, in inverse time, with light that depends on speed and is off now; with the work
    /// coordinates of angle zero if they are known.
    pub(crate) fn ready(&mut self, zero: Option<&str>) -> Vec<String> {
        (self.place, self.lit) = (None, false);
        let zero = zero.map(str::to_owned);
        ["G21G90G17".to_owned()]
            .into_iter()
            .chain(zero)
            .chain(["G1G93F1".to_owned(), "M4S0".to_owned()])
            .collect()
    }

    /// The place of an axis, as a number.
    fn number(&self, joint: Joint, steps: i64) -> String {
        let value = steps as f64 * self.units[joint] - self.begins[joint];
        trimmed(value, DECIMALS)
    }

    /// The place of a report, in steps of the machine.
    pub(crate) fn place_of(&self, status: &Status) -> Option<PanTilt<f64>> {
        let value = |j: Joint| status.place.get(self.axes[j].index()).copied();
        let both = PanTilt::new(value(Joint::Pan)?, value(Joint::Tilt)?);
        Some(PanTilt::from_fn(|j| {
            let machine = if status.is_machine { both[j] } else { both[j] + self.begins[j] };
            machine / self.units[j]
        }))
    }

    /// Lines of a move or a rest; of a move with its feed in inverse time, 1/min.
    pub(crate) fn lines(&mut self, item: &Item, feed: impl FnOnce() -> f64) -> Vec<String> {
        if item.is_rest() {
            return self.rest(item);
        }
        let mut words: Vec<(usize, String)> = Vec::new();
        for joint in Joint::BOTH {
            if self.place.is_none_or(|place| place[joint] != item.to[joint]) {
                let axis = self.axes[joint].index();
                words.push((axis, format!("{}{}", LETTERS[axis], self.number(joint, item.to[joint]))));
            }
        }
        words.sort();
        let mut line: String = words.into_iter().map(|(_, word)| word).collect();
        let feed = feed();
        let decimals = if feed >= 1000.0 { 1 } else { 4 };
        let _ = write!(line, "F{}", trimmed(feed, decimals));
        if item.lit != self.lit {
            let power = if item.lit { trimmed(self.full_power, 3) } else { "0".to_owned() };
            let _ = write!(line, "S{power}");
        }
        (self.place, self.lit) = (Some(item.to), item.lit);
        vec![line]
    }

    /// A rest. Light that depends on speed is off then: where it is wanted it is switched on for just as long, and off again by the same order.
    fn rest(&mut self, item: &Item) -> Vec<String> {
        // no longer than asked, on boards that rest for whole steps
        let ticks = item.ticks - item.ticks % SHORTEST_REST;
        let wait = format!("G4P{}", trimmed(f64::from(ticks) * TICK_S, 3));
        if !item.lit {
            return vec![wait];
        }
        self.lit = false;
        vec![format!("M3S{}", trimmed(self.full_power, 3)), wait, "M4S0".to_owned()]
    }

    /// Says where angle zero is, in steps of the machine. (By where it is now, it would be by what the board's parser believes, which need not be what it reports.)
    pub(crate) fn home(&mut self, zero: PanTilt<i64>, number: u8) -> String {
        let mut line = format!("G10L2P{number}");
        for joint in Joint::BOTH {
            let value = trimmed(zero[joint] as f64 * self.units[joint], DECIMALS);
            let _ = write!(line, "{}{value}", self.axes[joint].letter);
            // as the board has it: with so many decimals
            self.begins[joint] = value.parse().unwrap_or(0.0);
        }
        self.place = None;
        line
    }

    /// Takes back what is said of light, if there is any: a board that rests is dark anyway.
    pub(crate) fn dark(&mut self) -> Option<String> {
        std::mem::take(&mut self.lit).then(|| "S0".to_owned())
    }

    /// The next move says where it leads on both axes.
    pub(crate) fn forget(&mut self) {
        self.place = None;
    }
}

/// A number without zeros at its end.
fn trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: PanTilt<BoardAxis> =
        PanTilt::new(BoardAxis { letter: 'Y', reversed: false }, BoardAxis { letter: 'X', reversed: true });

    fn item(to: (i64, i64), by: (i64, i64), lit: bool) -> Item {
        let zero = PanTilt::new(0.0, 0.0);
        Item {
            ends: 0,
            ticks: 120,
            lit,
            to: PanTilt::new(to.0, to.1),
            by: PanTilt::new(by.0, by.1),
            rates: (zero, zero),
        }
    }

    #[test]
    fn moves_are_short_lines_with_what_changes() {
        let mut writer = Writer::new(AXES, PanTilt::new(0.01, 0.02), PanTilt::new(1.0, 0.0), 1000.0);
        assert_eq!(writer.ready(Some("G59")), ["G21G90G17", "G59", "G1G93F1", "M4S0"]);
        let feed = || 3000.0;
        assert_eq!(writer.lines(&item((100, -50), (5, 1), true), feed), ["X-1Y0F3000S1000"]);
        assert_eq!(writer.lines(&item((110, -50), (10, 0), true), feed), ["Y0.1F3000"]);
        assert_eq!(writer.lines(&item((110, -40), (0, 10), false), || 7.25), ["X-0.8F7.25S0"]);
        assert_eq!(writer.lines(&item((110, -40), (0, 0), false), feed), ["G4P0.1"]);
        assert_eq!(writer.lines(&item((110, -40), (0, 0), true), feed), ["M3S1000", "G4P0.1", "M4S0"]);
        assert_eq!(writer.home(PanTilt::new(0, 50), 6), "G10L2P6Y0X1");
        assert_eq!(writer.lines(&item((110, -40), (1, 0), false), feed), ["X-1.8Y1.1F3000"]);
    }
}

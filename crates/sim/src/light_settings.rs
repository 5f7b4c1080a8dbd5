//! Laser data of a rig, its exposure limit, and the direction to park in if it stays lit.

use tracelight_rig::TICK_F64_S;

use crate::laws::ObserverName;

/// Energy that may fall in one place where the rig file says nothing else, J: what a class 2 laser gives in a second.
const PLACE_J: f64 = 1e-3;
/// Longest that light stands where the rig file says nothing else, s, however weak it is.
const USUAL_S: f64 = 1.0;
/// Radius of a place on the wall, m.
const PLACE_M: f64 = 1e-3;
/// Distance of that wall, m: 3 ft, the usual one. On a nearer wall the angle is a smaller place.
const USUAL_DISTANCE_M: f64 = 0.9144;
/// Wander of the position estimate of a joint at rest under a Kalman filter, which interpolates within a count; counts.
const FOLLOWED_COUNTS: f64 = 0.25;
/// Wander under the other observers, which go from count to count; counts.
const COUNTED_COUNTS: f64 = 0.5;

/// A laser, how long its light may stand in one place, and where the head turns if it does not go dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSettings {
    /// What its label says.
    pub class: LaserClass,
    /// Power of its light, W.
    pub power_w: f64,
    /// How long it may stand, s.
    pub standing_s: f64,
    /// Its wavelength, nm; nobody need know that of a simulated one.
    pub wavelength_nm: Option<f64>,
    /// Day on which somebody measured its power at the aperture.
    pub measured_on: Option<Day>,
    /// The highest class that whoever operates it answers for.
    pub operated: LaserClass,
}

/// A day of the calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Day {
    year: u16,
    month: u8,
    day: u8,
}

impl Day {
    /// Reads `2026-11-30`; `None` if that is no day.
    pub fn read(text: &str) -> Option<Self> {
        let (year, rest) = text.split_once('-')?;
        let (month, day) = rest.split_once('-')?;
        let number = |text: &str, digits: usize| -> Option<u16> {
            let is_number = text.len() == digits && text.bytes().all(|byte| byte.is_ascii_digit());
            text.parse().ok().filter(|_| is_number)
        };
        let (year, month, day) = (number(year, 4)?, number(month, 2)?, number(day, 2)?);
        let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
        let days = match month {
            4 | 6 | 9 | 11 => 30,
            2 => 28 + u16::from(is_leap),
            1..=12 => 31,
            _ => return None,
        };
        let (month, day) = (month as u8, (1..=days).contains(&day).then_some(day as u8)?);
        Some(Self { year, month, day })
    }
}

impl std::fmt::Display for Day {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

impl LightSettings {
    /// Shortest and longest time that light may be let stand, s.
    pub const STANDING_S: (f64, f64) = (0.02, 10.0);
    /// Least and most power, W.
    pub const POWER_W: (f64, f64) = (1e-6, 10.0);

    /// A laser pointer: class 2, 1 mW.
    pub const POINTER: Self = Self {
        class: LaserClass::Two,
        power_w: 1e-3,
        standing_s: USUAL_S,
        wavelength_nm: None,
        measured_on: None,
        operated: LaserClass::Two,
    };

    /// Why a real head may not be lit with it: what nobody has said of the laser, or its class; `None` if it may.
    pub fn unfit(&self) -> Option<String> {
        let said =
            [("wavelength", self.wavelength_nm.is_some()), ("measured_on", self.measured_on.is_some())];
        let missing: Vec<&str> =
            said.into_iter().filter(|(_, is_said)| !is_said).map(|(key, _)| key).collect();
        if !missing.is_empty() {
            return Some(format!(
                "its rig file does not say {} of the laser: a real one is measured at its aperture before it is lit; add to [laser] what its label says and what you measured, \
                 such as class = \"2\", power = \"0.8mW\", wavelength = \"650nm\", measured_on = \"2026-11-30\"",
                missing.join(" and ")
            ));
        }
        let order = |class| LaserClass::ALL.into_iter().position(|other| other == class);
        (order(self.class) > order(self.operated)).then(|| {
            format!(
                "its laser is of class {}, and nothing above class {} is lit: light of class 3R and above hurts eyes before anybody blinks, and nothing here is a certified \
                 safety function; whoever has key, interlock, beam stop, goggles and somebody who answers for all of that says so by [laser] operated_class = \"{}\"",
                self.class.name(),
                self.operated.name(),
                self.class.name()
            )
        })
    }

    /// How long light of that power, W, stands where the rig file does not say it, s: 1 mJ, but no longer than a second.
    pub fn usual_standing_s(power_w: f64) -> f64 {
        let (least, most) = Self::STANDING_S;
        (PLACE_J / power_w).min(USUAL_S).clamp(least, most)
    }

    /// How long it may stand, ticks.
    pub(crate) fn standing_ticks(&self) -> u32 {
        (self.standing_s / TICK_F64_S).round() as u32
    }
}

/// Radius of a place as the head sees it, rad, with encoders of that count, rad: it holds any disc of 1 mm on a wall 3 ft away or further,
/// and by how much what is believed of the joints wanders.
pub(crate) fn standing_radius_rad(count_rad: f64, observer: ObserverName) -> f64 {
    let wanders = if observer == ObserverName::Kalman { FOLLOWED_COUNTS } else { COUNTED_COUNTS };
    PLACE_M / USUAL_DISTANCE_M + wanders * count_rad
}

/// Class of a laser by IEC 60825-1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaserClass {
    /// Safe.
    One,
    /// Safe but through lenses.
    OneM,
    /// Visible; the blink of an eye protects.
    Two,
    /// Visible; safe for the eye as long as no lens is used.
    TwoM,
    /// Some risk to an eye.
    ThreeR,
    /// Hurts an eye.
    ThreeB,
    /// Hurts eyes and skin, and sets fire.
    Four,
}

impl LaserClass {
    /// Every class, the safest first.
    pub const ALL: [Self; 7] =
        [Self::One, Self::OneM, Self::Two, Self::TwoM, Self::ThreeR, Self::ThreeB, Self::Four];

    /// As labels have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::One => "1",
            Self::OneM => "1M",
            Self::Two => "2",
            Self::TwoM => "2M",
            Self::ThreeR => "3R",
            Self::ThreeB => "3B",
            Self::Four => "4",
        }
    }

    /// The class of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|class| class.name() == name)
    }

    /// Most power of visible light that a narrow beam of the class has, W; of class 4 there is no most.
    pub const fn most_w(self) -> f64 {
        match self {
            Self::One | Self::OneM => 0.39e-3,
            Self::Two | Self::TwoM => 1e-3,
            Self::ThreeR => 5e-3,
            Self::ThreeB => 0.5,
            Self::Four => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_is_one_of_the_calendar() {
        for day in ["2026-11-30", "2024-02-29", "2000-02-29", "0001-01-01"] {
            assert_eq!(Day::read(day).map(|day| day.to_string()).as_deref(), Some(day));
        }
        for none in [
            "2026-02-29",
            "1900-02-29",
            "2026-13-01",
            "2026-04-31",
            "2026-1-01",
            "26-01-01",
            "2026-01-00",
            "+026-01-01",
            "",
        ] {
            assert_eq!(Day::read(none), None, "{none}");
        }
    }

    #[test]
    fn a_real_head_is_lit_by_a_laser_that_was_measured_and_is_answered_for() {
        let said = LightSettings {
            wavelength_nm: Some(650.0),
            measured_on: Day::read("2026-11-30"),
            ..LightSettings::POINTER
        };
        assert_eq!(said.unfit(), None);
        assert!(LightSettings::POINTER.unfit().is_some_and(|why| why.contains("wavelength and measured_on")));
        let strong = LightSettings { class: LaserClass::ThreeB, power_w: 0.1, ..said };
        assert!(strong.unfit().is_some_and(|why| why.contains("operated_class = \"3B\"")));
        assert_eq!(LightSettings { operated: LaserClass::ThreeB, ..strong }.unfit(), None);
        assert!(LightSettings { operated: LaserClass::ThreeR, ..strong }.unfit().is_some());
    }
}

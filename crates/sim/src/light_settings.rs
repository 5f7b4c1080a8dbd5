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
}

impl LightSettings {
    /// Shortest and longest time that light may be let stand, s.
    pub const STANDING_S: (f64, f64) = (0.02, 10.0);
    /// Least and most power, W.
    pub const POWER_W: (f64, f64) = (1e-6, 10.0);

    /// A laser pointer: class 2, 1 mW.
    pub const POINTER: Self = Self { class: LaserClass::Two, power_w: 1e-3, standing_s: USUAL_S };

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

//! How much light falls in one place: no more than a budget, wherever the spot goes and comes back to.
//!
//! Directions of the beam are parted into squares, by four grids at once, each half a square beside another. Light is charged, tick by
//! tick, to the square of each grid that the spot is in. What a square was charged leaks while no light falls there, at a tenth of
//! the rate at which light is charged. Where one has spent its budget, it is dark.
//!
//! **Why that bounds the light in *any* disc of radius r.** A square is 4.1 r wide. Along either axis the borders of a grid and those of
//! the one beside it are 2.05 r apart, so a stretch of 2 r crosses a border of one of the two at most. Hence one of the four grids has
//! a square that holds the whole disc: whatever light falls into the disc is charged to that square. One that holds b at most and
//! leaks a tenth of a tick in each dark one lets through b + W / 10 at most in any time W.
//!
//! **Why a small table is enough.** A grid remembers [`SQUARES`] squares. A new one takes the place of the one that holds least, and what
//! that held is kept as what *any* square may hold that is in no table: nothing is ever forgotten, at worst something is charged to
//! more than it fell on. That is little: let every one of n squares hold v at least, and the k-th latest have been left S ticks ago; it
//! was lit for v + S / 10 at least, so S + 10 v grows by 10/9 from each to the one before it. None holds more than b, so v is less than
//! b (9/10)ⁿ: with 32 of them a twenty-ninth of the budget.
//!
//! A direction is a place on the unit sphere, so light straight up stands, whatever pan does. What lies within r of each other on a wall at
//! distance d lies within r / d as the head sees it, wherever on that wall it is.

use core::f32::consts::{FRAC_PI_2, PI, TAU};

use tracelight_rig::{PanTilt, TICK_S};

use crate::config::Config;
use crate::recent_light::RecentLight;

/// Squares that a grid remembers.
const SQUARES: usize = 32;
/// What leaks in a dark tick, as a share of what a lit one charges.
const LEAK: f32 = 0.1;
/// Width of a square in radii: more than 4, see above.
const WIDTH: f32 = 4.1;
/// Share of the budget down to which a square that spent it must leak before there is light again: a relay is not to chatter at the brim.
const OPEN_AGAIN: f32 = 0.5;
/// Ticks a laser may shine longer than its relay is believed to let it.
const SLACK_TICKS: u32 = 2;
/// How long a plan may ask for light in vain, ticks.
const PATIENCE_TICKS: u32 = 100;

/// Where the light of a head was, and whether more may follow. Constant memory, bounded work.
///
/// A host that runs it over a plan's setpoints knows beforehand where a rig would be dark.
#[derive(Clone, Copy, Debug)]
pub struct LightBudget {
    /// Ticks since the start; it may run over.
    now: u32,
    grids: [Grid; 4],
    rows: Rows,
    /// What any square may hold that is in no table, and all of the light of a head of which nobody knows where it points.
    beneath: Spent,
    /// Light of a head of which nobody knows where it points.
    recent: RecentLight,
    /// How long ago the gate fell, ticks.
    shut_ticks: u32,
    /// For how long a plan has asked in vain, ticks.
    asked_ticks: u32,
}

impl Default for LightBudget {
    fn default() -> Self {
        Self::new()
    }
}

impl LightBudget {
    /// Of a head that lit nothing yet.
    pub const fn new() -> Self {
        Self {
            now: 0,
            grids: [Grid::EMPTY; 4],
            rows: Rows::NONE,
            beneath: Spent::NOTHING,
            recent: RecentLight::NONE,
            shut_ticks: u32::MAX,
            asked_ticks: 0,
        }
    }

    /// One tick passes. `gate` is what the laser was told in the last one, `laser_on` what is seen of it; the joints are at `angle_rad`,
    /// `None` where nobody knows.
    pub fn tick(
        &mut self,
        config: &Config,
        angle_rad: Option<PanTilt<f32>>,
        gate: bool,
        laser_on: Option<bool>,
    ) {
        self.now = self.now.wrapping_add(1);
        self.shut_ticks = if gate { 0 } else { self.shut_ticks.saturating_add(1) };
        // a relay may close at once and open late; where it is watched, the worse of the two counts
        let may_shine = self.shut_ticks <= config.laser_off_ticks + SLACK_TICKS;
        let shines = may_shine || laser_on == Some(true);
        self.recent.tick(shines && angle_rad.is_none());
        if !shines {
            return;
        }
        let most = most(config);
        match angle_rad.and_then(Direction::of) {
            Some(direction) => {
                let squares = self.rows.squares(direction, WIDTH * config.standing_radius_rad);
                for (grid, square) in self.grids.iter_mut().zip(squares) {
                    let dropped = grid.enter(square, self.now, &self.beneath);
                    grid.latest().charge(self.now, most);
                    self.beneath.rise_to(&dropped, self.now);
                }
            }
            None => self.beneath.charge(self.now, most),
        }
    }

    /// Whether there may be no light where the joints are, rad, or will be, by their speed in rad/s, when a gate that falls now has made it
    /// dark; `None` where nobody knows.
    pub fn is_spent(&mut self, config: &Config, at: Option<(PanTilt<f32>, PanTilt<f32>)>) -> bool {
        let most = most(config);
        let Some((angle_rad, rate_rad_s)) = at else {
            return self.beneath.is_shut(self.now, most) || self.recent.left_ticks() <= tail_ticks(config);
        };
        let later_s = tail_ticks(config) as f32 * TICK_S;
        let later_rad = PanTilt::from_fn(|j| angle_rad[j] + later_s * rate_rad_s[j]);
        let (Some(here), Some(there)) = (Direction::of(angle_rad), Direction::of(later_rad)) else {
            return true;
        };
        let width_rad = WIDTH * config.standing_radius_rad;
        let here = self.rows.squares(here, width_rad);
        let there = self.rows.squares(there, width_rad);
        let (now, mut beneath) = (self.now, self.beneath);
        let is_new_shut = beneath.is_shut(now, most);
        self.beneath = beneath;
        let mut is_shut = |k: usize, square: Square| {
            self.grids[k].find(square).map_or(is_new_shut, |spent| spent.is_shut(now, most))
        };
        (0..4).any(|k| is_shut(k, here[k]) || (there[k] != here[k] && is_shut(k, there[k])))
    }

    /// Whether a head of which nobody knows where it points may light all of a dot of so many ticks.
    pub(crate) fn has_room(&mut self, config: &Config, ticks: u32) -> bool {
        let most = most(config);
        let lasts = ticks + tail_ticks(config);
        let left = most - self.beneath.held(self.now) >= ticks as f32;
        left && !self.beneath.is_shut(self.now, most) && self.recent.left_ticks() >= lasts
    }

    /// Angles mean other directions from now on: what was spent somewhere may have been spent anywhere.
    pub(crate) fn turn(&mut self) {
        for grid in &mut self.grids {
            for spent in &grid.spent {
                self.beneath.rise_to(spent, self.now);
            }
            *grid = Grid::EMPTY;
        }
    }

    /// A plan wants light in this tick and only this budget speaks against it, or not.
    pub(crate) const fn ask(&mut self, in_vain: bool) {
        self.asked_ticks = if in_vain { self.asked_ticks.saturating_add(1) } else { 0 };
    }

    /// Whether a plan has asked in vain for too long.
    pub(crate) const fn is_asked_too_long(&self) -> bool {
        self.asked_ticks >= PATIENCE_TICKS
    }
}

/// Longest dot of a head of which nobody knows where it points, ticks: a second with all that shines on, or the budget where that is less.
pub(crate) fn longest_dot_ticks(config: &Config) -> u32 {
    config.standing_ticks.min(RecentLight::MOST_TICKS).saturating_sub(tail_ticks(config)).max(1)
}

/// How long there may be light after a gate that falls in this tick.
const fn tail_ticks(config: &Config) -> u32 {
    config.laser_off_ticks + SLACK_TICKS + 1
}

/// What a square may hold when the gate falls: with what shines on its budget is spent.
fn most(config: &Config) -> f32 {
    config.standing_ticks.saturating_sub(tail_ticks(config)).max(1) as f32
}

/// What light was charged to a square, less what has leaked.
#[derive(Clone, Copy, Debug)]
struct Spent {
    square: Square,
    /// Ticks, when it was charged last.
    held: f32,
    /// That tick.
    charged: u32,
    /// It held all it may, and has not leaked since.
    shut: bool,
}

impl Spent {
    const NOTHING: Self = Self { square: Square::NONE, held: 0.0, charged: 0, shut: false };

    /// What it holds after that tick, if it was dark, or charged already.
    fn held(&self, now: u32) -> f32 {
        (self.held - LEAK * now.wrapping_sub(self.charged) as f32).max(0.0)
    }

    fn charge(&mut self, now: u32, most: f32) {
        // this tick is lit, and does not leak
        self.held = if self.charged == now { self.held } else { self.held(now.wrapping_sub(1)) } + 1.0;
        self.charged = now;
        self.shut |= self.held >= most;
    }

    fn is_shut(&mut self, now: u32, most: f32) -> bool {
        let held = self.held(now);
        self.shut = held >= most || (self.shut && held > OPEN_AGAIN * most);
        self.shut
    }

    /// Holds no less than the other from now on.
    fn rise_to(&mut self, other: &Self, now: u32) {
        let held = other.held(now);
        if held > self.held(now) {
            (self.held, self.charged) = (held, now);
        }
        self.shut |= other.shut;
    }
}

/// One of four ways to part all directions into squares, and what those hold that light fell into.
#[derive(Clone, Copy, Debug)]
struct Grid {
    spent: [Spent; SQUARES],
    latest: usize,
}

impl Grid {
    const EMPTY: Self = Self { spent: [Spent::NOTHING; SQUARES], latest: 0 };

    fn latest(&mut self) -> &mut Spent {
        &mut self.spent[self.latest % SQUARES]
    }

    fn find(&mut self, square: Square) -> Option<&mut Spent> {
        if self.latest().square == square {
            return Some(self.latest());
        }
        self.spent.iter_mut().find(|spent| spent.square == square)
    }

    /// Makes a square the latest; what is no longer remembered for it, if anything.
    fn enter(&mut self, square: Square, now: u32, beneath: &Spent) -> Spent {
        if self.latest().square == square {
            return Spent::NOTHING;
        }
        if let Some(place) = self.spent.iter().position(|spent| spent.square == square) {
            self.latest = place;
            return Spent::NOTHING;
        }
        let least = |&a: &usize, &b: &usize| self.spent[a].held(now).total_cmp(&self.spent[b].held(now));
        self.latest = (0..SQUARES).min_by(least).unwrap_or(0);
        core::mem::replace(self.latest(), Spent { square, ..*beneath })
    }
}

/// Number of a square in its grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Square {
    row: i32,
    column: i32,
}

impl Square {
    /// None of any grid.
    const NONE: Self = Self { row: i32::MIN, column: 0 };
}

/// Which way the beam goes: tilt not beyond straight up or down.
#[derive(Clone, Copy)]
struct Direction {
    pan_turns: f32,
    tilt_rad: f32,
}

impl Direction {
    /// `None` for what is no number, or further round than any joint goes.
    fn of(angle_rad: PanTilt<f32>) -> Option<Self> {
        if !(angle_rad.pan.abs() < 10.0 * TAU && angle_rad.tilt.abs() < PI) {
            return None;
        }
        // beyond the pole it points where another pan would have it, from the other side
        let (pan_rad, tilt_rad) = match angle_rad.tilt {
            tilt if tilt > FRAC_PI_2 => (angle_rad.pan + PI, PI - tilt),
            tilt if tilt < -FRAC_PI_2 => (angle_rad.pan + PI, -PI - tilt),
            tilt => (angle_rad.pan, tilt),
        };
        Some(Self { pan_turns: pan_rad / TAU, tilt_rad })
    }
}

/// How many squares the rows have that the beam was in last: of the grids whose rows begin straight ahead, and of those beside them.
#[derive(Clone, Copy, Debug)]
struct Rows {
    row: [i32; 2],
    across: [f32; 2],
}

impl Rows {
    const NONE: Self = Self { row: [i32::MIN; 2], across: [1.0; 2] };

    /// The square of each grid that a direction lies in.
    fn squares(&mut self, direction: Direction, width_rad: f32) -> [Square; 4] {
        let mut squares = [Square::NONE; 4];
        for tall in 0..2 {
            let row = floor(direction.tilt_rad / width_rad + 0.5 * tall as f32);
            if row != self.row[tall] {
                self.row[tall] = row;
                self.across[tall] = across((row as f32 - 0.5 * tall as f32) * width_rad, width_rad);
            }
            for wide in 0..2 {
                let along = (direction.pan_turns - floor(direction.pan_turns) as f32) * self.across[tall];
                let column = floor(along + 0.5 * wide as f32);
                // once round
                let column = if column as f32 >= self.across[tall] { 0 } else { column };
                squares[2 * tall + wide] = Square { row, column };
            }
        }
        squares
    }
}

/// How many squares fit round a row that begins at that tilt, rad, where it is narrowest.
fn across(from_rad: f32, width_rad: f32) -> f32 {
    let furthest_rad = from_rad.abs().max((from_rad + width_rad).abs());
    libm::floorf(TAU * libm::cosf(furthest_rad) / width_rad).max(1.0)
}

/// The whole number below.
fn floor(value: f32) -> i32 {
    let towards_zero = value as i32;
    towards_zero - i32::from(towards_zero as f32 > value)
}

//! Bounds the light in one place to a budget, however often the spot returns there.
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

use tracelight_rig::{Fault, PanTilt, TICK_S};

use crate::config::Config;
use crate::finding::Finding;
use crate::recent_light::RecentLight;
use crate::squares::{Common, Direction, Rows, Square};

/// Squares that a grid remembers.
const SQUARES: usize = 32;
/// What leaks in a dark tick, as a share of what a lit one charges.
const LEAK: f32 = 0.1;
/// Width of a square in radii: more than 4, see above.
const WIDTH: f32 = 4.1;
/// Share of the budget down to which a square that spent it must leak before there is light again: a relay is not to chatter at the brim.
const OPEN_AGAIN: f32 = 0.5;
/// A dark time after which nothing is left of any budget, ticks.
const LONG_DARK_TICKS: u32 = 1 << 20;
/// Ticks a laser may shine longer than its relay is believed to let it.
const SLACK_TICKS: u32 = 2;
/// How often it is looked up at most what any square holds, ticks: it takes as long as some ticks else.
const LOOK_UP_TICKS: u32 = 64;
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
    /// Exposure of the squares that were entered last.
    common: Common,
    /// Lit ticks up to the last one that are not yet charged to these squares.
    pending: u32,
    /// Upper bound of the exposure of any square, ticks: its value at the last lookup plus the light since.
    bound: f32,
    looked_up: u32,
    /// The next bound, of the grids that were looked up for it so far, and how many those are.
    next_bound: f32,
    looked: usize,
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
            common: Common::NONE,
            pending: 0,
            bound: 0.0,
            looked_up: 0,
            next_bound: 0.0,
            looked: 0,
            beneath: Spent::NOTHING,
            recent: RecentLight::NONE,
            shut_ticks: u32::MAX,
            asked_ticks: 0,
        }
    }

    /// Of a head whose gate fell that long ago, and of which nobody knows where it was lit before: it may have been anywhere, for as long as it may be.
    pub fn spent(config: &Config, shut_ticks: u32) -> Self {
        // some minutes after it nothing is left
        let dark_ticks = shut_ticks.saturating_sub(tail_ticks(config)).min(LONG_DARK_TICKS);
        let recent = RecentLight::full_before(dark_ticks);
        let mut budget = Self { now: dark_ticks, recent, shut_ticks, ..Self::new() };
        budget.beneath.charge(0, config.standing_ticks, most(config));
        budget.bound = most(config);
        budget.next_bound = budget.bound;
        budget
    }

    /// How long ago the gate fell, ticks; `u32::MAX` of one that was never open.
    pub const fn shut_ticks(&self) -> u32 {
        self.shut_ticks
    }

    /// In how many dark ticks there may be light again where none was charged yet; 0 where there may be now.
    pub fn opens_in_ticks(&self, config: &Config) -> u32 {
        let left = self.beneath.held(self.now) - OPEN_AGAIN * most(config);
        if self.beneath.shut && left > 0.0 { (left / LEAK) as u32 + 1 } else { 0 }
    }

    /// One tick passes. `gate` is whether light was wanted in the last one, `seen` whether any is seen; the joints are at `angle_rad`,
    /// `None` where nobody knows.
    pub fn tick(&mut self, config: &Config, angle_rad: Option<PanTilt<f32>>, gate: bool, seen: Option<bool>) {
        self.now = self.now.wrapping_add(1);
        self.shut_ticks = if gate { 0 } else { self.shut_ticks.saturating_add(1) };
        // a relay may close at once and open late; where light is seen, the worse of the two counts
        let may_shine = self.shut_ticks <= config.laser_off_ticks + SLACK_TICKS;
        let shines = may_shine || seen == Some(true);
        if angle_rad.is_none() || !self.recent.is_dark() {
            self.recent.tick(shines && angle_rad.is_none());
        }
        if !shines {
            return self.settle(config, self.now.wrapping_sub(1));
        }
        self.bound += 1.0;
        self.next_bound += 1.0;
        match angle_rad {
            Some(angle_rad) if self.common.holds(angle_rad) => self.pending += 1,
            _ => self.charge(config, angle_rad.and_then(Direction::of)),
        }
    }

    /// Charges this tick to where the beam goes that went elsewhere before.
    #[inline(never)] // most ticks do not come here
    fn charge(&mut self, config: &Config, direction: Option<Direction>) {
        self.settle(config, self.now.wrapping_sub(1));
        let Some(direction) = direction else {
            return self.beneath.charge(self.now, 1, most(config));
        };
        let (squares, common) = self.rows.squares(direction, WIDTH * config.standing_radius_rad);
        self.common = common;
        for (grid, square) in self.grids.iter_mut().zip(squares) {
            let dropped = grid.enter(square, self.now, &self.beneath);
            grid.latest().charge(self.now, 1, most(config));
            self.beneath.rise_to(&dropped, self.now);
        }
    }

    /// Charges what is pending, of which that tick was the last.
    fn settle(&mut self, config: &Config, last: u32) {
        if self.pending > 0 {
            let most = most(config);
            self.grids.iter_mut().for_each(|grid| grid.latest().charge(last, self.pending, most));
            self.pending = 0;
        }
    }

    /// Whether light is forbidden at these joint angles, rad, or where the joints will be, at this speed in rad/s, once a gate that falls now has
    /// darkened the beam; `None` if the position is unknown.
    pub fn is_spent(&mut self, config: &Config, at: Option<(PanTilt<f32>, PanTilt<f32>)>) -> bool {
        let most = most(config);
        let Some((angle_rad, rate_rad_s)) = at else {
            return self.beneath.is_shut(self.now, most) || self.recent.left_ticks() <= tail_ticks(config);
        };
        if self.bound < most {
            return !(angle_rad.pan + angle_rad.tilt).is_finite();
        }
        self.is_spent_near(config, (angle_rad, rate_rad_s))
    }

    /// Looks the squares up, for when one of them may have spent its budget.
    #[inline(never)] // most ticks do not come here
    fn is_spent_near(
        &mut self,
        config: &Config,
        (angle_rad, rate_rad_s): (PanTilt<f32>, PanTilt<f32>),
    ) -> bool {
        self.settle(config, self.now);
        self.look_up(most(config));
        let later_s = tail_ticks(config) as f32 * TICK_S;
        let later_rad = PanTilt::from_fn(|j| angle_rad[j] + later_s * rate_rad_s[j]);
        [angle_rad, later_rad].into_iter().any(|place| self.is_shut(config, place))
    }

    /// Whether any square that a place lies in has spent its budget.
    fn is_shut(&mut self, config: &Config, place_rad: PanTilt<f32>) -> bool {
        let Some(direction) = Direction::of(place_rad) else { return true };
        let (squares, _) = self.rows.squares(direction, WIDTH * config.standing_radius_rad);
        let (now, most) = (self.now, most(config));
        let is_new_shut = self.beneath.is_shut(now, most);
        let mut squares = self.grids.iter_mut().zip(squares);
        squares.any(|(grid, square)| grid.find(square).map_or(is_new_shut, |spent| spent.is_shut(now, most)))
    }

    /// Looks up now and then what any square holds at most, one grid in a tick.
    fn look_up(&mut self, most: f32) {
        if self.now.wrapping_sub(self.looked_up) < LOOK_UP_TICKS {
            return;
        }
        let now = self.now;
        let holds = |spent: &mut Spent| if spent.is_shut(now, most) { most } else { spent.held(now) };
        if self.looked == 0 {
            // what any new square may hold
            self.next_bound = holds(&mut self.beneath);
        }
        if let Some(grid) = self.grids.get_mut(self.looked) {
            self.next_bound = grid.spent.iter_mut().map(holds).fold(self.next_bound, f32::max);
            self.looked += 1;
            return;
        }
        self.bound = self.next_bound.max(holds(&mut self.beneath));
        (self.looked, self.looked_up) = (0, now);
    }

    /// Whether a head of which nobody knows where it points may light all of a dot of so many ticks.
    pub(crate) fn has_room(&mut self, config: &Config, ticks: u32) -> bool {
        let most = most(config);
        let lasts = ticks + tail_ticks(config);
        let left = most - self.beneath.held(self.now) >= ticks as f32;
        left && !self.beneath.is_shut(self.now, most) && self.recent.left_ticks() >= lasts
    }

    /// Angles mean other directions from now on: what was spent somewhere may have been spent anywhere.
    pub(crate) fn turn(&mut self, config: &Config) {
        self.settle(config, self.now);
        self.common = Common::NONE;
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

    /// The fault that it is when a plan has asked in vain for too long.
    pub(crate) fn asked_too_long(&self) -> Option<Finding> {
        (self.asked_ticks >= PATIENCE_TICKS)
            .then(|| Finding::after(Fault::LightStood, self.asked_ticks, PATIENCE_TICKS))
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
    /// Exposure when last charged, ticks.
    held: f32,
    /// Tick of the last charge.
    charged: u32,
    /// Whether the square reached its limit and has not leaked since.
    shut: bool,
}

impl Spent {
    const NOTHING: Self = Self { held: 0.0, charged: 0, shut: false };

    /// What it holds after that tick, if it was dark, or charged already.
    fn held(&self, now: u32) -> f32 {
        (self.held - LEAK * now.wrapping_sub(self.charged) as f32).max(0.0)
    }

    /// Charges `ticks` of light, the last of them at tick `last`.
    fn charge(&mut self, last: u32, ticks: u32, most: f32) {
        // a new one holds what any may in its first lit tick already
        let dark = last.wrapping_sub(self.charged).saturating_sub(ticks);
        self.held = (self.held - LEAK * dark as f32).max(0.0) + ticks as f32;
        self.charged = last;
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
    squares: [Square; SQUARES],
    spent: [Spent; SQUARES],
    latest: usize,
}

impl Grid {
    const EMPTY: Self =
        Self { squares: [Square::NONE; SQUARES], spent: [Spent::NOTHING; SQUARES], latest: 0 };

    fn latest(&mut self) -> &mut Spent {
        &mut self.spent[self.latest % SQUARES]
    }

    /// Where a square stands in the table.
    fn place(&self, square: Square) -> Option<usize> {
        if self.squares[self.latest % SQUARES] == square {
            return Some(self.latest);
        }
        // without a branch: all at once
        let places = (0_u32..).zip(&self.squares);
        let place = places.fold(u32::MAX, |found, (k, &other)| if other == square { k } else { found });
        (place != u32::MAX).then_some(place as usize)
    }

    fn find(&mut self, square: Square) -> Option<&mut Spent> {
        self.place(square).map(|place| &mut self.spent[place % SQUARES])
    }

    /// Makes a square the latest; what is no longer remembered for it, if anything.
    fn enter(&mut self, square: Square, now: u32, beneath: &Spent) -> Spent {
        if let Some(place) = self.place(square) {
            self.latest = place;
            return Spent::NOTHING;
        }
        // the one that was entered longest ago, as a rule, has leaked empty
        let next = (self.latest + 1) % SQUARES;
        let least = |&a: &usize, &b: &usize| {
            self.spent[a % SQUARES].held(now).total_cmp(&self.spent[b % SQUARES].held(now))
        };
        self.latest = match self.spent[next].held(now) > 0.0 {
            true => (0..SQUARES).min_by(least).unwrap_or(next),
            false => next,
        };
        self.squares[self.latest % SQUARES] = square;
        core::mem::replace(self.latest(), *beneath)
    }
}

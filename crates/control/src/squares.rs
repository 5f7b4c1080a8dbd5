//! Divides the directions of the beam into the squares of four grids.

use core::f32::consts::{FRAC_PI_2, PI, TAU};

use tracelight_rig::PanTilt;

use crate::elementary::sin_cos;

/// Number of a square in its grid: its row and its column, 16 bits each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Square(u32);

impl Square {
    /// None of any grid.
    pub(crate) const NONE: Self = Self(u32::MAX);

    const fn new(row: i32, column: i32) -> Self {
        Self((row as u32) << 16 | (column as u32 & 0xffff))
    }
}

/// Narrowest square, rad: with it rows and columns are fewer than 16 bits can number.
const NARROWEST_RAD: f32 = 2e-4;

/// Which way the beam goes: tilt not beyond straight up or down.
#[derive(Clone, Copy)]
pub(crate) struct Direction {
    pan_turns: f32,
    tilt_rad: f32,
    /// Tilt is beyond straight up or down, and another pan would have it so from the other side.
    is_over: bool,
}

impl Direction {
    /// `None` for what is no number, or further round than any joint goes.
    pub(crate) fn of(angle_rad: PanTilt<f32>) -> Option<Self> {
        if !(angle_rad.pan.abs() < 10.0 * TAU && angle_rad.tilt.abs() < PI) {
            return None;
        }
        let is_over = angle_rad.tilt.abs() > FRAC_PI_2;
        let (pan_rad, tilt_rad) = match is_over {
            true => (angle_rad.pan + PI, PI.copysign(angle_rad.tilt) - angle_rad.tilt),
            false => (angle_rad.pan, angle_rad.tilt),
        };
        Some(Self { pan_turns: pan_rad / TAU, tilt_rad, is_over })
    }
}

/// How many squares the rows have that the beam was in last: of the grids whose rows begin straight ahead, and of those beside them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows {
    row: [i32; 2],
    across: [f32; 2],
    /// How wide each of them is, turns.
    turns: [f32; 2],
}

impl Rows {
    pub(crate) const NONE: Self = Self { row: [i32::MIN; 2], across: [1.0; 2], turns: [1.0; 2] };

    /// The square of each grid that a direction lies in, and what lies in all of them.
    pub(crate) fn squares(&mut self, direction: Direction, width_rad: f32) -> ([Square; 4], Common) {
        let width_rad = width_rad.max(NARROWEST_RAD);
        let mut squares = [Square::NONE; 4];
        let mut common = Common::all(direction);
        let round = floor(direction.pan_turns) as f32;
        for tall in 0..2 {
            let beside = 0.5 * tall as f32;
            let row = floor(direction.tilt_rad / width_rad + beside);
            let from_rad = (row as f32 - beside) * width_rad;
            if row != self.row[tall] {
                self.row[tall] = row;
                self.across[tall] = across(from_rad, width_rad);
                self.turns[tall] = 1.0 / self.across[tall];
            }
            common.within_tilt(from_rad, from_rad + width_rad);
            let (across, turns) = (self.across[tall], self.turns[tall]);
            for wide in 0..2 {
                let beside = 0.5 * wide as f32;
                let column = floor((direction.pan_turns - round) * across + beside);
                let from_turns = round + (column as f32 - beside) * turns;
                common.within_pan(TAU * from_turns, TAU * (from_turns + turns));
                // once round
                let column = if column as f32 >= across { 0 } else { column };
                squares[2 * tall + wide] = Square::new(row, column);
            }
        }
        (squares, common)
    }
}

/// Joint angles of which all directions lie in the same square of each grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Common {
    least_rad: PanTilt<f32>,
    most_rad: PanTilt<f32>,
}

impl Common {
    pub(crate) const NONE: Self =
        Self { least_rad: PanTilt::new(1.0, 1.0), most_rad: PanTilt::new(-1.0, -1.0) };

    /// All that are not beyond the pole; none where this one is.
    const fn all(direction: Direction) -> Self {
        if direction.is_over {
            return Self::NONE;
        }
        let all = f32::INFINITY;
        Self { least_rad: PanTilt::new(-all, -FRAC_PI_2), most_rad: PanTilt::new(all, FRAC_PI_2) }
    }

    const fn within_pan(&mut self, from_rad: f32, to_rad: f32) {
        self.least_rad.pan = self.least_rad.pan.max(from_rad);
        self.most_rad.pan = self.most_rad.pan.min(to_rad);
    }

    const fn within_tilt(&mut self, from_rad: f32, to_rad: f32) {
        self.least_rad.tilt = self.least_rad.tilt.max(from_rad);
        self.most_rad.tilt = self.most_rad.tilt.min(to_rad);
    }

    /// Whether a direction is one of them; to rounding, which is far less than what is left about a disc in its square.
    pub(crate) fn holds(&self, angle_rad: PanTilt<f32>) -> bool {
        let (least, most) = (self.least_rad, self.most_rad);
        angle_rad.pan >= least.pan
            && angle_rad.pan <= most.pan
            && angle_rad.tilt >= least.tilt
            && angle_rad.tilt <= most.tilt
    }
}

/// How many squares fit round a row that begins at that tilt, rad, where it is narrowest.
fn across(from_rad: f32, width_rad: f32) -> f32 {
    let furthest_rad = from_rad.abs().max((from_rad + width_rad).abs());
    libm::floorf(TAU * sin_cos(furthest_rad).1 / width_rad).max(1.0)
}

/// The whole number below.
fn floor(value: f32) -> i32 {
    let towards_zero = value as i32;
    towards_zero - i32::from(towards_zero as f32 > value)
}

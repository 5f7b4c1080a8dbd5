//! Records where rules were removed and what they left there.

use tracelight_image::threshold::over;
use tracelight_image::{Mask, Plane, Region};
use tracelight_stroke::{Point, polyline_length};

use super::rules::Rules;
use super::wipe::Levels;

/// Share of a patch of ink, and of a line, that lies where rules lay, if they left it.
const PATCH: f64 = 0.6;
const LINE: f64 = 0.9;
/// A line that a rule left is at most so many times as wide as the rule, and px more.
const WIDER: f64 = 1.5;
const WIDER_PX: f64 = 1.0;
/// One that is so many times as long as the rule is wide lies along it by no chance; of one that is shorter than that, but not than this,
/// more is asked.
const LONG: f64 = 4.0;
const SHORTEST: f64 = 2.0;
/// What is darker than a rule by more than this share has ink on it; a rule reaches as far as it has this share of its darkness, and for
/// sure where it has that.
const DARKER: f32 = 1.25;
const FOOT: f32 = 0.02;
const SURE: f32 = 0.25;

/// What was taken off a plane.
#[derive(Clone, Debug)]
pub(crate) struct TakenOff {
    pub(crate) rules: Rules,
    level: Lay,
    upright: Lay,
}

/// Where rules of one direction lay, but for what is darker there than they.
#[derive(Clone, Debug)]
struct Lay {
    /// As far as they are seen.
    far: Mask,
    /// Nearer to their middles.
    near: Mask,
}

impl Lay {
    /// On a plane as it was with the rules on it, which are so dark over the paper's darkness.
    fn of(dark: &Plane<u8>, under: &Plane<u8>, levels: Levels) -> Self {
        let darkest = f32::from(under.values.iter().copied().max().unwrap_or(0));
        let most = (DARKER * darkest).max(darkest + levels.margin());
        let inked = over(dark, most as u8);
        let on = |share: f32| over(under, (share * darkest) as u8).without(&inked);
        Self { far: on(FOOT), near: on(SURE) }
    }
}

impl TakenOff {
    /// Of a plane as it was with the rules on it; how dark level ones are, and upright ones, over the paper's.
    pub(super) fn of(
        dark: &Plane<u8>,
        rules: Rules,
        [level, upright]: [&Plane<u8>; 2],
        levels: Levels,
    ) -> Self {
        let [level, upright] = [level, upright].map(|under| Lay::of(dark, under, levels));
        Self { rules, level, upright }
    }

    /// Converts the rules to the doubled resolution.
    pub(crate) fn doubled(self) -> Self {
        let twice = |mask: Mask| mask.doubled_to(2 * mask.width(), 2 * mask.height());
        let [level, upright] =
            [self.level, self.upright].map(|lay| Lay { far: twice(lay.far), near: twice(lay.near) });
        Self { rules: self.rules.scaled(2.0), level, upright }
    }

    /// Whether rules left a patch of ink: most of it lies where they lay.
    pub(crate) fn left_patch(&self, region: &Region) -> bool {
        let is_on = |&(x, y): &(usize, usize)| {
            let (x, y) = (x as isize, y as isize);
            self.level.far.get(x, y) || self.upright.far.get(x, y)
        };
        region.places().filter(is_on).count() as f64 >= PATCH * region.area() as f64
    }

    /// Whether a rule left a line of some width: it lies along where the rule lay, and is no wider and no darker.
    pub(crate) fn left_line(&self, points: &[Point], width: f64) -> bool {
        let length = polyline_length(points);
        let is_along = |upright: bool, lay: &Lay| {
            let combs = self.rules.combs.iter().filter(|comb| comb.upright == upright);
            let widest = combs.map(|comb| comb.width_px).fold(0.0, f64::max);
            let mask = if length >= LONG * widest { &lay.far } else { &lay.near };
            let may_be = width <= WIDER * widest + WIDER_PX && length >= SHORTEST * widest;
            may_be && share_on(points, mask) >= LINE
        };
        is_along(false, &self.level) || is_along(true, &self.upright)
    }
}

/// Share of a line's length that lies on a mask.
fn share_on(points: &[Point], mask: &Mask) -> f64 {
    let (mut all, mut on) = (0_usize, 0_usize);
    for pair in points.windows(2) {
        let steps = pair[0].distance(pair[1]).ceil().max(1.0) as usize;
        for k in 0..steps {
            let at = pair[0].lerp(pair[1], (k as f64 + 0.5) / steps as f64);
            all += 1;
            on += usize::from(mask.get(at.x.floor() as isize, at.y.floor() as isize));
        }
    }
    on as f64 / all.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::super::rules::Comb;
    use super::*;

    /// A rule of level 80, two px wide, along row 20; from column 60 on there is ink of level 200 on it.
    fn taken_off() -> TakenOff {
        let on_rule = |i: usize| (19..21).contains(&(i / 100));
        let pixels = 100 * 40;
        let plane = |level: &dyn Fn(usize) -> u8| Plane {
            width: 100,
            height: 40,
            values: (0..pixels).map(level).collect(),
        };
        let under = plane(&|i| if on_rule(i) { 80 } else { 0 });
        let dark = plane(&|i| if !on_rule(i) { 0 } else { if i % 100 < 60 { 80 } else { 200 } });
        let comb = Comb { count: 1, spacing_px: 30.0, width_px: 2.0, upright: false, turned_rad: 0.0 };
        let levels = Levels { noise: 0.0, ink: 200.0 };
        TakenOff::of(&dark, Rules { combs: vec![comb] }, [&under, &plane(&|_| 0)], levels)
    }

    #[test]
    fn what_lies_along_a_rule_was_left_by_it_and_what_crosses_it_or_is_darker_was_drawn() {
        let left = |from: (f64, f64), to: (f64, f64), width: f64| {
            taken_off().left_line(&[Point::from(from), Point::from(to)], width)
        };
        assert!(left((10.0, 19.5), (40.0, 20.5), 2.0));
        assert!(!left((10.0, 19.5), (40.0, 20.5), 6.0), "wider");
        assert!(!left((65.0, 20.0), (90.0, 20.0), 2.0), "darker");
        assert!(!left((30.0, 5.0), (30.0, 35.0), 2.0), "across");
    }

    #[test]
    fn twice_as_closely_it_lies_twice_as_far_down_and_is_twice_as_wide() {
        let taken_off = taken_off().doubled();
        let left =
            |y: f64, width: f64| taken_off.left_line(&[Point::new(20.0, y), Point::new(80.0, y)], width);
        assert!(left(40.0, 4.0) && left(40.0, 6.0));
        assert!(!left(20.0, 4.0), "where it lay from afar");
        assert!(!left(40.0, 12.0), "wider");
    }
}

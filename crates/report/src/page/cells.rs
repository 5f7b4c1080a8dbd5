use super::axis::Axis;
use super::html::base64;
use tracelight_rig::TICK_F64_S;

/// More cells than this are made wider: the page stays small, and what is looked at closer is still finer than a screen.
const MOST: usize = 16_000;
/// Heights are kept in so many steps from the axis' low end to its high one: ten times finer than a pixel.
const HEIGHT: f64 = 4000.0;

/// A curve's values for the page's script, which draws them anew where somebody looks closer.
///
/// The axis is parted into cells, a tick each while there are not too many. A cell without a value is the number 0. One with a value is
/// how much it is above the cell's before, in steps, as 2 n for n ≥ 0 and −2 n − 1 below, plus 1; where cells are wider than a tick
/// that is the lowest of its values, and how much the highest is above it follows. Numbers are of seven bits a byte, the low ones
/// first, all but the last byte with the eighth bit set; bytes in base 64.
pub(super) struct Cells {
    text: String,
    /// Whether each has a lowest and a highest value.
    pairs: bool,
}

impl Cells {
    /// Of points over a time axis, in s.
    pub(super) fn new(points: &[(f64, Option<f64>)], x: &Axis, y: &Axis) -> Self {
        let ticks = ((x.high() - x.low()) / TICK_F64_S).round().clamp(1.0, 1e9) as usize + 1;
        let count = ticks.min(MOST);
        let mut cells: Vec<Option<(i64, i64)>> = vec![None; count];
        for (at, value) in points.iter().filter_map(|&(t, v)| Some((t, v.filter(|v| v.is_finite())?))) {
            let place = (at - x.low()) / (x.high() - x.low()) * (count - 1) as f64;
            let height = (y.share(value) * HEIGHT).round() as i64;
            let Some(cell) = cells.get_mut(place.round().max(0.0) as usize) else { continue };
            *cell = Some(cell.map_or((height, height), |(low, high)| (low.min(height), high.max(height))));
        }
        let pairs = ticks > MOST;
        let mut bytes = Vec::with_capacity(count);
        let mut last = 0;
        for cell in cells {
            let Some((low, high)) = cell else {
                push(&mut bytes, 0);
                continue;
            };
            let step = low - last;
            push(&mut bytes, if step < 0 { -2 * step } else { 2 * step + 1 } as u64);
            last = low;
            if pairs {
                push(&mut bytes, (high - low) as u64);
            }
        }
        Self { text: base64(&bytes), pairs }
    }

    /// As attributes of the path that shows them.
    pub(super) fn attributes(&self) -> String {
        format!(r#" data-v="{}"{}"#, self.text, if self.pairs { " data-pairs" } else { "" })
    }
}

fn push(bytes: &mut Vec<u8>, mut number: u64) {
    while number > 127 {
        bytes.push(number as u8 & 127 | 128);
        number >>= 7;
    }
    bytes.push(number as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_says_how_much_it_is_above_the_one_before() {
        let (x, y) = (Axis::new(0.0, 0.004, 4), Axis::new(0.0, 1.0, 4));
        let points = [(0.0, Some(0.0)), (0.001, Some(0.001)), (0.003, Some(0.0)), (0.004, Some(0.1))];
        // 0: 1, 4 steps up: 9, none: 0, 4 down: 8, 400 up: 801 = 33 + 6 · 128
        let cells = Cells::new(&points, &x, &y);
        assert_eq!(cells.attributes(), format!(r#" data-v="{}""#, base64(&[1, 9, 0, 8, 128 + 33, 6])));
    }

    #[test]
    fn a_long_run_keeps_the_lowest_and_the_highest_of_each_cell() {
        let (x, y) = (Axis::new(0.0, 100.0, 4), Axis::new(0.0, 1.0, 4));
        let points: Vec<_> = (0..=100_000).map(|i| (f64::from(i) * 1e-3, Some(f64::from(i % 2)))).collect();
        let attributes = Cells::new(&points, &x, &y).attributes();
        assert!(attributes.ends_with("data-pairs"));
        // a byte for the lowest and two for how much the highest is above it, a cell
        assert!((MOST * 4..MOST * 4 + 40).contains(&attributes.len()), "{}", attributes.len());
    }
}

//! AutoCAD's numbered colours.

use tracelight_stroke::Colour;

/// Numbers of greys, from 250 on.
const GREYS: [u32; 6] = [0x333333, 0x505050, 0x696969, 0x828282, 0xbebebe, 0xffffff];

/// The colour of a number from 1 to 255; `None` for others.
///
/// 7 is white on a black screen and black on white paper: black here. From 10 on, tens are hues 15° apart; within
/// ten, pairs darken, and the odd one of a pair is half saturated.
pub(super) fn colour(number: i64) -> Option<Colour> {
    Some(Colour::from_rgb(match number {
        1 => 0xff0000,
        2 => 0xffff00,
        3 => 0x00ff00,
        4 => 0x00ffff,
        5 => 0x0000ff,
        6 => 0xff00ff,
        7 => 0x000000,
        8 => 0x808080,
        9 => 0xc0c0c0,
        10..=249 => return Some(hue(number as usize)),
        250..=255 => GREYS[(number - 250) as usize],
        _ => return None,
    }))
}

fn hue(number: usize) -> Colour {
    const VALUES: [f64; 5] = [255.0, 165.75, 127.5, 76.5, 38.25];
    let degrees = (number / 10 - 1) * 15;
    let high = VALUES[number % 10 / 2];
    let low = if number.is_multiple_of(2) { 0.0 } else { 0.5 * high };
    let rise = |degrees: usize| (low + (high - low) * degrees as f64 / 60.0) as u8;
    let (up, down) = (rise(degrees % 60), rise(60 - degrees % 60));
    let (high, low) = (high as u8, low as u8);
    match degrees / 60 {
        0 => Colour::new(high, up, low),
        1 => Colour::new(down, high, low),
        2 => Colour::new(low, high, up),
        3 => Colour::new(low, down, high),
        4 => Colour::new(up, low, high),
        _ => Colour::new(high, low, down),
    }
}

/// The number whose colour is the nearest, and whether it is that very colour.
pub(super) fn nearest(colour_of: Colour) -> (i64, bool) {
    let apart = |c: Colour| {
        let sides = [(c.r, colour_of.r), (c.g, colour_of.g), (c.b, colour_of.b)];
        sides.into_iter().map(|(a, b)| i64::from(a.abs_diff(b)).pow(2)).sum::<i64>()
    };
    let all = (1..=255).filter_map(|number| Some((apart(colour(number)?), number)));
    let (distance, number) = all.min().unwrap_or((1, 7));
    (number, distance == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_colours_of_other_readers() {
        // of ezdxf 1.4
        let known = [
            (10, 0xff0000),
            (12, 0xa50000),
            (23, 0xa56752),
            (42, 0xa57c00),
            (83, 0x67a552),
            (122, 0x00a57c),
            (245, 0x7f3f4f),
        ];
        for (number, rgb) in known {
            assert_eq!(colour(number), Some(Colour::from_rgb(rgb)), "{number}");
        }
        assert_eq!((colour(0), colour(256), colour(-1)), (None, None, None));
    }

    #[test]
    fn a_colour_of_the_table_has_its_number() {
        for number in 1..=255 {
            let own = colour(number).unwrap();
            let (found, exact) = nearest(own);
            assert!(exact && colour(found) == Some(own), "{number}");
        }
        assert_eq!(nearest(Colour::new(254, 1, 1)), (1, false));
    }
}

use tracelight_image::Grey;
use tracelight_markers::find_tags;

use crate::scene::Dice;

const WIDTH: usize = 1280;
const HEIGHT: usize = 720;

/// Counts markers in images that have none: patches of all sizes and levels, framed squares of random cells, noise.
pub(crate) fn count(images: u64) {
    let (mut found, mut right) = (0, 0);
    for seed in 0..images {
        let tags = find_tags(&image(&mut Dice::new(seed)));
        found += tags.len();
        right += tags.iter().filter(|tag| tag.wrong_cells == 0).count();
    }
    println!("{found} markers in {images} images that have none, {right} of them without a wrong cell");
}

fn image(dice: &mut Dice) -> Grey {
    let mut levels = vec![dice.between(120.0, 220.0) as u8; WIDTH * HEIGHT];
    for _ in 0..40 {
        let (x, y) = (dice.between(0.0, 1200.0) as usize, dice.between(0.0, 640.0) as usize);
        let (w, h) = (dice.between(4.0, 200.0) as usize, dice.between(4.0, 200.0) as usize);
        let level = dice.between(0.0, 255.0) as u8;
        for row in levels.chunks_mut(WIDTH).skip(y).take(h) {
            row.iter_mut().skip(x).take(w).for_each(|v| *v = level);
        }
    }
    for _ in 0..12 {
        square(&mut levels, dice);
    }
    let noise = dice.between(0.0, 6.0);
    for v in &mut levels {
        *v = (f64::from(*v) + dice.between(-noise, noise)).clamp(0.0, 255.0) as u8;
    }
    Grey::new(WIDTH, HEIGHT, levels).expect("an image")
}

/// A black frame on white about random cells.
fn square(levels: &mut [u8], dice: &mut Dice) {
    let cell = dice.between(2.0, 9.0) as usize;
    let (x, y) = (dice.between(0.0, 1180.0) as usize, dice.between(0.0, 620.0) as usize);
    for row in 0..10 {
        for column in 0..10 {
            let (inner, border) = (
                (1..9).contains(&row) && (1..9).contains(&column),
                [1, 8].contains(&row) || [1, 8].contains(&column),
            );
            let black = inner && (border || dice.between(0.0, 1.0) < 0.5);
            for line in levels.chunks_mut(WIDTH).skip(y + row * cell).take(cell) {
                line.iter_mut()
                    .skip(x + column * cell)
                    .take(cell)
                    .for_each(|v| *v = if black { 30 } else { 220 });
            }
        }
    }
}

//! Lines that a DXF has twice on one layer in one colour. They are told apart before lines are joined, for an outline that is drawn
//! twice has four ends at each corner. All of them stay in the drawing: which lines are left out is decided where the
//! layers have been chosen, for a line on two layers is needed where only one is drawn.

use std::collections::HashMap;

use tracelight_stroke::{Path, Split, doubles};

use super::blocks::Drawn;

/// What is drawn for the first time on its layer and in its colour, and what lies on that.
pub(super) fn apart(drawn: Vec<Drawn>) -> [Vec<Drawn>; 2] {
    let mut alike: HashMap<_, Vec<usize>> = HashMap::new();
    // a dot is no part of a line that it lies on
    for (number, own) in drawn.iter().enumerate().filter(|(_, own)| !own.is_dot) {
        alike.entry((own.layer, own.colour)).or_default().push(number);
    }
    let mut splits: Vec<Option<Split>> = vec![None; drawn.len()];
    for numbers in alike.values() {
        let paths: Vec<&Path> = numbers.iter().map(|&number| &drawn[number].path).collect();
        for (&number, split) in numbers.iter().zip(doubles(&paths).0) {
            splits[number] = split;
        }
    }
    let [mut once, mut again] = [Vec::with_capacity(drawn.len()), Vec::new()];
    for (own, split) in drawn.into_iter().zip(splits) {
        match split {
            None => once.push(own),
            Some(split) => {
                once.extend(split.once.into_iter().map(|path| own.along(path)));
                again.extend(split.again.into_iter().map(|path| own.along(path)));
            }
        }
    }
    [once, again]
}

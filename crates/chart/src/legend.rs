//! Where the entries of a legend stand: one after another, in rows.

/// Pixels: a row's height, the line before a name, the air after it, and what a letter takes at most.
pub(crate) const ROW: i32 = 22;
pub(crate) const LINE: i32 = 22;
const BEFORE_NAME: i32 = 8;
const AFTER: i32 = 26;
const LETTER: i32 = 8;
pub(crate) const EDGE: i32 = 12;

/// From the left of an entry to its name.
pub(crate) const TO_NAME: i32 = LINE + BEFORE_NAME;

/// For each entry, given by its name, how far from the left it stands, and in which row, from zero.
pub(crate) fn places(names: &[&str], width: i32) -> Vec<(i32, i32)> {
    let (mut x, mut row) = (EDGE, 0);
    let mut places = Vec::with_capacity(names.len());
    for name in names {
        let wide = TO_NAME + LETTER * name.chars().count() as i32;
        if x > EDGE && x + wide > width - EDGE {
            (x, row) = (EDGE, row + 1);
        }
        places.push((x, row));
        x += wide + AFTER;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_follow_each_other_and_fold() {
        let keys = ["state", "a rather long name of a law", "pid"];
        assert_eq!(places(&keys, 1000), [(12, 0), (108, 0), (380, 0)]);
        assert_eq!(places(&keys, 300), [(12, 0), (12, 1), (12, 2)]);
    }
}

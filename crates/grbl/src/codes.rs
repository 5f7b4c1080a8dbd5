//! What the numbers mean with which a board refuses a line, or stops.

/// Why a board refuses a line, by its number.
#[must_use]
pub fn error_text(code: u16) -> &'static str {
    match code {
        1 => "a word of the line does not begin with a letter",
        2 => "a number of the line cannot be read",
        3 => "it does not know that $ command",
        4 => "a value is negative that may not be",
        5 => "homing is off ($22=0)",
        6 => "a step pulse would be too short",
        7 => "its stored settings were spoilt and are the usual ones now: set them again",
        8 => "it takes $ commands only while it is idle",
        9 => "it is locked by an alarm, or jogs",
        10 => "soft limits need homing ($22=1)",
        11 => "the line is longer than its memory",
        12 => "so many steps a second are more than it makes",
        13 => "its door is open",
        14 => "the line is longer than what it stores",
        15 => "the jog leads beyond its travel",
        16 => "that is no jog",
        17 => "laser mode needs a spindle output by pulse width",
        20 => "it does not know that command",
        21 => "two commands of one group are in the line",
        22 => "no feed rate is set",
        23 => "a whole number is needed",
        24 => "two commands want the axes of the line",
        25 => "a word is twice in the line",
        26 => "axes are missing in the line",
        27 => "the line's number is not valid",
        28 => "a value that the command needs is missing",
        29 => "there are no work coordinates of that number",
        30 => "G53 goes with G0 and G1 alone",
        31 => "axes are in the line that nothing uses",
        32 => "an arc needs an axis of its plane",
        33 => "the arc leads nowhere that can be",
        34 => "the arc's radius is not valid",
        35 => "an arc needs its centre or its radius",
        36 => "values are in the line that nothing uses",
        37 => "that axis has no tool length",
        38 => "the tool's number is too large",
        _ => "it does not say why",
    }
}

/// Why a board stopped and is locked, by the number of its alarm.
#[must_use]
pub fn alarm_text(code: u16) -> &'static str {
    match code {
        1 => "an end stop was hit, and it does not know any more where it stands",
        2 => "a move would have led beyond its travel (soft limits, $20=1)",
        3 => "it was reset while it moved, and does not know any more where it stands",
        4 | 5 => "a probe was not in the state that was expected",
        6 => "homing was reset",
        7 => "the door was opened while it homed",
        8 => "homing did not come off the end stop: see $27 and the wiring",
        9 => "homing did not find the end stop: see $130, $131 and the wiring",
        10 => "homing did not find the second end stop of an axis",
        _ => "it does not say why; the manual of its firmware does",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_has_words_of_its_own() {
        let known = (1..=38).filter(|code| ![18, 19].contains(code));
        let texts: Vec<&str> = known.map(error_text).collect();
        for (i, text) in texts.iter().enumerate() {
            assert!(!texts[..i].contains(text) && *text != error_text(99), "{text}");
        }
        assert!((1..=10).all(|code| alarm_text(code) != alarm_text(99)));
    }
}

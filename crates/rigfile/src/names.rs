//! What a rig's name says, where it is no file's.

/// The rig that is to be driven by a board that is emulated behind a wire: `emulated` for that of the preset `report`, or `emulated:NAME`.
#[must_use]
pub fn emulated(name: &str) -> Option<&str> {
    match name.strip_prefix("emulated")? {
        "" => Some("report"),
        rest => rest.strip_prefix(':').filter(|base| !base.is_empty() && !base.starts_with("emulated")),
    }
}

/// Whether a name is that of a serial port, where people have a board.
#[must_use]
pub fn is_port(name: &str) -> bool {
    let number = name.strip_prefix("COM").or_else(|| name.strip_prefix("com"));
    name.starts_with("/dev/")
        || number.is_some_and(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_whether_a_board_is_emulated() {
        assert_eq!(emulated("emulated"), Some("report"));
        assert_eq!(emulated("emulated:worn"), Some("worn"));
        assert_eq!(emulated("emulated:my.toml"), Some("my.toml"));
        for none in ["report", "emulate", "emulated:", "emulated:emulated", "emulatedreport"] {
            assert_eq!(emulated(none), None, "{none}");
        }
    }
}

//! What a rig's name says, where it is no file's.

use tracelight_sim::RigConfig;

/// The rig that is to be driven by a board that is emulated behind a wire: `emulated` for that of the preset `report`, or `emulated:NAME`.
#[must_use]
pub fn emulated(name: &str) -> Option<&str> {
    match name.strip_prefix("emulated")? {
        "" => Some("report"),
        rest => rest.strip_prefix(':').filter(|base| !base.is_empty() && !base.starts_with("emulated")),
    }
}

/// Whether a name is that of a serial port, where people have a board.
fn is_port(name: &str) -> bool {
    let number = name.strip_prefix("COM").or_else(|| name.strip_prefix("com"));
    name.starts_with("/dev/")
        || number.is_some_and(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()))
}

/// What speaks Grbl, and the rig whose head is there, where one is said: `grbl:PORT`, `grbl:tcp:HOST`, `grbl:tcp:HOST:PORT`, each with `:RIG` behind.
#[must_use]
pub fn on_grbl(name: &str) -> Option<(&str, Option<&str>)> {
    let place = name.strip_prefix("grbl:").filter(|place| !place.is_empty())?;
    let is_rig = |rig: &str| rig.ends_with(".toml") || RigConfig::preset(rig).is_some();
    match place.rsplit_once(':') {
        Some((port, rig)) if is_rig(rig) => Some((port, Some(rig))),
        _ => Some((place, None)),
    }
}

/// The port that a name means, and the rig whose head is there, where one is said: `PORT` or `PORT:RIG`. Whether there is such a port is asked; one of the usual
/// names may also be missing.
pub fn at_port(name: &str, is_there: impl Fn(&str) -> bool) -> Option<(&str, Option<&str>)> {
    if is_there(name) {
        return Some((name, None));
    }
    // names of ports may have colons
    let parts = name.rsplit_once(':').filter(|(_, rig)| !rig.is_empty());
    let is_rig = |rig: &str| rig.ends_with(".toml") || RigConfig::preset(rig).is_some();
    match parts {
        Some((port, rig)) if is_there(port) || is_port(port) && is_rig(rig) => Some((port, Some(rig))),
        _ => is_port(name).then_some((name, None)),
    }
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

    #[test]
    fn a_board_that_speaks_grbl_is_named_so() {
        assert_eq!(on_grbl("grbl:/dev/ttyUSB0"), Some(("/dev/ttyUSB0", None)));
        assert_eq!(on_grbl("grbl:/dev/ttyUSB0:my.toml"), Some(("/dev/ttyUSB0", Some("my.toml"))));
        assert_eq!(on_grbl("grbl:tcp:192.168.1.9"), Some(("tcp:192.168.1.9", None)));
        assert_eq!(
            on_grbl("grbl:tcp:fluidnc.local:23:stepper"),
            Some(("tcp:fluidnc.local:23", Some("stepper")))
        );
        for none in ["grbl:", "grbl", "/dev/ttyUSB0", "stepper"] {
            assert_eq!(on_grbl(none), None, "{none}");
        }
    }

    #[test]
    fn a_port_may_say_whose_head_is_there() {
        let there = |name: &str| ["/dev/ttyACM0", "out/head", "/dev/by-path/usb-0:1:1.0"].contains(&name);
        let at = |name| at_port(name, there);
        assert_eq!(at("/dev/ttyACM0"), Some(("/dev/ttyACM0", None)));
        assert_eq!(at("/dev/ttyACM0:worn"), Some(("/dev/ttyACM0", Some("worn"))));
        assert_eq!(at("out/head:my.toml"), Some(("out/head", Some("my.toml"))));
        assert_eq!(at("out/head"), Some(("out/head", None)));
        // what is missing is a port by its name
        assert_eq!(at("/dev/ttyACM7"), Some(("/dev/ttyACM7", None)));
        assert_eq!(at("/dev/ttyACM7:my.toml"), Some(("/dev/ttyACM7", Some("my.toml"))));
        assert_eq!(at("/dev/by-path/usb-0:1:1.0"), Some(("/dev/by-path/usb-0:1:1.0", None)));
        assert_eq!(at("/dev/by-path/usb-0:2:1.0"), Some(("/dev/by-path/usb-0:2:1.0", None)));
        assert_eq!(at("/dev/by-path/usb-0:1:1.0:worn"), Some(("/dev/by-path/usb-0:1:1.0", Some("worn"))));
        for none in ["report", "my.toml", "emulated:worn", "out/foot", "out/foot:worn", ""] {
            assert_eq!(at(none), None, "{none}");
        }
    }
}

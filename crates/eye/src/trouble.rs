//! What goes wrong in a simulated room, and when: to see what is made of it.

use std::fmt;
use std::str::FromStr;

use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{EyeTrouble, LinkSettings, RigConfig, Room, Trouble};
use tracelight_task::Failure;

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    /// An encoder's count is off by so many more.
    Slip(Joint, i32),
    /// The head is bumped into, rad.
    HeadBump(f64),
    /// The rig loses power.
    PowerLoss,
    /// The beam turns further, by that share when the job ends.
    Drift(f64),
    /// Something with the camera.
    Eye(EyeTrouble),
    /// Something with the wire to an emulated board, all the time.
    Link(LinkSettings),
    /// Something with it, or with its host, once.
    Wire(Trouble),
}

/// Something that goes wrong once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TroubleAt {
    what: What,
    /// After the drawing began, s; what happens to the head waits until it draws.
    after_s: f64,
}

/// Of a bump's angle, what is about pan's axis and about tilt's.
const BUMP_SHARES: [f64; 2] = [0.8, 0.6];
/// Longest that is waited, s: as long as a job can be.
const LONGEST_S: f64 = 1800.0;

const KINDS: &str = "pan-slip=COUNTS, tilt-slip=COUNTS, head-bump=DEGREES, power-loss, drift=PERCENT, camera-bump=PX, camera-unplugged, camera-frozen, \
                     camera-black, camera-slow=IMAGES_A_SECOND, camera-stamps=SECONDS, unplug=SECONDS, host-stall=SECONDS; or, all the time and without @SECONDS, \
                     link-loss=PERCENT, link-corrupt=PERCENT, link-delay=MS, link-jitter=MS";

impl FromStr for TroubleAt {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = |why: String| format!("{why}; a trouble is NAME=VALUE@SECONDS, with {KINDS}");
        let is_link = text.starts_with("link-");
        let (what, after) = match text.split_once('@') {
            None if is_link => (text, "0"),
            Some(_) if is_link => {
                return Err(wrong("what is wrong with a link is so all the time: no @".to_owned()));
            }
            parts => parts.ok_or_else(|| wrong("no @ and no time".to_owned()))?,
        };
        let number = |text: &str, most: f64| -> Result<f64, String> {
            let value: f64 = text.parse().map_err(|_| wrong(format!("{text:?} is no number")))?;
            if value.abs() <= most { Ok(value) } else { Err(wrong(format!("{value} is more than {most}"))) }
        };
        let after_s = number(after.strip_suffix('s').unwrap_or(after), LONGEST_S)?;
        let (name, value) = what.split_once('=').unwrap_or((what, ""));
        let within = |least: f64, most: f64| {
            let value = number(value, most)?;
            if value >= least { Ok(value) } else { Err(wrong(format!("{value} is less than {least}"))) }
        };
        let share = |text: &str, unit: &str, most: f64| {
            let value = number(text.strip_suffix(unit).unwrap_or(text), most)?;
            if value >= 0.0 { Ok(value) } else { Err(wrong(format!("{value} is less than 0"))) }
        };
        let percent = |text: &str| share(text, "%", 50.0).map(|percent| 0.01 * percent);
        let ms = |text: &str| share(text, "ms", 1000.0);
        let counts = |joint: Joint| Ok::<_, String>(What::Slip(joint, number(value, 1000.0)?.round() as i32));
        let what = match name {
            "pan-slip" => counts(Joint::Pan)?,
            "tilt-slip" => counts(Joint::Tilt)?,
            "head-bump" => What::HeadBump(number(value, 45.0)?.to_radians()),
            "power-loss" => What::PowerLoss,
            "drift" => What::Drift(0.01 * number(value, 10.0)?),
            "camera-bump" => What::Eye(EyeTrouble::Bump(number(value, 1000.0)?)),
            "camera-unplugged" => What::Eye(EyeTrouble::Unplugged),
            "camera-frozen" => What::Eye(EyeTrouble::Frozen),
            "camera-black" => What::Eye(EyeTrouble::Black),
            "camera-slow" => What::Eye(EyeTrouble::Slow(1.0 / within(0.1, 1000.0)?)),
            "camera-stamps" => What::Eye(EyeTrouble::Stamps(within(0.0, 10.0)?)),
            "link-loss" => What::Link(LinkSettings { loss: percent(value)?, ..LinkSettings::default() }),
            "link-corrupt" => {
                What::Link(LinkSettings { corrupt: percent(value)?, ..LinkSettings::default() })
            }
            "link-delay" => What::Link(LinkSettings { delay_ms: ms(value)?, ..LinkSettings::default() }),
            "link-jitter" => What::Link(LinkSettings { jitter_ms: ms(value)?, ..LinkSettings::default() }),
            "unplug" => What::Wire(Trouble::Unplug((1e3 * within(1e-3, 60.0)?) as u32)),
            "host-stall" => What::Wire(Trouble::HostStall((1e3 * within(1e-3, 60.0)?) as u32)),
            other => return Err(wrong(format!("nobody knows {other:?}"))),
        };
        let takes_none = matches!(
            what,
            What::PowerLoss | What::Eye(EyeTrouble::Unplugged | EyeTrouble::Frozen | EyeTrouble::Black)
        );
        if takes_none && !value.is_empty() {
            return Err(wrong(format!("{name} takes no value")));
        }
        Ok(Self { what, after_s: after_s.max(0.0) })
    }
}

impl fmt::Display for TroubleAt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.what {
            What::Slip(Joint::Pan, _) => "pan-slip",
            What::Slip(Joint::Tilt, _) => "tilt-slip",
            What::HeadBump(_) => "head-bump",
            What::PowerLoss => "power-loss",
            What::Drift(_) => "drift",
            What::Eye(EyeTrouble::Bump(_)) => "camera-bump",
            What::Eye(EyeTrouble::Unplugged) => "camera-unplugged",
            What::Eye(EyeTrouble::Frozen) => "camera-frozen",
            What::Eye(EyeTrouble::Black) => "camera-black",
            What::Eye(EyeTrouble::Slow(_)) => "camera-slow",
            What::Eye(EyeTrouble::Stamps(_)) => "camera-stamps",
            What::Link(_) => return f.write_str("link"),
            What::Wire(Trouble::Unplug(_)) => "unplug",
            What::Wire(_) => "host-stall",
        };
        write!(f, "{name}@{}", self.after_s)
    }
}

impl TroubleAt {
    /// Lets it happen if it is time; whether it did. `left_s` is how long the job goes on.
    pub fn strike(&self, room: &mut Room, (now_s, left_s): (f64, f64), lit: bool) -> bool {
        let of_head = matches!(self.what, What::Slip(..) | What::HeadBump(_) | What::PowerLoss);
        if now_s < self.after_s || (of_head && !lit) {
            return false;
        }
        match self.what {
            What::Slip(joint, counts) => room.rig().suffer(Trouble::EncoderJump(joint, counts)),
            What::HeadBump(rad) => room.rig().suffer(bump(rad)),
            What::PowerLoss => room.rig().suffer(Trouble::PowerLoss),
            What::Drift(share) => room.rig().suffer(Trouble::Drift(share / left_s.max(1.0))),
            What::Eye(trouble) => room.suffer(trouble),
            // of itself
            What::Link(_) | What::Wire(_) => {}
        }
        true
    }

    /// What happens to a head that no camera watches, by itself.
    fn of_rig(&self) -> Option<Trouble> {
        match self.what {
            What::Slip(joint, counts) => Some(Trouble::EncoderJump(joint, counts)),
            What::HeadBump(rad) => Some(bump(rad)),
            What::PowerLoss => Some(Trouble::PowerLoss),
            What::Wire(trouble) => Some(trouble),
            What::Drift(_) | What::Eye(_) | What::Link(_) => None,
        }
    }
}

fn bump(rad: f64) -> Trouble {
    let [pan, tilt] = BUMP_SHARES.map(|share| share * rad);
    Trouble::Bump(PanTilt::new(pan, tilt))
}

/// Has an emulated board and its wire suffer what is theirs, and what a head does that no camera watches.
///
/// # Errors
/// `usage`: there is neither board nor room that could suffer it.
pub fn emulate(rig: &mut RigConfig, troubles: &[TroubleAt], is_watched: bool) -> Result<(), Failure> {
    let wrong = |what: &TroubleAt, needs: &str| {
        Err(Failure::usage(
            "usage",
            format!("--sim-trouble {what}: no real head is driven yet, and this is for {needs}"),
        ))
    };
    for trouble in troubles {
        let of_room = is_watched && !matches!(trouble.what, What::Link(_) | What::Wire(_));
        match (&mut rig.emulated, trouble.what, trouble.of_rig()) {
            _ if of_room => {}
            (None, What::Link(_) | What::Wire(_), _) => {
                return wrong(trouble, "an emulated board: give --rig emulated");
            }
            (Some(emulated), What::Link(link), _) => emulated.link = emulated.link.with(&link),
            (Some(emulated), _, Some(what)) => emulated.troubles.push((trouble.after_s, what)),
            (Some(_), ..) => return wrong(trouble, "a simulated room: give --camera sim:PICTURE"),
            (None, ..) => {
                return wrong(
                    trouble,
                    "a simulated room or an emulated board: give --camera sim:PICTURE or --rig emulated",
                );
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn troubles_are_read_and_what_is_wrong_with_them_told() {
        let read = |text: &str| text.parse::<TroubleAt>();
        let slip = TroubleAt { what: What::Slip(Joint::Pan, 20), after_s: 3.5 };
        assert_eq!(read("pan-slip=20@3.5"), Ok(slip));
        let slow = TroubleAt { what: What::Eye(EyeTrouble::Slow(0.2)), after_s: 0.0 };
        assert_eq!(read("camera-slow=5@0s"), Ok(slow));
        assert!(read("camera-black@1").is_ok());
        for (text, why) in [
            ("pan-slip=20", "no @"),
            ("pan-slip=x@1", "\"x\" is no number"),
            ("head-bump=90@1", "90 is more than 45"),
            ("camera-slow=0@1", "0 is less than 0.1"),
            ("camera-black=1@1", "takes no value"),
            ("quake@1", "nobody knows \"quake\""),
            ("drift=nan@1", "is more than"),
            ("link-loss=1%@3", "all the time"),
            ("link-loss=-1", "-1 is less than 0"),
            ("link-delay=2000ms", "2000 is more than 1000"),
            ("unplug=0@1", "0 is less than 0.001"),
        ] {
            let said = read(text).unwrap_err();
            assert!(said.contains(why), "{text}: {said}");
        }
    }
}

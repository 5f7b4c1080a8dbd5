//! What goes wrong in a simulated room, and when: to see what is made of it.

use std::fmt;
use std::str::FromStr;

use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{EyeTrouble, Room, Trouble};

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
                     camera-black, camera-slow=IMAGES_A_SECOND, camera-stamps=SECONDS";

impl FromStr for TroubleAt {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = |why: String| format!("{why}; a trouble is NAME=VALUE@SECONDS, with {KINDS}");
        let (what, after) = text.split_once('@').ok_or_else(|| wrong("no @ and no time".to_owned()))?;
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
            What::HeadBump(rad) => {
                let [pan, tilt] = BUMP_SHARES.map(|share| share * rad);
                room.rig().suffer(Trouble::Bump(PanTilt::new(pan, tilt)));
            }
            What::PowerLoss => room.rig().suffer(Trouble::PowerLoss),
            What::Drift(share) => room.rig().suffer(Trouble::Drift(share / left_s.max(1.0))),
            What::Eye(trouble) => room.suffer(trouble),
        }
        true
    }
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
        ] {
            let said = read(text).unwrap_err();
            assert!(said.contains(why), "{text}: {said}");
        }
    }
}

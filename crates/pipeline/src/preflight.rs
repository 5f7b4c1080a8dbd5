//! What is looked at before any light.

use jiff::civil::Date;
use serde::Serialize;
use tracelight_rig::{Joint, PanTilt};
use tracelight_task::counted;
use tracelight_trajectory::Plan;

use crate::distance::DistanceFrom;
use crate::driving::{Driving, unreached};
use crate::placed::Placed;
use crate::standing::Standing;

/// A joint that comes nearer than this to the end of its travel is told, rad.
const NEAR_END_RAD: f64 = 0.017;

/// From this angle between the beam and the wall's normal on, spot and errors are more than twice as long as wide, degrees.
const SLANTING_DEG: f64 = 60.0;

/// A rig that was identified so long ago may have worn since, days.
const OLD_DAYS: i64 = 90;

/// How something looks before light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// As it should be.
    Passed,
    /// Somebody should look: it may be wrong.
    Warned,
    /// Nothing will be drawn like this.
    Refused,
}

/// One thing that was looked at.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What.
    pub name: &'static str,
    /// How it looks.
    pub verdict: Verdict,
    /// What was found, and what to do about it.
    pub words: String,
}

impl Check {
    const fn new(name: &'static str, verdict: Verdict, words: String) -> Self {
        Self { name, verdict, words }
    }

    /// Warned where something is so, else passed.
    fn warned_if(name: &'static str, is_wrong: bool, words: String) -> Self {
        Self::new(name, if is_wrong { Verdict::Warned } else { Verdict::Passed }, words)
    }

    /// One line of a list.
    #[must_use]
    pub fn line(&self) -> String {
        let mark = match self.verdict {
            Verdict::Passed => "ok  ",
            Verdict::Warned => "look",
            Verdict::Refused => "no  ",
        };
        format!("{mark}  {:<11}  {}", self.name, self.words)
    }
}

/// What is looked at beside the drawing.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// The head knows where it points.
    pub homed: bool,
    /// The day, such as 2026-11-23.
    pub today: &'a str,
}

/// Looks at all that should be right before any light: reach, torque, speed, standing light, no-go areas, the age of calibrations, homing, the distance.
#[must_use]
pub fn preflight(placed: &Placed, driving: &Driving, plan: &Plan, before: Before<'_>) -> Vec<Check> {
    let standing = Standing::of(&placed.drawing, driving);
    let mut checks = vec![
        homed(before.homed),
        distance(&standing),
        reach(&standing, driving, plan),
        torque(plan),
        speed(plan),
        light(driving),
        no_go(placed),
    ];
    checks.extend(head_age(driving, before.today));
    checks.extend(rig_age(driving, before.today));
    checks
}

fn homed(is_homed: bool) -> Check {
    match is_homed {
        true => Check::new("homed", Verdict::Passed, "it knows where it points".to_owned()),
        false => {
            let words =
                "it does not know where it points: home it (tracelight home at a port, --home with a camera)";
            Check::new("homed", Verdict::Refused, words.to_owned())
        }
    }
}

fn distance(standing: &Standing) -> Check {
    let m = standing.distance_m;
    let is_unknown = standing.from == DistanceFrom::Assumed;
    let who = match is_unknown {
        true => "assumed: every size is wrong as far as it is; measure it, --distance",
        false => standing.from.words(),
    };
    Check::warned_if("distance", is_unknown, format!("{m:.3} m, {who}"))
}

fn reach(standing: &Standing, driving: &Driving, plan: &Plan) -> Check {
    let range = driving.machine.geometry.range_rad;
    let asked = PanTilt::from_fn(|joint: Joint| {
        let angles = plan.points.iter().map(|point| point.joints[joint].position_rad);
        angles.fold((0.0, 0.0), |(least, most): (f64, f64), angle| (least.min(angle), most.max(angle)))
    });
    let degrees =
        |(least, most): (f64, f64)| format!("{:+.0} to {:+.0}°", least.to_degrees(), most.to_degrees());
    let of = |joint: Joint| format!("{joint} {} of {}", degrees(asked[joint]), degrees(range[joint]));
    let mut words = format!("{}, {}", of(Joint::Pan), of(Joint::Tilt));
    let left = |joint| (asked[joint].0 - range[joint].0).min(range[joint].1 - asked[joint].1);
    let is_near = Joint::BOTH.into_iter().any(|joint| left(joint) < NEAR_END_RAD);
    let slants = standing.largest_angle_deg > SLANTING_DEG;
    if is_near {
        words += ": near the end of its travel; draw smaller, or from further away";
    }
    if slants {
        words += &format!(
            ": the beam is up to {:.0}° from square; stand at {:.2} m",
            standing.largest_angle_deg, standing.best_distance_m
        );
    }
    Check::warned_if("reach", is_near || slants, words)
}

fn torque(plan: &Plan) -> Check {
    let percent = 100.0 * plan.torque_peak_fraction();
    Check::warned_if("torque", percent > 100.0, format!("up to {percent:.0} % of what the motors have"))
}

fn speed(plan: &Plan) -> Check {
    let unreached = unreached(plan);
    let is_slow = unreached.is_some();
    let words = unreached.unwrap_or_else(|| format!("lit at {:.3} m/s", plan.set_speed_m_s));
    Check::warned_if("speed", is_slow, words)
}

/// A plan whose light would stand is refused before: see [`check_standing`](crate::check_standing).
fn light(driving: &Driving) -> Check {
    let words = format!("stands nowhere longer than the {} s that are allowed", driving.rig.light.standing_s);
    Check::new("light", Verdict::Passed, words)
}

fn no_go(placed: &Placed) -> Check {
    let words = placed.left_out.map_or_else(|| "no area is to be kept dark".to_owned(), |left| left.words());
    Check::new("no-go", Verdict::Passed, words)
}

fn head_age(driving: &Driving, today: &str) -> Option<Check> {
    let days = age_days(driving.head_date.as_deref()?, today)?;
    let words = match days {
        ..=0 => "found today where it stands".to_owned(),
        _ => {
            format!(
                "found {} ago where it stands: if head or wall were moved since, calibrate again",
                counted(days as usize, "day")
            )
        }
    };
    Some(Check::warned_if("head file", days > 0, words))
}

fn rig_age(driving: &Driving, today: &str) -> Option<Check> {
    let identified = driving.rig.identified.as_ref()?;
    let days = age_days(&identified.date, today)?;
    let ago = counted(days.max(0) as usize, "day");
    let words = match days > OLD_DAYS {
        true => format!("identified {ago} ago: joints wear, identify it again (tracelight lab identify)"),
        false => format!("identified {ago} ago"),
    };
    Some(Check::warned_if("rig file", days > OLD_DAYS, words))
}

/// Days from one day to another; `None` of what is no day.
fn age_days(date: &str, today: &str) -> Option<i64> {
    let [date, today]: [Date; 2] = [date.parse().ok()?, today.parse().ok()?];
    Some(i64::from(date.until(today).ok()?.get_days()))
}

#[cfg(test)]
mod tests {
    use tracelight_aim::HeadPose;
    use tracelight_sim::RigConfig;
    use tracelight_stroke::{Affine, Drawing, Path, Stroke};

    use super::*;
    use crate::driving::{Asked, request_of};
    use crate::schedule::schedule;

    fn looked_at(
        width_m: f64,
        change: impl Fn(&mut Driving),
        homed: bool,
    ) -> Vec<(&'static str, Verdict, String)> {
        let rig = RigConfig::report();
        let request = request_of(&rig);
        let mut driving = Driving::new(rig, HeadPose::square_on(0.9144), request, Asked::default());
        change(&mut driving);
        let ends = [(-0.5 * width_m, 0.0), (0.5 * width_m, 0.0)].map(Into::into);
        let drawing = Drawing { strokes: vec![Stroke::new(Path::polyline(&ends, false).unwrap())] };
        let placed = Placed::of(drawing, (width_m, 0.1), Affine::IDENTITY);
        let plan = schedule(&placed, &driving).unwrap().plan;
        let checks = preflight(&placed, &driving, &plan, Before { homed, today: "2026-11-29" });
        checks.into_iter().map(|check| (check.name, check.verdict, check.words)).collect()
    }

    fn verdict(checks: &[(&'static str, Verdict, String)], name: &str) -> (Verdict, String) {
        let (_, verdict, words) = checks.iter().find(|(own, ..)| *own == name).unwrap();
        (*verdict, words.clone())
    }

    #[test]
    fn what_nobody_told_is_warned_of_and_what_is_told_passes() {
        let checks = looked_at(0.3, |_| (), true);
        assert_eq!(verdict(&checks, "distance").0, Verdict::Warned);
        for name in ["homed", "reach", "torque", "speed", "light", "no-go"] {
            assert_eq!(verdict(&checks, name).0, Verdict::Passed, "{checks:?}");
        }
        assert!(!checks.iter().any(|(name, ..)| name.ends_with("file")), "there is none");
        let told = looked_at(0.3, |driving| driving.asked.distance = DistanceFrom::Asked, true);
        assert_eq!(verdict(&told, "distance").0, Verdict::Passed);
    }

    #[test]
    fn a_head_that_was_not_homed_is_refused() {
        assert_eq!(verdict(&looked_at(0.3, |_| (), false), "homed").0, Verdict::Refused);
    }

    #[test]
    fn the_age_of_a_head_file_is_told() {
        let of = |date: &str| {
            let checks = looked_at(0.3, |driving| driving.head_date = Some(date.to_owned()), true);
            verdict(&checks, "head file")
        };
        assert_eq!(of("2026-11-29").0, Verdict::Passed);
        let (old, words) = of("2026-10-30");
        assert!(old == Verdict::Warned && words.contains("30 days ago"), "{words}");
    }

    #[test]
    fn a_line_so_short_that_its_speed_is_never_reached_is_warned_of() {
        let checks = looked_at(0.01, |_| (), true);
        assert_eq!(verdict(&checks, "speed").0, Verdict::Warned, "{checks:?}");
    }
}

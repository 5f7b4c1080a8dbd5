//! What a limit of a plan is shown in: greys, and one colour for what the motors cannot do.

use tracelight_chart::{Colour, Ramp, Rgb, Theme};
use tracelight_rig::Joint;
use tracelight_trajectory::Binding;

/// The step of the greys, or `None` for the colour of limits that are reached.
const fn grey(limit: Option<Binding>) -> Option<usize> {
    match limit {
        None => Some(0),
        Some(Binding::SpeedCap) => Some(3),
        Some(Binding::Acceleration(_)) => Some(5),
        Some(Binding::Jerk(_)) => Some(6),
        Some(Binding::JointSpeed(_)) => Some(7),
        Some(Binding::Torque(_)) => None,
    }
}

/// On a light ground.
pub(crate) fn rgb(limit: Option<Binding>) -> Rgb {
    let accent = Colour::Limit.rgb(Theme::Light);
    grey(limit).map_or(accent, |step| Ramp::Grey.rgb(step, Theme::Light))
}

/// Its class in the page's style sheet.
pub(crate) fn class(limit: Binding) -> String {
    grey(Some(limit)).map_or_else(|| "fill-limit".to_owned(), |step| format!("fill-g{step}"))
}

/// Whose it is: where the colour does not tell, its place or its pen does.
pub(crate) const fn joint(limit: Binding) -> Option<Joint> {
    match limit {
        Binding::SpeedCap => None,
        Binding::Torque(joint)
        | Binding::Acceleration(joint)
        | Binding::Jerk(joint)
        | Binding::JointSpeed(joint) => Some(joint),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_differ_in_colour_and_joints_do_not() {
        let pan = Binding::ALL.into_iter().filter(|&limit| joint(limit) != Some(Joint::Tilt));
        let mut seen: Vec<String> = pan.map(|limit| rgb(Some(limit)).to_string()).collect();
        seen.push(rgb(None).to_string());
        let all = seen.len();
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), all);
        assert_eq!(rgb(Some(Binding::Jerk(Joint::Pan))), rgb(Some(Binding::Jerk(Joint::Tilt))));
        assert_eq!(class(Binding::Torque(Joint::Tilt)), "fill-limit");
    }
}

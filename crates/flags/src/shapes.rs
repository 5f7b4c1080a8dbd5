use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use tracelight_experiment::profile_name::ProfileName;
use tracelight_trajectory::Ramps;

/// Names of profiles on the command line.
pub fn profile() -> impl TypedValueParser<Value = ProfileName> {
    let known = ProfileName::ALL.map(|profile| PossibleValue::new(profile.name()).help(profile.about()));
    PossibleValuesParser::new(known).map(|name| ProfileName::named(&name).unwrap_or(ProfileName::SCurve))
}

/// `pa1,pa2,pb1,pb2`: shares of the acceleration phase over which the acceleration builds up and fades, and the same of
/// the deceleration phase.
pub fn ramps(text: &str) -> Result<Ramps, String> {
    let wrong = |why: &str| {
        format!(
            "{text} {why}; give four shares with commas between, such as 0.2,0.2,0.15,0.15: how long the acceleration \
             builds up and fades, then the deceleration, each of its own phase and the two not more than 1 together"
        )
    };
    let shares: Result<Vec<f64>, _> = text.split(',').map(|share| share.trim().parse::<f64>()).collect();
    let Ok(&[pa1, pa2, pb1, pb2]) = shares.as_deref() else {
        return Err(wrong("is not four numbers"));
    };
    let in_one = |a: f64, b: f64| a >= 0.0 && b >= 0.0 && a + b <= 1.0;
    if in_one(pa1, pa2) && in_one(pb1, pb2) {
        Ok(Ramps { pa1, pa2, pb1, pb2 })
    } else {
        Err(wrong("leaves a phase less than nothing, or more than all"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_shares_are_ramps_and_nothing_else_is() {
        assert_eq!(ramps("0.2, 0.2,0.15,0.15"), Ok(Ramps::REPORT));
        assert_eq!(ramps("0,0,0,0"), Ok(Ramps::NONE));
        for text in
            ["", "0.2", "0.2,0.2,0.15", "0.6,0.5,0,0", "-0.1,0,0,0", "NaN,0,0,0", "0,0,0,0,0", "a,0,0,0"]
        {
            assert!(ramps(text).unwrap_err().contains("0.2,0.2,0.15,0.15"), "{text}");
        }
    }
}

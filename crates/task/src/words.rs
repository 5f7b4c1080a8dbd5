//! What faults, darknesses and phases mean, in words.

use tracelight_rig::{Darkness, Fault, Phase};

/// So many of something, in words: "1 stroke", "2 strokes".
#[must_use]
pub fn counted(count: usize, one: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {one}{plural}")
}

/// What a fault means and what to look at, one sentence each.
#[must_use]
pub const fn fault_words(fault: Fault) -> &'static str {
    match fault {
        Fault::EncoderJumped => {
            "An encoder's count moved faster than the joint can: look for a loose plug, interference or a slipping disc, and home the head before it is armed again."
        }
        Fault::EncoderDead => {
            "The motor was driven but its encoder did not move: look for a broken wire, a slipping disc or a blocked joint."
        }
        Fault::SetpointsStale => {
            "Segments ran out in the middle of the job: the host was too slow or the connection broke."
        }
        Fault::SetpointInvalid => {
            "A segment left the limits of a joint's angle, speed or acceleration somewhere, let it stray further than any may, or did not join the one before it: plan the job again with this rig file."
        }
        Fault::LimitReached => {
            "A joint left its limits: check the zero of the head and the limits in the rig file."
        }
        Fault::HoldTimedOut => {
            "The head did not come back to its stroke in time: something holds it, or the gains do not suit this rig."
        }
        Fault::EncoderNoisy => {
            "Edges came where the joint was not: look for interference on an encoder's lines, a loose plug or a missing shield."
        }
        Fault::EncoderSlipping => {
            "What an encoder shows and what its motor must have done do not belong together: look for a slipping disc or belt, or an amplifier whose gain is not the rig file's."
        }
        Fault::AmplifierSaturated => {
            "An amplifier gave all it has for 0.3 s: something blocks the joint, or the law and its bandwidth do not suit this rig."
        }
        Fault::MotorHot => {
            "A motor was driven harder than it can be cooled: let it rest. control.motor_continuous and control.motor_heating in the rig file set the bound."
        }
        Fault::LaserStuck => {
            "The laser did not follow its gate: a relay's contact sticks or its coil is not driven. Switch the laser's supply off by hand."
        }
        Fault::HostLost => {
            "The host stopped saying that it is there: it ended, hangs, or the connection broke. control.host_silence sets the bound."
        }
        Fault::EstimateDiverged => {
            "What is believed of a joint's speed does not add up to what its encoder counted: the observer does not suit this rig, or its model is far off."
        }
        Fault::NotANumber => {
            "A measurement, a setpoint or a law's result was no number: look for a broken edge stamp, and report it if there is none."
        }
        _ => "The rig stopped the job for a reason this version has no words for.",
    }
}

/// Why the interlock darkened the beam, one sentence each.
#[must_use]
pub const fn darkness_words(reason: Darkness) -> &'static str {
    match reason {
        Darkness::Planned => "The plan wants no light here.",
        Darkness::Disarmed => "Nobody armed the rig.",
        Darkness::Doubtful => {
            "An encoder showed no edge where its joint should have passed several, does not fit what its motor does, or lost a count."
        }
        Darkness::Unhomed => {
            "The rig was powered up, or lost counts, and was not homed since: nobody knew where light would fall."
        }
        Darkness::HostSilent => "No host had said of late that it is there.",
        Darkness::FollowingError => "A joint was further from its setpoint than the stroke allows.",
        Darkness::SpotError => "Both joints together put the spot too far from its stroke.",
        Darkness::Holding => "The plan waited until the head was back on its stroke.",
        Darkness::OutOfBounds => "A setpoint lay outside the joint limits.",
        Darkness::Stale => "There was no valid setpoint for this tick.",
        Darkness::Faulted => "A fault is latched.",
    }
}

/// A phase's name in tables and logs.
#[must_use]
pub const fn phase_word(phase: Phase) -> &'static str {
    match phase {
        Phase::Dark => "dark",
        Phase::Armed => "armed",
        Phase::Tracing => "tracing",
        Phase::Holding => "holding",
        Phase::Done => "done",
        Phase::Faulted => "faulted",
    }
}

use crate::RelayConfig;

/// A relay: follows its coil after a delay that depends on the direction; a change of mind within the delay is
/// forgotten.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relay {
    config: RelayConfig,
    closed: bool,
    /// How long the coil has asked for the other state, s.
    asked_s: f64,
    stuck: bool,
}

impl Relay {
    pub(crate) const fn new(config: RelayConfig) -> Self {
        Self { config, closed: false, asked_s: 0.0, stuck: false }
    }

    pub(crate) const fn is_closed(&self) -> bool {
        self.closed
    }

    /// The contact stays as it is, welded or worn out; or it does not any more.
    pub(crate) const fn stick(&mut self, stuck: bool) {
        self.stuck = stuck;
    }

    /// Holds the coil for `step_s`.
    pub(crate) fn drive(&mut self, coil: bool, step_s: f64) {
        if coil == self.closed || self.stuck {
            self.asked_s = 0.0;
            return;
        }
        self.asked_s += step_s;
        let delay = if coil { self.config.on_s } else { self.config.off_s };
        // half a step of slack: sums of steps are not exact, and a delay of whole ticks must stay one
        if self.asked_s + 0.5 * step_s >= delay {
            self.closed = coil;
            self.asked_s = 0.0;
        }
    }
}

/// Play between encoder and beam: the beam stays until it is pushed (the play operator of hysteresis; Visintin,
/// *Differential Models of Hysteresis*, §III.2).
pub(crate) fn play(beam_rad: f64, joint_rad: f64, backlash_rad: f64) -> f64 {
    let half = 0.5 * backlash_rad;
    beam_rad.clamp(joint_rad - half, joint_rad + half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_relay_takes_five_milliseconds_on_and_three_off() {
        let mut relay = Relay::new(RelayConfig { on_s: 5e-3, off_s: 3e-3 });
        let mut run = |coil: bool, ticks: usize| {
            for _ in 0..ticks * 10 {
                relay.drive(coil, 1e-4);
            }
            relay.is_closed()
        };
        assert!(!run(true, 4));
        assert!(run(true, 1));
        assert!(run(false, 2));
        assert!(run(true, 2), "a short dropout is not seen");
        assert!(!run(false, 3));
    }

    #[test]
    fn the_beam_waits_in_the_play() {
        assert_eq!(play(0.0, 0.4, 1.0), 0.0);
        assert_eq!(play(0.0, 0.8, 1.0), 0.30000000000000004);
    }
}

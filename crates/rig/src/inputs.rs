//! External safety inputs that forbid light: switches in a loop, status lines of amplifiers and supplies.

use crate::{Fault, Joint};

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Input {
    /// The loop of emergency stops.
    EmergencyStop,
    /// The interlock of a lid or a door.
    Lid,
    /// The key switch.
    Key,
    /// An amplifier's own fault line.
    Amplifier(Joint),
    /// Whether the supply gives the voltage it should.
    Supply,
    /// Thermal switches of laser, amplifiers or motors.
    Temperature,
}

/// What an input says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InputState {
    /// The rig does not have this input.
    Absent,
    /// The input is present and permits light.
    Fine,
    /// The input is present and forbids light, or its line is cut.
    Open,
}

/// What all inputs say, two bits each. A rig says of each which it has; of those it does not have nothing is ever told to be fine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Inputs {
    present: u8,
    open: u8,
}

impl Input {
    /// Every input.
    pub const ALL: [Input; 7] = [
        Input::EmergencyStop,
        Input::Lid,
        Input::Key,
        Input::Amplifier(Joint::Pan),
        Input::Amplifier(Joint::Tilt),
        Input::Supply,
        Input::Temperature,
    ];

    /// The fault that it means when it opens.
    pub const fn fault(self) -> Fault {
        match self {
            Input::EmergencyStop => Fault::EmergencyStop,
            Input::Lid => Fault::InterlockOpen,
            Input::Key => Fault::KeyOff,
            Input::Amplifier(_) => Fault::AmplifierFault,
            Input::Supply => Fault::SupplyLow,
            Input::Temperature => Fault::TooHot,
        }
    }

    /// The joint that it belongs to, if any.
    pub const fn joint(self) -> Option<Joint> {
        match self {
            Input::Amplifier(joint) => Some(joint),
            _ => None,
        }
    }

    /// Its bit in each of the two sets.
    const fn bit(self) -> u8 {
        match self {
            Input::EmergencyStop => 1,
            Input::Lid => 1 << 1,
            Input::Key => 1 << 2,
            Input::Amplifier(Joint::Pan) => 1 << 3,
            Input::Amplifier(Joint::Tilt) => 1 << 4,
            Input::Supply => 1 << 5,
            Input::Temperature => 1 << 6,
        }
    }
}

impl Inputs {
    /// Of a rig that has none.
    pub const ABSENT: Inputs = Inputs { present: 0, open: 0 };

    /// Returns a copy with one input changed.
    #[must_use]
    pub const fn with(self, input: Input, state: InputState) -> Self {
        let (bit, others) = (input.bit(), !input.bit());
        let (present, open) = (self.present & others, self.open & others);
        match state {
            InputState::Absent => Self { present, open },
            InputState::Fine => Self { present: present | bit, open },
            InputState::Open => Self { present: present | bit, open: open | bit },
        }
    }

    /// What one of them says.
    pub const fn state(self, input: Input) -> InputState {
        if self.present & input.bit() == 0 {
            InputState::Absent
        } else if self.open & input.bit() == 0 {
            InputState::Fine
        } else {
            InputState::Open
        }
    }

    /// Those there are, a bit each in the order of [`Input::ALL`].
    pub const fn present_bits(self) -> u8 {
        self.present
    }

    /// Those that say stop, a bit each in the same order.
    pub const fn open_bits(self) -> u8 {
        self.open
    }

    /// Of inputs of which these are there, what they say when these bits say stop; of one that is not there nothing is said.
    #[must_use]
    pub const fn opened_by(self, open_bits: u8) -> Self {
        Self { present: self.present, open: open_bits & self.present }
    }

    /// Whether any of them says stop.
    pub const fn any_open(self) -> bool {
        self.open != 0
    }

    /// Those that say stop, in the order of [`Input::ALL`].
    pub fn opened(self) -> impl Iterator<Item = Input> {
        Input::ALL.into_iter().filter(move |&input| self.open & input.bit() != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Clears, Motors};

    #[test]
    fn what_a_rig_does_not_have_is_never_fine() {
        for input in Input::ALL {
            assert_eq!(Inputs::default().state(input), InputState::Absent);
            let one = Inputs::ABSENT.with(input, InputState::Fine);
            for other in Input::ALL.into_iter().filter(|&other| other != input) {
                assert_eq!(one.state(other), InputState::Absent, "{other:?} beside {input:?}");
            }
            let gone = one.with(input, InputState::Open).with(input, InputState::Absent);
            assert_eq!(gone, Inputs::ABSENT, "{input:?}");
        }
    }

    #[test]
    fn each_input_opens_by_itself_into_a_fault_that_waits_for_it() {
        let fine = Input::ALL.into_iter().fold(Inputs::ABSENT, |all, i| all.with(i, InputState::Fine));
        assert!(!fine.any_open() && fine.opened().next().is_none());
        for input in Input::ALL {
            let open = fine.with(input, InputState::Open);
            assert!(open.any_open());
            assert!(open.opened().eq([input]), "{input:?}");
            let row = input.fault().row();
            assert_eq!(row.clears, Clears::FineAndArmed, "{input:?}");
            let holds = matches!(input, Input::Lid | Input::Key);
            assert_eq!(row.motors, if holds { Motors::Held } else { Motors::Off }, "{input:?}");
            assert_eq!(open.with(input, InputState::Fine), fine);
        }
    }
}

use crate::{Input, InputState, Inputs};

/// What a rig has, beside two joints and a gate: what it does not have is absent, never fine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Capabilities {
    /// Its encoders' edges are stamped: [`Measurement::edge_age_ticks`](crate::Measurement::edge_age_ticks).
    pub stamps: bool,
    /// Something watches the switch that the gate drives: [`Sensed::laser_on`](crate::Sensed::laser_on).
    pub gate_watched: bool,
    /// Something sees the light that leaves the head: [`Sensed::light`](crate::Sensed::light).
    pub light_watched: bool,
    /// A gyroscope is fixed to its foot: [`Sensed::foot_rad_s`](crate::Sensed::foot_rad_s).
    pub gyroscope: bool,
    /// The length of its ticks is measured: [`Sensed::lasted_ticks`](crate::Sensed::lasted_ticks).
    pub times_ticks: bool,
    /// Its encoders know their angle from power-up on: it needs no homing.
    pub absolute: bool,
    /// Its safety inputs; of those that are present it says what they say in each tick.
    pub inputs: Inputs,
}

impl Capabilities {
    /// A bit each: the flags in the order of the fields from bit 0, from bit 16 on the safety inputs that there are, in the order of [`Input::ALL`].
    pub fn bits(&self) -> u32 {
        let Self { stamps, gate_watched, light_watched, gyroscope, times_ticks, absolute, inputs } = *self;
        let flags = [stamps, gate_watched, light_watched, gyroscope, times_ticks, absolute];
        let flags = (0..).zip(flags).fold(0, |bits, (bit, has)| bits | u32::from(has) << bit);
        flags | u32::from(inputs.present_bits()) << 16
    }

    /// From these bits; `None` if there are others, which a newer rig may have.
    pub fn from_bits(bits: u32) -> Option<Self> {
        let has = |bit: u32| bits & 1 << bit != 0;
        let inputs = Input::ALL.into_iter().zip(16..).filter(|&(_, bit)| has(bit));
        let inputs = inputs.fold(Inputs::ABSENT, |all, (input, _)| all.with(input, InputState::Fine));
        let read = Self {
            stamps: has(0),
            gate_watched: has(1),
            light_watched: has(2),
            gyroscope: has(3),
            times_ticks: has(4),
            absolute: has(5),
            inputs,
        };
        (read.bits() == bits).then_some(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bits of the flags, in the order of the fields.
    const FLAGS: u32 = 6;

    #[test]
    fn each_has_a_bit_of_its_own_and_others_are_not_known() {
        for bit in 0..32 {
            let read = Capabilities::from_bits(1 << bit);
            let is_known = bit < FLAGS || (16..16 + Input::ALL.len() as u32).contains(&bit);
            assert_eq!(read.map(|read| read.bits()), is_known.then_some(1 << bit), "{bit}");
        }
        let all = ((1 << FLAGS) - 1) | (0x7F << 16);
        assert_eq!(Capabilities::from_bits(all).map(|read| read.bits()), Some(all));
        assert_eq!(Capabilities::from_bits(0), Some(Capabilities::default()));
    }
}

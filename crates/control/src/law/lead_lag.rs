/// Two sections in a row: up to four poles and four zeros from error to torque, N m/rad.
///
/// Discretized for the tick by whoever makes it; an unused section is [`Biquad::PASS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeadLag {
    /// Sections, in signal order.
    pub sections: [Biquad; 2],
}

/// (b₀ + b₁ z⁻¹ + b₂ z⁻²) / (1 + a₁ z⁻¹ + a₂ z⁻²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Biquad {
    /// b₀, b₁, b₂.
    pub numerator: [f32; 3],
    /// a₁, a₂.
    pub denominator: [f32; 2],
}

impl Biquad {
    /// Changes nothing.
    pub const PASS: Self = Self { numerator: [1.0, 0.0, 0.0], denominator: [0.0; 2] };

    /// Transposed direct form II: the form that loses least in `f32`.
    fn pass(&self, memory: &mut [f32; 2], input: f32) -> f32 {
        let [b0, b1, b2] = self.numerator;
        let [a1, a2] = self.denominator;
        let output = b0 * input + memory[0];
        memory[0] = b1 * input - a1 * output + memory[1];
        memory[1] = b2 * input - a2 * output;
        output
    }
}

/// Two numbers a section.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LeadLagState([[f32; 2]; 2]);

impl LeadLag {
    pub(super) fn torque_nm(&self, state: &mut LeadLagState, error_rad: f32) -> f32 {
        let sections = self.sections.iter().zip(&mut state.0);
        sections.fold(error_rad, |signal, (section, memory)| section.pass(memory, signal))
    }
}

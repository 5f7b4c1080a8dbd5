use crate::{Actuation, Command, Sensed, Telemetry};

/// The hardware seam: motors, encoders and laser of one head, boards or equations.
///
/// Implementations MUST
/// - return from [`exchange`](Self::exchange) once per tick, one tick after the last return;
/// - hold the actuation (zero-order) until the next exchange;
/// - take both encoders' counts at the same instant, and never wrap them within a job;
/// - stamp an edge either always or never ([`Measurement::edge_age_ticks`](crate::Measurement::edge_age_ticks));
/// - open both of the laser's switches and zero the amplifiers by themselves when the exchanges stop coming;
/// - say what is seen of the laser's switch and of its light either always or never ([`Sensed::laser_on`], [`Sensed::light`]);
/// - drive each of the laser's switches by its own command, whatever the other says;
/// - tell nothing of an input that is not there ([`InputState::Absent`](crate::InputState::Absent)), and a line that is cut as open;
/// - never fail: a dead encoder is a count that does not move, which is the controller's to notice.
pub trait Head {
    /// Applies an actuation for one tick and returns what is sensed at its end.
    fn exchange(&mut self, actuation: &Actuation) -> Sensed;
}

/// The host's seam: a controller with its head, behind a wire or in this process.
///
/// Implementations MUST
/// - start dark, disarmed and unhomed ([`Command::Home`]);
/// - refuse a command they cannot hold by returning it, and lose none they accepted;
/// - deliver one [`Telemetry`] for every tick, in order, none twice;
/// - darken within one tick of the host's disappearance becoming known.
pub trait Rig {
    /// Hands over a command; gives it back when the rig's queue is full.
    fn send(&mut self, command: Command) -> Result<(), Command>;

    /// Waits for the next tick's telemetry; `None` once the rig is gone.
    fn next(&mut self) -> Option<Telemetry>;
}

/// Whoever borrows a rig drives it.
impl<R: Rig + ?Sized> Rig for &mut R {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        (**self).send(command)
    }

    fn next(&mut self) -> Option<Telemetry> {
        (**self).next()
    }
}

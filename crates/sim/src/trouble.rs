use tracelight_plant::{LooseBelt, Weakening};
use tracelight_rig::{Input, InputState, Joint, Measurement, PanTilt};

/// What can go wrong with a rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// Somebody leans on the head: torque at the joints, N m.
    Push(PanTilt<f64>),
    /// The supply sags: that share is left of what the amplifiers give, and of the most they can.
    SupplySag(f64),
    /// An encoder's line is cut: its count stands still.
    EncoderCut(Joint),
    /// An encoder's count is off by that many more.
    EncoderJump(Joint, i32),
    /// Noise on an encoder's lines: in that share of all ticks it reads a count too many or too few.
    EncoderNoise(Joint, f64),
    /// An encoder's disc slips: it turns by that share of what the joint turns.
    EncoderSlip(Joint, f64),
    /// An encoder's counter takes that share of the edges its disc shows.
    EdgesMissed(Joint, f64),
    /// A joint's belt jumps teeth where it carries too much.
    BeltSkip(Joint, LooseBelt),
    /// A joint's amplifier gives less and less torque for a volt.
    AmplifierWeakens(Joint, Weakening),
    /// An encoder's stamps are no numbers.
    StampGarbled(Joint),
    /// The laser's relay stays as it is; its second switch, the enable, goes on working.
    LaserStuck,
    /// Somebody put in another relay: it follows the gate again.
    LaserMended,
    /// The laser's second switch, the enable's, stays as it is.
    EnableStuck,
    /// Somebody bumps into what the head stands on, which turns by so much about pan's and tilt's axes, rad, and stays so.
    Bump(PanTilt<f64>),
    /// The controller loses power for a moment: it begins anew, its encoders at zero where the joints are now.
    PowerLoss,
    /// A belt's wheels grow warm: each second the beam turns by that share more for the same counts.
    Drift(f64),
    /// A safety input opens, or is fine again.
    Input(Input, InputState),
    /// The host of a board behind a wire hangs for so many ms.
    HostStall(u32),
    /// The host of a board behind a wire is killed; another one begins so many ms later, and configures the board anew.
    HostKilled(u32),
    /// Somebody pulls the cable to the board, and puts it in again after so many ms.
    Unplug(u32),
    /// A bit of the configuration of a board behind a wire is another one: word and bit.
    BitFlip(usize, u32),
    /// The controller's processor is held up: the next tick takes so many ticks longer.
    TickLate(f64),
}

/// What can go wrong with a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EyeTrouble {
    /// Somebody bumps into the camera and turns it: the middle of its image moves by this many px to the right.
    Bump(f64),
    /// The camera is unplugged and sends no more images.
    Unplugged,
    /// The camera freezes and repeats its last image.
    Frozen,
    /// Something covers its lens.
    Black,
    /// From one image to the next it takes so long, s.
    Slow(f64),
    /// Each image's stamp is off by up to so much, s.
    Stamps(f64),
}

/// What happens to an encoder's count on its way to the controller.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) cut_at: Option<i32>,
    pub(crate) off: i32,
    pub(crate) noise: f64,
    pub(crate) garbled: bool,
    /// From where on the counter misses edges, and what share of them it still takes.
    misses: Option<(i32, f64)>,
    last: i32,
    dice: oorandom::Rand64,
}

impl Line {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            cut_at: None,
            off: 0,
            noise: 0.0,
            garbled: false,
            misses: None,
            last: 0,
            dice: oorandom::Rand64::new(u128::from(seed)),
        }
    }

    pub(crate) const fn miss(&mut self, share: f64) {
        self.misses = Some((self.last, share));
    }

    pub(crate) fn carry(&mut self, measured: Measurement) -> Measurement {
        self.last = measured.count;
        if let Some(count) = self.cut_at {
            return Measurement { count, edge_age_ticks: None };
        }
        let turned = match self.misses {
            Some((from, share)) => from + (share * f64::from(measured.count - from)).round() as i32,
            None => measured.count,
        };
        let noisy = self.noise > 0.0 && self.dice.rand_float() < self.noise;
        let wrong = if noisy { 2 * self.dice.rand_range(0..2) as i32 - 1 } else { 0 };
        let edge_age_ticks = measured.edge_age_ticks.map(|age| if self.garbled { f32::NAN } else { age });
        Measurement { count: turned + self.off + wrong, edge_age_ticks }
    }
}

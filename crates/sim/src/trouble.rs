use tracelight_rig::{Joint, Measurement, PanTilt};

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
    /// An encoder's stamps are no numbers.
    StampGarbled(Joint),
    /// The laser's switch stays as it is.
    LaserStuck,
}

/// What happens to an encoder's count on its way to the controller.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) cut_at: Option<i32>,
    pub(crate) off: i32,
    pub(crate) noise: f64,
    pub(crate) garbled: bool,
    /// From where on the disc slips, and by what share it still turns.
    slips: Option<(i32, f64)>,
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
            slips: None,
            last: 0,
            dice: oorandom::Rand64::new(u128::from(seed)),
        }
    }

    pub(crate) const fn slip(&mut self, share: f64) {
        self.slips = Some((self.last, share));
    }

    pub(crate) fn carry(&mut self, measured: Measurement) -> Measurement {
        self.last = measured.count;
        if let Some(count) = self.cut_at {
            return Measurement { count, edge_age_ticks: None };
        }
        let turned = match self.slips {
            Some((from, share)) => from + (share * f64::from(measured.count - from)).round() as i32,
            None => measured.count,
        };
        let noisy = self.noise > 0.0 && self.dice.rand_float() < self.noise;
        let wrong = if noisy { 2 * self.dice.rand_range(0..2) as i32 - 1 } else { 0 };
        let edge_age_ticks = measured.edge_age_ticks.map(|age| if self.garbled { f32::NAN } else { age });
        Measurement { count: turned + self.off + wrong, edge_age_ticks }
    }
}

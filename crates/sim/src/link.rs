//! A wire between a host and a board, in memory, and what can go wrong with it.

use std::collections::VecDeque;

use crate::trouble::Trouble;

/// How bad a wire is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkSettings {
    /// Share of all packets that are lost, either way.
    pub loss: f64,
    /// Share of all packets of which a bit is another one when they come.
    pub corrupt: f64,
    /// How long a packet takes at least, ms.
    pub delay_ms: f64,
    /// How much longer it may take, ms; a later packet never comes before an earlier one.
    pub jitter_ms: f64,
}

impl LinkSettings {
    /// Both at once: the worse of each.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            loss: self.loss.max(other.loss),
            corrupt: self.corrupt.max(other.corrupt),
            delay_ms: self.delay_ms.max(other.delay_ms),
            jitter_ms: self.jitter_ms.max(other.jitter_ms),
        }
    }
}

/// A board that is emulated behind a wire, and what goes wrong with both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Emulation {
    /// The wire.
    pub link: LinkSettings,
    /// What happens once, and when: s of the rig's time.
    pub troubles: Vec<(f64, Trouble)>,
}

/// One direction of it.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    settings: LinkSettings,
    dice: oorandom::Rand64,
    /// Packets on their way, and when they come, µs.
    coming: VecDeque<(u64, Vec<u8>)>,
    /// Nothing gets through.
    is_cut: bool,
}

impl Way {
    pub(crate) fn new(settings: LinkSettings, seed: u64) -> Self {
        Self {
            settings,
            dice: oorandom::Rand64::new(u128::from(seed)),
            coming: VecDeque::new(),
            is_cut: false,
        }
    }

    /// The cable is pulled, or put in again: what is on its way is lost.
    pub(crate) fn cut(&mut self, is_cut: bool) {
        self.is_cut = is_cut;
        self.coming.clear();
    }

    /// Sends packets, each with a zero at its end.
    pub(crate) fn send(&mut self, now_us: u64, bytes: &[u8]) {
        for packet in bytes.split_inclusive(|&byte| byte == 0) {
            let is_lost = self.settings.loss > 0.0 && self.dice.rand_float() < self.settings.loss;
            if self.is_cut || is_lost {
                continue;
            }
            let mut packet = packet.to_vec();
            if self.settings.corrupt > 0.0 && self.dice.rand_float() < self.settings.corrupt {
                let bit = self.dice.rand_range(0..8 * packet.len() as u64) as usize;
                packet[bit / 8] ^= 1 << (bit % 8);
            }
            let jitter = if self.settings.jitter_ms > 0.0 { self.dice.rand_float() } else { 0.0 };
            let takes_us = 1e3 * (self.settings.delay_ms + jitter * self.settings.jitter_ms);
            let before = self.coming.back().map_or(0, |&(due, _)| due);
            self.coming.push_back(((now_us + takes_us as u64).max(before), packet));
        }
    }

    /// What has come by now.
    pub(crate) fn come(&mut self, now_us: u64) -> Vec<u8> {
        let mut bytes = Vec::new();
        while let Some((_, packet)) = self.coming.pop_front_if(|&mut (due, _)| due <= now_us) {
            bytes.extend_from_slice(&packet);
        }
        bytes
    }
}

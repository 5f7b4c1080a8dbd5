use tracelight_linear::logspace;
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{LawName, RigConfig};

/// A law, and how fast its loops are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Which law; its observer is the one it is meant for.
    pub law: LawName,
    /// Bandwidth of each loop, rad/s.
    pub bandwidth_rad_s: PanTilt<f64>,
}

impl Setting {
    /// What a rig has.
    pub const fn of(rig: &RigConfig) -> Self {
        Self { law: rig.control.law, bandwidth_rad_s: rig.control.bandwidth_rad_s }
    }

    /// The rig driven so. A law that stays keeps the rig's observer.
    pub fn apply(&self, rig: &RigConfig) -> RigConfig {
        let mut set = rig.clone();
        if set.control.law != self.law {
            set.control.observer = None;
        }
        set.control.law = self.law;
        set.control.bandwidth_rad_s = self.bandwidth_rad_s;
        set
    }
}

/// Each law at `count` bandwidths from the lowest to the highest, evenly on a logarithmic scale, both joints alike.
pub fn coarse(laws: &[LawName], range_rad_s: (f64, f64), count: usize) -> Vec<Setting> {
    let bandwidths = logspace(range_rad_s, count);
    let of_law = |&law: &LawName| {
        let even = |&rad_s: &f64| Setting { law, bandwidth_rad_s: PanTilt::new(rad_s, rad_s) };
        bandwidths.iter().map(even).collect::<Vec<_>>()
    };
    laws.iter().flat_map(of_law).collect()
}

/// A setting with each joint a quarter faster and slower, alone and together; not the setting itself.
pub fn around(setting: Setting) -> Vec<Setting> {
    const STEPS: [f64; 3] = [0.8, 1.0, 1.25];
    let pairs = STEPS.into_iter().flat_map(|pan| STEPS.map(|tilt| (pan, tilt)));
    pairs
        .filter(|pair| *pair != (1.0, 1.0))
        .map(|(pan, tilt)| {
            let PanTilt { pan: p, tilt: t } = setting.bandwidth_rad_s;
            Setting { bandwidth_rad_s: PanTilt::new(pan * p, tilt * t), ..setting }
        })
        .collect()
}

/// What a setting must bear: motors that are not what is believed of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// By how much they may be stronger, and weaker, as a factor of at least 1.
    pub gain: f64,
    /// By how much their currents may lag, s.
    pub lag_s: f64,
}

impl Demand {
    /// Heads that are so: strong, weak, late, and strong and late. Nobody told the controller. Their amplifiers give the same torque at
    /// most, so that what is asked is of the loops, not of motors that a plan is too fast for.
    pub fn heads(&self, rig: &RigConfig) -> [RigConfig; 4] {
        let head = |factor: f64, lag_s: f64| {
            let mut head = rig.clone();
            for joint in Joint::BOTH {
                let truth = &mut head.truth.model.motors[joint];
                truth.torque_nm_per_v *= factor;
                truth.limit_v /= factor;
                truth.back_emf_v_s_per_rad /= factor;
                head.model.motors[joint].limit_v /= factor;
            }
            head.truth.wear.current_lag_s += lag_s;
            head
        };
        [head(self.gain, 0.0), head(1.0 / self.gain, 0.0), head(1.0, self.lag_s), head(self.gain, self.lag_s)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_spread_over_laws_and_bandwidths() {
        let all = coarse(&[LawName::State, LawName::Pid], (10.0, 160.0), 5);
        assert_eq!(all.len(), 10);
        assert!((all[2].bandwidth_rad_s.pan - 40.0).abs() < 1e-9 && all[7].law == LawName::Pid);
        let near = around(all[2]);
        assert_eq!(near.len(), 8);
        assert!(near.iter().all(|s| *s != all[2] && s.law == LawName::State));
    }

    #[test]
    fn a_demand_is_of_the_truth_alone() {
        let rig = RigConfig::report();
        let heads = Demand { gain: 2.0, lag_s: 1e-3 }.heads(&rig);
        let [believed, true_one] = [&heads[1].model, &heads[1].truth.model].map(|model| model.motors.tilt);
        assert_eq!(believed.torque_nm_per_v, rig.model.motors.tilt.torque_nm_per_v);
        assert!((true_one.torque_limit_nm() / rig.model.motors.tilt.torque_limit_nm() - 1.0).abs() < 1e-12);
        let gains = heads
            .map(|head| head.truth.model.motors.pan.torque_nm_per_v / rig.model.motors.pan.torque_nm_per_v);
        assert_eq!(gains, [2.0, 0.5, 1.0, 2.0]);
        assert_eq!(Setting::of(&Setting::of(&rig).apply(&rig)), Setting::of(&rig));
    }
}

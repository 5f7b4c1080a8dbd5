use tracelight_rig::Joint;

use super::fit::fit;
use super::pieces::{
    COULOMB, GRAVITY, INERTIA, LEAST_RAD_S, Piece, Row, SHORTEST_S, SPRING, UNKNOWNS, VISCOUS, pieces,
    trials_of,
};
use super::{Believed, FrictionError, Side, Trial};
use crate::regression::Uncertain;

/// A joint's friction, inertia and weight from whole curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// kg m²; `None` where speeds hardly change, so that only what is believed of it is known.
    pub inertia_kg_m2: Option<Uncertain>,
    /// Turning forwards; `None` where it did so in fewer than three trials.
    pub pos: Option<Side>,
    /// Backwards.
    pub neg: Option<Side>,
    /// With cos and sin of the angle, N m; `None` where it was not asked.
    pub gravity_nm: Option<[Uncertain; 2]>,
    /// What cables pull back, N m/rad; `None` where it was not asked. What they pull at zero looks like Coulomb friction.
    pub spring_nm_per_rad: Option<Uncertain>,
    /// Share of what voltages did to the motion that the equation explains.
    pub r2: f64,
    /// Trials in which it turned.
    pub trials: usize,
    /// Torques by themselves, stretch by stretch.
    pub parts: Vec<Part>,
}

/// A short stretch of motion, and what is left of its motor's torque once all else has taken its part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Mean speed, rad/s.
    pub rate_rad_s: f64,
    /// Where its middle was, rad.
    pub angle_rad: f64,
    /// Left for friction, N m.
    pub friction_nm: f64,
    /// Left for weight and cables: what holds them, N m.
    pub weight_nm: f64,
}

/// Longest piece, s: what the equation leaves out adds up twice over a longer one.
const LONGEST_S: f64 = 4.0;
/// Length of the stretches whose torques are shown, s.
const SHOWN_S: f64 = 1.0;
/// Fewest trials with motion in a direction.
const LEAST_TRIALS: usize = 3;
/// Least squares over all pieces of all trials of one joint: second integrals of torque, so that nothing is differentiated, with
/// place and speed at the start of each piece free. Intervals from how trials differ (Liang & Zeger, *Biometrika* 73, 1986, eq. 2): what
/// is left within one is alike.
pub fn curves(joint: Joint, trials: &[&Trial], believed: &Believed) -> Result<Curves, FrictionError> {
    let pieces: Vec<Piece> = trials
        .iter()
        .enumerate()
        .flat_map(|(number, trial)| pieces(number, trial, believed, LONGEST_S))
        .collect();
    let count = |side: usize| trials_of(pieces.iter().filter(|p| p.side == side));
    let (turned, sides) = (trials_of(pieces.iter()), [count(0), count(1)]);
    if sides.iter().all(|&n| n < LEAST_TRIALS) {
        return Err(FrictionError::TooFew {
            joint,
            turned,
            trials: trials.len(),
            least: LEAST_TRIALS,
            speed_rad_s: LEAST_RAD_S,
            time_s: SHORTEST_S,
        });
    }
    let seen = sides.map(|n| n >= LEAST_TRIALS);
    let used: Vec<&Piece> = pieces.iter().filter(|p| seen[p.side]).collect();
    let unknowns: Vec<usize> = (0..UNKNOWNS)
        .filter(|k| match k {
            1 | 3 => seen[0],
            2 | 4 => seen[1],
            5 | 6 => believed.gravity_nm.is_some(),
            7 => believed.cables,
            _ => true,
        })
        .collect();
    // without any voltage there is nothing to hold friction against
    if used.iter().all(|piece| piece.rows.iter().all(|row| row.motor == 0.0)) {
        return Err(FrictionError::Alike { joint });
    }
    let fit = fit(&used, unknowns, believed).ok_or(FrictionError::Alike { joint })?;
    if let Some(inertia) = fit.value(INERTIA).filter(|inertia| inertia.value.is_nan() || inertia.value <= 0.0)
    {
        return Err(FrictionError::Impossible { joint, inertia_kg_m2: inertia.value });
    }
    let reach = Reach::of(trials, &used, believed);
    let side = |s: usize| {
        let found = Side { viscous: fit.value(VISCOUS[s])?, coulomb_nm: fit.value(COULOMB[s])? };
        reach.tells(&found, s).then_some(found)
    };
    if side(0).is_none() && side(1).is_none() {
        return Err(FrictionError::Alike { joint });
    }
    let gravity = fit.value(GRAVITY[0]).zip(fit.value(GRAVITY[1]));
    let mut found = Curves {
        inertia_kg_m2: fit.value(INERTIA),
        pos: side(0),
        neg: side(1),
        gravity_nm: gravity.map(|(cos, sin)| [cos, sin]),
        spring_nm_per_rad: fit.value(SPRING),
        r2: fit.r2,
        trials: turned,
        parts: Vec::new(),
    };
    found.parts = parts(trials, believed, &found);
    Ok(found)
}

/// How strong the motor was in all trials, and how fast it turned each way: what is known of friction to no less than that is not known.
struct Reach {
    torque_nm: f64,
    /// Lowest and highest.
    rates_rad_s: [(f64, f64); 2],
}

impl Reach {
    fn of(trials: &[&Trial], pieces: &[&Piece], believed: &Believed) -> Self {
        let volts = trials.iter().flat_map(|trial| &trial.samples).map(|sample| sample.volts.abs());
        let rate = |side: usize| {
            let own = pieces.iter().filter(|piece| piece.side == side).map(|piece| piece.rate_rad_s.abs());
            own.fold((f64::INFINITY, 0.0_f64), |(low, high), rate| (low.min(rate), high.max(rate)))
        };
        Self { torque_nm: believed.torque_nm(volts.fold(0.0, f64::max)), rates_rad_s: [rate(0), rate(1)] }
    }

    fn tells(&self, found: &Side, side: usize) -> bool {
        /// Shares of the highest speed by which speeds differ at least: at one speed nothing tells viscous from Coulomb friction.
        const VARIED: f64 = 0.02;
        let (low, high) = self.rates_rad_s[side];
        // three trials of one kind tell no interval, and that is said where it is shown
        let within = |u: Uncertain| if u.within.is_finite() { u.within } else { 0.0 };
        let viscous_nm = within(found.viscous) * high;
        high - low > VARIED * high
            && viscous_nm <= self.torque_nm
            && within(found.coulomb_nm) <= self.torque_nm
    }
}

/// What is left of the motor's torque on each short stretch.
fn parts(trials: &[&Trial], believed: &Believed, found: &Curves) -> Vec<Part> {
    let value = |value: Option<Uncertain>| value.map_or(0.0, |u| u.value);
    let mut all = [0.0; UNKNOWNS];
    all[INERTIA] = found.inertia_kg_m2.map_or(believed.inertia_kg_m2, |inertia| inertia.value);
    for (side, of) in [found.pos, found.neg].into_iter().enumerate() {
        all[VISCOUS[side]] = value(of.map(|s| s.viscous));
        all[COULOMB[side]] = value(of.map(|s| s.coulomb_nm));
    }
    let weight = GRAVITY.into_iter().chain([SPRING]);
    for (place, of) in GRAVITY.into_iter().zip(found.gravity_nm.into_iter().flatten()) {
        all[place] = of.value;
    }
    all[SPRING] = value(found.spring_nm_per_rad);
    let without = |places: &mut dyn Iterator<Item = usize>| {
        let mut known = all;
        places.for_each(|place| known[place] = 0.0);
        known
    };
    let but_friction = without(&mut VISCOUS.into_iter().chain(COULOMB));
    let but_weight = without(&mut weight.into_iter());
    let part = |piece: Piece| {
        // as torques and a speed that held would have: Coulomb friction's column is that of a torque of 1
        let held = COULOMB[piece.side];
        let along =
            |of: &dyn Fn(&Row) -> f64| piece.rows.iter().map(|row| of(row) * row.terms[held]).sum::<f64>();
        let square = along(&|row| row.terms[held]);
        Part {
            rate_rad_s: along(&|row| row.terms[VISCOUS[piece.side]]) / square,
            angle_rad: piece.angle_rad,
            friction_nm: along(&|row| row.less(&but_friction)) / square,
            weight_nm: along(&|row| row.less(&but_weight)) / square,
        }
    };
    let all = trials.iter().flat_map(|trial| pieces(0, trial, believed, SHOWN_S)).map(part);
    all.filter(|part| [part.rate_rad_s, part.friction_nm, part.weight_nm].iter().all(|v| v.is_finite()))
        .collect()
}

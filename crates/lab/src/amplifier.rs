use crate::regression::{Uncertain, regression};

/// A current that was read while an amplifier was given volts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurrentPoint {
    /// V at the amplifier's input.
    pub volts: f64,
    /// A through the motor.
    pub amperes: f64,
    /// Speed of the joint meanwhile, rad/s; `None` if nobody looked.
    pub rate_rad_s: Option<f64>,
}

/// An amplifier and its motor: amperes = gain × volts − `back_emf` × speed + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplifier {
    /// A/V with the motor at rest.
    pub gain: Uncertain,
    /// A s/rad: what the turning motor's own voltage takes away; `None` if no speeds tell it.
    pub back_emf: Option<Uncertain>,
    /// A at 0 V.
    pub offset: Uncertain,
    /// What somebody reads who divides amperes by volts, speed or not, A/V.
    pub as_read: f64,
    /// Share of the current's variance that is explained.
    pub r2: f64,
    /// What is left, root mean square, A.
    pub left_a: f64,
    /// Readings.
    pub points: usize,
}

/// What readings say of an amplifier; `None` if their volts are too few or too much alike.
pub fn amplifier(points: &[CurrentPoint]) -> Option<Amplifier> {
    let column = |of: &dyn Fn(&CurrentPoint) -> f64| points.iter().map(of).collect::<Vec<f64>>();
    let (volts, amperes) = (column(&|p| p.volts), column(&|p| p.amperes));
    let ones = vec![1.0; points.len()];
    let rates: Option<Vec<f64>> = points.iter().map(|p| p.rate_rad_s.map(|rate| -rate)).collect();
    // speeds that are the volts' over again cannot be told from them
    let with = rates.and_then(|rates| regression(&[volts.clone(), ones.clone(), rates], &amperes));
    let (found, back_emf) = match with {
        Some(found) => (found.clone(), found.factors.get(2).copied()),
        None => (regression(&[volts.clone(), ones], &amperes)?, None),
    };
    let squares: f64 = volts.iter().map(|v| v * v).sum();
    let as_read = volts.iter().zip(&amperes).map(|(v, a)| v * a).sum::<f64>() / squares;
    Some(Amplifier {
        gain: found.factors[0],
        back_emf,
        offset: found.factors[1],
        as_read,
        r2: found.r2,
        left_a: found.left,
        points: points.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_motors_own_voltage_is_told_from_the_amplifiers_gain() {
        let mut dice = oorandom::Rand64::new(3);
        let mut point = |k: i32| {
            let (volts, rate) = (f64::from(k % 11 - 5), f64::from(k % 7 - 3) + f64::from(k % 11 - 5));
            let amperes = 0.1 * volts - 0.004 * rate + 0.002 + 0.001 * (dice.rand_float() - 0.5);
            CurrentPoint { volts, amperes, rate_rad_s: Some(rate) }
        };
        let points: Vec<CurrentPoint> = (0..300).map(&mut point).collect();
        let found = amplifier(&points).unwrap();
        let near = |found: Uncertain, wanted: f64| (found.value - wanted).abs() < 2.0 * found.within + 1e-5;
        assert!(near(found.gain, 0.1) && near(found.back_emf.unwrap(), 0.004) && near(found.offset, 0.002));
        assert!(found.gain.within < 1e-4 && found.left_a < 4e-4 && found.r2 > 0.999, "{found:?}");
        assert!(found.as_read < 0.0965, "read with the motor turning it looks weaker: {}", found.as_read);
        // nobody looked at the speeds
        let blind: Vec<CurrentPoint> =
            points.iter().map(|p| CurrentPoint { rate_rad_s: None, ..*p }).collect();
        let found = amplifier(&blind).unwrap();
        assert!(found.back_emf.is_none() && (found.gain.value - 0.096).abs() < 1e-3, "{found:?}");
        assert_eq!(amplifier(&points[..2]), None);
        assert_eq!(amplifier(&[points[3]; 20]), None, "one voltage tells no gain");
    }
}

use tracelight_dynamics::Lumped;
use tracelight_linear::{Complex, LinearError, Matrix, StateSpace, Time, TransferFunction};
use tracelight_rig::{Joint, PanTilt};

/// What a head is linearized about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operation {
    /// Its inertia and gravity.
    pub head: Lumped,
    /// Viscous friction, N m s/rad. Coulomb friction has no linear form: it is left out.
    pub viscous: PanTilt<f64>,
    /// Where tilt is, rad; where pan is does not matter.
    pub tilt_rad: f64,
    /// How fast both turn, steadily, rad/s.
    pub rate_rad_s: PanTilt<f64>,
}

/// A head near one way to move, or to stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// States: pan, tilt, their rates; inputs: torques of pan and tilt; outputs: pan, tilt. All as differences, rad and N m.
    pub system: StateSpace,
    /// Torques that keep it so, N m.
    pub holding_nm: PanTilt<f64>,
}

impl Operation {
    /// The Jacobian of M⁻¹ (τ − C − G − Fv q̇) there, by derivatives on paper; that the accelerations are zero there leaves out how M
    /// changes.
    pub fn linearize(&self) -> Result<Linearization, LinearError> {
        let (mass, bias) = self.head.mass_and_bias(self.tilt_rad, self.rate_rad_s);
        let slopes = self.head.bias_slopes(self.tilt_rad, self.rate_rad_s);
        let by_pan = PanTilt::new(slopes.by_pan_rate.pan + self.viscous.pan, slopes.by_pan_rate.tilt);
        let by_tilt = PanTilt::new(slopes.by_tilt_rate.pan, slopes.by_tilt_rate.tilt + self.viscous.tilt);
        let (mut a, mut b) = (Matrix::zeros(4, 4), Matrix::zeros(4, 2));
        (a[(0, 2)], a[(1, 3)]) = (1.0, 1.0);
        for (column, torque) in [(1, slopes.by_tilt), (2, by_pan), (3, by_tilt)] {
            let acceleration = mass.solve(torque);
            (a[(2, column)], a[(3, column)]) = (-acceleration.pan, -acceleration.tilt);
        }
        for (column, torque) in [(0, PanTilt::new(1.0, 0.0)), (1, PanTilt::new(0.0, 1.0))] {
            let acceleration = mass.solve(torque);
            (b[(2, column)], b[(3, column)]) = (acceleration.pan, acceleration.tilt);
        }
        let c = Matrix::identity(2, 4);
        Ok(Linearization {
            system: StateSpace::new(a, b, c, Matrix::zeros(2, 2), Time::Continuous)?,
            holding_nm: PanTilt::from_fn(|j| bias[j] + self.viscous[j] * self.rate_rad_s[j]),
        })
    }
}

impl Linearization {
    /// From a joint's torque to its angle, rad/(N m), nothing cancelled.
    pub fn transfer(&self, joint: Joint) -> Result<TransferFunction, LinearError> {
        let place = match joint {
            Joint::Pan => 0,
            Joint::Tilt => 1,
        };
        Ok(self.system.transfer(place, place)?.transfer())
    }

    /// The same without what a joint has of the other that it hardly moves: poles that a zero takes back but for a ten thousandth of
    /// their size; and these.
    pub fn own_transfer(&self, joint: Joint) -> Result<(TransferFunction, Vec<Complex>), LinearError> {
        const TAKEN_BACK: f64 = 1e-4;
        Ok(self.transfer(joint)?.minimal(TAKEN_BACK))
    }
}

#[cfg(test)]
mod tests {
    use tracelight_dynamics::HeadBodies;

    use super::*;

    /// As the report had it.
    fn report() -> Linearization {
        let bodies = HeadBodies { gravity_m_s2: 9.8, ..HeadBodies::set_a() };
        let operation = Operation {
            head: bodies.lumped(),
            viscous: PanTilt::new(0.01, 0.01),
            tilt_rad: 0.5_f64.atan(),
            rate_rad_s: PanTilt::default(),
        };
        operation.linearize().unwrap()
    }

    /// G11 and G22 to every digit the report printed.
    #[test]
    fn the_reports_transfer_functions_come_out_to_every_digit() {
        let printed = |joint: Joint, cancelled: bool| {
            let found = report();
            let g =
                if cancelled { found.own_transfer(joint).unwrap().0 } else { found.transfer(joint).unwrap() };
            g.to_string()
        };
        let g11 = "(13.16 s² + 1.754 s + 10.29) / (s⁴ + 0.2649 s³ + 0.7997 s² + 0.1029 s)";
        assert_eq!(printed(Joint::Pan, false), g11);
        assert_eq!(printed(Joint::Tilt, true), "13.33 / (s² + 0.1333 s + 0.7822)");
        assert_eq!(printed(Joint::Pan, true), "13.16 / (s² + 0.1316 s)");
    }

    /// Central differences of the equations of motion, about a head that moves.
    #[test]
    fn the_jacobian_is_that_of_the_equations_of_motion() {
        let operation = Operation {
            head: HeadBodies::set_b().lumped(),
            viscous: PanTilt::new(0.003, 0.002),
            tilt_rad: -0.7,
            rate_rad_s: PanTilt::new(3.0, -2.0),
        };
        let found = operation.linearize().unwrap();
        let accelerate = |x: [f64; 4], u: [f64; 2]| {
            let rate = PanTilt::new(x[2], x[3]);
            let (mass, bias) = operation.head.mass_and_bias(x[1], rate);
            let torque = PanTilt::from_fn(|j| {
                let given = if j == Joint::Pan { u[0] } else { u[1] };
                given + found.holding_nm[j] - bias[j] - operation.viscous[j] * rate[j]
            });
            let acceleration = mass.solve(torque);
            [acceleration.pan, acceleration.tilt]
        };
        const STEP: f64 = 1e-6;
        let at = [0.2, -0.7, 3.0, -2.0];
        assert!(accelerate(at, [0.0; 2]).iter().all(|a| a.abs() < 1e-12));
        for column in 0..6 {
            let moved = |by: f64| {
                let (mut x, mut u) = (at, [0.0; 2]);
                if column < 4 {
                    x[column] += by
                } else {
                    u[column - 4] += by
                }
                accelerate(x, u)
            };
            let (up, down) = (moved(STEP), moved(-STEP));
            for row in 0..2 {
                let slope = (up[row] - down[row]) / (2.0 * STEP);
                let ours = match column {
                    0..4 => found.system.a()[(2 + row, column)],
                    _ => found.system.b()[(2 + row, column - 4)],
                };
                assert!((slope - ours).abs() < 1e-6 * (1.0 + slope.abs()), "{row} {column}: {ours} {slope}");
            }
        }
    }
}

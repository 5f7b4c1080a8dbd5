//! Regulators that others published, as numbers with their source.

use tracelight_linear::{Complex, Matrix, StateSpace, Time};
use tracelight_maths::complex;

/// A published regulator of one input, to the digits that were printed.
struct Published {
    source: &'static str,
    a: &'static [f64],
    b: &'static [f64],
    q: &'static [f64],
    r: f64,
    gain: &'static [f64],
    /// Row by row; empty where none was printed, as are the poles.
    cost: &'static [f64],
    poles: &'static [(f64, f64)],
    /// Half the last printed digit.
    within: f64,
}

const PUBLISHED: [Published; 4] = [
    Published {
        source: "MathWorks, lqr (Control System Toolbox): an inverted pendulum on a cart, by Bryson's rule",
        a: &[0.0, 1.0, 0.0, 0.0, 0.0, -0.1, 3.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -0.5, 30.0, 0.0],
        b: &[0.0, 2.0, 0.0, 5.0],
        q: &[1.0, 0.0, 1.0, 0.0],
        r: 1.0,
        gain: &[-1.0, -1.7559, 16.9145, 3.2274],
        cost: &[
            1.5346, 1.2127, -3.2274, -0.6851, 1.2127, 1.5321, -4.5626, -0.9640, -3.2274, -4.5626, 26.5487,
            5.2079, -0.6851, -0.9640, 5.2079, 1.0311,
        ],
        poles: &[(-0.8684, 0.8523), (-0.8684, -0.8523), (-5.4941, 0.4564), (-5.4941, -0.4564)],
        within: 0.5001e-4,
    },
    Published {
        source: "python-control, statefbk_test.py: an integrator, its cost √(Q R), its gain √(Q/R)",
        a: &[0.0],
        b: &[1.0],
        q: &[10.0],
        r: 2.0,
        gain: &[2.236_067_977_499_79],
        cost: &[4.472_135_954_999_579],
        poles: &[(-2.236_067_977_499_79, 0.0)],
        within: 1e-12,
    },
    Published {
        source: "CTMS, Aircraft Pitch: State-Space Methods for Controller Design (University of Michigan), p = 50",
        a: &[-0.313, 56.7, 0.0, -0.0139, -0.426, 0.0, 0.0, 56.7, 0.0],
        b: &[0.232, 0.0203, 0.0],
        q: &[0.0, 0.0, 50.0],
        r: 1.0,
        gain: &[-0.6435, 169.6950, 7.0711],
        cost: &[],
        poles: &[],
        within: 0.5001e-4,
    },
    Published {
        source: "CTMS, Inverted Pendulum: State-Space Methods for Controller Design, x = 5000 and y = 100",
        a: &[
            0.0,
            1.0,
            0.0,
            0.0,
            0.0,
            -0.024 * 0.1 / 0.0132,
            0.04 * 9.8 * 0.09 / 0.0132,
            0.0,
            0.0,
            0.0,
            0.0,
            1.0,
            0.0,
            -0.06 * 0.1 / 0.0132,
            0.06 * 9.8 * 0.7 / 0.0132,
            0.0,
        ],
        b: &[0.0, 0.024 / 0.0132, 0.0, 0.06 / 0.0132],
        q: &[5000.0, 0.0, 100.0, 0.0],
        r: 1.0,
        gain: &[-70.7107, -37.8345, 105.5298, 20.9238],
        cost: &[],
        poles: &[],
        within: 0.5001e-4,
    },
];

#[test]
fn regulators_are_those_that_were_published() {
    for Published { source, a, b, q, r, gain, cost, poles, within } in PUBLISHED {
        let n = b.len();
        let a = Matrix::from_row_slice(n, n, a);
        let b = Matrix::from_row_slice(n, 1, b);
        let plant =
            StateSpace::new(a, b, Matrix::identity(n, n), Matrix::zeros(n, 1), Time::Continuous).unwrap();
        let q = Matrix::from_diagonal(&q.to_vec().into());
        let is = plant.lqr(&q, &Matrix::from_element(1, 1, r)).unwrap();
        let off = (&is.gain - Matrix::from_row_slice(1, n, gain)).amax();
        assert!(off <= within, "{source}: {}", is.gain);
        if !cost.is_empty() {
            let cost = Matrix::from_row_slice(n, n, cost);
            assert!((&is.cost - cost).amax() <= within, "{source}: {}", is.cost);
        }
        for &(re, im) in poles {
            let pole = Complex::new(re, im);
            let nearest = is.poles.iter().map(|z| complex::norm(z - pole)).fold(f64::INFINITY, f64::min);
            assert!(nearest <= 1.5 * within, "{source}: {pole} of {:?}", is.poles);
        }
    }
}

use tracelight_maths::acos;

use crate::{LinearError, Matrix, Peak, StateSpace};

/// How finely norms are found.
const TOLERANCE: f64 = 1e-9;

/// By how much gain and phase of a loop may change together, at the same time, before it is unstable.
///
/// The loop is multiplied by (1 + α (1 − σ)/2 δ) / (1 − α (1 + σ)/2 δ) with any |δ| < 1: a disk (Seiler, Packard & Gahinet, *An
/// introduction to disk margins*, IEEE Control Systems 40, 2020).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskMargin {
    /// The size of the disk, α.
    pub alpha: f64,
    /// Where it is least, rad/s.
    pub rad_s: f64,
    /// Least and largest factor of the gain; the largest may be infinite, and below 0 there is none.
    pub gain: (f64, f64),
    /// Lag or lead, rad; infinite where no phase alone makes it unstable.
    pub phase_rad: f64,
}

/// Disk margins of a loop of several channels.
#[derive(Clone, Debug, PartialEq)]
pub struct DiskMargins {
    /// Of each channel, the others closed and unchanged.
    pub each: Vec<DiskMargin>,
    /// Of all channels changed at the same time, each in its own way: what is guaranteed.
    pub together: DiskMargin,
    /// Of all channels changed at the same time, also by each other: any matrix in place of the disk's δ.
    pub all: DiskMargin,
}

impl DiskMargin {
    fn of(alpha: f64, rad_s: f64, skew: f64) -> Self {
        let (less, more) = (0.5 * alpha * (1.0 - skew), 0.5 * alpha * (1.0 + skew));
        // beyond a disk through infinity there is no largest gain
        let high = if more < 1.0 { (1.0 + less) / (1.0 - more) } else { f64::INFINITY };
        let low = (1.0 - less) / (1.0 + more);
        let cosine = if high.is_finite() { (1.0 + low * high) / (low + high) } else { low };
        let phase_rad = if (-1.0..=1.0).contains(&cosine) { acos(cosine) } else { f64::INFINITY };
        Self { alpha, rad_s, gain: (low.max(0.0), high), phase_rad }
    }
}

impl StateSpace {
    /// Disk margins of this open loop closed by unity negative feedback; a skew σ of 0 treats more and less gain alike, 1 is of S, −1 of T.
    /// None where the closed loop is not stable.
    ///
    /// # Errors
    /// [`LinearError::Shape`] without as many outputs as inputs, [`LinearError::AlgebraicLoop`], and as
    /// [`h_infinity_norm`](Self::h_infinity_norm).
    pub fn disk_margins(&self, skew: f64) -> Result<Option<DiskMargins>, LinearError> {
        let sensitivity = self.sensitivity()?;
        let shifted = |system: Self| {
            let size = system.d().nrows();
            let d = system.d() + Matrix::from_diagonal_element(size, size, 0.5 * (skew - 1.0));
            Self::new(system.a().clone(), system.b().clone(), system.c().clone(), d, system.time())
        };
        let of = |peak: Peak| DiskMargin::of(1.0 / peak.gain, peak.rad_s, skew);
        let whole = shifted(sensitivity.clone())?;
        let Some(all) = whole.h_infinity_norm(TOLERANCE)? else { return Ok(None) };
        let together = whole.scaled_norm(all, TOLERANCE)?;
        // with the others closed, the sensitivity of a channel is that on the diagonal
        let each = (0..self.d().nrows()).map(|i| {
            let peak = shifted(sensitivity.channel(i, i)?)?.h_infinity_norm(TOLERANCE)?;
            Ok::<_, LinearError>(peak.map(of))
        });
        let each: Option<Vec<DiskMargin>> = each.collect::<Result<_, _>>()?;
        Ok(each.map(|each| DiskMargins { each, together: of(together), all: of(all) }))
    }

    /// (1 + L)⁻¹ of this open loop.
    ///
    /// # Errors
    /// [`LinearError::Shape`] without as many outputs as inputs, [`LinearError::AlgebraicLoop`].
    pub fn sensitivity(&self) -> Result<Self, LinearError> {
        let size = self.d().nrows();
        if size != self.d().ncols() {
            return Err(LinearError::Shape("a loop has as many outputs as inputs"));
        }
        let open =
            (Matrix::identity(size, size) + self.d()).try_inverse().ok_or(LinearError::AlgebraicLoop)?;
        let back = &open * self.c();
        Self::new(self.a() - self.b() * &back, self.b() * &open, -back, open, self.time())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Time, TransferFunction};

    fn margin(text: &str, skew: f64) -> DiskMargin {
        let open = TransferFunction::parse(text, Time::Continuous).unwrap().state_space().unwrap();
        open.disk_margins(skew).unwrap().unwrap().all
    }

    /// The first example of Seiler, Packard & Gahinet; its frequency by |S − ½| at three million frequencies.
    #[test]
    fn the_published_example() {
        let found = margin("25/(s^3+10s^2+10s+10)", 0.0);
        assert!((found.alpha - 0.4581).abs() < 1e-4 && (found.rad_s - 1.9550).abs() < 1e-3, "{found:?}");
        assert!((found.gain.0 - 0.6273).abs() < 1e-4 && (found.gain.1 - 1.5942).abs() < 1e-4, "{found:?}");
        assert!((found.phase_rad.to_degrees() - 25.8017).abs() < 1e-3, "{found:?}");
    }

    /// The spinning satellite: each loop alone has no end of gain, both together little.
    #[test]
    fn channels_that_are_safe_alone_may_not_be_together() {
        let a = Matrix::from_row_slice(2, 2, &[0.0, 10.0, -10.0, 0.0]);
        let c = Matrix::from_row_slice(2, 2, &[1.0, 10.0, -10.0, 1.0]);
        let open =
            StateSpace::new(a, Matrix::identity(2, 2), c, Matrix::zeros(2, 2), Time::Continuous).unwrap();
        let margins = open.disk_margins(0.0).unwrap().unwrap();
        assert!(margins.each.iter().all(|margin| (margin.alpha - 2.0).abs() < 1e-6), "{margins:?}");
        assert!((margins.all.alpha - 0.0997).abs() < 1e-4, "{margins:?}");
    }

    /// The spinning satellite with the static controllers of MATLAB's documentation of `diskmargin` (C of 1, 8, −10, 1: from 0.4890 to
    /// 0.4899) and of python-control's `margin_test.py` (C of 1, 10, −10, 1: 0.3754, 3.3 dB and 21.26°, within 0.1). The digits are those
    /// of the least of σ(D M D⁻¹) over D, the largest over 6001 frequencies, by scipy.
    #[test]
    fn channels_that_change_each_in_its_own_way_may_change_by_more() {
        for (eight, truth, any) in [(8.0, 0.489_937_1, 0.123_167_2), (10.0, 0.376_152_1, 0.099_762_57)] {
            let a = Matrix::from_row_slice(2, 2, &[0.0, 10.0, -10.0, 0.0]);
            let c = Matrix::from_row_slice(2, 2, &[1.0, eight, -10.0, 1.0]);
            let k = Matrix::from_row_slice(2, 2, &[1.0, -2.0, 0.0, 1.0]);
            let open = StateSpace::new(a, k, c, Matrix::zeros(2, 2), Time::Continuous).unwrap();
            let margins = open.disk_margins(0.0).unwrap().unwrap();
            let together = margins.together;
            assert!((together.alpha - truth).abs() < 1e-6 * truth, "{eight}: {margins:?}");
            assert!((margins.all.alpha - any).abs() < 1e-6, "{eight}: {margins:?}");
            assert!(margins.each.iter().all(|margin| (margin.alpha - 2.0).abs() < 1e-6), "{margins:?}");
            if eight == 10.0 {
                let db = 20.0 * together.gain.1.log10();
                assert!((db - 3.3).abs() < 0.1 && (together.phase_rad.to_degrees() - 21.26).abs() < 0.1);
            }
        }
    }

    #[test]
    fn skewed_to_the_ends_it_is_of_the_sensitivity_and_of_its_complement() {
        let open = TransferFunction::parse("4/(s(s+2))", Time::Continuous).unwrap();
        let closed = open.closed().unwrap();
        let complement = margin("4/(s(s+2))", -1.0);
        assert!((complement.alpha * closed.peak().unwrap().gain - 1.0).abs() < 1e-8, "{complement:?}");
        let least = margin("4/(s(s+2))", 1.0);
        let distance = open.margins().modulus.unwrap().distance;
        assert!((least.alpha / distance - 1.0).abs() < 1e-8, "{least:?} {distance}");
        let unstable =
            TransferFunction::parse("9/((s+1)^3)", Time::Continuous).unwrap().state_space().unwrap();
        assert_eq!(unstable.disk_margins(0.0), Ok(None));
    }
}

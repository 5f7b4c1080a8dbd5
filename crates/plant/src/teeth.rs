//! Belts that skip teeth.

/// A toothed belt that is too slack: where it carries too much, its teeth climb out of their gaps and fall into the next ones (ratcheting:
/// Collins, *What is ratcheting in synchronous belt drives?*, Linear Motion Tips, 2017).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LooseBelt {
    /// Most torque it carries, as a share of the most its motor gives at the joint. It carries what hangs on the joint, not the rotor.
    pub holds_share: f64,
    /// Teeth of the joint's wheel: the joint loses 2π over that at a time.
    pub teeth: u32,
}

/// Where the teeth of a loose belt lie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Teeth {
    holds_nm: f64,
    pitch_rad: f64,
    /// How far the rotor is ahead of the joint where they lie in their gaps without load, rad: whole pitches.
    gap_rad: f64,
}

/// What a belt does at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mesh {
    /// The belt is engaged and carries this torque, N m.
    Carries(f64),
    /// Its teeth have just fallen into the next gaps: what turned at two speeds turns at one.
    Lands,
}

impl Teeth {
    /// In their gaps, of a belt whose motor gives `limit_nm` at most.
    pub(crate) fn new(belt: LooseBelt, limit_nm: f64) -> Self {
        Self {
            holds_nm: belt.holds_share * limit_nm,
            pitch_rad: std::f64::consts::TAU / f64::from(belt.teeth.max(1)),
            gap_rad: 0.0,
        }
    }

    /// Lying where they lie, of a belt that holds as much as another from now on.
    pub(crate) const fn holding_as(self, other: &Self) -> Self {
        Self { gap_rad: self.gap_rad, ..*other }
    }

    /// See the field.
    pub(crate) const fn gap_rad(&self) -> f64 {
        self.gap_rad
    }

    /// The rotor is `ahead_rad` of the joint, and a belt whose teeth cannot climb would carry `taut_nm`. To the middle between two gaps they climb
    /// against what the belt holds, and from there on that draws them into the next.
    pub(crate) fn mesh(&mut self, ahead_rad: f64, taut_nm: f64) -> Mesh {
        let climbed_rad = ahead_rad - self.gap_rad;
        let way = climbed_rad.signum();
        if climbed_rad.abs() < 0.5 * self.pitch_rad {
            Mesh::Carries(taut_nm.clamp(-self.holds_nm, self.holds_nm))
        } else if climbed_rad.abs() < self.pitch_rad {
            Mesh::Carries(-way * self.holds_nm)
        } else {
            self.gap_rad += way * self.pitch_rad;
            Mesh::Lands
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn teeth_climb_to_the_middle_and_fall_into_the_next_gap() {
        let belt = LooseBelt { holds_share: 0.5, teeth: 60 };
        let pitch = std::f64::consts::TAU / 60.0;
        let mut teeth = Teeth::new(belt, 2.0);
        assert_eq!(teeth.mesh(0.01, 0.9), Mesh::Carries(0.9));
        assert_eq!(teeth.mesh(-0.01, -1.1), Mesh::Carries(-1.0), "they climb");
        assert_eq!(teeth.mesh(-0.6 * pitch, -9.0), Mesh::Carries(1.0), "they fall");
        assert_eq!(teeth.mesh(-0.4 * pitch, -9.0), Mesh::Carries(-1.0), "they fall back");
        assert_eq!(teeth.gap_rad(), 0.0);
        assert_eq!(teeth.mesh(-1.01 * pitch, -9.0), Mesh::Lands);
        assert_eq!(teeth.gap_rad(), -pitch);
        assert_eq!(teeth.mesh(-1.01 * pitch, -0.5), Mesh::Carries(-0.5));
    }
}

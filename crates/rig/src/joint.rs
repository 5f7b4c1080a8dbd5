use core::ops::{Index, IndexMut};

/// One of the two axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Joint {
    /// About the vertical; positive turns the beam left as seen from the head.
    Pan,
    /// About the pan-carried horizontal axis; positive turns the beam down.
    Tilt,
}

impl Joint {
    /// Both joints, pan first.
    pub const BOTH: [Joint; 2] = [Joint::Pan, Joint::Tilt];

    /// `pan` or `tilt`.
    pub const fn name(self) -> &'static str {
        match self {
            Joint::Pan => "pan",
            Joint::Tilt => "tilt",
        }
    }
}

impl core::fmt::Display for Joint {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

/// One quantity for each of the two joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PanTilt<T> {
    /// Of the pan joint.
    pub pan: T,
    /// Of the tilt joint.
    pub tilt: T,
}

impl<T> PanTilt<T> {
    /// Pan first, then tilt.
    pub const fn new(pan: T, tilt: T) -> Self {
        Self { pan, tilt }
    }

    /// Evaluates `f` for each joint.
    pub fn from_fn(mut f: impl FnMut(Joint) -> T) -> Self {
        Self { pan: f(Joint::Pan), tilt: f(Joint::Tilt) }
    }

    /// Each joint's value through `f`.
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> PanTilt<U> {
        PanTilt { pan: f(self.pan), tilt: f(self.tilt) }
    }
}

impl<T> Index<Joint> for PanTilt<T> {
    type Output = T;

    fn index(&self, joint: Joint) -> &T {
        match joint {
            Joint::Pan => &self.pan,
            Joint::Tilt => &self.tilt,
        }
    }
}

impl<T> IndexMut<Joint> for PanTilt<T> {
    fn index_mut(&mut self, joint: Joint) -> &mut T {
        match joint {
            Joint::Pan => &mut self.pan,
            Joint::Tilt => &mut self.tilt,
        }
    }
}

/// What one joint may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLimits {
    /// Lowest angle, rad.
    pub lower_rad: f32,
    /// Highest angle, rad.
    pub upper_rad: f32,
    /// Highest speed, rad/s.
    pub speed_rad_s: f32,
    /// Highest acceleration, rad/s².
    pub acceleration_rad_s2: f32,
}

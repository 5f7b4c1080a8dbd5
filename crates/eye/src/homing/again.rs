//! A head that lost counts while it drew: homed again by a dot where the camera should see one.

use tracelight_task::Failure;

use crate::Driven;
use crate::head::{ACROSS_AGAIN, dots};
use crate::homing::state::{Homed, Homing, anywhere};

impl<D: Driven> Homing<'_, D> {
    /// Lights dots in sight, of a known head whose counts are not far off, until one is seen; tells the rig where its joints are by that.
    pub(super) fn home_again(&mut self) -> Result<Homed, Failure> {
        let change = self.change()?;
        let in_sight = dots(self.camera, self.driving, ACROSS_AGAIN);
        let count = in_sight.len();
        let (mut at, mut sought) = (Default::default(), 0);
        // from the middle on: it is in sight for sure, however far off the counts are
        for place in in_sight.into_iter().cycle().skip(count / 2).take(count) {
            let Ok(there) = self.driving.machine.angles(place) else { continue };
            if let Some(fault) = self.go(at, there)? {
                return Err(Failure::fault(fault));
            }
            (at, sought) = (there, sought + 1);
            let on_wall = self.dot(change)?.and_then(|spot| self.camera.target(spot));
            let geometry = anywhere(&self.driving.machine.geometry);
            let truly = on_wall.and_then(|on_wall| geometry.angles(&self.driving.pose, on_wall).ok());
            if let Some(truly) = truly {
                self.tell(truly)?;
                return Ok(Homed { sought, stops: self.stops, counts: self.counts });
            }
        }
        let message = format!(
            "the head lost counts, and the camera saw none of {sought} dots by which it was to be homed again: is the laser on, and the camera's view of the wall free?"
        );
        Err(Failure::failed("head-not-found", message))
    }
}

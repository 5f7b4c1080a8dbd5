use std::io;
use std::time::Duration;

use moq_v4l::Device;
use moq_v4l::control::{Control, Description, Value};

use super::why::calmly;

/// Identifiers of controls (Linux, `v4l2-controls.h`).
mod id {
    pub(super) const AUTOGAIN: u32 = 0x0098_0912;
    pub(super) const GAIN: u32 = 0x0098_0913;
    /// 0 and 3 expose by themselves, 1 as they are told.
    pub(super) const EXPOSURE_AUTO: u32 = 0x009a_0901;
    /// In units of 100 µs.
    pub(super) const EXPOSURE_ABSOLUTE: u32 = 0x009a_0902;
    /// Whether images may become fewer where it is dark.
    pub(super) const EXPOSURE_AUTO_PRIORITY: u32 = 0x009a_0903;
    pub(super) const FOCUS_AUTO: u32 = 0x009a_090c;
}

/// `V4L2_EXPOSURE_MANUAL`.
const BY_HAND: i64 = 1;
/// Unit of `EXPOSURE_ABSOLUTE`, s.
const EXPOSURE_S: f64 = 1e-4;
/// Steps in which a camera's gain is raised from where it was found to its most.
const GAIN_STEPS: i64 = 4;
/// How often a camera that is busy with what it was told before is told again, and after how long.
const TRIES: usize = 6;
const TRY_AGAIN: Duration = Duration::from_millis(40);

/// Least and most of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Range {
    least: i64,
    most: i64,
}

/// What a camera lets itself be told. What was changed is put back when it is dropped.
pub(super) struct Controls {
    device: Device,
    /// What it can be exposed for, in its units; `None` of a camera that exposes as it likes.
    exposure: Option<Range>,
    /// The exposure it was told last.
    told: Option<i64>,
    /// What its gain may be.
    gain: Option<Range>,
    /// How much the gain is raised at once.
    gain_step: i64,
    /// Controls that were changed, and what they were before.
    changed: Vec<(u32, i64)>,
}

impl Controls {
    /// Has a camera expose as it is told from now on, if it can. Its images come already: some forget what they were told before.
    pub(super) fn take_over(device: Device) -> Self {
        let mut controls =
            Self { device, exposure: None, told: None, gain: None, gain_step: 0, changed: Vec::new() };
        // a camera without an automatic has no such control, and takes exposures all the same
        let is_by_hand = match controls.read(id::EXPOSURE_AUTO) {
            Ok(None) => true,
            Ok(Some(_)) => controls.set(id::EXPOSURE_AUTO, BY_HAND).is_ok(),
            Err(_) => false,
        };
        let listed = controls.listed();
        let listed = listed.as_deref();
        if is_by_hand && let Some(range) = controls.range(id::EXPOSURE_ABSOLUTE, listed) {
            controls.exposure = Some(range);
            // both are of the automatic, which may know neither
            for (control, off) in [(id::EXPOSURE_AUTO_PRIORITY, 0), (id::AUTOGAIN, 0)] {
                if controls.value(control).is_some() {
                    drop(controls.set(control, off));
                }
            }
            controls.gain = controls.range(id::GAIN, listed);
            if let (Some(range), Some(gain)) = (controls.gain, controls.value(id::GAIN)) {
                controls.gain_step = ((range.most - gain) / GAIN_STEPS).max(1);
            }
        } else {
            controls.put_back();
        }
        controls
    }

    /// Shortest and longest exposure, s, of a camera that can be told.
    pub(super) fn exposure_s(&self) -> Option<[f64; 2]> {
        self.exposure.map(|range| [range.least, range.most].map(|value| value as f64 * EXPOSURE_S))
    }

    /// Least, present and greatest gain, in its own units.
    pub(super) fn gain(&self) -> Option<[i64; 3]> {
        let range = self.gain?;
        Some([range.least, self.value(id::GAIN)?, range.most])
    }

    /// Whether it focuses by itself, which changes what a lens was calibrated for.
    pub(super) fn focuses(&self) -> bool {
        self.value(id::FOCUS_AUTO).is_some_and(|value| value != 0)
    }

    /// Exposes for so long from some image on, s; returns how long really, and whether it was told otherwise before. `None` of a camera
    /// that exposes as it likes.
    pub(super) fn expose(&mut self, exposure_s: f64) -> Option<(f64, bool)> {
        let range = self.exposure?;
        let wanted = ((exposure_s / EXPOSURE_S).round() as i64).clamp(range.least, range.most);
        let is_new = self.told != Some(wanted);
        if is_new {
            // one that can not take it goes on as before, and says so
            drop(self.set(id::EXPOSURE_ABSOLUTE, wanted));
            self.told = Some(wanted);
        }
        let is = self.value(id::EXPOSURE_ABSOLUTE).unwrap_or(wanted);
        Some((is as f64 * EXPOSURE_S, is_new))
    }

    /// Raises the gain, if it can be.
    pub(super) fn brighten(&mut self) -> bool {
        let (Some(range), Some(gain)) = (self.gain, self.value(id::GAIN)) else { return false };
        let wanted = (gain + self.gain_step).min(range.most);
        wanted > gain
            && self.set(id::GAIN, wanted).is_ok()
            && self.value(id::GAIN).is_some_and(|value| value > gain)
    }

    fn set(&mut self, control: u32, value: i64) -> io::Result<()> {
        let before = self.value(control);
        if before == Some(value) {
            return Ok(());
        }
        self.tell(control, value)?;
        if let (Some(before), false) = (before, self.changed.iter().any(|(id, _)| *id == control)) {
            self.changed.push((control, before));
        }
        Ok(())
    }

    /// Tells a camera, more than once where it is busy.
    fn tell(&self, control: u32, value: i64) -> io::Result<()> {
        let mut tries = 1;
        loop {
            let control = Control { id: control, value: Value::Integer(value) };
            match self.device.set_control(control) {
                Err(error) if tries < TRIES && may_pass(&error) => std::thread::sleep(TRY_AGAIN),
                result => return result,
            }
            tries += 1;
        }
    }

    /// What a control is; `None` of one that is not there.
    fn read(&self, control: u32) -> io::Result<Option<i64>> {
        match calmly(|| self.device.control(control)) {
            Ok(Control { value: Value::Integer(value), .. }) => Ok(Some(value)),
            Ok(Control { value: Value::Boolean(value), .. }) => Ok(Some(i64::from(value))),
            Ok(_) => Ok(None),
            Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// What a control is, if that can be read.
    fn value(&self, control: u32) -> Option<i64> {
        self.read(control).ok().flatten()
    }

    /// All controls; `None` where one is of a kind that is younger than the library, which panics at it.
    fn listed(&self) -> Option<Vec<Description>> {
        calmly(|| self.device.query_controls()).ok()
    }

    /// What a control may be.
    fn range(&mut self, control: u32, listed: Option<&[Description]>) -> Option<Range> {
        if let Some(all) = listed {
            let known = all.iter().find(|known| known.id == control)?;
            let range = Range { least: known.minimum, most: known.maximum };
            return (range.least < range.most).then_some(range);
        }
        // then the ends are tried: what lies beyond them is set to them. None below 0: drivers reckon without signs
        let before = self.value(control)?;
        let [least, most] = [0, i64::from(i32::MAX)].map(|end| {
            drop(self.set(control, end));
            self.value(control)
        });
        drop(self.set(control, before));
        let range = Range { least: least?, most: most? };
        (range.least < range.most).then_some(range)
    }

    /// All as it was found.
    fn put_back(&mut self) {
        // in the opposite order: an exposure cannot be set any more once it is automatic
        for (control, value) in std::mem::take(&mut self.changed).into_iter().rev() {
            // a camera that is gone needs nothing put back
            drop(self.tell(control, value));
        }
    }
}

impl Drop for Controls {
    fn drop(&mut self) {
        self.put_back();
    }
}

/// Whether a camera may take in a moment what it refuses now: it is busy, or not yet in the state it was told to be in.
fn may_pass(error: &io::Error) -> bool {
    /// `EIO`
    const IO: i32 = 5;
    matches!(error.kind(), io::ErrorKind::ResourceBusy | io::ErrorKind::PermissionDenied)
        || error.raw_os_error() == Some(IO)
}

use tracelight_maths::single;
use tracelight_sim::Run;
use tracelight_stroke::Point;

use super::layout::{Layout, WIDTH};
use super::plane::Plane;
use crate::finished::Finished;

/// What an open shutter collects of the spot: the line itself, and what lens and wall scatter of it.
pub(super) struct Exposure {
    /// The line, as wide as the spot is at this scale; reduced so often.
    core: Plane,
    core_level: u32,
    core_gain: f32,
    /// Scatter in the lens close by, reduced once or more.
    halo: Plane,
    halo_level: u32,
    halo_gain: f32,
    /// Veil in the lens, reduced three times.
    veil: Plane,
    /// Light the room sends back to the wall, reduced four times.
    bounce: Plane,
}

/// Light at one pixel: what the lens adds, and what falls on the wall and takes its texture.
pub(super) struct Light {
    /// From the line and the lens.
    pub(super) lens: f32,
    /// On the wall.
    pub(super) wall: f32,
}

// Brightness where a line drawn at the set speed has its middle, in units of the film's white. A Gaussian's peak is
// 0.4/σ, so each gain below is the wished peak times σ/0.4; the peaks were chosen by eye.
/// A line of a pixel or two is bright enough to be one; a broad one ends where a camera sees the spot end, two deviations from its middle.
const CORE_PEAKS: (f32, f32) = (4.0, 24.0);
const FINE_PX: f32 = 1.5;
/// Standard deviation of the spot on the wall, m: that of the laser which simulated cameras see.
const SPOT_M: f64 = 1e-3;
/// A finer spot is as wide as the lens draws it.
const FINEST_PX: f32 = 0.6;
const HALO_SIGMA_PX: f32 = 5.0;
const HALO_PEAK: f32 = 0.36;
const VEIL_SIGMA_PX: f32 = 26.0;
const VEIL_GAIN: f32 = 0.032 * VEIL_SIGMA_PX / 0.4;
const BOUNCE_SIGMA_PX: f32 = 85.0;
const BOUNCE_GAIN: f32 = 0.05 * BOUNCE_SIGMA_PX / 0.4;

impl Exposure {
    /// Collects every lit tick of all laps.
    pub(super) fn new(job: &Finished<'_>, layout: &Layout) -> Self {
        let mut dose = Plane::dark(WIDTH as usize, layout.height as usize);
        // a tick at the set speed leaves as much energy as it covers pixels: one a pixel of line
        let per_tick = (job.set_speed_m_s * tracelight_rig::TICK_F64_S * layout.px_per_m).clamp(1e-6, 1e6);
        let laps = job.earlier_laps.iter().chain([job.run]);
        let share = per_tick / (1 + job.earlier_laps.len()) as f64;
        laps.for_each(|run| expose(&mut dose, run, layout, share));
        let blurred = |plane: Plane, sigma: f32, level: u32| {
            let sigma = sigma / (1 << level) as f32;
            plane.blurred(sigma, sigma)
        };
        let core_px = ((SPOT_M * layout.px_per_m) as f32).max(FINEST_PX).min(WIDTH as f32 / 16.0);
        let halo_px = HALO_SIGMA_PX.max(2.5 * core_px);
        let peak = (CORE_PEAKS.1 * single::powf(FINE_PX / core_px, 1.3)).clamp(CORE_PEAKS.0, CORE_PEAKS.1);
        let (core_level, halo_level) = (level(core_px), level(halo_px).max(1));
        Self {
            core_gain: peak * core_px / 0.4,
            core_level,
            halo: blurred(dose.reduced(halo_level), halo_px, halo_level),
            halo_level,
            halo_gain: HALO_PEAK * halo_px / 0.4,
            veil: blurred(dose.reduced(3), VEIL_SIGMA_PX, 3),
            bounce: blurred(dose.reduced(4), BOUNCE_SIGMA_PX, 4),
            core: blurred(dose.reduced(core_level), core_px, core_level),
        }
    }

    /// Light at the pixel in column `x`, row `y`.
    pub(super) fn at(&self, x: usize, y: usize) -> Light {
        let (u, v) = (x as f32 + 0.5, y as f32 + 0.5);
        let core =
            if self.core_level == 0 { self.core.row(y)[x] } else { self.core.sample(u, v, self.core_level) };
        let line = core * self.core_gain;
        let halo = self.halo.sample(u, v, self.halo_level) * self.halo_gain;
        let veil = self.veil.sample(u, v, 3) * VEIL_GAIN;
        Light { lens: line + 0.4 * halo + veil, wall: 1.6 * halo + self.bounce.sample(u, v, 4) * BOUNCE_GAIN }
    }
}

/// How often a plane is reduced before it is blurred: five pixels of deviation are wide enough to be smooth.
fn level(sigma_px: f32) -> u32 {
    (0..6).find(|&level| sigma_px <= 5.0 * (1 << level) as f32).unwrap_or(6)
}

/// Adds a run's lit way to the dose, `energy` a tick.
fn expose(dose: &mut Plane, run: &Run, layout: &Layout, energy: f64) {
    let mut before: Option<Point> = None;
    for tick in &run.ticks {
        let spot = tick.spot.filter(|p| tick.light && p.is_finite()).map(|p| layout.pixel_from_target * p);
        if let Some(to) = spot {
            draw(dose, before.unwrap_or(to), to, energy);
        }
        before = spot;
    }
}

/// Spreads a tick's energy evenly over the way it covers, in steps of half a pixel at most.
fn draw(dose: &mut Plane, from: Point, to: Point, energy: f64) {
    const MOST_STEPS: f64 = 4096.0; // a spot that jumps across the wall must not cost time
    let steps = (from.distance(to) * 2.0).ceil().clamp(1.0, MOST_STEPS);
    for i in 0..steps as u32 {
        let p = from.lerp(to, (f64::from(i) + 0.5) / steps);
        dose.splat(p.x as f32, p.y as f32, (energy / steps) as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_line_is_bright_where_the_spot_went_and_dark_elsewhere() {
        let fixture = fixture::star();
        let job = fixture.job();
        let layout = Layout::new(&job);
        let exposure = Exposure::new(&job, &layout);
        let tick = fixture.run.ticks.iter().filter(|t| t.light).nth(500).unwrap();
        let on = layout.pixel_from_target * tick.spot.unwrap();
        let bright = exposure.at(on.x as usize, on.y as usize).lens;
        let dark = exposure.at(20, 20).lens;
        assert!(bright > 5.0, "{bright}");
        assert!(dark < 0.02, "{dark}");
    }

    #[test]
    fn standing_still_burns_brighter() {
        let fixture = fixture::star();
        let job = fixture.job();
        let layout = Layout::new(&job);
        let mut run = Run::default();
        let tick = *fixture.run.ticks.iter().find(|t| t.light).unwrap();
        run.ticks = vec![tick; 100];
        let once = Run { ticks: vec![tick] };
        let sum = |run: &Run| {
            let mut dose = Plane::dark(WIDTH as usize, layout.height as usize);
            expose(&mut dose, run, &layout, 1.0);
            dose.values.iter().sum::<f32>()
        };
        assert!((sum(&run) / sum(&once) - 100.0).abs() < 0.1);
    }
}

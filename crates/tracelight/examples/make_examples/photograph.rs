//! What a simulated camera sees, as a JPEG file.

use std::error::Error;

use tracelight_aim::Camera;
use tracelight_picture::Raster;
use tracelight_plant::{CameraConfig, SimulatedCamera, Wall};

/// One photograph, exposed for 0.9 of what would fill a white pixel in full light. `seed` draws the sensor's noise.
pub(super) fn jpeg(
    config: &CameraConfig,
    camera: &Camera,
    scene: &Wall,
    seed: u64,
    quality: u8,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let exposure_s = 0.9 * config.sensor.reference_s;
    let image = SimulatedCamera::new(config, camera, scene, seed).expose(0.0, exposure_s, &[]);
    let raster =
        Raster::new(image.width as u32, image.height as u32, image.rgb).ok_or("an empty photograph")?;
    Ok(raster.jpeg(quality)?)
}

//! Loads what is to be drawn: a scene file, or a bulk file, which is put on the stage.

use std::path::Path;

use crate::import;
use crate::import::source::Source;
use crate::outcome::Failure;
use crate::scene::Scene;
use crate::scene_file::{self, Changes};

/// Loads the file at `path`, or stdin for `-`.
///
/// # Errors
/// What is wrong with the file, or a change that it does not allow.
pub fn load(path: &Path, changes: &Changes) -> Result<Scene, Failure> {
    let mut source = Source::open(path)?;
    let Some(scene) = import::objects(&mut source, changes.frame) else {
        if changes.frame.is_some() {
            let name = &source.name;
            let told = format!("{name} is a scene, whose [[spheres]] say frame = N; --frame is for a file of spheres");
            return Err(Failure::Usage(told));
        }
        let reader = source.reader();
        return Ok(scene_file::read(reader, &source.name, source.folder().unwrap_or(Path::new("")), changes)?);
    };
    let mut scene = scene?;
    if let Some(factor) = changes.radius_scale {
        let told = || Failure::Usage(format!("no radius is finite if it is multiplied by {factor:?}"));
        scene.scale_radii(factor).ok_or_else(told)?;
    }
    scene.set_stage(changes.view);
    Ok(scene)
}

//! Objects from other programs' files: spheres from XYZ, meshes from OBJ.

mod elements;
pub mod obj;
pub mod xyz;

use std::path::Path;

use crate::scene::{Look, Scene};
use glam::DVec3;

/// Why a bulk file cannot be read.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum ImportError {
    /// A file of spheres.
    Xyz(#[from] xyz::XyzError),
    /// A mesh.
    Obj(#[from] obj::ObjError),
    /// A file of spheres without a sphere.
    #[error("{0}: no objects")]
    Empty(String),
}

/// Reads a bulk file into a scene with a camera, lights and colours of its own; `None` if `path` does not end like one.
///
/// Files of spheres end in `.xyz` or `.extxyz`, meshes in `.obj`.
///
/// # Errors
/// What is wrong with the file.
pub fn load(path: &Path) -> Option<Result<Scene, ImportError>> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    match ending.as_str() {
        "xyz" | "extxyz" => Some(spheres(path)),
        "obj" => Some(mesh(path)),
        _ => None,
    }
}

fn spheres(path: &Path) -> Result<Scene, ImportError> {
    let mut scene = Scene::empty();
    scene.add_spheres(xyz::load(path, xyz::Options::default())?, None);
    if scene.is_empty() {
        return Err(ImportError::Empty(path.display().to_string()));
    }
    scene.set_stage();
    Ok(scene)
}

fn mesh(path: &Path) -> Result<Scene, ImportError> {
    let mut scene = Scene::empty();
    scene.looks.push(Look::colored(DVec3::new(0.8, 0.78, 0.74)));
    scene.add_mesh(obj::load(path)?, 0, path);
    scene.set_stage();
    Ok(scene)
}

/// Reads a number; what is none is given back for a message.
fn number(word: &[u8]) -> Result<f64, String> {
    std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()).ok_or_else(|| shown(word))
}

/// What was found, for a message: cut where it is long.
fn shown(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    let text = text.trim();
    match text.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_owned(),
    }
}

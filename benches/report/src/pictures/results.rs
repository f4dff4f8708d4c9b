//! What is measured of whole pictures.

use serde::{Deserialize, Serialize};

use crate::measure::Time;

/// What was measured of all methods on one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pictured {
    pub(crate) scene: String,
    pub(crate) group: Group,
    pub(crate) objects: usize,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) methods: Vec<Painted>,
}

/// What a scene is there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Group {
    Figures,
    Crowd,
    Hard,
    /// Made for the last byte: drawn by the textbook and by the program alone.
    Certified,
}

/// What was measured of one method on one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Painted {
    pub(crate) method: String,
    pub(crate) ours: bool,
    pub(crate) wrong_pixels: usize,
    /// Nanoseconds for one ray, shading included, on one thread.
    pub(crate) time: Time,
    /// The picture as PNG in base64, where it is worth a look.
    pub(crate) png: Option<String>,
}

//! The six figures of the report: scene files that are part of the program.

use crate::assets::FIGURE_SCENES;
use crate::scene::Scene;
use crate::scene_file::{self, SceneError};

/// One of the six figures.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Its number in the report, from 1.
    pub number: u8,
    /// What it shows.
    pub title: &'static str,
    /// Its scene file.
    pub text: &'static str,
}

/// The six figures, in order.
pub const FIGURES: [Figure; 6] = [
    Figure { number: 1, title: "one sphere, white on black", text: FIGURE_SCENES[0] },
    Figure { number: 2, title: "spheres, the nearest wins", text: FIGURE_SCENES[1] },
    Figure { number: 3, title: "spheres in Phong's light", text: FIGURE_SCENES[2] },
    Figure { number: 4, title: "one triangle in one colour", text: FIGURE_SCENES[3] },
    Figure { number: 5, title: "colours across a triangle", text: FIGURE_SCENES[4] },
    Figure { number: 6, title: "a texture around a sphere", text: FIGURE_SCENES[5] },
];

impl Figure {
    /// The figure with this number in 1..=6.
    pub fn numbered(number: u8) -> Option<&'static Self> {
        FIGURES.iter().find(|figure| figure.number == number)
    }

    /// The name of its scene file and, with another ending, of its picture.
    pub fn name(&self) -> String {
        format!("figure-{}", self.number)
    }

    /// Reads its scene file.
    ///
    /// # Errors
    /// None, as a test shows; the type is that of any scene file.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        scene_file::embedded(self.text, &format!("{}.toml", self.name()))
    }
}

//! The six figures of the report: scene files and the image that they need, carried in the program.

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
    Figure { number: 1, title: "one sphere, white on black", text: include_str!("../scenes/figure-1.toml") },
    Figure { number: 2, title: "spheres, the nearest wins", text: include_str!("../scenes/figure-2.toml") },
    Figure { number: 3, title: "spheres in Phong's light", text: include_str!("../scenes/figure-3.toml") },
    Figure { number: 4, title: "one triangle in one colour", text: include_str!("../scenes/figure-4.toml") },
    Figure { number: 5, title: "colours across a triangle", text: include_str!("../scenes/figure-5.toml") },
    Figure { number: 6, title: "a texture around a sphere", text: include_str!("../scenes/figure-6.toml") },
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

/// Returns the bytes of the file that a figure's scene names, if it is carried in the program.
pub fn asset(path: &str) -> Option<&'static [u8]> {
    (path == "../assets/earth-natural-720x360.png").then_some(include_bytes!("../assets/earth-natural-720x360.png"))
}

//! Draws the six figures of the report, and scenes of your own.
//!
//! A picture is made in one pass: [`scene_file`] reads a checked [`scene`], [`render`] sends the [`camera`]'s rays
//! through a tree of the objects and shades what they hit, and [`output`] saves the pixels. [`cli`] is the program.
//!
//! ```
//! use figures::camera::Size;
//! use figures::figure::Figure;
//! use figures::render::Renderer;
//!
//! let scene = Figure::numbered(1).unwrap().scene()?;
//! let view = scene.view(Size { width: 64, height: 48, samples: 1 }).unwrap();
//! let picture = Renderer::new(scene).rows(&view, 0..48, 255, &|_rows| ());
//! assert_eq!(picture.rays, 64 * 48);
//! assert_eq!(picture.samples[..3], [0, 0, 0]); // the corner is black
//! # Ok::<(), figures::scene_file::SceneError>(())
//! ```

pub mod ask;
mod assets;
pub mod camera;
pub mod certify;
pub mod cli;
pub mod convert;
pub mod draw;
pub mod figure;
pub mod generate;
pub mod import;
pub mod load;
mod memory;
pub mod objects;
mod options;
pub mod outcome;
pub mod output;
pub mod render;
pub mod scene;
pub mod scene_file;
mod seen;
pub mod stage;
pub mod stderr;
mod text;
mod texture_file;
pub mod tile;

// The example on the front page is compiled like any other.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct FrontPage;

// And that of the page on questions.
#[cfg(doctest)]
#[doc = include_str!("../../docs/questions.md")]
struct Questions;

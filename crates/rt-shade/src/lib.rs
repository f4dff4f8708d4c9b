//! Phong shading, the mapping of textures onto spheres, and colours. Knows no shapes.
//!
//! Colours are linear RGB in a [`glam::DVec3`], 1.0 = full; nothing applies a gamma. Functions take a vector also as
//! three numbers, `[f64; 3]`, into which `to_array` turns an answer. Every result is the same
//! bits on every platform: only additions, multiplications, divisions and square roots are used, which IEEE 754
//! rounds correctly, and no function of the system's mathematics library.
//!
//! ```
//! use glam::DVec3;
//! use rt_shade::{Material, PointLight, SurfacePoint, color, phong};
//!
//! let material = Material { ambient: 0.1, diffuse: 0.9, specular: 0.0, shininess: 1.0 };
//! let lamp = PointLight { position: DVec3::new(0.0, 0.0, 5.0), color: DVec3::ONE };
//! let seen = SurfacePoint::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::new(1.0, 0.5, 0.0), &material);
//! let shaded = phong(&seen, &[lamp]);
//! assert_eq!(shaded.color.to_array().map(|c| color::to_sample(c, 255)), [255, 128, 0]);
//! ```

mod arctangent;
pub mod certified;
pub mod color;
mod double_word;
mod mapping;
mod phong;
mod phong_batch;
mod power;
mod texture;

/// The vectors of every signature: another version of the crate has other types.
pub use glam;
pub use mapping::{sphere_uv, texture_uv, texture_uv_within};
pub use phong::{Errors, Material, PointLight, Shaded, Sides, SurfacePoint, phong, phong_with_sides};
pub use phong_batch::phong_batch;
pub use texture::{Texture, TextureError};

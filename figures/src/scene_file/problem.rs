//! What can be wrong with a scene file.

use crate::camera::CameraError;
use crate::import::ImportError;
use crate::scene::LookIndex;
use crate::text::{Utf16, escaped, quoted};

/// The largest scene file that is read. More spheres than fit belong into a bulk file.
pub(super) const MAX_BYTES: u64 = 256 << 20;

/// What is wrong with a scene file, and where.
#[derive(Debug, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct SceneError {
    pub(super) place: String,
    #[source]
    pub(super) problem: Box<SceneProblem>,
}

#[derive(Debug, thiserror::Error)]
pub(super) enum SceneProblem {
    #[error("{0}")]
    Syntax(String),
    #[error("cannot read it: {0}")]
    Read(std::io::Error),
    #[error("not UTF-8 text; a scene file is TOML")]
    NotText,
    #[error(transparent)]
    Utf16(Utf16),
    #[error("larger than {} MiB; put the spheres into an XYZ file", MAX_BYTES >> 20)]
    TooLarge,
    #[error("{name} must be finite, found {found}")]
    NotFinite { name: &'static str, found: String },
    #[error("{name} must not be negative, found {found}")]
    Negative { name: &'static str, found: f64 },
    #[error("{name} must be more than 0, found {found}")]
    NotPositive { name: &'static str, found: f64 },
    #[error("{name} must be three numbers from 0 to 1, found {found}")]
    NoColor { name: &'static str, found: String },
    #[error("material {} is not defined; {known}", quoted(name))]
    UnknownMaterial { name: String, known: String },
    #[error("material {} has neither a color nor a texture", quoted(.0))]
    NoPaint(String),
    #[error("material {} has both a color and a texture; keep one", quoted(.0))]
    TwoPaints(String),
    #[error("{0} is for a material with a texture")]
    NoTexture(&'static str),
    #[error("a triangle cannot have a texture, and material {} has one", quoted(.0))]
    TexturedTriangle(String),
    #[error("a triangle needs a material or colors")]
    BareTriangle,
    #[error("the triangle has no area: its vertices lie on one line")]
    FlatTriangle,
    #[error(transparent)]
    Camera(CameraError),
    #[error(transparent)]
    Texture(rt_io::ReadImageError),
    #[error("{} is not part of the program", escaped(.0))]
    NotEmbedded(String),
    #[error(transparent)]
    Import(ImportError),
    #[error("the scene is on the stage (stage = true), which has its own; remove the {0} or the stage")]
    Staged(&'static str),
    #[error("the scene has a camera of its own; --view is for files, and scenes with stage = true")]
    OwnCamera,
    #[error("a light has either a position or a camera, its place relative to the camera")]
    LightPlace,
    #[error("frame must be 1 or more, found {0}")]
    Frame(i64),
    #[error("no radius is finite if it is multiplied by {0:?}")]
    Radii(f64),
    #[error("no objects; add a [[sphere]], [[spheres]], [[triangle]] or [[mesh]]")]
    Empty,
    #[error("more than {} materials", LookIndex::MOST)]
    TooManyLooks,
}

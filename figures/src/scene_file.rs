//! Scene files: from TOML to a checked [`Scene`]. `docs/scene-format.md` describes them for people who write them.
//!
//! The text is parsed into tables that mirror the format one to one, each value with its place in the file; unknown
//! keys are refused there. Then every number is checked, names are resolved and files are read. The first thing that
//! is wrong ends it, told as `file:line:column: message`.

mod elements;

use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::marker::PhantomData;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rt_geom::{Sphere, Triangle};
use rt_shade::{Material, PointLight, Texture};
use serde::de::{Deserialize, Deserializer, Error as _, SeqAccess, Visitor};
use toml::Spanned;

use crate::camera::Camera;
use crate::figure::asset;
use crate::import::{obj, xyz};
use crate::scene::{COLOR, DEFAULT_MATERIAL, Filter, Look, Paint, Scene, TooManyColors};
use crate::text::{Utf16, escaped, file_name, listed, meant, quoted, without_mark};
use crate::texture_file;

/// The largest scene file that is read. More spheres than fit belong into a bulk file.
const MAX_BYTES: u64 = 256 << 20;

/// Of a longer scene file the elements are parsed in groups of about this many bytes, so that memory is that of the text,
/// twice, and of the scene.
const GROUP_BYTES: usize = 1 << 18;

/// What is wrong with a scene file, and where.
#[derive(Debug, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct SceneError {
    place: String,
    #[source]
    problem: Box<Problem>,
}

#[derive(Debug, thiserror::Error)]
enum Problem {
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
    Camera(crate::camera::CameraError),
    #[error(transparent)]
    Texture(rt_io::ReadImageError),
    #[error("{} is not part of the program", escaped(.0))]
    NotEmbedded(String),
    #[error(transparent)]
    Spheres(xyz::XyzError),
    #[error(transparent)]
    Mesh(obj::ObjError),
    #[error("no objects; add a [[sphere]], [[spheres]], [[triangle]] or [[mesh]]")]
    Empty,
    #[error("more than {COLOR} materials")]
    TooManyLooks,
    /// Files with more colours than can be numbered.
    #[error(transparent)]
    TooManyColors(TooManyColors),
}

// The tables of the format, one to one.

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneTable {
    #[serde(default)]
    camera: Option<Spanned<CameraTable>>,
    #[serde(default)]
    background: Option<Vector>,
    #[serde(default, deserialize_with = "tables")]
    light: Vec<LightTable>,
    #[serde(default)]
    material: BTreeMap<String, Spanned<MaterialTable>>,
    #[serde(default, deserialize_with = "tables")]
    sphere: Vec<SphereTable>,
    #[serde(default, deserialize_with = "tables")]
    spheres: Vec<SpheresTable>,
    #[serde(default, deserialize_with = "tables")]
    triangle: Vec<Spanned<TriangleTable>>,
    #[serde(default, deserialize_with = "tables")]
    mesh: Vec<MeshTable>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraTable {
    eye: Option<Vector>,
    look_at: Option<Vector>,
    up: Option<Vector>,
    fov: Option<Number>,
    #[serde(default)]
    fit: bool,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct LightTable {
    position: Vector,
    color: Option<Vector>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialTable {
    color: Option<Vector>,
    texture: Option<Spanned<String>>,
    mirrored: Option<Spanned<bool>>,
    filter: Option<Spanned<Filter>>,
    ambient: Option<Number>,
    diffuse: Option<Number>,
    specular: Option<Number>,
    shininess: Option<Number>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct SphereTable {
    center: Vector,
    radius: Number,
    material: Spanned<String>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct SpheresTable {
    file: Spanned<String>,
    scale: Option<Number>,
    radius: Option<Number>,
    material: Option<Spanned<String>>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct TriangleTable {
    a: Vector,
    b: Vector,
    c: Vector,
    material: Option<Spanned<String>>,
    colors: Option<Spanned<Triple<Vector>>>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct MeshTable {
    file: Spanned<String>,
    material: Option<Spanned<String>>,
}

type Number = Spanned<Real>;
type Vector = Spanned<Triple<Real>>;

/// A number, written as an integer or a float; not checked yet.
#[derive(Clone, Copy)]
struct Real(f64);

impl<'de> Deserialize<'de> for Real {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AnyNumber;
        impl Visitor<'_> for AnyNumber {
            type Value = Real;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Real, E> {
                Ok(Real(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Real, E> {
                Ok(Real(value as f64)) // rounded to the nearest, as a float with these digits would be
            }
        }
        deserializer.deserialize_any(AnyNumber)
    }
}

/// An array of exactly three values; what serde derives would pass over a fourth.
struct Triple<T>([T; 3]);

impl Triple<Real> {
    fn vector(&self) -> DVec3 {
        DVec3::from_array(self.0.each_ref().map(|number| number.0))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Triple<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Three<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Three<T> {
            type Value = Triple<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of three")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Triple<T>, A::Error> {
                let mut found = Vec::new();
                while let Some(value) = values.next_element()? {
                    found.push(value);
                }
                let length = found.len();
                found.try_into().map(Triple).map_err(|_| A::Error::invalid_length(length, &self))
            }
        }
        deserializer.deserialize_any(Three(PhantomData))
    }
}

/// Reads an array of tables, and says how to write one where there is something else.
fn tables<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<T>, D::Error> {
    struct Tables<T>(PhantomData<T>);
    impl<'de, T: Deserialize<'de>> Visitor<'de> for Tables<T> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("an array of tables, such as [[sphere]]")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Vec<T>, A::Error> {
            let mut found = Vec::new();
            while let Some(value) = values.next_element()? {
                found.push(value);
            }
            Ok(found)
        }
    }
    deserializer.deserialize_any(Tables(PhantomData))
}

/// Where the files that a scene names are looked up.
#[derive(Clone, Copy, Debug)]
enum Files<'a> {
    /// In this folder.
    Folder(&'a Path),
    /// Among the files in the program.
    Embedded,
}

/// Reads the scene file at `path`; the files that it names are looked up beside it.
///
/// # Errors
/// Whatever is wrong with the file or the files that it names, with its place.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let name = file_name(path);
    let refuse = |problem| SceneError { place: name.clone(), problem: Box::new(problem) };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|error| refuse(Problem::Read(error)))?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(|error| refuse(Problem::Read(error)))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(refuse(Problem::TooLarge));
    }
    let bytes = without_mark(&bytes).map_err(|error| refuse(Problem::Utf16(error)))?;
    let text = str::from_utf8(bytes).map_err(|_| refuse(Problem::NotText))?;
    parse(text, &name, Files::Folder(path.parent().unwrap_or(Path::new(""))))
}

/// Reads a scene that is part of the program; it may name no files but those that are part of it too.
///
/// # Errors
/// As [`load`].
pub fn embedded(text: &str, name: &str) -> Result<Scene, SceneError> {
    parse(text, name, Files::Embedded)
}

fn parse(text: &str, name: &str, files: Files<'_>) -> Result<Scene, SceneError> {
    Checker { text, name, files, offset: 0 }.scene(GROUP_BYTES)
}

/// Turns tables into the scene. Its methods check one kind of value each.
#[derive(Clone, Copy)]
struct Checker<'a> {
    text: &'a str,
    name: &'a str,
    files: Files<'a>,
    /// Where in the text the part begins in which spans count.
    offset: usize,
}

impl Checker<'_> {
    /// Checks all of the text. If it is longer than `group`, its elements are parsed in groups of about that size.
    fn scene(&self, group: usize) -> Result<Scene, SceneError> {
        let (table, groups) = self.tables(group)?;
        let mut scene = Scene::empty();
        if let Some(camera) = &table.camera {
            scene.camera = self.camera(camera)?;
        }
        if let Some(color) = &table.background {
            scene.background = self.color("background", color)?;
        }
        let mut materials = BTreeMap::new();
        for (material, table) in &table.material {
            materials
                .insert(material.as_str(), self.push(&mut scene.looks, table.span(), |_| self.look(material, table))?);
        }
        let mut bare = None;
        self.elements(&table, &materials, &mut bare, &mut scene)?;
        for range in groups {
            let part = Self { offset: range.start, ..*self };
            part.elements(&part.parsed(&self.text[range])?, &materials, &mut bare, &mut scene)?;
        }
        for spheres in &table.spheres {
            self.spheres(spheres, &materials, &mut scene)?;
        }
        if scene.vertex_colors.iter().all(Option::is_none) {
            scene.vertex_colors.clear();
        }
        for mesh in &table.mesh {
            let look = match &mesh.material {
                Some(material) => self.paint(&scene, &materials, material)?,
                None => self.bare(&mut scene, &mut bare, mesh.file.span())?,
            };
            let path = self.path(&mesh.file)?;
            let found = obj::load(&path).map_err(|error| self.refuse(mesh.file.span(), Problem::Mesh(error)))?;
            scene.add_mesh(found, look, &path);
        }
        if scene.is_empty() {
            return Err(self.refuse(0..0, Problem::Empty));
        }
        Ok(scene)
    }

    /// The tables of the text, or those of a long one without its elements, and where groups of these are.
    fn tables(&self, group: usize) -> Result<(SceneTable, Vec<Range<usize>>), SceneError> {
        let long = self.text.len() > group;
        if let Some(elements::Cut { rest, groups }) = long.then(|| elements::cut(self.text, group)).flatten() {
            let table = self.parsed(&rest)?;
            // Elements may be left whose headers are written otherwise: then their order among the others would be lost.
            if table.light.is_empty() && table.sphere.is_empty() && table.triangle.is_empty() {
                return Ok((table, groups));
            }
        }
        Ok((self.parsed(self.text)?, Vec::new()))
    }

    /// Parses a document: all of the text, or a part of it that begins at `offset`.
    fn parsed(&self, text: &str) -> Result<SceneTable, SceneError> {
        toml::from_str(text).map_err(|error| {
            let message = error.message().trim().replace('\n', ", ").replace('`', "\"");
            let message = escaped(&message).into_owned();
            self.refuse(error.span().unwrap_or(0..0), Problem::Syntax(message))
        })
    }

    /// Adds the lights, spheres and triangles of a table to the scene.
    fn elements(
        &self,
        table: &SceneTable,
        materials: &BTreeMap<&str, u32>,
        bare: &mut Option<u32>,
        scene: &mut Scene,
    ) -> Result<(), SceneError> {
        for light in &table.light {
            let color = light.color.as_ref().map_or(Ok(DVec3::ONE), |color| self.color("color", color))?;
            scene.lights.push(PointLight { position: self.point("position", &light.position)?, color });
        }
        for sphere in &table.sphere {
            let center = self.point("center", &sphere.center)?;
            let radius = self.not_negative("radius", &sphere.radius)?;
            let look = self.material(materials, &sphere.material)?;
            scene.spheres.push(Sphere::new(center, radius).expect("center and radius were checked"));
            scene.sphere_looks.push(look);
        }
        for triangle in &table.triangle {
            self.triangle(triangle, materials, bare, scene)?;
        }
        Ok(())
    }

    fn camera(&self, table: &Spanned<CameraTable>) -> Result<Camera, SceneError> {
        let CameraTable { eye, look_at, up, fov, fit } = table.get_ref();
        let point =
            |name, value: &Option<Vector>, default| value.as_ref().map_or(Ok(default), |value| self.point(name, value));
        let eye = point("eye", eye, DVec3::ZERO)?;
        let look_at = point("look_at", look_at, eye + DVec3::NEG_Z)?;
        let up = point("up", up, DVec3::Y)?;
        let degrees = fov.as_ref().map_or(90.0, |fov| fov.get_ref().0);
        let camera = Camera::new(eye, look_at, up, degrees).map_err(|error| {
            let place = fov.as_ref().filter(|_| error == crate::camera::CameraError::FieldOfView);
            self.refuse(place.map_or(table.span(), Spanned::span), Problem::Camera(error))
        })?;
        Ok(if *fit { camera.fitted() } else { camera })
    }

    fn look(&self, name: &str, table: &Spanned<MaterialTable>) -> Result<Look, SceneError> {
        let MaterialTable { color, texture, mirrored, filter, ambient, diffuse, specular, shininess } = table.get_ref();
        let paint = match (color, texture) {
            (Some(_), Some(_)) => return Err(self.refuse(table.span(), Problem::TwoPaints(name.to_owned()))),
            (None, None) => return Err(self.refuse(table.span(), Problem::NoPaint(name.to_owned()))),
            (Some(color), None) => {
                let misplaced = [
                    mirrored.as_ref().map(|value| ("mirrored", value.span())),
                    filter.as_ref().map(|value| ("filter", value.span())),
                ];
                if let Some((key, span)) = misplaced.into_iter().flatten().next() {
                    return Err(self.refuse(span, Problem::NoTexture(key)));
                }
                Paint::Color(self.color("color", color)?)
            }
            (None, Some(file)) => Paint::Image {
                texture: self.texture(file)?,
                mirrored: mirrored.as_ref().is_some_and(|value| *value.get_ref()),
                filter: filter.as_ref().map_or_else(Filter::default, |value| *value.get_ref()),
            },
        };
        let coefficient = |name, value: &Option<Number>, default| {
            value.as_ref().map_or(Ok(default), |value| self.not_negative(name, value))
        };
        let material = Material {
            ambient: coefficient("ambient", ambient, DEFAULT_MATERIAL.ambient)?,
            diffuse: coefficient("diffuse", diffuse, DEFAULT_MATERIAL.diffuse)?,
            specular: coefficient("specular", specular, DEFAULT_MATERIAL.specular)?,
            shininess: shininess
                .as_ref()
                .map_or(Ok(DEFAULT_MATERIAL.shininess), |value| self.positive("shininess", value))?,
        };
        Ok(Look { paint, material })
    }

    fn texture(&self, file: &Spanned<String>) -> Result<Texture, SceneError> {
        let name = file.get_ref();
        let read = match (self.files, asset(name)) {
            (Files::Embedded, Some(bytes)) => texture_file::decode(bytes, name),
            _ => texture_file::load(&self.path(file)?),
        };
        read.map_err(|error| self.refuse(file.span(), Problem::Texture(error)))
    }

    fn spheres(
        &self,
        table: &SpheresTable,
        materials: &BTreeMap<&str, u32>,
        scene: &mut Scene,
    ) -> Result<(), SceneError> {
        let SpheresTable { file, scale, radius, material } = table;
        let look = material.as_ref().map(|material| self.material(materials, material)).transpose()?;
        let options = xyz::Options {
            scale: scale.as_ref().map_or(Ok(1.0), |scale| self.positive("scale", scale))?,
            radius: radius.as_ref().map(|radius| self.not_negative("radius", radius)).transpose()?,
            colored: look.is_none(),
        };
        let path = self.path(file)?;
        let found = xyz::load(&path, options);
        let found = found.map_err(|error| self.refuse(file.span(), Problem::Spheres(error)))?;
        scene.add_spheres(found, look, &path).map_err(|error| self.refuse(file.span(), Problem::TooManyColors(error)))
    }

    fn triangle(
        &self,
        table: &Spanned<TriangleTable>,
        materials: &BTreeMap<&str, u32>,
        bare: &mut Option<u32>,
        scene: &mut Scene,
    ) -> Result<(), SceneError> {
        let TriangleTable { a, b, c, material, colors } = table.get_ref();
        let [a, b, c] = [self.point("a", a)?, self.point("b", b)?, self.point("c", c)?];
        let triangle = Triangle::new(a, b, c).expect("the vertices were checked");
        if triangle.is_degenerate() {
            return Err(self.refuse(table.span(), Problem::FlatTriangle));
        }
        let look = match (material, colors) {
            (Some(material), _) => self.paint(scene, materials, material)?,
            (None, Some(_)) => self.bare(scene, bare, table.span())?,
            (None, None) => return Err(self.refuse(table.span(), Problem::BareTriangle)),
        };
        let colors = colors.as_ref().map(|colors| {
            let Triple([a, b, c]) = colors.get_ref();
            Ok([self.color("colors", a)?, self.color("colors", b)?, self.color("colors", c)?])
        });
        scene.triangles.push(triangle);
        scene.triangle_looks.push(look);
        scene.vertex_colors.push(colors.transpose()?);
        Ok(())
    }

    /// The look that triangles without a material share.
    fn bare(&self, scene: &mut Scene, bare: &mut Option<u32>, span: Range<usize>) -> Result<u32, SceneError> {
        match *bare {
            Some(look) => Ok(look),
            None => Ok(*bare.insert(self.push(&mut scene.looks, span, |_| Ok(Look::colored(DVec3::ONE)))?)),
        }
    }

    /// The look of a triangle: a material without a texture.
    fn paint(
        &self,
        scene: &Scene,
        materials: &BTreeMap<&str, u32>,
        material: &Spanned<String>,
    ) -> Result<u32, SceneError> {
        let look = self.material(materials, material)?;
        if matches!(scene.looks[look as usize].paint, Paint::Image { .. }) {
            return Err(self.refuse(material.span(), Problem::TexturedTriangle(material.get_ref().clone())));
        }
        Ok(look)
    }

    /// Where a file is that the scene names.
    fn path(&self, file: &Spanned<String>) -> Result<PathBuf, SceneError> {
        match self.files {
            Files::Folder(folder) => Ok(folder.join(file.get_ref())),
            Files::Embedded => Err(self.refuse(file.span(), Problem::NotEmbedded(file.get_ref().clone()))),
        }
    }

    /// Adds a look to the list and returns its position.
    fn push(
        &self,
        looks: &mut Vec<Look>,
        span: Range<usize>,
        look: impl FnOnce(&Self) -> Result<Look, SceneError>,
    ) -> Result<u32, SceneError> {
        let position = u32::try_from(looks.len()).ok().filter(|&position| position < COLOR);
        let position = position.ok_or_else(|| self.refuse(span, Problem::TooManyLooks))?;
        looks.push(look(self)?);
        Ok(position)
    }

    fn material(&self, materials: &BTreeMap<&str, u32>, name: &Spanned<String>) -> Result<u32, SceneError> {
        materials.get(name.get_ref().as_str()).copied().ok_or_else(|| {
            let names = || materials.keys().copied();
            let known = match (materials.len(), meant(name.get_ref(), names())) {
                (0, _) => "no material is".to_owned(),
                (_, Some(meant)) => format!("did you mean {}?", quoted(meant)),
                _ => format!("there is {}", listed(materials.keys().copied())),
            };
            self.refuse(name.span(), Problem::UnknownMaterial { name: name.get_ref().clone(), known })
        })
    }

    fn not_negative(&self, name: &'static str, value: &Number) -> Result<f64, SceneError> {
        let Real(found) = *value.get_ref();
        if !found.is_finite() {
            return Err(self.refuse(value.span(), Problem::NotFinite { name, found: found.to_string() }));
        }
        if found < 0.0 {
            return Err(self.refuse(value.span(), Problem::Negative { name, found }));
        }
        Ok(found)
    }

    fn positive(&self, name: &'static str, value: &Number) -> Result<f64, SceneError> {
        let found = self.not_negative(name, value)?;
        if found == 0.0 {
            return Err(self.refuse(value.span(), Problem::NotPositive { name, found }));
        }
        Ok(found)
    }

    fn point(&self, name: &'static str, value: &Vector) -> Result<DVec3, SceneError> {
        let found = value.get_ref().vector();
        if !found.is_finite() {
            return Err(self.refuse(value.span(), Problem::NotFinite { name, found: found.to_string() }));
        }
        Ok(found)
    }

    fn color(&self, name: &'static str, value: &Vector) -> Result<DVec3, SceneError> {
        let found = value.get_ref().vector();
        // Written so that NaN fails it.
        if !found.to_array().iter().all(|channel| (0.0..=1.0).contains(channel)) {
            return Err(self.refuse(value.span(), Problem::NoColor { name, found: found.to_string() }));
        }
        Ok(found)
    }

    /// The error `problem` at the start of `span`; lines and columns count from 1, columns in characters.
    fn refuse(&self, span: Range<usize>, problem: Problem) -> SceneError {
        let before = &self.text[..self.text.floor_char_boundary(self.offset + span.start)];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        SceneError { place: format!("{}:{line}:{column}", self.name), problem: Box::new(problem) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a text becomes if it is parsed as a whole, and if each element is parsed by itself.
    fn both(text: &str) -> [Result<String, String>; 2] {
        [usize::MAX, 1].map(|group| {
            let checker = Checker { text, name: "a.toml", files: Files::Embedded, offset: 0 };
            checker.scene(group).map(|scene| format!("{scene:?}")).map_err(|error| format!("{error} {error:?}"))
        })
    }

    #[test]
    fn a_scene_in_parts_is_the_whole_scene() {
        for figure in crate::figure::FIGURES {
            let [whole, parts] = both(figure.text);
            assert!(whole.is_ok() && whole == parts, "figure {}: {whole:?} {parts:?}", figure.number);
        }
        let head = "[[sphere]]\ncenter = [0, 0, -3]\nradius = 1\nmaterial = \"a\"\n[material.a]\ncolor = [1, 0.5, 0]\n";
        let element = |i: u32| match i % 3 {
            0 => format!("[[light]]\nposition = [{i}, 0, 0] # [[light]]\n"),
            1 => format!("[[ sphere ]]\ncenter = [0, {i}, -3]\nradius = {i}\nmaterial = \"a\"\n"),
            _ => format!(
                "[[triangle]]\na = [0, 0, 0]\nb = [{i}, 0, 0]\nc = [0, 0, 1]\ncolors = [\n[1, 0, 0],\n[0, 1, 0], [0, 0, 1]]\n"
            ),
        };
        let elements: String = (1..50).map(element).collect();
        for text in [head.to_owned() + &elements, elements.clone() + head, elements.clone() + head + &elements] {
            let [whole, parts] = both(&text);
            assert!(whole.is_ok() && whole == parts, "{whole:?} {parts:?}");
        }
    }

    #[test]
    fn an_error_in_a_part_has_its_place_in_the_whole() {
        let good = "[[light]]\nposition = [1, 2, 3]\n";
        let end = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n[material.a]\ncolor = [1, 1, 1]\n";
        for bad in [
            "[[light]]\nposition = [1, nan, 3]\n",
            "[[light]]\nposition = [1, 2]\n",
            "[[light]]\nplace = [1, 2, 3]\n",
            "[[light]]\nposition = [1, 2, 3\n",
            "[[light]\nposition = [1, 2, 3]\n",
            "[[light]]\nposition = [1, 2, 3]\nposition = [1, 2, 3]\n",
            "[[light]]\n",
            "[[light]]\ncolor = [2, 0, 0]\nposition = [1, 2, 3]\n",
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = -1\nmaterial = \"a\"\n",
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"b\"\n",
            "[[triangle]]\na = [0, 0, 0]\nb = [0, 0, 0]\nc = [0, 0, 1]\nmaterial = \"a\"\n",
            "[[lamp]]\nposition = [1, 2, 3]\n",
            "[[\"light\"]]\nposition = [1, 2, \"3\"]\n",
            "background = [[light]]\n",
            "a = \"\"\"\n[[light]]\n\"\"\"\n",
        ] {
            let [whole, parts] = both(&(good.repeat(3) + bad + good + end));
            assert!(whole.is_err() && whole == parts, "{bad}: {whole:?} {parts:?}");
        }
        for bad in ["light = []\n", "light = 3\n"] {
            let [whole, parts] = both(&(bad.to_owned() + good + end));
            assert!(whole.is_err() && whole == parts, "{bad}: {whole:?} {parts:?}");
        }
        for bad in ["[light.more]\n", "[light]\n"] {
            let [whole, parts] = both(&(good.to_owned() + bad + good + end));
            assert!(whole.is_err() && parts.is_err(), "{bad}: {whole:?} {parts:?}");
        }
    }

    #[test]
    fn headers_that_are_written_otherwise_keep_their_order() {
        let end = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n[material.a]\ncolor = [1, 1, 1]\n";
        let light = |header: &str, x: u32| format!("{header}\nposition = [{x}, 2, 3]\n");
        let text = light("[[light]]", 1)
            + &light("[[\"light\"]]", 2)
            + &light("[['light']]", 3)
            + &light("[[light]]", 4)
            + end;
        let [whole, parts] = both(&text);
        assert!(whole.is_ok() && whole == parts, "{whole:?} {parts:?}");
    }
}

//! Scene files: from TOML to a checked [`Scene`]. `docs/scene-format.md` describes them for people who write them.
//!
//! The text is parsed into tables that mirror the format one to one, each value with its place in the file; unknown
//! keys are refused there. Then every number is checked, names are resolved and files are read. The first error ends
//! it, as `file:line:column: message`.

mod elements;
mod problem;
mod tables;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rt_geom::{Sphere, Triangle};
use rt_shade::{Material, PointLight, Texture};
use toml::Spanned;

use crate::assets::asset;
use crate::camera::{Camera, CameraError};
use crate::import::spheres::Options;
use crate::import::{load_mesh, load_spheres};
use crate::scene::{DEFAULT_MATERIAL, Filter, Look, LookIndex, Paint, Scene};
use crate::stage::Direction;
use crate::text::{escaped, file_name, listed, meant, quoted, without_mark};
use crate::texture_file;
pub use problem::SceneError;
use problem::{MAX_BYTES, SceneProblem};
use tables::{
    AnyNumber, CameraTable, LightTable, MaterialTable, MeshTable, NumberEntry, SceneTable, SpheresTable, TriangleTable,
    Triple, VectorEntry,
};

/// Of a longer scene file the elements are parsed in groups of about this many bytes, so that memory is that of the
/// text, twice, and of the scene.
const GROUP_BYTES: usize = 1 << 18;

/// What the command line changes in what is loaded.
#[derive(Clone, Copy, Debug, Default)]
pub struct Changes {
    /// The frame of a bulk file, from 1.
    pub frame: Option<u64>,
    /// A factor for all radii; finite and more than 0.
    pub radius_scale: Option<f64>,
    /// Where objects on the stage are seen from.
    pub view: Option<Direction>,
}

/// Where the files that a scene names are looked up.
#[derive(Clone, Copy)]
enum Files<'a> {
    /// In this folder.
    Folder(&'a Path),
    /// Among the files in the program.
    Embedded,
}

/// Reads the scene file at `path`; the files that it names are looked up beside it.
///
/// # Errors
/// The first error in the file or in the files that it names, with its place.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let name = file_name(path);
    let refuse = |error| SceneError { place: name.clone(), problem: Box::new(SceneProblem::Read(error)) };
    let file = File::open(path).map_err(refuse)?;
    read(file, &name, path.parent().unwrap_or(Path::new("")), &Changes::default())
}

/// Reads a scene from `source`, which errors call `name`; the files that it names are looked up in `folder`.
///
/// # Errors
/// As [`load`].
pub(crate) fn read(source: impl Read, name: &str, folder: &Path, changes: &Changes) -> Result<Scene, SceneError> {
    let refuse = |problem| SceneError { place: name.to_owned(), problem: Box::new(problem) };
    let mut bytes = Vec::new();
    source.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(|error| refuse(SceneProblem::Read(error)))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(refuse(SceneProblem::TooLarge));
    }
    let bytes = without_mark(&bytes).map_err(|error| refuse(SceneProblem::Utf16(error)))?;
    let text = str::from_utf8(bytes).map_err(|_| refuse(SceneProblem::NotText))?;
    Checker { text, name, files: Files::Folder(folder), offset: 0, changes }.scene(GROUP_BYTES)
}

/// Reads a scene that is part of the program; it may name no files but those that are part of it too.
///
/// # Errors
/// As [`load`].
pub fn embedded(text: &str, name: &str) -> Result<Scene, SceneError> {
    let changes = &Changes::default();
    Checker { text, name, files: Files::Embedded, offset: 0, changes }.scene(GROUP_BYTES)
}

/// Turns tables into a scene. Its methods check one kind of value each.
#[derive(Clone, Copy)]
struct Checker<'a> {
    text: &'a str,
    name: &'a str,
    files: Files<'a>,
    /// Where in the text the part begins in which spans count.
    offset: usize,
    changes: &'a Changes,
}

/// A scene that is being made.
#[derive(Default)]
struct Draft<'a> {
    scene: Scene,
    materials: BTreeMap<&'a str, LookIndex>,
    /// The look that triangles without a material share, once there is one.
    bare: Option<LookIndex>,
    /// Whether the scene has the stage's camera and lights.
    stage: bool,
    /// The lights that turn with the camera, by their position in the list: to its right, up and back from the middle,
    /// in radii of the scene; and where their tables are.
    camera_lights: Vec<(usize, DVec3, Range<usize>)>,
}

/// Checks a value that may be left out, which means `default`.
fn or<T, V>(value: Option<&T>, default: V, check: impl FnOnce(&T) -> Result<V, SceneError>) -> Result<V, SceneError> {
    value.map_or(Ok(default), check)
}

impl Checker<'_> {
    /// Checks all of the text. If it is longer than `group`, its elements are parsed in groups of about that size.
    fn scene(&self, group: usize) -> Result<Scene, SceneError> {
        let (table, groups) = self.tables(group)?;
        let mut draft = Draft { stage: table.stage.as_ref().is_some_and(|stage| *stage.get_ref()), ..Draft::default() };
        draft.scene.camera = self.camera(table.camera.as_ref(), draft.stage)?;
        let background = table.background.as_ref().map(|color| self.color("background", color)).transpose()?;
        for (name, material) in &table.material {
            let look = self.look(name, material)?;
            draft.materials.insert(name, self.add_look(&mut draft.scene, look, material.span())?);
        }
        self.elements(&table, &mut draft)?;
        for range in groups {
            let part = Self { offset: range.start, ..*self };
            part.elements(&part.parsed(&self.text[range])?, &mut draft)?;
        }
        for spheres in &table.spheres {
            self.spheres(spheres, &mut draft)?;
        }
        if draft.scene.vertex_colors.iter().all(Option::is_none) {
            draft.scene.vertex_colors.clear();
        }
        for mesh in &table.mesh {
            self.mesh(mesh, &mut draft)?;
        }
        if draft.scene.is_empty() {
            return Err(self.refuse(0..0, SceneProblem::Empty));
        }
        if let Some(factor) = self.changes.radius_scale {
            draft.scene.scale_radii(factor).ok_or_else(|| self.refuse(0..0, SceneProblem::Radii(factor)))?;
        }
        if draft.stage {
            draft.scene.set_stage(self.changes.view);
        }
        draft.scene.background = background.unwrap_or(draft.scene.background);
        self.place_lights(draft)
    }

    /// The scene, with the lights that turn with the camera at their places.
    fn place_lights(&self, Draft { mut scene, camera_lights, .. }: Draft<'_>) -> Result<Scene, SceneError> {
        if camera_lights.is_empty() {
            return Ok(scene);
        }
        let spot = scene.spot();
        for (light, at, span) in camera_lights {
            let position = spot.at(at);
            if !position.is_finite() {
                let found = position.to_string();
                return Err(self.refuse(span, SceneProblem::NotFinite { name: "the light's place", found }));
            }
            scene.lights[light].position = position;
        }
        Ok(scene)
    }

    /// The tables of the text, or those of a long one without its elements, and where groups of these are.
    fn tables(&self, group: usize) -> Result<(SceneTable, Vec<Range<usize>>), SceneError> {
        let long = self.text.len() > group;
        if let Some(elements::Sections { rest, groups }) = long.then(|| elements::cut(self.text, group)).flatten() {
            let table = self.parsed(&rest)?;
            // Elements may be left whose headers are written in another way: then their order would be lost.
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
            self.refuse(error.span().unwrap_or(0..0), SceneProblem::Syntax(message))
        })
    }

    /// Adds the lights, spheres and triangles of a table to the scene.
    fn elements(&self, table: &SceneTable, draft: &mut Draft<'_>) -> Result<(), SceneError> {
        for light in &table.light {
            if draft.stage {
                return Err(self.refuse(light.span(), SceneProblem::Staged("[[light]]")));
            }
            let LightTable { position, camera, color } = light.get_ref();
            let color = or(color.as_ref(), DVec3::ONE, |color| self.color("color", color))?;
            let position = match (position, camera) {
                (Some(position), None) => self.point("position", position)?,
                (None, Some(camera)) => {
                    // Placed when all objects are known.
                    let at = self.point("camera", camera)?;
                    let span = self.offset + camera.span().start;
                    draft.camera_lights.push((draft.scene.lights.len(), at, span..span));
                    DVec3::ZERO
                }
                _ => return Err(self.refuse(light.span(), SceneProblem::LightPlace)),
            };
            draft.scene.lights.push(PointLight { position, color });
        }
        for sphere in &table.sphere {
            let center = self.point("center", &sphere.center)?;
            let radius = self.not_negative("radius", &sphere.radius)?;
            let look = self.material(draft, &sphere.material)?;
            draft.scene.spheres.push(Sphere::new(center, radius).expect("center and radius were checked"));
            draft.scene.sphere_looks.push(look);
        }
        table.triangle.iter().try_for_each(|triangle| self.triangle(triangle, draft))
    }

    /// The camera of the table, or the default; a scene on the stage may have none.
    fn camera(&self, table: Option<&Spanned<CameraTable>>, stage: bool) -> Result<Camera, SceneError> {
        match table {
            Some(table) if stage => return Err(self.refuse(table.span(), SceneProblem::Staged("[camera]"))),
            table if !stage && self.changes.view.is_some() => {
                return Err(self.refuse(table.map_or(0..0, Spanned::span), SceneProblem::OwnCamera));
            }
            _ => {}
        }
        let Some(table) = table else { return Ok(Camera::default()) };
        let CameraTable { eye, look_at, up, fov, fit } = table.get_ref();
        let point =
            |name, value: &Option<VectorEntry>, default| or(value.as_ref(), default, |value| self.point(name, value));
        let eye = point("eye", eye, DVec3::ZERO)?;
        let look_at = point("look_at", look_at, eye + DVec3::NEG_Z)?;
        let up = point("up", up, DVec3::Y)?;
        let degrees = fov.as_ref().map_or(90.0, |fov| fov.get_ref().0);
        let camera = Camera::new(eye, look_at, up, degrees).map_err(|error| {
            let place = fov.as_ref().filter(|_| error == CameraError::FieldOfView);
            self.refuse(place.map_or(table.span(), Spanned::span), SceneProblem::Camera(error))
        })?;
        Ok(if *fit { camera.fitted() } else { camera })
    }

    fn look(&self, name: &str, table: &Spanned<MaterialTable>) -> Result<Look, SceneError> {
        let MaterialTable { color, texture, mirrored, filter, ambient, diffuse, specular, shininess } = table.get_ref();
        let paint = match (color, texture) {
            (Some(_), Some(_)) => return Err(self.refuse(table.span(), SceneProblem::TwoPaints(name.to_owned()))),
            (None, None) => return Err(self.refuse(table.span(), SceneProblem::NoPaint(name.to_owned()))),
            (Some(color), None) => {
                let misplaced = [
                    mirrored.as_ref().map(|value| ("mirrored", value.span())),
                    filter.as_ref().map(|value| ("filter", value.span())),
                ];
                if let Some((key, span)) = misplaced.into_iter().flatten().next() {
                    return Err(self.refuse(span, SceneProblem::NoTexture(key)));
                }
                Paint::Color(self.color("color", color)?)
            }
            (None, Some(file)) => Paint::Image {
                texture: self.texture(file)?,
                mirrored: mirrored.as_ref().is_some_and(|value| *value.get_ref()),
                filter: filter.as_ref().map_or_else(Filter::default, |value| *value.get_ref()),
            },
        };
        let coefficient = |name, value: &Option<NumberEntry>, default| {
            or(value.as_ref(), default, |value| self.not_negative(name, value))
        };
        let material = Material {
            ambient: coefficient("ambient", ambient, DEFAULT_MATERIAL.ambient)?,
            diffuse: coefficient("diffuse", diffuse, DEFAULT_MATERIAL.diffuse)?,
            specular: coefficient("specular", specular, DEFAULT_MATERIAL.specular)?,
            shininess: or(shininess.as_ref(), DEFAULT_MATERIAL.shininess, |value| self.positive("shininess", value))?,
        };
        Ok(Look { paint, material })
    }

    fn texture(&self, file: &Spanned<String>) -> Result<Texture, SceneError> {
        let name = file.get_ref();
        let embedded = if let Files::Embedded = self.files { asset(name) } else { None };
        let read = match embedded {
            Some(bytes) => texture_file::decode(bytes, name),
            None => texture_file::load(&self.path(file)?),
        };
        read.map_err(|error| self.refuse(file.span(), SceneProblem::Texture(error)))
    }

    fn spheres(&self, table: &SpheresTable, draft: &mut Draft<'_>) -> Result<(), SceneError> {
        let SpheresTable { file, scale, radius, material, frame } = table;
        let look = material.as_ref().map(|material| self.material(draft, material)).transpose()?;
        let frame = match frame {
            None => 1,
            Some(frame) => {
                let found = *frame.get_ref();
                let number = u64::try_from(found).ok().filter(|&number| number > 0);
                number.ok_or_else(|| self.refuse(frame.span(), SceneProblem::Frame(found)))?
            }
        };
        let options = Options {
            frame,
            scale: or(scale.as_ref(), 1.0, |scale| self.positive("scale", scale))?,
            radius: radius.as_ref().map(|radius| self.not_negative("radius", radius)).transpose()?,
            colored: look.is_none(),
        };
        let added = load_spheres(&self.path(file)?, options);
        let added = added.and_then(|(found, name)| found.add_to(&mut draft.scene, look, &name));
        added.map_err(|error| self.refuse(file.span(), SceneProblem::Import(error)))
    }

    fn mesh(&self, MeshTable { file, material }: &MeshTable, draft: &mut Draft<'_>) -> Result<(), SceneError> {
        let look = match material {
            Some(material) => Ok(self.color_look(draft, material)?),
            None => Err(self.bare(draft, file.span())?),
        };
        let added = load_mesh(&self.path(file)?);
        let added = added.and_then(|(found, name)| found.add_to(&mut draft.scene, look, &name));
        added.map_err(|error| self.refuse(file.span(), SceneProblem::Import(error)))
    }

    fn triangle(&self, table: &Spanned<TriangleTable>, draft: &mut Draft<'_>) -> Result<(), SceneError> {
        let TriangleTable { a, b, c, material, colors } = table.get_ref();
        let [a, b, c] = [self.point("a", a)?, self.point("b", b)?, self.point("c", c)?];
        let triangle = Triangle::new(a, b, c).expect("the vertices were checked");
        if triangle.is_degenerate() {
            return Err(self.refuse(table.span(), SceneProblem::FlatTriangle));
        }
        let look = match (material, colors) {
            (Some(material), _) => self.color_look(draft, material)?,
            (None, Some(_)) => self.bare(draft, table.span())?,
            (None, None) => return Err(self.refuse(table.span(), SceneProblem::BareTriangle)),
        };
        let colors = colors.as_ref().map(|colors| {
            let Triple([a, b, c]) = colors.get_ref();
            Ok([self.color("colors", a)?, self.color("colors", b)?, self.color("colors", c)?])
        });
        draft.scene.triangles.push(triangle);
        draft.scene.triangle_looks.push(look);
        draft.scene.vertex_colors.push(colors.transpose()?);
        Ok(())
    }

    /// The look that triangles without a material share.
    fn bare(&self, draft: &mut Draft<'_>, span: Range<usize>) -> Result<LookIndex, SceneError> {
        match draft.bare {
            Some(look) => Ok(look),
            None => Ok(*draft.bare.insert(self.add_look(&mut draft.scene, Look::colored(DVec3::ONE), span)?)),
        }
    }

    /// The look of a triangle: a material without a texture.
    fn color_look(&self, draft: &Draft<'_>, material: &Spanned<String>) -> Result<LookIndex, SceneError> {
        let look = self.material(draft, material)?;
        match draft.scene.look(look) {
            Some(Look { paint: Paint::Image { .. }, .. }) => {
                Err(self.refuse(material.span(), SceneProblem::TexturedTriangle(material.get_ref().clone())))
            }
            _ => Ok(look),
        }
    }

    /// Where a file is that the scene names.
    fn path(&self, file: &Spanned<String>) -> Result<PathBuf, SceneError> {
        match self.files {
            Files::Folder(folder) => Ok(folder.join(file.get_ref())),
            Files::Embedded => Err(self.refuse(file.span(), SceneProblem::NotEmbedded(file.get_ref().clone()))),
        }
    }

    fn add_look(&self, scene: &mut Scene, look: Look, span: Range<usize>) -> Result<LookIndex, SceneError> {
        scene.add_look(look).ok_or_else(|| self.refuse(span, SceneProblem::TooManyLooks))
    }

    fn material(&self, draft: &Draft<'_>, name: &Spanned<String>) -> Result<LookIndex, SceneError> {
        draft.materials.get(name.get_ref().as_str()).copied().ok_or_else(|| {
            let names = || draft.materials.keys().copied();
            let known = match (names().len(), meant(name.get_ref(), names())) {
                (0, _) => "no material is".to_owned(),
                (_, Some(meant)) => format!("did you mean {}?", quoted(meant)),
                _ => format!("there is {}", listed(names())),
            };
            self.refuse(name.span(), SceneProblem::UnknownMaterial { name: name.get_ref().clone(), known })
        })
    }

    fn not_negative(&self, name: &'static str, value: &NumberEntry) -> Result<f64, SceneError> {
        let AnyNumber(found) = *value.get_ref();
        if !found.is_finite() {
            return Err(self.refuse(value.span(), SceneProblem::NotFinite { name, found: found.to_string() }));
        }
        if found < 0.0 {
            return Err(self.refuse(value.span(), SceneProblem::Negative { name, found }));
        }
        Ok(found)
    }

    fn positive(&self, name: &'static str, value: &NumberEntry) -> Result<f64, SceneError> {
        let found = self.not_negative(name, value)?;
        if found == 0.0 {
            return Err(self.refuse(value.span(), SceneProblem::NotPositive { name, found }));
        }
        Ok(found)
    }

    fn point(&self, name: &'static str, value: &VectorEntry) -> Result<DVec3, SceneError> {
        let found = value.get_ref().vector();
        if !found.is_finite() {
            return Err(self.refuse(value.span(), SceneProblem::NotFinite { name, found: found.to_string() }));
        }
        Ok(found)
    }

    fn color(&self, name: &'static str, value: &VectorEntry) -> Result<DVec3, SceneError> {
        let found = value.get_ref().vector();
        // Written so that NaN fails it.
        if !found.to_array().iter().all(|channel| (0.0..=1.0).contains(channel)) {
            return Err(self.refuse(value.span(), SceneProblem::NoColor { name, found: found.to_string() }));
        }
        Ok(found)
    }

    /// The error `problem` at the start of `span`; lines and columns count from 1, columns in characters.
    fn refuse(&self, span: Range<usize>, problem: SceneProblem) -> SceneError {
        let end = self.offset + span.start;
        let before = self.text.char_indices().take_while(|(at, c)| at + c.len_utf8() <= end);
        let (line, column) = before.fold((1, 1), |(line, column), (_, c)| match c {
            '\n' => (line + 1, 1),
            _ => (line, column + 1),
        });
        SceneError { place: format!("{}:{line}:{column}", self.name), problem: Box::new(problem) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a text becomes if it is parsed as a whole, and if each element is parsed by itself.
    fn both(text: &str) -> [Result<String, String>; 2] {
        [usize::MAX, 1].map(|group| {
            let checker =
                Checker { text, name: "a.toml", files: Files::Embedded, offset: 0, changes: &Changes::default() };
            checker.scene(group).map(|scene| format!("{scene:?}")).map_err(|error| format!("{error} {error:?}"))
        })
    }

    #[test]
    fn a_scene_in_parts_is_the_whole_scene() {
        for figure in crate::assets::FIGURE_SCENES {
            let [whole, parts] = both(figure);
            assert!(whole.is_ok() && whole == parts, "{figure}: {whole:?} {parts:?}");
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

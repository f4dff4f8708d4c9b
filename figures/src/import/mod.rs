//! Objects from other programs' files: spheres from XYZ, meshes from OBJ.

mod elements;
mod foreign;
pub mod obj;
mod polygon;
mod problem;
mod words;
pub mod xyz;

use std::path::Path;

use glam::DVec3;

use crate::scene::{Look, Scene};
use crate::text::file_name;
use problem::FileProblem;
pub use problem::ImportError;
pub(crate) use words::{decimal, shown};

/// Reads a bulk file into a scene with a camera, lights and colours of its own; `None` if `path` is that of a scene
/// file.
///
/// Files of spheres end in `.xyz` or `.extxyz`, meshes in `.obj`. Scene files end in `.toml`; a path without an ending
/// that is not a regular file, such as a pipe, counts as one too.
///
/// # Errors
/// What is wrong with the file, or what else it is.
pub fn load(path: &Path) -> Option<Result<Scene, ImportError>> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("").to_ascii_lowercase();
    match ending.as_str() {
        "toml" => return None,
        "xyz" | "extxyz" => return Some(spheres(path)),
        "obj" => return Some(mesh(path)),
        _ => {}
    }
    // The scene reader has the errors for what is not a plain file.
    let plain = path.metadata().is_ok_and(|found| found.is_file());
    (plain || (path.exists() && !ending.is_empty())).then(|| Err(foreign::refused(path)))
}

fn spheres(path: &Path) -> Result<Scene, ImportError> {
    let mut scene = Scene::default();
    xyz::load(path, xyz::Options::default())?.add_to(&mut scene, None, path)?;
    if scene.is_empty() {
        return Err(FileProblem::NoSpheres(file_name(path)).into());
    }
    scene.set_stage();
    Ok(scene)
}

fn mesh(path: &Path) -> Result<Scene, ImportError> {
    let mut scene = Scene::default();
    let clay = scene.add_look(Look::colored(DVec3::new(0.8, 0.78, 0.74))).expect("the first look of a scene");
    obj::load(path)?.add_to(&mut scene, clay, path);
    scene.set_stage();
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_refused_by_their_own_names() {
        let folder = oracle::files::folder();
        let path = |name: &str| folder.path().join(name);
        let refusal = |name: &str, content: &[u8]| {
            std::fs::write(path(name), content).unwrap();
            let error = load(&path(name)).expect("it is no scene file").unwrap_err().to_string();
            let error = error.strip_prefix(path(name).to_str().unwrap()).unwrap().to_owned();
            let remedy = "; a scene is a .toml file, a file of spheres .xyz or .extxyz, a mesh .obj";
            error.strip_suffix(remedy).map(|told| told[2..].to_owned()).unwrap_or(error)
        };
        let by_name = [
            ("a.pdb", "PDB"),
            ("a.cif", "mmCIF"),
            ("a.LMP", "LAMMPS data"),
            ("a.stl", "STL"),
            ("a.ply", "PLY"),
            ("a.gltf", "glTF"),
            ("a.xyz.gz", "a compressed file"),
        ];
        for (name, format) in by_name {
            assert_eq!(refusal(name, b"text"), format!("{format} is not read"), "{name}");
        }
        let by_content: [(&[u8], &str); 7] = [
            (b"HEADER    HYDROLASE\n", "PDB"),
            (b"data_1HPV\n#\n", "CIF"),
            (b"ply\nformat ascii 1.0\n", "PLY"),
            (b"solid a\nfacet normal 0 0 1\n", "STL"),
            (b"\x1f\x8b\x08", "gzip data"),
            (b"\x89PNG\r\n", "a PNG image"),
            (b"glTF\x02\0\0\0", "glTF"),
        ];
        for (content, format) in by_content {
            assert_eq!(refusal("molecule", content), format!("{format} is not read"));
            for name in ["a.xyz", "a.obj"] {
                assert_eq!(refusal(name, content), format!("it holds {format}, which is not read"), "{name}");
            }
        }
        assert_eq!(refusal("molecule", b"text"), "its name has no ending that says what it is");
        assert_eq!(refusal("a.scene", b"text"), "files that end in .scene are not read");
        assert!(load(&path("a.toml")).is_none());
        // A missing file is an error of the scene reader.
        assert!(load(&path("nothing")).is_none() && load(folder.path()).is_none());
    }

    #[test]
    fn what_a_mesh_leaves_out_is_told_once_each() {
        let folder = oracle::files::folder();
        let path = folder.path().join("bell\u{7}.obj");
        let text = "v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 1 0\nvn 0 0 1\nusemtl red\nf 1 2 3 4\nf 1 1 2\nf 1 2 3\n";
        std::fs::write(&path, text).unwrap();
        let warnings = mesh(&path).unwrap().warnings;
        let told: Vec<&str> =
            warnings.iter().map(|text| text.split_once(r"bell\u{7}.obj: ").expect("an escaped name").1).collect();
        assert_eq!(
            told,
            [
                "left out 1 triangle without area",
                "1 face crosses itself; the triangles of such a face may overlap",
                "passed over: materials (mtllib, usemtl), normals (vn)",
            ]
        );
    }
}

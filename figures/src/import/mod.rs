//! Objects from other programs' files: spheres from XYZ and PDB, meshes from OBJ, PLY and STL, packed with gzip or not.
//!
//! A file is known by the ending of its name, without that of gzip, or by its content where the ending says nothing.

mod blocks;
mod elements;
pub(crate) mod foreign;
pub mod mesh;
pub mod mtl;
pub mod obj;
pub mod pdb;
pub mod ply;
mod polygon;
mod problem;
pub(crate) mod source;
pub mod spheres;
pub mod stl;
mod words;
pub mod xyz;

use std::path::Path;

use glam::DVec3;

use crate::scene::{Look, Scene};
use foreign::Format;
use mesh::Mesh;
use problem::FileProblem;
pub use problem::ImportError;
use source::Source;
use spheres::{Options, Spheres};
pub(crate) use words::{decimal, shown};

/// Reads the file of spheres at `path`, and returns what messages call it.
///
/// # Errors
/// What is wrong with the file, or what else it is.
pub fn load_spheres(path: &Path, options: Options) -> Result<(Spheres, String), ImportError> {
    let mut source = Source::open(path)?;
    match source.format()? {
        format @ (Format::Xyz | Format::Pdb) => Ok((spheres(&mut source, format, options)?, source.name)),
        format => Err(source.misplaced(format, "spheres, in XYZ or PDB")),
    }
}

/// Reads the mesh at `path`, and returns what messages call it.
///
/// # Errors
/// What is wrong with the file, or what else it is.
pub fn load_mesh(path: &Path) -> Result<(Mesh, String), ImportError> {
    let mut source = Source::open(path)?;
    match source.format()? {
        format @ (Format::Obj | Format::Ply | Format::Stl) => Ok((mesh(&mut source, format)?, source.name)),
        format => Err(source.misplaced(format, "a mesh, in OBJ, PLY or STL")),
    }
}

/// Reads the objects of a bulk file into a scene with nothing else; `None` if it is a scene file.
pub(crate) fn objects(source: &mut Source, frame: Option<u64>) -> Option<Result<Scene, ImportError>> {
    let read = |source: &mut Source| {
        let mut scene = Scene::default();
        match source.format()? {
            Format::Scene => return Ok(None),
            format @ (Format::Xyz | Format::Pdb) => {
                let options = Options { frame: frame.unwrap_or(1), ..Options::default() };
                spheres(source, format, options)?.add_to(&mut scene, None, &source.name)?;
            }
            format => {
                if frame.is_some() {
                    return Err(source.misplaced(format, "spheres: a mesh has no frames (--frame)"));
                }
                let clay = Look::colored(DVec3::new(0.8, 0.78, 0.74));
                let clay = scene.add_look(clay).expect("the first look of a scene");
                mesh(source, format)?.add_to(&mut scene, Err(clay), &source.name)?;
            }
        }
        if scene.is_empty() {
            return Err(FileProblem::NoSpheres(source.name.clone()).into());
        }
        Ok(Some(scene))
    };
    read(source).transpose()
}

fn spheres(source: &mut Source, format: Format, options: Options) -> Result<Spheres, ImportError> {
    let (reader, name) = (source.reader(), &source.name);
    let found = match format {
        Format::Pdb => pdb::read(reader, name, options),
        _ => xyz::read(reader, source.length, name, options),
    };
    found.map_err(|error| source.explained(error, format))
}

fn mesh(source: &mut Source, format: Format) -> Result<Mesh, ImportError> {
    let (reader, name) = (source.reader(), &source.name);
    let found = match format {
        Format::Ply => ply::read(reader, name),
        Format::Stl => stl::read(reader, name),
        _ => obj::read(reader, name, source.folder()),
    };
    found.map_err(|error| source.explained(error, format))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The scene of a file with this content, or its error without the file's name and the list of formats.
    fn loaded(name: &str, content: &[u8]) -> Result<Scene, String> {
        let folder = oracle::files::folder();
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        let scene = Source::open(&path).and_then(|mut source| objects(&mut source, None).expect("no scene file"));
        scene.map_err(|error| {
            let error = error.to_string();
            let error = error.strip_prefix(path.to_str().unwrap()).unwrap()[2..].to_owned();
            let remedy = "; read are .toml (a scene), .xyz and .pdb (spheres), .obj, .ply and .stl (meshes)";
            error.strip_suffix(remedy).map(str::to_owned).unwrap_or(error)
        })
    }

    #[test]
    fn other_formats_are_refused_by_their_own_names() {
        let refusal = |name: &str, content: &[u8]| loaded(name, content).unwrap_err();
        let by_name = [
            ("a.pdbqt", "PDBQT or PQR"),
            ("a.cif", "mmCIF"),
            ("a.LMP", "LAMMPS data"),
            ("a.gltf", "glTF"),
            ("a.cif.gz", "mmCIF"),
            ("a.xyz.bz2", "a compressed file"),
        ];
        for (name, format) in by_name {
            let content = if name.ends_with("gz") { packed(b"text") } else { b"text".to_vec() };
            assert_eq!(refusal(name, &content), format!("{format} is not read"), "{name}");
        }
        let by_content: [(&[u8], &str); 4] = [
            (b"data_1HPV\n#\n", "CIF"),
            (b"\x89PNG\r\n", "a PNG image"),
            (b"glTF\x02\0\0\0", "glTF"),
            (b"a\0b", "binary data"),
        ];
        for (content, format) in by_content {
            assert_eq!(refusal("molecule", content), format!("{format} is not read"));
            for name in ["a.xyz", "a.obj", "a.ply", "a.stl.gz"] {
                let content = if name.ends_with("gz") { packed(content) } else { content.to_vec() };
                assert_eq!(refusal(name, &content), format!("it holds {format}, which is not read"), "{name}");
            }
        }
        assert_eq!(refusal("a.xyz", b"ply\nformat"), "it holds PLY; its name must end in .ply");
        assert_eq!(refusal("molecule", b"text"), "neither the ending of its name nor how it begins says what it is");
        assert_eq!(refusal("a.scene", b"text"), "files that end in .scene are not read");
    }

    /// The bytes, packed with gzip.
    fn packed(bytes: &[u8]) -> Vec<u8> {
        use std::io::Write;
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn a_file_is_known_by_its_ending_or_its_content_packed_or_not() {
        let pdb = format!("{:30}{:8.3}{:8.3}{:8.3}{:22} C\n", "ATOM      1  CA  GLY A   1", 1.0, 2.0, 3.0, "");
        let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\n\
                   element face 1\nproperty list int int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        let mut binary = b"head".to_vec();
        binary.resize(80, 0);
        binary.extend(1_u32.to_le_bytes());
        binary.extend(
            [0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).as_flattened(),
        );
        binary.extend([0; 2]);
        let stl = "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
        let files: [(&str, &[u8]); 6] = [
            ("xyz", b"1\n\nC 1 2 3\n"),
            ("pdb", pdb.as_bytes()),
            ("obj", b"# a mesh\no it\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
            ("ply", ply.as_bytes()),
            ("stl", stl.as_bytes()),
            ("STL", &binary),
        ];
        for (ending, content) in files {
            for name in [format!("a.{ending}"), format!("a.{ending}.gz"), "a".to_owned(), "a.data".to_owned()] {
                for content in [content.to_vec(), packed(content)] {
                    assert_eq!(loaded(&name, &content).unwrap().len(), 1, "{name} {content:?}");
                }
            }
        }
        let folder = oracle::files::folder();
        for (name, content) in [("a.toml", ""), ("a", "# it\n[camera]\n"), ("b", "stage = true\n")] {
            std::fs::write(folder.path().join(name), content).unwrap();
            let mut source = Source::open(&folder.path().join(name)).unwrap();
            assert!(objects(&mut source, None).is_none(), "{name}");
        }
        // A little that unpacks to much: 300 members of a megabyte of remarks each.
        let remarks =
            "REMARK and so on, as far as a line goes in such a file, which is eighty columns.\n".repeat(12_500);
        let path = folder.path().join("much.pdb.gz");
        std::fs::write(&path, packed(remarks.as_bytes()).repeat(300)).unwrap();
        let error = oracle::files::full_message(&load_spheres(&path, Options::default()).unwrap_err());
        assert!(error.ends_with("it unpacks to more than 256 MiB; unpack it first"), "{error}");
        // Cut short or spoiled, a packed file is an error of reading.
        let whole = packed(b"1\n\nC 1 2 3\n");
        for bad in [&whole[..whole.len() - 6], &[&whole[..], b"more"].concat()[..], &whole[..12]] {
            let path = folder.path().join("bad.xyz.gz");
            std::fs::write(&path, bad).unwrap();
            let error = load_spheres(&path, Options::default()).unwrap_err().to_string();
            assert_eq!(error, format!("cannot read {}", path.display()));
        }
    }

    #[test]
    fn what_a_mesh_leaves_out_is_told_once_each() {
        let text = "v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 1 0\nvn 0 0 1\nusemtl red\nf 1 2 3 4\nf 1 1 2\nf 1 2 3\n";
        let warnings = loaded("bell\u{7}.obj", text.as_bytes()).unwrap().warnings;
        let told: Vec<&str> =
            warnings.iter().map(|text| text.split_once(r"bell\u{7}.obj: ").expect("an escaped name").1).collect();
        assert_eq!(
            told,
            [
                "left out 1 triangle without area",
                "1 face crosses itself; the triangles of such a face may overlap",
                "passed over: normals (vn)",
                "no color is known of material \"red\"",
            ]
        );
    }

    #[test]
    fn faces_have_the_colors_of_their_materials() {
        let folder = oracle::files::folder();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("my paint.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
        std::fs::write(path("more.mtl"), "newmtl green\nKd 0 1 0\n").unwrap();
        let text = "mtllib my paint.mtl\nmtllib more.mtl none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n\
                    usemtl green\nf 1 2 4 3\nusemtl red\nf 2 3 4\nusemtl blue\nf 1 2 3\nusemtl green\nf 1 2 3\n";
        std::fs::write(path("a.obj"), text).unwrap();
        let (mesh, name) = load_mesh(&path("a.obj")).unwrap();
        let mut scene = Scene::default();
        let looks = [DVec3::ZERO, DVec3::ONE].map(|color| scene.add_look(Look::colored(color)).unwrap());
        mesh.add_to(&mut scene, Err(looks[1]), &name).unwrap();
        let color = |&look| match scene.look(look).unwrap().paint {
            crate::scene::Paint::Color(color) => color,
            crate::scene::Paint::Image { .. } => DVec3::NAN,
        };
        let colors: Vec<DVec3> = scene.triangle_looks.iter().map(color).collect();
        assert_eq!(colors, [DVec3::ONE, DVec3::Y, DVec3::Y, DVec3::X, DVec3::ONE, DVec3::Y]);
        let warnings = scene.warnings.join("\n");
        assert!(warnings.contains("none.mtl\" are passed over: there is no such file"), "{warnings}");
        assert!(warnings.contains("no color is known of material \"blue\"") && scene.warnings.len() == 2, "{warnings}");
        // One look for all of it.
        let mut scene = Scene::default();
        let look = scene.add_look(Look::colored(DVec3::ZERO)).unwrap();
        load_mesh(&path("a.obj")).unwrap().0.add_to(&mut scene, Ok(look), &name).unwrap();
        assert_eq!(scene.triangle_looks, [look; 6]);
    }
}

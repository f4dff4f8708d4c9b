//! Objects from other programs' files: spheres from XYZ, meshes from OBJ.

mod elements;
mod foreign;
pub mod obj;
mod polygon;
pub mod xyz;

use std::path::Path;

use crate::scene::{Look, Scene, TooManyColors};
use crate::text::file_name;
pub use foreign::Foreign;
use glam::DVec3;

/// Why a bulk file cannot be read.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum ImportError {
    /// A file of spheres.
    Xyz(#[from] xyz::XyzError),
    /// A mesh.
    Obj(#[from] obj::ObjError),
    /// A file of spheres with more colours than can be numbered.
    Colors(#[from] TooManyColors),
    /// A file of spheres without a sphere.
    #[error("{0}: no objects")]
    Empty(String),
    /// A file in another format.
    Foreign(#[from] Foreign),
}

/// Reads a bulk file into a scene with a camera, lights and colours of its own; `None` if `path` is that of a scene file.
///
/// Files of spheres end in `.xyz` or `.extxyz`, meshes in `.obj`. Scene files end in `.toml`; what is no plain file and has no
/// ending, as a pipe, is taken for one too.
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
    // What is no plain file, the scene's reader tells.
    let plain = path.metadata().is_ok_and(|found| found.is_file());
    (plain || (path.exists() && !ending.is_empty())).then(|| Err(Foreign::refused(path).into()))
}

fn spheres(path: &Path) -> Result<Scene, ImportError> {
    let mut scene = Scene::empty();
    scene.add_spheres(xyz::load(path, xyz::Options::default())?, None, path)?;
    if scene.is_empty() {
        return Err(ImportError::Empty(file_name(path)));
    }
    scene.set_stage();
    Ok(scene)
}

fn mesh(path: &Path) -> Result<Scene, ImportError> {
    let mut scene = Scene::empty();
    scene.looks.push(Look::colored(DVec3::new(0.8, 0.78, 0.74)));
    scene.add_mesh(obj::load(path)?, 0, path);
    scene.set_stage();
    Ok(scene)
}

/// The words of a line. (What `split` and `filter` give too, in half the time.)
struct Words<'a>(&'a [u8]);

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    #[inline]
    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.0.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = &self.0[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.0 = rest;
        Some(word)
    }
}

/// Reads a number, rounded once to the nearest double; what is none is given back for a message.
fn number(word: &[u8]) -> Result<f64, String> {
    short_decimal(word)
        .or_else(|| std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()))
        .ok_or_else(|| shown(word))
}

/// Reads a number of at most 15 digits without an exponent, as nearly all are in files of spheres and meshes.
///
/// Its digits are a whole number below 2^53 and its scale a power of ten up to 10^15: both are doubles, so their
/// quotient is the only rounding. Source: W. D. Clinger, "How to Read Floating Point Numbers Accurately", 1990.
#[inline]
fn short_decimal(word: &[u8]) -> Option<f64> {
    const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.len() > 16 {
        return None;
    }
    let (mut whole, mut point) = (0_u64, None);
    for (at, &byte) in digits.iter().enumerate() {
        match byte {
            b'0'..=b'9' => whole = 10 * whole + u64::from(byte - b'0'),
            b'.' if point.is_none() => point = Some(at),
            _ => return None,
        }
    }
    let count = digits.len() - usize::from(point.is_some());
    if !(1..=15).contains(&count) {
        return None;
    }
    let behind = point.map_or(0, |point| digits.len() - 1 - point);
    let value = whole as f64 / POWERS[behind];
    Some(if negative { -value } else { value })
}

/// What was found, for a message: cut where it is long.
fn shown(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    let text = text.trim();
    match text.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_decimal_is_the_nearest_double() {
        let mut bits = 7_u64;
        let mut next = |below: u32| {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            usize::try_from((bits >> 33) % u64::from(below)).unwrap()
        };
        let mut short = 0;
        for _ in 0..100_000 {
            let mut word = ["", "-", "+"][next(3)].to_owned();
            let (digits, point) = (1 + next(17), next(20));
            for at in 0..digits {
                if at == point {
                    word.push('.');
                }
                word.push(char::from(b"0123456789"[next(10)]));
            }
            let expected: f64 = word.parse().unwrap();
            assert_eq!(number(word.as_bytes()).unwrap().to_bits(), expected.to_bits(), "{word}");
            short += usize::from(short_decimal(word.as_bytes()).is_some());
        }
        assert!((80_000..100_000).contains(&short), "{short}");
    }

    #[test]
    fn other_formats_are_refused_by_their_own_names() {
        let folder = tempfile::tempdir().unwrap();
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
        // What is not there is told by whoever reads scenes.
        assert!(load(&path("nothing")).is_none() && load(folder.path()).is_none());
    }

    #[test]
    fn what_a_mesh_leaves_out_is_told_once_each() {
        let folder = tempfile::tempdir().unwrap();
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

    #[test]
    fn what_is_no_short_decimal_is_left_to_the_library() {
        for word in ["", "-", "+", ".", "-.", "1e3", "1..2", "1.2.3", "--1", "0x1", "1,5", "nan", "inf", "\u{b2}"] {
            assert_eq!(short_decimal(word.as_bytes()), None, "{word}");
            assert_eq!(number(word.as_bytes()).is_ok(), word.parse::<f64>().is_ok(), "{word}");
        }
        for (word, value) in [("-0", -0.0_f64), ("5.", 5.0), (".5", 0.5), ("999999999999999", 999_999_999_999_999.0)] {
            assert_eq!(short_decimal(word.as_bytes()).map(f64::to_bits), Some(value.to_bits()), "{word}");
        }
    }
}

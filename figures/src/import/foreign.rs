//! Files in formats that are not read, known by how they begin or by the ending of their name, so that they are refused
//! by their own name and not as broken TOML.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::problem::{FileProblem, ImportError};
use crate::text::file_name;

/// Refuses a file that cannot be read by its ending: by what it holds, else by the ending, else for having none.
pub(super) fn refused(path: &Path) -> ImportError {
    let ending = ending(path);
    let what = match (known(path), ending.as_str()) {
        (Some(format), _) => format!("{format} is not read"),
        (None, "") => "its name has no ending that says what it is".to_owned(),
        (None, ending) => format!("files that end in .{ending} are not read"),
    };
    FileProblem::Foreign { path: file_name(path), what }.into()
}

/// Returns the error of a reader that has failed on the file at `path` or, if the file begins as another format does,
/// one that names this format.
pub(super) fn explained(error: ImportError, path: &Path) -> ImportError {
    if !error.is_of_content() {
        return error;
    }
    match start(path).and_then(|start| begins_as(&start)) {
        None => error,
        Some(format) => {
            let what = format!("it holds {format}, which is not read");
            FileProblem::Foreign { path: file_name(path), what }.into()
        }
    }
}

/// The ending of a file's name in lower case; empty if it is long or has other characters than letters and digits.
fn ending(path: &Path) -> String {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("");
    let harmless = ending.len() <= 12 && ending.chars().all(|c| c.is_ascii_alphanumeric());
    if harmless { ending.to_ascii_lowercase() } else { String::new() }
}

/// The format of a file, by what it holds or by its name.
fn known(path: &Path) -> Option<&'static str> {
    let ending = ending(path);
    let by_ending = || {
        let format = ENDINGS.iter().find(|(_, endings)| endings.contains(&ending.as_str()));
        format.map(|(format, _)| *format)
    };
    start(path).and_then(|start| begins_as(&start)).or_else(by_ending)
}

/// The first bytes of a plain file; not of a pipe, which can be read only once.
fn start(path: &Path) -> Option<Vec<u8>> {
    if !path.metadata().ok()?.is_file() {
        return None;
    }
    let mut start = Vec::new();
    File::open(path).ok()?.take(1024).read_to_end(&mut start).ok()?;
    Some(start)
}

/// The format that starts with these bytes.
fn begins_as(start: &[u8]) -> Option<&'static str> {
    let magic = MAGIC.iter().find(|(magic, _)| start.starts_with(magic));
    if let Some((_, format)) = magic {
        return Some(format);
    }
    let text = String::from_utf8_lossy(start);
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text.lines().map(str::trim_end);
    let (first, second) = (lines.next().unwrap_or(""), lines.next().unwrap_or(""));
    let fourth = lines.nth(1).unwrap_or("");
    let word = first.split_whitespace().next().unwrap_or("");
    match word {
        "ply" => return Some("PLY"),
        "solid" if second.trim_start().starts_with("facet") || second.trim_start().starts_with("endsolid") => {
            return Some("STL");
        }
        "HEADER" | "REMARK" | "CRYST1" | "COMPND" | "HETATM" | "ATOM" | "MODEL" | "TITLE" | "AUTHOR"
            if first.len() > word.len() && !first.contains('=') =>
        {
            return Some("PDB");
        }
        "OFF" | "COFF" | "NOFF" if first == word => return Some("OFF"),
        _ if word.starts_with("data_") && word.len() > 5 => return Some("CIF"),
        "ITEM:" => return Some("a LAMMPS dump"),
        _ if first.contains("LAMMPS") && !first.starts_with('#') => return Some("LAMMPS data"),
        _ if first.starts_with("@<TRIPOS>") => return Some("MOL2"),
        _ if fourth.ends_with("V2000") || fourth.ends_with("V3000") => return Some("MOL or SDF"),
        "<?xml" | "<svg" | "<html" | "<!DOCTYPE" => return Some("XML or HTML"),
        _ if first == "{" || first.starts_with("{\"") => return Some("JSON (as glTF is)"),
        _ => {}
    }
    // A binary STL has no magic number: 80 bytes of any kind, a count, and 50 bytes for each triangle.
    let binary = start.len() > 84 && start[..84].contains(&0);
    binary.then_some("binary data")
}

/// Formats with a known beginning.
const MAGIC: [(&[u8], &str); 21] = [
    (b"\x1f\x8b", "gzip data"),
    (b"BZh", "bzip2 data"),
    (b"\xfd7zXZ", "xz data"),
    (b"\x28\xb5\x2f\xfd", "Zstandard data"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"7z\xbc\xaf", "a 7z archive"),
    (b"glTF", "glTF"),
    (b"\x89PNG", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"II*\0", "a TIFF image"),
    (b"MM\0*", "a TIFF image"),
    (b"P3\n", "a PPM image"),
    (b"P6\n", "a PPM image"),
    (b"%PDF", "PDF"),
    (b"\x7fELF", "a program"),
    (b"CDF\x01", "NetCDF"),
    (b"CDF\x02", "NetCDF"),
    (b"\x89HDF", "HDF5"),
    (b"Kaydara FBX", "FBX"),
    (b"BLENDER", "a Blender scene"),
];

/// Formats with a known ending.
const ENDINGS: [(&str, &[&str]); 24] = [
    ("PDB", &["pdb", "ent", "pdbqt", "pqr"]),
    ("mmCIF", &["cif", "mmcif", "mcif", "bcif"]),
    ("a LAMMPS dump", &["lammpstrj", "dump"]),
    ("LAMMPS data", &["lmp", "lammps", "lmpdat"]),
    ("STL", &["stl"]),
    ("PLY", &["ply"]),
    ("glTF", &["gltf", "glb"]),
    ("OFF", &["off"]),
    ("MOL or SDF", &["mol", "sdf", "sd"]),
    ("MOL2", &["mol2"]),
    ("GRO", &["gro"]),
    ("Gaussian cube", &["cube", "cub"]),
    ("VASP", &["vasp", "poscar", "contcar"]),
    ("a trajectory", &["xtc", "trr", "dcd", "nc", "traj"]),
    ("COLLADA", &["dae"]),
    ("FBX", &["fbx"]),
    ("3DS", &["3ds"]),
    ("a Blender scene", &["blend"]),
    ("USD", &["usd", "usda", "usdc", "usdz"]),
    ("STEP or IGES", &["step", "stp", "iges", "igs"]),
    ("an OBJ material library", &["mtl"]),
    ("JSON", &["json"]),
    ("YAML", &["yaml", "yml"]),
    ("a compressed file", &["gz", "bz2", "xz", "zst", "zip", "7z", "z", "lz4"]),
];

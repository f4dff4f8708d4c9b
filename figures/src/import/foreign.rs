//! The format of a file, by its first bytes or by the ending of its name. So a format that is read is recognised without
//! an ending, and one that is not read is refused by its own name and not as broken TOML.

use std::path::Path;

use super::stl;

/// A format that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    /// A scene, in TOML.
    Scene,
    /// Spheres.
    Xyz,
    Pdb,
    /// Meshes.
    Obj,
    Ply,
    Stl,
}

impl Format {
    /// The name of the format, and the endings of its files.
    pub(super) const ALL: [(Self, &'static str, &'static [&'static str]); 6] = [
        (Self::Scene, "a scene", &["toml"]),
        (Self::Xyz, "XYZ", &["xyz", "extxyz"]),
        (Self::Pdb, "PDB", &["pdb", "ent"]),
        (Self::Obj, "OBJ", &["obj"]),
        (Self::Ply, "PLY", &["ply"]),
        (Self::Stl, "STL", &["stl"]),
    ];

    /// The format that an ending, in lower case, stands for.
    pub(crate) fn of_ending(ending: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, _, endings)| endings.contains(&ending)).map(|(format, ..)| *format)
    }

    pub(super) fn name(self) -> (&'static str, &'static str) {
        let found = Self::ALL.iter().find(|(format, ..)| *format == self);
        found.map_or(("", ""), |(_, name, endings)| (name, endings[0]))
    }
}

/// What a file is, by how it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    /// A format that is read.
    Read(Format),
    /// The name of another.
    Foreign(&'static str),
}

/// The ending of a file's name in lower case; empty if it is long or has other characters than letters and digits.
pub(super) fn ending(path: &Path) -> String {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("");
    let harmless = ending.len() <= 12 && ending.chars().all(|c| c.is_ascii_alphanumeric());
    if harmless { ending.to_ascii_lowercase() } else { String::new() }
}

/// The format, not read, of files with such an ending.
pub(super) fn of_ending(ending: &str) -> Option<&'static str> {
    ENDINGS.iter().find(|(_, endings)| endings.contains(&ending)).map(|(format, _)| *format)
}

/// The format that starts with these bytes.
pub(super) fn begins_as(start: &[u8]) -> Option<Known> {
    let magic = MAGIC.iter().find(|(magic, _)| start.starts_with(magic));
    if let Some((_, format)) = magic {
        return Some(Known::Foreign(format));
    }
    // Text may be cut within a line.
    let text = String::from_utf8_lossy(start);
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = text.lines().map(str::trim_end);
    let (first, third) = (lines.next().unwrap_or(""), lines.nth(1).unwrap_or(""));
    let fourth = lines.next().unwrap_or("");
    let word = first.split_whitespace().next().unwrap_or("");
    match word {
        "ply" if first == word => return Some(Known::Read(Format::Ply)),
        "HEADER" | "REMARK" | "CRYST1" | "COMPND" | "HETATM" | "ATOM" | "MODEL" | "TITLE" | "AUTHOR"
            if first.len() > word.len() && !first.contains('=') =>
        {
            return Some(Known::Read(Format::Pdb));
        }
        "OFF" | "COFF" | "NOFF" if first == word => return Some(Known::Foreign("OFF")),
        _ if word.starts_with("data_") && word.len() > 5 => return Some(Known::Foreign("CIF")),
        "ITEM:" => return Some(Known::Foreign("a LAMMPS dump")),
        _ if first.contains("LAMMPS") && !first.starts_with('#') => return Some(Known::Foreign("LAMMPS data")),
        _ if first.starts_with("@<TRIPOS>") => return Some(Known::Foreign("MOL2")),
        _ if fourth.ends_with("V2000") || fourth.ends_with("V3000") => return Some(Known::Foreign("MOL or SDF")),
        "<?xml" | "<svg" | "<html" | "<!DOCTYPE" => return Some(Known::Foreign("XML or HTML")),
        _ if first == "{" || first.starts_with("{\"") => return Some(Known::Foreign("JSON (as glTF is)")),
        _ => {}
    }
    let (head, more) = start.split_at(start.len().min(84));
    if stl::is_text(head, more) && !first.contains('=') {
        return Some(Known::Read(Format::Stl));
    }
    if start.contains(&0) {
        let stl = stl::can_be_binary(start);
        return Some(if stl { Known::Read(Format::Stl) } else { Known::Foreign("binary data") });
    }
    // A count, a comment, and a line that begins with a word and three numbers.
    let mut words = third.split_whitespace().skip(1);
    if first.trim().parse::<u64>().is_ok()
        && words.by_ref().take(3).filter(|word| word.parse::<f64>().is_ok()).count() == 3
    {
        return Some(Known::Read(Format::Xyz));
    }
    // Of the first lines that have a keyword each is one of a mesh's, or of a scene's.
    let keywords = text.lines().filter_map(|line| line.split_whitespace().next()).filter(|word| !word.starts_with('#'));
    let mut keywords = keywords.take(4).peekable();
    keywords.peek()?;
    if keywords.all(|word| ["v", "vn", "vt", "o", "g", "s", "mtllib", "usemtl", "f"].contains(&word)) {
        return Some(Known::Read(Format::Obj));
    }
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let is_scene = lines.next().is_some_and(|line| line.starts_with('[') || line.contains('='));
    is_scene.then_some(Known::Read(Format::Scene))
}

/// Formats with a known beginning.
const MAGIC: [(&[u8], &str); 20] = [
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
const ENDINGS: [(&str, &[&str]); 22] = [
    ("PDBQT or PQR", &["pdbqt", "pqr"]),
    ("mmCIF", &["cif", "mmcif", "mcif", "bcif"]),
    ("a LAMMPS dump", &["lammpstrj", "dump"]),
    ("LAMMPS data", &["lmp", "lammps", "lmpdat"]),
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
    ("a compressed file", &["bz2", "xz", "zst", "zip", "7z", "z", "lz4"]),
];

//! The diffuse colours of Wavefront material libraries (MTL): `newmtl NAME`, then `Kd r g b`.
//!
//! A library only adds colour to a mesh, so what is wrong with one is a warning, and the mesh is drawn without it.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::problem::LONGEST_LINE;
use super::words::{Words, number, rest};
use crate::text::{file_name, quoted};

/// More of a library is not read.
const MAX_BYTES: u64 = 64 << 20;

/// The materials of some libraries.
#[derive(Debug, Default)]
pub struct Library {
    /// The diffuse colour of each material that has one, each channel in `0..=1`.
    pub colors: HashMap<Vec<u8>, DVec3>,
    /// Whether an image is to colour a material, which is passed over.
    pub has_maps: bool,
}

impl Library {
    /// Adds the libraries that an OBJ file in `folder` names: one, whose name may have spaces, or several.
    pub(super) fn add(&mut self, names: &[u8], folder: &Path, notes: &mut Vec<String>) {
        let path = |name: &[u8]| -> PathBuf { folder.join(String::from_utf8_lossy(name).replace('\\', "/")) };
        let whole = path(names);
        // A pipe or a device would not end.
        let paths = if whole.is_file() { vec![whole] } else { Words(names).map(path).collect() };
        for path in paths {
            let read = if path.is_file() {
                File::open(&path).and_then(|file| self.read(BufReader::new(file.take(MAX_BYTES))))
            } else {
                Err(io::Error::other("there is no such file"))
            };
            if let Err(error) = read {
                notes.push(format!("the materials in {} are passed over: {error}", quoted(&file_name(&path))));
            }
        }
    }

    /// Reads a library. A channel beyond 0 to 1 is the nearer end, since no picture shows more.
    ///
    /// # Errors
    /// What `source` says, or a line that is too long or has no numbers where a colour should be.
    pub fn read(&mut self, mut source: impl BufRead) -> io::Result<()> {
        let (mut bytes, mut line, mut name) = (Vec::new(), 0, None);
        loop {
            bytes.clear();
            if source.by_ref().take(LONGEST_LINE as u64).read_until(b'\n', &mut bytes)? == 0 {
                return Ok(());
            }
            line += 1;
            if bytes.len() == LONGEST_LINE {
                return Err(io::Error::other(format!("line {line} is too long")));
            }
            let mut words = Words(&bytes);
            match words.next() {
                Some(b"newmtl") => name = Some(rest(&bytes, b"newmtl").to_vec()),
                Some(b"map_Kd") => self.has_maps = true,
                Some(b"Kd") => {
                    let channels: Vec<f64> = words.take(3).map_while(|word| number(word).ok()).collect();
                    match (channels[..].try_into().map(DVec3::from_array), &name) {
                        // A spectrum in a file, or XYZ.
                        (Err(_), _) if matches!(Words(&bytes).nth(1), Some(b"spectral" | b"xyz")) => {}
                        (Ok(color), Some(name)) if !color.is_nan() => {
                            self.colors.insert(name.clone(), color.clamp(DVec3::ZERO, DVec3::ONE));
                        }
                        _ => return Err(io::Error::other(format!("line {line}: expected Kd red green blue"))),
                    }
                }
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_belong_to_their_names() {
        let mut library = Library::default();
        let text = "# a\nnewmtl red one\nKa 1 1 1\nKd 1 0.25 0\nmap_Kd red.png\nnewmtl bright\n\tKd 2 -1 0.5\nnewmtl x\nKd spectral a\n";
        library.read(text.as_bytes()).unwrap();
        assert_eq!(library.colors.len(), 2);
        assert_eq!(library.colors[&b"red one"[..]], DVec3::new(1.0, 0.25, 0.0));
        assert_eq!(library.colors[&b"bright"[..]], DVec3::new(1.0, 0.0, 0.5));
        assert!(library.has_maps);
        for bad in ["Kd 1 1 1\n", "newmtl a\nKd 1 1\n", "newmtl a\nKd 1 nan 0\n", "newmtl a\nKd red\n"] {
            let error = Library::default().read(bad.as_bytes()).unwrap_err().to_string();
            assert!(error.ends_with("expected Kd red green blue"), "{bad}: {error}");
        }
    }
}

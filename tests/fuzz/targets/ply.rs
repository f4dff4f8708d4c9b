//! Any bytes: the reader of PLY files gives triangles that all have an area, or an error.
#![no_main]

use figures::import::ply;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(mesh) = ply::read(bytes, "fuzz.ply") {
        assert!(mesh.vertex_colors.is_empty() || mesh.vertex_colors.len() == mesh.triangles.len());
        assert!(mesh.triangles.iter().all(|triangle| !triangle.is_degenerate()));
    }
});

//! Any bytes: the reader of meshes gives triangles that all have an area, or an error.
#![no_main]

use figures::import::obj;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(mesh) = obj::read(bytes, "fuzz.obj", None) {
        assert!(mesh.vertex_colors.is_empty() || mesh.vertex_colors.len() == mesh.triangles.len());
        assert!(mesh.triangles.iter().all(|triangle| !triangle.is_degenerate()));
    }
});

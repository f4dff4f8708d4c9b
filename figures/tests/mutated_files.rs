//! Files with a few bytes changed are read or refused: nothing panics, and what is read keeps its promises.

use figures::import::spheres::Options;
use figures::import::{ImportError, mesh::Mesh, obj, pdb, ply, stl, xyz};
use figures::scene_file;
use proptest::prelude::*;

const CASES: u32 = 10_000;

const SCENES: [&[u8]; 4] = [
    include_bytes!("../scenes/figure-1.toml"),
    include_bytes!("../scenes/figure-5.toml"),
    include_bytes!("../../tests/fuzz/seeds/scene/phong.toml"),
    include_bytes!("../../tests/fuzz/seeds/scene/texture.toml"),
];
const SPHERES: [&[u8]; 3] = [
    include_bytes!("../../tests/fuzz/seeds/xyz/labels.xyz"),
    include_bytes!("../../tests/fuzz/seeds/xyz/plain.xyz"),
    include_bytes!("../../tests/fuzz/seeds/xyz/extended.xyz"),
];
const PROTEINS: [&[u8]; 2] =
    [include_bytes!("../../tests/fuzz/seeds/pdb/ions.pdb"), include_bytes!("../../tests/fuzz/seeds/pdb/models.pdb")];
const MESHES: [&[u8]; 2] =
    [include_bytes!("../../tests/fuzz/seeds/obj/square.obj"), include_bytes!("../../tests/fuzz/seeds/obj/notched.obj")];
const SCANS: [&[u8]; 3] = [
    include_bytes!("../../tests/fuzz/seeds/ply/ascii.ply"),
    include_bytes!("../../tests/fuzz/seeds/ply/big.ply"),
    include_bytes!("../../tests/fuzz/seeds/ply/little.ply"),
];
const PARTS: [&[u8]; 2] =
    [include_bytes!("../../tests/fuzz/seeds/stl/text.stl"), include_bytes!("../../tests/fuzz/seeds/stl/binary.stl")];

/// One of the files with one to four changes: a byte replaced, taken out, or some text put in.
fn mutated(files: &'static [&'static [u8]]) -> impl Strategy<Value = Vec<u8>> {
    let snippets =
        ["nan", "inf", "-1", "1e999", "0", "99999999999999999999", "\n", "[", "\"", "=", " ", "#", "é", ".", "/"];
    let change = (any::<prop::sample::Index>(), 0..3, any::<u8>(), prop::sample::select(snippets.to_vec()));
    (prop::sample::select(files.to_vec()), prop::collection::vec(change, 1..=4)).prop_map(|(file, changes)| {
        let mut bytes = file.to_vec();
        for (index, kind, byte, snippet) in changes {
            if bytes.is_empty() {
                break;
            }
            let at = index.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => drop(bytes.remove(at)),
                _ => drop(bytes.splice(at..at, snippet.bytes())),
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    #[test]
    fn a_mutated_scene_is_read_or_refused(bytes in mutated(&SCENES)) {
        let text = String::from_utf8_lossy(&bytes);
        match scene_file::embedded(&text, "scene.toml") {
            Ok(scene) => scene.check(),
            Err(error) => {
                let message = error.to_string();
                prop_assert!(message.starts_with("scene.toml:") && !message.contains('\n'), "{message}");
            }
        }
    }

    #[test]
    fn a_mutated_file_of_spheres_is_read_or_refused(bytes in mutated(&SPHERES)) {
        match xyz::read(&bytes[..], bytes.len() as u64, "atoms.xyz", Options::default()) {
            Ok(found) => {
                prop_assert_eq!(found.spheres.len(), found.color_indices.len());
                prop_assert!(found.color_indices.iter().all(|&index| (index as usize) < found.colors.len()));
            }
            Err(error) => prop_assert!(error.to_string().starts_with("atoms.xyz:"), "{error}"),
        }
    }

    #[test]
    fn a_mutated_pdb_is_read_or_refused(bytes in mutated(&PROTEINS), frame in 1..3_u64) {
        match pdb::read(&bytes[..], "a.pdb", Options { frame, ..Options::default() }) {
            Ok(found) => prop_assert_eq!(found.spheres.len(), found.color_indices.len()),
            Err(error) => prop_assert!(error.to_string().starts_with("a.pdb:"), "{error}"),
        }
    }

    #[test]
    fn a_mutated_mesh_is_read_or_refused(bytes in mutated(&MESHES)) {
        check(obj::read(&bytes[..], "mesh", None))?;
    }

    #[test]
    fn a_mutated_ply_is_read_or_refused(bytes in mutated(&SCANS)) {
        check(ply::read(&bytes[..], "mesh"))?;
    }

    #[test]
    fn a_mutated_stl_is_read_or_refused(bytes in mutated(&PARTS)) {
        check(stl::read(&bytes[..], "mesh"))?;
    }
}

fn check(read: Result<Mesh, ImportError>) -> Result<(), TestCaseError> {
    match read {
        Ok(mesh) => {
            prop_assert!(mesh.vertex_colors.is_empty() || mesh.vertex_colors.len() == mesh.triangles.len());
            prop_assert!(mesh.material_of.is_empty() || mesh.material_of.len() == mesh.triangles.len());
            prop_assert!(mesh.triangles.iter().all(|triangle| !triangle.is_degenerate()));
        }
        Err(error) => prop_assert!(error.to_string().starts_with("mesh:"), "{error}"),
    }
    Ok(())
}

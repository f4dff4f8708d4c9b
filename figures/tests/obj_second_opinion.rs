//! The reader of meshes agrees with the `tobj` crate on well-formed files of triangles. (Of larger faces that crate
//! makes fans, whatever their shape.)
//!
//! It does not use that crate: `tobj` 4.0.5 says no line in its errors, gives a vertex without a colour that of the
//! next which has one, and overflows on a face with a huge normal index.

use std::fmt::Write;

use figures::import::obj;
use glam::DVec3;
use proptest::prelude::*;
use rt_geom::Triangle;

/// A well-formed mesh: vertices, all with colours or none, and triangles.
fn mesh() -> impl Strategy<Value = String> {
    let number = prop_oneof![-9.0..9.0_f64, (-3..4_i32).prop_map(f64::from), prop::num::f64::NORMAL];
    let vertex = (prop::array::uniform3(number), prop::array::uniform3(0.0..=1.0_f64));
    let index = any::<prop::sample::Index>();
    let faces = prop::collection::vec((prop::collection::vec(index, 3), 0..4), 1..6);
    (prop::collection::vec(vertex, 3..12), faces, any::<bool>()).prop_map(|(vertices, faces, colored)| {
        let mut text = "# a mesh\nvn 0 0 1\nvt 0 0\no part\n".to_owned();
        for ([x, y, z], [red, green, blue]) in &vertices {
            write!(text, "v {x:e} {y} {z}").unwrap();
            text += &if colored { format!(" {red} {green} {blue}\n") } else { "\n".to_owned() };
        }
        for (corners, style) in faces {
            text.push('f');
            for corner in corners {
                let index = corner.index(vertices.len());
                let word = match style {
                    0 => format!(" {}", index + 1),
                    1 => format!(" {}/1/1", index + 1),
                    2 => format!(" {}//1", index + 1),
                    _ => format!(" -{}", vertices.len() - index),
                };
                text += &word;
            }
            text.push('\n');
        }
        text
    })
}

/// The triangles with an area and their colours, as `tobj` reads them.
fn second_opinion(text: &str) -> Vec<(Triangle, Option<[DVec3; 3]>)> {
    let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, no_materials).unwrap();
    let mut found = Vec::new();
    for mesh in models.into_iter().map(|model| model.mesh) {
        let at = |numbers: &[f64], index: u32| DVec3::from_slice(&numbers[3 * index as usize..]);
        for corners in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| at(&mesh.positions, corners[k]));
            let colors = (!mesh.vertex_color.is_empty()).then(|| [0, 1, 2].map(|k| at(&mesh.vertex_color, corners[k])));
            let triangle = Triangle::new(a, b, c).unwrap();
            if !triangle.is_degenerate() {
                found.push((triangle, colors));
            }
        }
    }
    found
}

proptest! {
    #[test]
    fn tobj_reads_the_same_triangles(text in mesh()) {
        let expected = second_opinion(&text);
        match obj::read(text.as_bytes(), "mesh.obj", None) {
            Ok(mesh) => {
                let colors = |at: usize| mesh.vertex_colors.get(at).copied().flatten();
                let found: Vec<_> = mesh.triangles.iter().enumerate().map(|(at, t)| (*t, colors(at))).collect();
                prop_assert_eq!(found, expected);
            }
            Err(error) => {
                prop_assert!(error.to_string().contains("has an area"), "{error}");
                prop_assert!(expected.is_empty());
            }
        }
    }
}

//! Every byte of a picture is that of exact mathematics, whatever the scene, and its stages say how it was decided.
//!
//! The golden pictures `certified-*.ppm` were made without this program: exact hits in integers, and balls of a
//! library for arbitrary precision.

use std::fs;
use std::path::{Path, PathBuf};

use figures::camera::Size;
use figures::certify::Certified;
use figures::objects::Method;
use figures::render::{Renderer, Rows};
use figures::scene::Scene;
use figures::scene_file;
use oracle::files::folder;
use rayon::ThreadPoolBuilder;

/// Columns, rows, samples along a side of a pixel, and the text of a scene.
struct Case {
    name: &'static str,
    size: [u32; 3],
    /// How many samples show the border of a texel in exactly the middle of a pixel, and no precision decides that.
    ties: u64,
    /// The largest sample of the golden picture, if there is one.
    golden: Option<u16>,
    text: &'static str,
}

const CASES: [Case; 10] = [
    Case { name: "far", size: [24, 18, 1], ties: 0, golden: Some(65535), text: FAR },
    Case { name: "ground", size: [24, 18, 2], ties: 0, golden: Some(255), text: GROUND },
    Case { name: "offset", size: [24, 18, 1], ties: 0, golden: None, text: OFFSET },
    Case { name: "plane", size: [24, 18, 1], ties: 0, golden: Some(65535), text: PLANE },
    Case { name: "seam", size: [25, 19, 1], ties: 0, golden: Some(255), text: SEAM },
    Case { name: "pole", size: [25, 19, 1], ties: 0, golden: None, text: POLE },
    Case { name: "diagonal", size: [19, 19, 1], ties: 4 * 5, golden: Some(255), text: DIAGONAL },
    Case { name: "halves", size: [24, 18, 2], ties: 0, golden: Some(255), text: HALVES },
    Case { name: "flat", size: [24, 18, 3], ties: 0, golden: Some(255), text: FLAT },
    Case { name: "coefficients", size: [24, 18, 1], ties: 0, golden: Some(65535), text: COEFFICIENTS },
];

/// A ball of radius 1 at a distance of 1e15.
const FAR: &str = r#"
background = [0.1, 0.2, 0.3]

[camera]
eye = [1e15, 0.0, 0.0]
look_at = [0.0, 0.0, 0.0]
fov = 1.2032113697747289e-13

[[light]]
position = [2.0, 3.0, 5.0]

[[light]]
position = [4.0, -0.3, 1.1]
color = [0.5, 0.7, 0.1]

[material.m]
color = [0.9, 0.6, 0.25]
specular = 0.4
shininess = 20.0

[[sphere]]
center = [0.0, 0.0, 0.0]
radius = 1.0
material = "m"
"#;

/// A ground that is a ball of radius 1e20.
const GROUND: &str = r#"
background = [0.5, 0.7, 0.9]

[camera]
eye = [0.4, 1.7, 6.0]
look_at = [0.0, 0.5, 0.0]
fov = 50.0

[[light]]
position = [-1.6, 3.0, 2.2]
color = [1.0, 0.75, 0.4]

[[light]]
position = [4.0, 10.0, -3.0]
color = [0.4, 0.7, 1.0]

[material.ground]
color = [0.6, 0.6, 0.55]
ambient = 0.2
specular = 0.3
shininess = 12.0

[material.map]
texture = "map.ppm"
filter = "bilinear"

[[sphere]]
center = [0.0, -1e20, 0.0]
radius = 1e20
material = "ground"

[[sphere]]
center = [0.1, 0.5, 0.2]
radius = 0.5
material = "map"

[[sphere]]
center = [1.8, 0.7, -1.0]
radius = 1.0
material = "ground"
"#;

/// A scene 1e13 from the origin of the coordinates.
const OFFSET: &str = r#"
[camera]
eye = [1e13, 1e13, 1.0000000000006e13]
look_at = [1e13, 1e13, 1e13]
fov = 50.0

[[light]]
position = [1.0000000000004e13, 1.0000000000005e13, 1.0000000000003e13]

[material.m]
texture = "map.ppm"
specular = 0.4
shininess = 9.0

[material.n]
color = [1.0, 1.0, 1.0]
ambient = 0.3
specular = 0.2
shininess = 40.0

[[sphere]]
center = [1e13, 1e13, 1e13]
radius = 1.5
material = "m"

[[triangle]]
a = [9999999999997.0, 9999999999998.0, 9999999999999.0]
b = [1.0000000000003e13, 9999999999998.0, 1e13]
c = [1e13, 1.0000000000003e13, 9999999999998.0]
material = "n"
colors = [[1.0, 0.0, 0.1], [0.2, 0.9, 0.3], [0.4, 0.5, 1.0]]
"#;

/// Lights in the planes of triangles, and a rounding error beside them.
const PLANE: &str = r#"
[camera]
fov = 80.0

[material.w]
color = [0.9, 0.8, 0.7]
shininess = 0.5

[material.v]
color = [0.3, 0.8, 0.7]
shininess = 2.0

[[light]]
position = [3.0, 2.0, -3.0]
color = [1.0, 0.0, 0.0]

[[light]]
position = [-5.0, 1.0, -2.9999999999999996]
color = [0.0, 1.0, 0.0]

[[light]]
position = [-5.0, 1.0, -3.0000000000000004]
color = [0.0, 0.0, 1.0]

[[light]]
position = [0.5, 0.25, -3.0]

[[triangle]]
a = [-2.0, -1.0, -3.0]
b = [0.0, -1.0, -3.0]
c = [-1.0, 1.5, -3.0]
material = "w"

[[triangle]]
a = [0.5, -1.0, -2.0]
b = [2.5, -1.0, -2.0]
c = [1.5, 1.5, -4.5]
material = "v"
"#;

/// The middle column exactly on the seam, the middle row on the equator.
const SEAM: &str = r#"
background = [0.02, 0.02, 0.05]

[camera]
eye = [-3.0, 0.0, 0.0]
look_at = [0.0, 0.0, 0.0]
fov = 45.0

[material.g]
texture = "map.ppm"
filter = "nearest"

[[sphere]]
center = [0.0, 0.0, 0.0]
radius = 1.0
material = "g"
"#;

/// Exactly above the north pole, lit: the middle column and row at quarters of a turn.
const POLE: &str = r#"
[camera]
eye = [0.0, 3.0, 0.0]
look_at = [0.0, 0.0, 0.0]
up = [0.0, 0.0, -1.0]
fov = 45.0

[[light]]
position = [2.0, 3.0, 1.0]

[material.g]
texture = "map.ppm"
filter = "nearest"
mirrored = true

[[sphere]]
center = [0.0, 0.0, 0.0]
radius = 1.0
material = "g"
"#;

/// The same with borders of texels along both diagonals: two equal roots whose difference is never seen to be zero, for
/// five pixels on each of four arms.
const DIAGONAL: &str = r#"
[camera]
eye = [0.0, 3.0, 0.0]
look_at = [0.0, 0.0, 0.0]
up = [0.0, 0.0, -1.0]
fov = 45.0

[material.g]
texture = "eight.ppm"
filter = "nearest"

[[sphere]]
center = [0.0, 0.0, 0.0]
radius = 1.0
material = "g"
"#;

/// Bytes that lie exactly between two: one half of white, and lights that are behind.
const HALVES: &str = r#"
background = [0.5, 0.5, 0.5]

[camera]
eye = [0.0, 0.0, 5.0]
look_at = [0.0, 0.0, 0.0]
fov = 45.0

[[light]]
position = [0.0, 0.0, -100.0]

[material.m0]
color = [1.0, 1.0, 1.0]
ambient = 0.5
diffuse = 0.5

[material.m1]
color = [1.0, 0.5, 0.125]
ambient = 0.25
diffuse = 0.5

[[sphere]]
center = [-1.0, 0.3, 0.0]
radius = 0.9
material = "m0"

[[triangle]]
a = [0.3, -1.5, 0.0]
b = [1.8, -1.5, 0.0]
c = [1.0, 1.0, 0.0]
material = "m1"
"#;

/// Without lights, colours between two bytes; with nine samples in a pixel.
const FLAT: &str = r#"
background = [0.1, 0.9, 0.3]

[camera]
eye = [0.0, 0.0, 5.0]
look_at = [0.0, 0.0, 0.0]
fov = 45.0

[material.h]
color = [0.5, 0.5, 0.5]

[material.t]
texture = "map.ppm"

[[sphere]]
center = [-0.5, 0.3, 0.0]
radius = 1.0
material = "h"

[[sphere]]
center = [1.0, 1.0, 0.5]
radius = 0.7
material = "t"

[[triangle]]
a = [-2.0, -2.0, -1.0]
b = [2.0, -2.0, -1.0]
c = [0.0, 2.0, -1.0]
material = "h"
colors = [[0.5, 0.5, 0.5], [0.5, 0.0, 1.0], [0.5, 1.0, 0.0]]
"#;

/// Coefficients beside colours so far from 1 that products leave the ordinary range.
const COEFFICIENTS: &str = r#"
[camera]
eye = [0.0, 0.0, 4.0]
look_at = [0.0, 0.0, 0.0]
fov = 50.0

[[light]]
position = [3.0, 1.0, 2.0]

[material.a]
color = [2e-306, 3.1e-306, 7e-306]
ambient = 1e305
diffuse = 0.0

[material.d]
color = [1e-311, 3e-311, 7e-311]
ambient = 0.0
diffuse = 1e308

[[sphere]]
center = [-0.8, 0.0, 0.0]
radius = 0.8
material = "a"

[[sphere]]
center = [0.8, 0.0, 0.0]
radius = 0.8
material = "d"
"#;

/// The image of a texture: five columns, three rows.
const MAP: &str = "P3 5 3 255
255 0 0  0 255 0  0 0 255  90 127 128  255 255 255
20 200 30  10 20 30  255 128 1  77 66 55  0 0 0
1 2 3  200 100 50  50 100 200  128 128 128  3 255 9
";

/// Eight columns, one row.
const EIGHT: &str = "P3 8 1 7
0 1 2  1 2 3  2 3 4  3 4 5  4 5 6  5 6 7  6 7 0  7 0 1
";

impl Case {
    fn load(&self, folder: &Path) -> Scene {
        let path = folder.join(self.name).with_extension("toml");
        fs::write(folder.join("map.ppm"), MAP).unwrap();
        fs::write(folder.join("eight.ppm"), EIGHT).unwrap();
        fs::write(&path, self.text).unwrap();
        scene_file::load(&path).unwrap()
    }

    /// The picture in bands of so many rows.
    fn draw(&self, maxval: u16, method: Method, band: u32) -> Rows {
        self.draw_on(false, maxval, method, band)
    }

    /// The same, without a background if `transparent`.
    fn draw_on(&self, transparent: bool, maxval: u16, method: Method, band: u32) -> Rows {
        let folder = folder();
        let [width, height, samples] = self.size;
        let scene = Scene { transparent, ..self.load(folder.path()) };
        let view = scene.view(Size { width, height, samples }).unwrap();
        let renderer = Renderer::with(scene, method);
        let bands = (0..height).step_by(band as usize).map(|top| top..height.min(top + band));
        let parts = bands.map(|rows| renderer.rows(&view, rows, maxval, &|_| ()));
        parts
            .reduce(|all, part| Rows {
                samples: [all.samples, part.samples].concat(),
                rays: all.rays + part.rays,
                hits: all.hits + part.hits,
                certified: all.certified.plus(part.certified),
            })
            .unwrap()
    }
}

/// All samples that a stage has decided or left open.
fn total(counts: Certified) -> u64 {
    counts.doubles + counts.double_double + counts.enclosures.iter().sum::<u64>() + counts.undecided
}

#[test]
fn every_sample_is_counted_once_and_open_only_where_a_tie_is_exact() {
    let mut all = Certified::default();
    for case in &CASES {
        for maxval in [255, 65535] {
            let drawn = case.draw(maxval, Method::Bvh, case.size[1]);
            let counts = drawn.certified;
            let [width, height, samples] = case.size.map(u64::from);
            assert_eq!(drawn.rays, width * height * samples * samples, "{}", case.name);
            assert_eq!(total(counts), drawn.rays, "{} {counts:?}", case.name);
            assert_eq!(counts.undecided, case.ties, "{} {counts:?}", case.name);
            assert!(drawn.hits > 0, "{}", case.name);
            all = all.plus(counts);
        }
    }
    assert!(all.doubles > 0 && all.double_double > 0 && all.enclosures[0] > 0, "{all:?}");
}

#[test]
fn the_bytes_depend_neither_on_tiles_nor_on_threads_nor_on_the_tree() {
    for case in &CASES {
        for maxval in [255, 65535] {
            let whole = case.draw(maxval, Method::Bvh, case.size[1]);
            for (threads, method, band) in [(1, Method::Bvh, 5), (3, Method::Loop, 7), (2, Method::Sorted, 1)] {
                let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let again = pool.install(|| case.draw(maxval, method, band));
                assert!(again.samples == whole.samples, "{} {maxval} {threads} {method:?} {band}", case.name);
                assert_eq!(again.certified, whole.certified, "{}", case.name);
            }
        }
    }
}

#[test]
fn without_a_background_the_bytes_are_the_same_where_all_samples_hit() {
    let mut partly = 0;
    for case in &CASES {
        let opaque = case.draw(65535, Method::Bvh, 5);
        let clear = case.draw_on(true, 65535, Method::Bvh, 5);
        assert_eq!((clear.rays, clear.hits, total(clear.certified)), (opaque.rays, opaque.hits, opaque.rays));
        let mut hits = 0.0;
        for (clear, opaque) in clear.samples.chunks_exact(4).zip(opaque.samples.chunks_exact(3)) {
            match clear[3] {
                65535 => assert_eq!(clear[..3], *opaque, "{}", case.name),
                0 => assert_eq!(clear[..3], [0; 3], "{}", case.name),
                _ => partly += 1,
            }
            hits += f64::from(clear[3]) / 65535.0;
        }
        let samples = f64::from(case.size[2] * case.size[2]);
        assert!((hits * samples - opaque.hits as f64).abs() < 0.1, "{}: {hits}", case.name);
    }
    assert!(partly > 20, "{partly}");
}

#[test]
fn pictures_are_those_of_exact_mathematics() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    for case in &CASES {
        let Some(maxval) = case.golden else { continue };
        let golden = fs::read(folder.join(format!("certified-{}.ppm", case.name))).unwrap();
        let [width, height, _] = case.size;
        let header = format!("P6\n{width} {height}\n{maxval}\n");
        let bytes = golden.strip_prefix(header.as_bytes()).expect("the header of the golden picture");
        let found = case.draw(maxval, Method::Bvh, height).samples;
        let found: Vec<u8> =
            found.iter().flat_map(|sample| sample.to_be_bytes().into_iter().skip(usize::from(maxval < 256))).collect();
        let wrong = found.iter().zip(bytes).filter(|(found, exact)| found != exact).count();
        assert_eq!((wrong, found.len()), (0, bytes.len()), "{}", case.name);
    }
}

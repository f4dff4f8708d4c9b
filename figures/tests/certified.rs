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
use rayon::ThreadPoolBuilder;

/// A scene in `tests/certified`, and its picture.
struct Case {
    name: &'static str,
    /// Columns, rows, samples along a side of a pixel.
    size: [u32; 3],
    /// How many samples show the border of a texel in exactly the middle of a pixel, and no precision decides that.
    ties: u64,
    /// The largest sample of the golden picture, if there is one.
    golden: Option<u16>,
}

const CASES: [Case; 10] = [
    Case { name: "far", size: [24, 18, 1], ties: 0, golden: Some(65535) },
    Case { name: "ground", size: [24, 18, 2], ties: 0, golden: Some(255) },
    Case { name: "offset", size: [24, 18, 1], ties: 0, golden: None },
    Case { name: "plane", size: [24, 18, 1], ties: 0, golden: Some(65535) },
    Case { name: "seam", size: [25, 19, 1], ties: 0, golden: Some(255) },
    Case { name: "pole", size: [25, 19, 1], ties: 0, golden: None },
    Case { name: "diagonal", size: [19, 19, 1], ties: 4 * 5, golden: Some(255) },
    Case { name: "halves", size: [24, 18, 2], ties: 0, golden: Some(255) },
    Case { name: "flat", size: [24, 18, 3], ties: 0, golden: Some(255) },
    Case { name: "coefficients", size: [24, 18, 1], ties: 0, golden: Some(65535) },
];

fn in_tests(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder)
}

impl Case {
    /// The picture in bands of so many rows.
    fn draw(&self, maxval: u16, method: Method, band: u32) -> Rows {
        self.draw_on(false, maxval, method, band)
    }

    /// The same, without a background if `transparent`.
    fn draw_on(&self, transparent: bool, maxval: u16, method: Method, band: u32) -> Rows {
        let path = in_tests("certified").join(self.name).with_extension("toml");
        let [width, height, samples] = self.size;
        let scene = Scene { transparent, ..scene_file::load(&path).unwrap() };
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
    let folder = in_tests("golden");
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

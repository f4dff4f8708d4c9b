//! Triangles from Wavefront OBJ files.
//!
//! Read are vertices, `v x y z` or `v x y z r g b`, and faces, `f 1 2 3`, which count vertices from 1 or, negative,
//! back from the last above; of `1/2/3` the first number counts. A face may name vertices that come later. `polygon.rs`
//! cuts faces of more than three vertices. A line that ends in `\` goes on in the next one, unless it has a comment.
//! Materials, `mtllib` and `usemtl`, give faces the diffuse colour of the library, which lies beside the file; `mtl.rs`
//! reads it. Everything else (texture coordinates, normals, lines, points) is ignored, and the mesh lists what it was:
//! the scene model has no use for it.
//!
//! `quick.rs` reads plain lines of vertices and faces, in parallel; `statement.rs` says what each statement means.

mod quick;
mod statement;

use std::io::Read;
use std::path::Path;

use super::mesh::Mesh;
use super::problem::{FileProblem, ImportError};
use quick::{Block, Rest};
use statement::ObjReader;

/// Reads a mesh from `source`, which errors call `name`; its material libraries are looked up in `folder`, if there is
/// one.
///
/// # Errors
/// What is wrong, with the line.
pub fn read(mut source: impl Read + Send, name: &str, folder: Option<&Path>) -> Result<Mesh, ImportError> {
    let mut reader = ObjReader::new();
    let mut line = 1;
    // While what was read of one block is appended, the next is read. Both keep their memory.
    let (mut ready, mut next) = (Block::default(), Block::default());
    let mut rest = Rest::default();
    loop {
        let (appended, filled) = rayon::join(|| reader.append(&ready, &mut line), || next.fill(&mut source, &mut rest));
        appended.map_err(|problem| ImportError::in_line(name, line, problem))?;
        filled.map_err(|source| FileProblem::Read { path: name.to_owned(), source })?;
        if next.is_empty() {
            break;
        }
        std::mem::swap(&mut ready, &mut next);
    }
    let mesh = reader.finish(folder).map_err(|(line, problem)| ImportError::in_line(name, line, problem))?;
    mesh.some(name)
}

#[cfg(test)]
mod tests {
    use std::io;

    use glam::DVec3;
    use rt_geom::Triangle;

    use super::super::problem::{LONGEST_LINE, LineProblem};
    use super::statement::statement;
    use super::*;

    fn parse(text: &str) -> Result<Mesh, ImportError> {
        read(text.as_bytes(), "mesh.obj", None)
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn a_square_is_two_triangles() {
        let mesh = parse(&format!("# a square\no it\n{SQUARE}vn 0 0 1\nf 1//1 2/7/1 3 4\n")).unwrap();
        let corners = |indices: [usize; 3]| {
            let all = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
            Triangle::new(all[indices[0]], all[indices[1]], all[indices[2]]).unwrap()
        };
        assert_eq!(mesh.triangles, [corners([0, 1, 2]), corners([0, 2, 3])]);
        assert_eq!((mesh.vertex_colors, mesh.flat), (vec![], 0));
    }

    #[test]
    fn a_notched_face_is_the_same_whichever_corner_comes_first() {
        let vertices = "v 0 0 0\nv 4 0 1\nv 4 4 2\nv 2 1 1\nv 0 4 1\n";
        let expected = parse(&format!("{vertices}f 1 2 3 4 5\n")).unwrap();
        for face in ["2 3 4 5 1", "3 4 5 1 2", "4 5 1 2 3", "5 1 2 3 4"] {
            assert_eq!(parse(&format!("{vertices}f {face}\n")).unwrap(), expected, "{face}");
        }
        // What the notch takes out is covered by none of them.
        let notch = rt_geom::Ray::new(DVec3::new(2.0, 3.0, 9.0), DVec3::NEG_Z).unwrap();
        assert!(expected.triangles.iter().all(|triangle| !triangle.any(&notch, 0.0..f64::INFINITY)));
    }

    #[test]
    fn a_face_that_crosses_itself_is_counted() {
        let mesh = parse("v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n").unwrap();
        assert_eq!(mesh.crossed, 1);
        assert_eq!(parse(&format!("{SQUARE}f 1 2 3 4\n")).unwrap().crossed, 0);
    }

    #[test]
    fn negative_numbers_count_back() {
        assert_eq!(parse(&format!("{SQUARE}f -4 -3 -2\n")).unwrap(), parse(&format!("{SQUARE}f 1 2 3\n")).unwrap());
    }

    #[test]
    fn a_face_may_come_before_its_vertices() {
        let expected = parse(&format!("{SQUARE}f 1 2 3\nf 1 3 4\nf 1 2 4\n")).unwrap();
        let mixed = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 1 3 4\nf -3 -2 4\nv 0 1 0\n";
        assert_eq!(parse(mixed).unwrap(), expected);
        assert_eq!(parse(&format!("f 1 2 3\nf 1 3 4\nf 1 2 4\n{SQUARE}")).unwrap(), expected);
        // Faces stay in order, those that could be cut at once too.
        let ordered = parse(&format!("{SQUARE}f 1 3 4\nf 1 2 3\n")).unwrap();
        assert_eq!(parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 3 4\nf 1 2 3\nv 0 1 0\n").unwrap(), ordered);
        let error = parse(&format!("f 1 2 3\nf 1 2 5\n{SQUARE}")).unwrap_err();
        assert_eq!(error.to_string(), "mesh.obj:2: no vertex 5 among the 4 of the file");
    }

    #[test]
    fn a_line_goes_on_after_a_backslash() {
        let expected = parse(&format!("{SQUARE}f 1 2 3\n")).unwrap();
        assert_eq!(parse(&format!("{SQUARE}f 1 \\\n2\\\r\n 3\n")).unwrap(), expected);
        // Not in a comment; and the end of the file ends it.
        assert_eq!(parse(&format!("# C:\\\n{SQUARE}f 1 2 3 \\")).unwrap(), expected);
        let error = parse(&format!("{SQUARE}f 1 \\\n2 3\nv 0 0 \\\n\\\nzero\n")).unwrap_err();
        assert_eq!(error.to_string(), "mesh.obj:7: expected a number, found \"zero\"");
    }

    #[test]
    fn a_byte_order_mark_is_passed_over() {
        let expected = parse(&format!("{SQUARE}f 1 2 3\n")).unwrap();
        assert_eq!(parse(&format!("\u{feff}{SQUARE}f 1 2 3\n")).unwrap(), expected);
        let error = read(&b"\xff\xfev\0 \0"[..], "mesh.obj", None).unwrap_err();
        assert_eq!(error.to_string(), "mesh.obj:1: UTF-16 text; save it as UTF-8");
    }

    #[test]
    fn what_is_passed_over_is_told() {
        let text = "vn 0 0 1\nusemtl red\nvt 0 0\nmtllib a.mtl\ng part\ns off\nl 1 2\n";
        let mesh = parse(&format!("{SQUARE}{text}f 1 2 3\n")).unwrap();
        assert_eq!(
            mesh.passed_over,
            [
                "normals (vn)",
                "texture coordinates (vt)",
                "lines (l)",
                "materials (mtllib, usemtl): they lie in another file"
            ]
        );
        assert!(parse(&format!("{SQUARE}f 1 2 3\n")).unwrap().passed_over.is_empty());
    }

    #[test]
    fn colors_belong_to_their_own_vertices() {
        let text = "v 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\nf 2 3 4\n";
        let mesh = parse(text).unwrap();
        assert_eq!(mesh.vertex_colors, [None, Some([DVec3::X, DVec3::Y, DVec3::Z])]);
    }

    #[test]
    fn flat_triangles_are_left_out_and_counted() {
        let mesh = parse(&format!("{SQUARE}f 1 2 2\nf 1 2 3\nf 1 1 1\nf 1 2 1 2\n")).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.flat), (1, 4));
        let error = parse(&format!("{SQUARE}f 1 2 2\n")).unwrap_err();
        assert!(error.to_string().contains("none of its 1 triangles has an area"), "{error}");
    }

    /// Reads statement by statement, by the rules above alone.
    fn read_slowly(mut text: &[u8]) -> Result<Mesh, ImportError> {
        let (mut reader, mut bytes, mut line) = (ObjReader::new(), Vec::new(), 0);
        let failed = |(line, problem)| ImportError::in_line("mesh.obj", line, problem);
        loop {
            let first = line + 1;
            if !statement(&mut text, &mut bytes, &mut line).unwrap() {
                break;
            }
            let long = bytes.len() == LONGEST_LINE && !bytes.ends_with(b"\n");
            let done = if long { Err(LineProblem::Long) } else { reader.statement(&bytes, first) };
            done.map_err(|problem| failed((first, problem)))?;
        }
        reader.finish(None).map_err(failed)?.some("mesh.obj")
    }

    fn assert_read_alike(text: &[u8]) -> bool {
        let quickly = read(text, "mesh.obj", None).map_err(|error| error.to_string());
        let slowly = read_slowly(text).map_err(|error| error.to_string());
        assert_eq!(quickly, slowly, "{:?}", String::from_utf8_lossy(text));
        quickly.is_ok()
    }

    /// All that can stand in a line, right or wrong.
    const PARTS: &str = "v,f,vn,vt,l,p,o it,g,s 1,usemtl red,mtllib a.mtl,#,# no,\\,\\\n,\\\r\n,1,-1,+2,0,1/2,2//3,3/\\,\
                         -900,99999999,4294967297,nan,inf,1e400,0x1,1.5e-3,\u{e9},\u{feff},curv2";

    /// A statement: most are right.
    fn line(random: &mut oracle::Random, vertices: &mut usize, hostile: u64) -> String {
        let blank = random.pick(&[" ", " ", " ", "\t", "  ", " \t ", "\x0c"]);
        let end = random.pick(&["\n", "\n", "\n", "\r\n", " \n", "\t\r\n"]);
        if random.one_in(hostile) {
            let parts: Vec<&str> = PARTS.split(',').collect();
            let words: Vec<&str> = (0..random.below(6)).map(|_| random.pick(&parts)).collect();
            return words.join(blank) + end;
        }
        let mut text = random.pick(&["", "", "", "", " ", "\t"]).to_owned();
        if *vertices < 3 || random.one_in(2) {
            *vertices += 1;
            let number = |random: &mut oracle::Random| match random.below(4) {
                0 => format!("{}", random.whole(-9, 9)),
                1 => format!("{:?}", random.uniform()),
                _ => format!("{:.6}", random.within(-20.0, 20.0)),
            };
            let count = random.pick(&[3, 3, 3, 4]);
            text += "v";
            (0..count).for_each(|_| text += &format!("{blank}{}", number(random)));
            if count == 3 && random.one_in(5) {
                (0..3).for_each(|_| text += &format!("{blank}{:.3}", random.share()));
            }
        } else {
            text += "f";
            let slash = random.pick(&["", "", "/1", "//2", "/3/4"]);
            let forward = random.one_in(9);
            for _ in 0..random.pick(&[3, 3, 3, 4, 5]) {
                let corner = 1 + random.below(*vertices + if forward { 3 } else { 0 });
                let back = !forward && random.one_in(3);
                let number = if back { format!("-{corner}") } else { corner.to_string() };
                text += &format!("{blank}{number}{slash}");
            }
        }
        text + random.pick(&["", "", "", "", "", " # remark", "\\\n"]) + end
    }

    #[test]
    fn the_quick_way_reads_as_the_slow_one_does() {
        let random = &mut oracle::Random::new(31);
        let (mut good, rounds) = (0, oracle::cases(100_000) / 10);
        for round in 0..rounds {
            // (Blocks have a kilobyte here.)
            let hostile = random.pick(&[30, 300, 3000, u64::MAX]);
            let (mut text, mut vertices) = (random.pick(&["", "", "\u{feff}", "# it\n"]).to_owned(), 0);
            (0..random.below(if round % 8 == 0 { 600 } else { 60 }))
                .for_each(|_| text += &line(random, &mut vertices, hostile));
            if random.one_in(4) {
                text.truncate(text.trim_end().len());
            }
            good += usize::from(assert_read_alike(text.as_bytes()));
        }
        assert!((rounds / 10..rounds).contains(&good), "{good} of {rounds}");
    }

    #[test]
    fn long_statements_are_read_alike() {
        let triangle = format!("{SQUARE}f 1 2 3\n");
        // Lines that all end in a backslash, and go on or not; statements across many blocks, and too long ones.
        for text in [
            format!("{triangle}{}", "# no\\\n".repeat(1000)),
            format!("{triangle}{}f 1 2 3\n", "# no\\\r\n".repeat(1000)),
            format!("{SQUARE}f 1 2{}3\nf 1 2 3\n", "\\\n".repeat(5000)),
            format!("{SQUARE}f 1 2 {}3\\", "\\\r\n".repeat(5000)),
            format!("{triangle}{}\nf 1 2\n", "x".repeat(LONGEST_LINE - 1)),
            format!("{triangle}{}\nf 1 2\n", "x".repeat(LONGEST_LINE)),
            format!("{triangle}{}", "x".repeat(LONGEST_LINE)),
            format!("{triangle}{}", "\\\n".repeat(LONGEST_LINE)),
            format!("{triangle}f 1 2\\\n{}", "x".repeat(2 * LONGEST_LINE)),
        ] {
            let [quickly, slowly] = [read(text.as_bytes(), "mesh.obj", None), read_slowly(text.as_bytes())];
            let [quickly, slowly] = [quickly, slowly].map(|read| read.map_err(|error| error.to_string()));
            assert_eq!(quickly, slowly, "{} bytes: {}...", text.len(), &text[..80]);
        }
    }

    /// Fails after its bytes.
    struct Torn<'a>(&'a [u8]);

    impl Read for Torn<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            if self.0.is_empty() { Err(io::Error::other("torn")) } else { self.0.read(buffer) }
        }
    }

    #[test]
    fn what_stands_before_a_broken_place_is_read_first() {
        for (text, message) in
            [("v 0 0 0\nv 0 0 zero\n", "mesh.obj:2: "), ("v 0 0 0\nv 0 0 zero", "cannot read"), ("", "cannot read")]
        {
            let error = read(Torn(text.as_bytes()), "mesh.obj", None).unwrap_err().to_string();
            assert!(error.starts_with(message), "{text:?}: {error}");
        }
    }
}

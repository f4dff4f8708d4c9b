//! Triangles from PLY files, as text and in both binary orders.
//!
//! The header lists elements, each with a count and properties. Of the vertices `x`, `y` and `z` are read, and `red`,
//! `green` and `blue` if all three are there; of the faces the list `vertex_indices` (or `vertex_index`), and the same
//! colours, which then take the place of the vertices'. A colour of whole numbers is a share of its type's largest.
//! Everything else is passed over, value by value, so memory is that of the vertices and the triangles, and a count in
//! the header reserves nothing.
//!
//! Source: G. Turk, "The PLY Polygon File Format", 1994.

use std::io::{self, BufRead, Read};

use glam::DVec3;

use super::mesh::{FaceColor, Faces, Mesh, Vertices};
use super::problem::{Broken, FileProblem, ImportError, LineProblem};
use super::words::{Words, number, shown};

/// No line of a header, and no number in a text, has so many bytes.
const LONGEST: u64 = 1 << 12;
/// No header has so many lines.
const MOST_LINES: usize = 1 << 12;

/// Reads a mesh from `source`, which errors call `name`.
///
/// # Errors
/// What is wrong, with the line, or with the element and its number.
pub fn read(source: impl BufRead, name: &str) -> Result<Mesh, ImportError> {
    let mut reader = PlyReader { source, line: 0, encoding: Encoding::Text, word: Vec::new() };
    let mesh = match reader.header() {
        Ok(elements) => reader.mesh(&elements),
        Err(Broken::Line(problem)) => return Err(ImportError::in_line(name, reader.line, problem)),
        Err(other) => Err((String::new(), other)),
    };
    let refuse = |what| FileProblem::Binary { path: name.to_owned(), what };
    let mesh = mesh.map_err(|(place, broken)| match (broken, reader.encoding) {
        (Broken::Read(source), _) if source.kind() != io::ErrorKind::UnexpectedEof => {
            FileProblem::Read { path: name.to_owned(), source }.into()
        }
        (Broken::Read(_), _) => refuse(format!("the file ends in {place}")).into(),
        (Broken::Line(problem), Encoding::Text) => ImportError::in_line(name, reader.line, problem),
        (Broken::Line(problem), _) => ImportError::from(refuse(format!("{place}: {problem}"))),
    })?;
    mesh.some(name)
}

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn of(word: &[u8]) -> Result<Self, LineProblem> {
        Ok(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return Err(LineProblem::Ply(format!("unknown type {:?}", shown(word)))),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// What a colour of 1 is.
    fn full(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::I32 => 2_147_483_647.0,
            Self::U32 => 4_294_967_295.0,
            Self::F32 | Self::F64 => 1.0,
        }
    }
}

/// What a property means here.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    /// x, y, z, red, green, blue: 0 to 5.
    Number(usize),
    Corners,
    Nothing,
}

struct Property {
    /// The type of the count, if it is a list.
    list: Option<Kind>,
    kind: Kind,
    role: Role,
}

struct Element {
    name: Vec<u8>,
    count: u64,
    properties: Vec<Property>,
    /// Things that are passed over, each once.
    passed_over: Vec<&'static str>,
}

impl Element {
    fn has(&self, numbers: std::ops::Range<usize>) -> bool {
        numbers.into_iter().all(|at| self.properties.iter().any(|property| property.role == Role::Number(at)))
    }

    /// Checks that it has what is read of it.
    fn check(&self) -> Result<(), LineProblem> {
        let corners = self.properties.iter().filter(|property| property.role == Role::Corners).count();
        let problem = match self.name.as_slice() {
            _ if self.count == 0 => return Ok(()),
            b"tristrips" => "strips of triangles are not read; write the mesh with faces",
            b"vertex" if !self.has(0..3) => "a vertex has the properties x, y and z",
            b"face" if corners != 1 => "a face has the list vertex_indices",
            _ => return Ok(()),
        };
        Err(LineProblem::Ply(problem.to_owned()))
    }

    fn property(&mut self, words: &[&[u8]]) -> Result<(), LineProblem> {
        let (list, kind, name) = match *words {
            [b"list", count, kind, name] => (Some(Kind::of(count)?), Kind::of(kind)?, name),
            [kind, name] => (None, Kind::of(kind)?, name),
            _ => return Err(LineProblem::Ply("expected property TYPE NAME".to_owned())),
        };
        let role = match (self.name.as_slice(), list.is_some(), name) {
            (b"vertex", false, b"x") => Role::Number(0),
            (b"vertex", false, b"y") => Role::Number(1),
            (b"vertex", false, b"z") => Role::Number(2),
            (b"vertex" | b"face", false, b"red" | b"diffuse_red") => Role::Number(3),
            (b"vertex" | b"face", false, b"green" | b"diffuse_green") => Role::Number(4),
            (b"vertex" | b"face", false, b"blue" | b"diffuse_blue") => Role::Number(5),
            (b"face", true, b"vertex_indices" | b"vertex_index") => Role::Corners,
            _ => Role::Nothing,
        };
        let told = match name {
            b"nx" => Some("normals (nx, ny, nz)"),
            b"s" | b"u" | b"texture_u" | b"texcoord" => Some("texture coordinates"),
            b"alpha" => Some("transparency (alpha)"),
            _ => None,
        };
        self.passed_over.extend(told.filter(|told| !self.passed_over.contains(told)));
        self.properties.push(Property { list, kind, role });
        Ok(())
    }
}

struct PlyReader<R> {
    source: R,
    line: usize,
    encoding: Encoding,
    /// A place to read a word into.
    word: Vec<u8>,
}

impl<R: BufRead> PlyReader<R> {
    fn header(&mut self) -> Result<Vec<Element>, Broken> {
        let mut elements: Vec<Element> = Vec::new();
        let mut bytes = Vec::new();
        for at in 1..MOST_LINES {
            bytes.clear();
            self.line = at;
            let read = self.source.by_ref().take(LONGEST).read_until(b'\n', &mut bytes).map_err(Broken::Read)?;
            let told = |text: &str| LineProblem::Ply(text.to_owned());
            if read == 0 || read as u64 == LONGEST {
                return Err(told("a header ends in a line end_header").into());
            }
            let words: Vec<&[u8]> = Words(&bytes).collect();
            match (&words[..], at) {
                ([b"ply"], 1) | ([], 2..) | ([b"comment" | b"obj_info", ..], 2..) => {}
                (_, 1) => return Err(told("a PLY file begins with a line ply").into()),
                ([b"format", encoding, _], _) => {
                    self.encoding = match *encoding {
                        b"ascii" => Encoding::Text,
                        b"binary_little_endian" => Encoding::LittleEndian,
                        b"binary_big_endian" => Encoding::BigEndian,
                        _ => return Err(LineProblem::Ply(format!("unknown format {:?}", shown(encoding))).into()),
                    }
                }
                ([b"element", name, count], _) => {
                    let count = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
                    let count = count.ok_or_else(|| told("expected element NAME COUNT"))?;
                    elements.push(Element { name: name.to_vec(), count, properties: vec![], passed_over: vec![] });
                }
                ([b"property", words @ ..], _) => match elements.last_mut() {
                    Some(element) => element.property(words)?,
                    None => return Err(told("a property belongs to an element above it").into()),
                },
                ([b"end_header"], _) => {
                    elements.iter().try_for_each(Element::check)?;
                    if self.encoding == Encoding::Text {
                        self.line += 1;
                    }
                    return Ok(elements);
                }
                ([word, ..], _) => {
                    return Err(LineProblem::Ply(format!("unknown keyword {:?}", shown(word))).into());
                }
                ([], _) => {}
            }
        }
        Err(LineProblem::Ply("a header ends in a line end_header".to_owned()).into())
    }

    /// Reads all elements; an error comes with the element and its number.
    fn mesh(&mut self, elements: &[Element]) -> Result<Mesh, (String, Broken)> {
        let (mut mesh, mut faces) = (Mesh::default(), Faces::default());
        let mut vertices = Vertices::default();
        let mut corners = Vec::new();
        for element in elements {
            let vertex = element.name == b"vertex";
            let face = element.name == b"face";
            let place = |number| format!("{} {number} of {}", shown(&element.name), element.count);
            if element.count > 0 {
                let other = (!vertex && !face).then_some("other elements than vertex and face");
                let passed_over = element.passed_over.iter().copied().chain(other);
                passed_over.for_each(|told| {
                    if !mesh.passed_over.contains(&told) {
                        mesh.passed_over.push(told);
                    }
                });
            }
            if element.properties.is_empty() {
                continue;
            }
            let colored = element.has(3..6);
            for number in 1..=element.count {
                let broken = |broken| (place(number), broken);
                let (values, full) = self.element(element, &mut corners).map_err(broken)?;
                if !vertex && !face {
                    continue;
                }
                let color = DVec3::new(values[3], values[4], values[5]) / full;
                if colored && !color.to_array().iter().all(|channel| (0.0..=1.0).contains(channel)) {
                    return Err(broken(LineProblem::VertexColor(color.max_element()).into()));
                }
                let done = if vertex {
                    self.vertex(&mut vertices, &values, colored.then_some(color))
                } else {
                    let color = if colored { FaceColor::Plain(color) } else { FaceColor::Unsaid };
                    self.face(&mut mesh, &mut faces, &corners, &vertices, color)
                };
                done.map_err(|problem| broken(problem.into()))?;
            }
        }
        if mesh.triangles.is_empty() && mesh.flat == 0 && !vertices.is_empty() {
            let what = format!("a cloud of {} points; only faces are drawn", vertices.len());
            return Err((what.clone(), Broken::Line(LineProblem::Ply(what))));
        }
        Ok(mesh)
    }

    fn vertex(&self, vertices: &mut Vertices, values: &[f64; 6], color: Option<DVec3>) -> Result<(), LineProblem> {
        let position = DVec3::new(values[0], values[1], values[2]);
        if !position.is_finite() {
            return Err(LineProblem::Coordinate);
        }
        vertices.try_push(position, color).map_err(|_| LineProblem::MeshMemory)
    }

    fn face(
        &self,
        mesh: &mut Mesh,
        faces: &mut Faces,
        corners: &[usize],
        vertices: &Vertices,
        color: FaceColor,
    ) -> Result<(), LineProblem> {
        if corners.len() < 3 {
            return Err(LineProblem::Face(corners.len()));
        }
        match corners.iter().find(|&&corner| corner >= vertices.len()) {
            Some(&corner) => {
                let problem = format!("there is no vertex {corner} among the {} above, counted from 0", vertices.len());
                Err(LineProblem::Ply(problem))
            }
            None => faces.add(mesh, corners, vertices, color),
        }
    }

    /// Reads one element: its numbers by their roles, what a colour of 1 is, and its corners.
    fn element(&mut self, element: &Element, corners: &mut Vec<usize>) -> Result<([f64; 6], f64), Broken> {
        let (mut values, mut full) = ([0.0; 6], 1.0);
        corners.clear();
        for &Property { list, kind, role } in &element.properties {
            let count = match list {
                None => 1,
                Some(count) => whole(self.number(count)?)?,
            };
            for _ in 0..count {
                let value = self.number(kind)?;
                match role {
                    Role::Number(at) => {
                        values[at] = value;
                        if at >= 3 {
                            full = kind.full();
                        }
                    }
                    Role::Corners => {
                        corners.try_reserve(1).map_err(|_| LineProblem::MeshMemory)?;
                        let corner = usize::try_from(whole(value)?).unwrap_or(usize::MAX);
                        corners.push(corner);
                    }
                    Role::Nothing => {}
                }
            }
        }
        Ok((values, full))
    }

    fn number(&mut self, kind: Kind) -> Result<f64, Broken> {
        if self.encoding == Encoding::Text {
            self.next_word()?;
            return Ok(number(&self.word)?);
        }
        let mut bytes = [0; 8];
        let bytes = &mut bytes[..kind.size()];
        self.source.read_exact(bytes).map_err(Broken::Read)?;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        let mut wide = [0; 8];
        wide[..bytes.len()].copy_from_slice(bytes);
        let [a, b, c, d, ..] = wide;
        Ok(match kind {
            Kind::I8 => i8::from_le_bytes([a]).into(),
            Kind::U8 => a.into(),
            Kind::I16 => i16::from_le_bytes([a, b]).into(),
            Kind::U16 => u16::from_le_bytes([a, b]).into(),
            Kind::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Kind::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Kind::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Kind::F64 => f64::from_le_bytes(wide),
        })
    }

    /// Reads the next word of a text; lines do not matter.
    fn next_word(&mut self) -> Result<(), Broken> {
        self.word.clear();
        loop {
            let buffer = self.source.fill_buf().map_err(Broken::Read)?;
            if buffer.is_empty() {
                let ended = io::ErrorKind::UnexpectedEof.into();
                return if self.word.is_empty() { Err(Broken::Read(ended)) } else { Ok(()) };
            }
            let mut taken = 0;
            let mut done = false;
            for &byte in buffer {
                if byte.is_ascii_whitespace() {
                    if !self.word.is_empty() {
                        done = true;
                        break;
                    }
                    self.line += usize::from(byte == b'\n');
                } else {
                    if self.word.len() as u64 == LONGEST {
                        return Err(LineProblem::Number(shown(&self.word)).into());
                    }
                    self.word.push(byte);
                }
                taken += 1;
            }
            self.source.consume(taken);
            if done {
                return Ok(());
            }
        }
    }
}

/// A count or an index.
fn whole(value: f64) -> Result<u64, LineProblem> {
    if value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of 32 bits")]
        let whole = value as u64;
        return Ok(whole);
    }
    Err(LineProblem::Ply(format!("expected a count or an index, found {value}")))
}

#[cfg(test)]
mod tests {
    use rt_geom::Triangle;

    use super::*;

    fn parse(bytes: &[u8]) -> Result<Mesh, ImportError> {
        read(bytes, "a.ply")
    }

    const HEADER: &str = "comment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n\
        property list uchar int vertex_indices\nproperty float quality\nelement edge 1\nproperty int a\nend_header\n";

    /// The same square in each encoding.
    fn square(encoding: &str) -> Vec<u8> {
        let mut bytes = format!("ply\nformat {encoding} 1.0\n{HEADER}").into_bytes();
        let corners = [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let faces = [&[0, 1, 2][..], &[0, 1, 2, 3]];
        if encoding == "ascii" {
            for (k, [x, y]) in corners.iter().enumerate() {
                bytes.extend(format!("{x} {y} 0.25 255 {} 0\n", 51 * k).bytes());
            }
            bytes.extend(b"3 0 1 2 0.5\r\n4 0 1\n 2 3 0.5\n7\n");
            return bytes;
        }
        let big = encoding.contains("big");
        let mut put = |mut number: Vec<u8>| {
            if big {
                number.reverse();
            }
            bytes.extend(number);
        };
        for (k, [x, y]) in corners.iter().enumerate() {
            put(x.to_le_bytes().to_vec());
            put(y.to_le_bytes().to_vec());
            put(0.25_f64.to_le_bytes().to_vec());
            [255, 51 * u8::try_from(k).unwrap(), 0].into_iter().for_each(|channel| put(vec![channel]));
        }
        for face in faces {
            put(vec![u8::try_from(face.len()).unwrap()]);
            face.iter().for_each(|corner: &i32| put(corner.to_le_bytes().to_vec()));
            put(0.5_f32.to_le_bytes().to_vec());
        }
        put(7_i32.to_le_bytes().to_vec());
        bytes
    }

    #[test]
    fn the_three_encodings_give_the_same_mesh() {
        let text = parse(&square("ascii")).unwrap();
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.25);
        let first = Triangle::new(at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)).unwrap();
        assert_eq!((text.triangles.len(), text.triangles[0]), (3, first));
        let colors = [0.0, 0.2, 0.4].map(|green| DVec3::new(1.0, green, 0.0));
        assert_eq!(text.vertex_colors[0], Some(colors));
        assert_eq!(text.passed_over, ["other elements than vertex and face"]);
        for encoding in ["binary_little_endian", "binary_big_endian"] {
            assert_eq!(parse(&square(encoding)).unwrap(), text, "{encoding}");
        }
    }

    #[test]
    fn a_faces_color_takes_the_place_of_the_vertices() {
        let text = String::from_utf8(square("ascii")).unwrap();
        let text =
            text.replace("property float quality", "property float red\nproperty float green\nproperty float blue");
        let text = text.replace(" 0.5\r\n", " 0 0.5 1\n").replace(" 0.5\n7", " 1 0 0\n7");
        let colors = parse(text.as_bytes()).unwrap().vertex_colors;
        assert_eq!(colors[..2], [Some([DVec3::new(0.0, 0.5, 1.0); 3]), Some([DVec3::X; 3])]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        let text = String::from_utf8(square("ascii")).unwrap();
        for (from, to, message) in [
            ("ply\n", "plY\n", "a.ply:1: a PLY file begins with a line ply"),
            ("ascii", "morse", "a.ply:2: unknown format \"morse\""),
            ("float x", "half x", "a.ply:5: unknown type \"half\""),
            ("element vertex 4", "element vertex -4", "a.ply:4: expected element NAME COUNT"),
            ("element vertex 4\n", "", "a.ply:4: a property belongs to an element above it"),
            ("end_header\n", "", "a.ply:16: unknown keyword \"0\""),
            ("0 0 0.25", "0 nan 0.25", "a.ply:17: a coordinate must be finite"),
            ("0 0 0.25", "0 zero 0.25", "a.ply:17: expected a number, found \"zero\""),
            ("3 0 1 2", "3 0 1 4", "a.ply:21: there is no vertex 4 among the 4 above"),
            ("3 0 1 2", "3 0 1 -1", "a.ply:21: expected a count or an index, found -1"),
            ("3 0 1 2", "2 0 1", "a.ply:21: a face has at least 3 vertices, found 2"),
            ("255 0 0", "256 0 0", "a.ply:17: a color must be from 0 to 1"),
            ("vertex_indices", "corners", "a.ply:16: a face has the list vertex_indices"),
            ("double z", "double w", "a.ply:16: a vertex has the properties x, y and z"),
            ("element vertex 4", "element vertex 400", "a.ply: the file ends in vertex 7 of 400"),
            ("element face 2", "element tristrips 2", "a.ply:16: strips of triangles are not read"),
        ] {
            assert!(text.contains(from), "{from}");
            let error = parse(text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(message), "{from} to {to}: {error}");
        }
        let cloud = "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\nend_header\n1 2 3\n";
        assert!(parse(cloud.as_bytes()).unwrap_err().to_string().contains("a cloud of 1 points; only faces are drawn"));
        let mut binary = square("binary_big_endian");
        binary.truncate(binary.len() - 10);
        assert_eq!(parse(&binary).unwrap_err().to_string(), "a.ply: the file ends in face 2 of 2");
    }

    #[test]
    fn a_count_reserves_nothing() {
        for element in [
            "element x 99999999999999999\n",
            "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n",
        ] {
            for format in ["ascii", "binary_little_endian"] {
                let text = format!("ply\nformat {format} 1.0\n{element}end_header\n1 2 3");
                assert!(parse(text.as_bytes()).is_err(), "{text}");
            }
        }
    }
}

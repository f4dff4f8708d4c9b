//! Spheres from files of the Protein Data Bank, in its format of fixed columns.
//!
//! An atom is a line that begins with `ATOM` or `HETATM`: coordinates in columns 31 to 54, the element in 77 and 78. Old
//! files have a line number there, and many programs nothing; then the name in columns 13 to 16 tells: an element's
//! symbol ends in column 14, so that ` CA ` is carbon and `CA  ` calcium. A model ends at `ENDMDL` or `END`, and one of
//! several is read. The oxygen and hydrogen of water, known by its residue's name, are small and pale: else the water
//! around a molecule hides it. Alternate locations are all there; everything else is passed over.
//!
//! Source: Worldwide Protein Data Bank, "Protein Data Bank Contents Guide: Atomic Coordinate Entry Format", 3.30, 2012.

use std::io::BufRead;

use glam::DVec3;
use rt_geom::Sphere;

use super::blocks::next_record;
use super::elements::{self, ElementName};
use super::problem::{ImportError, LineProblem};
use super::spheres::{AtomColor, Names, Options, Palette, Spheres};
use super::words::{number, shown};
use crate::text::without_mark;

/// The colour of water, and its radius as a part of the element's.
const WATER: DVec3 = DVec3::new(0.62, 0.78, 0.92);
const WATER_RADIUS: f64 = 0.5;

/// Names of residues that are water.
const WATERS: [&[u8]; 14] =
    [b"HOH", b"WAT", b"H2O", b"DOD", b"D2O", b"HHO", b"OHH", b"SOL", b"TIP", b"TP3", b"TIP3", b"TIP4", b"TP4", b"SPC"];

/// Reads spheres from `source`, which errors call `name`.
///
/// # Errors
/// What is wrong, with the line.
pub fn read(mut source: impl BufRead, name: &str, options: Options) -> Result<Spheres, ImportError> {
    let mut reader =
        PdbReader { options, found: Spheres::default(), palette: Palette::default(), names: Names::default() };
    let (mut bytes, mut line) = (Vec::new(), 0);
    // The model that atoms belong to now, and whether it has any; it begins with its first atom.
    let (mut model, mut open, mut waters, mut more) = (0, false, 0, None);
    while next_record(&mut source, &mut bytes, &mut line, name)? {
        let refuse = |problem| ImportError::in_line(name, line, problem);
        let text = if line == 1 { without_mark(&bytes).map_err(|error| refuse(error.into()))? } else { &bytes };
        match text.get(..6).unwrap_or(text).trim_ascii_end() {
            b"ATOM" | b"HETATM" => {
                model += u64::from(!open);
                open = true;
                match model == options.frame {
                    true => waters += u64::from(reader.atom(text).map_err(refuse)?),
                    // The rest need not be read.
                    false if model > options.frame => {
                        more = Some(line);
                        break;
                    }
                    false => {}
                }
            }
            b"MODEL" | b"ENDMDL" | b"END" => open = false,
            _ => {}
        }
    }
    if reader.found.spheres.is_empty() && model > 0 {
        let problem = LineProblem::Frames { frame: options.frame, found: model };
        return Err(ImportError::in_line(name, line, problem));
    }
    let PdbReader { mut found, names, .. } = reader;
    found.warnings.extend(names.note());
    if waters > 0 && options.colored {
        let atoms = if waters == 1 { "atom of water is" } else { "atoms of water are" };
        found.notes.push(format!("{waters} {atoms} drawn small and pale"));
    }
    found.notes.extend(
        more.map(|line| format!("model {} is drawn; another one begins in line {line} (--frame)", options.frame)),
    );
    Ok(found)
}

/// Spheres that are being read.
struct PdbReader {
    options: Options,
    found: Spheres,
    palette: Palette,
    names: Names,
}

impl PdbReader {
    /// Reads an atom's line, and returns whether it is water, drawn small and pale.
    fn atom(&mut self, line: &[u8]) -> Result<bool, LineProblem> {
        let Options { scale, radius, colored, .. } = self.options;
        let column = |at: usize| -> Result<f64, LineProblem> {
            let text = line.get(at..(at + 8).min(line.len())).unwrap_or_default();
            number(text.trim_ascii()).map_err(|_| LineProblem::Columns8 { first: at + 1, found: shown(text) })
        };
        let center = scale * DVec3::new(column(30)?, column(38)?, column(46)?);
        if !center.is_finite() {
            return Err(LineProblem::NotFinite { name: "position", found: shown(&line[30..54.min(line.len())]) });
        }
        let residue = line.get(17..21).unwrap_or_default().trim_ascii();
        let (mut size, mut paint) = (radius, AtomColor::Nothing);
        let mut water = false;
        // An element has to be known only where something depends on it.
        if colored || radius.is_none() {
            let element = self.element(line, residue)?;
            water = radius.is_none() && matches!(element, 0 | 1 | 8) && WATERS.contains(&residue);
            let part = if water { WATER_RADIUS } else { 1.0 };
            size = size.or(Some(part * elements::radius(element)));
            paint = match (colored, water) {
                (false, _) => AtomColor::Nothing,
                (true, true) => AtomColor::Color(WATER),
                (true, false) => AtomColor::Element(element),
            };
        }
        let size = scale * size.ok_or(LineProblem::NoRadius)?;
        let sphere = Sphere::new(center, size)
            .map_err(|_| LineProblem::NotFinite { name: "radius", found: size.to_string() })?;
        let count = self.found.spheres.len() as u64;
        let no_memory = |_| LineProblem::SphereMemory(count);
        self.found.spheres.try_reserve(1).map_err(no_memory)?;
        self.found.color_indices.try_reserve(1).map_err(no_memory)?;
        self.found.spheres.push(sphere);
        self.found.color_indices.push(self.palette.index(paint, &mut self.found.colors)?);
        Ok(water)
    }

    /// The element of an atom: of its own columns, else of its name's.
    fn element(&mut self, line: &[u8], residue: &[u8]) -> Result<u8, LineProblem> {
        // In mixed case, in which two letters are never taken for a place in a protein.
        let plain = |letters: &[u8]| {
            let letters = [letters[..1].to_ascii_uppercase(), letters[1..].to_ascii_lowercase()].concat();
            match elements::find(&letters) {
                Some(ElementName::Plain(element) | ElementName::Label(element @ 0)) => Some(element),
                _ => None,
            }
        };
        let symbol = line.get(76..78.min(line.len())).unwrap_or_default().trim_ascii();
        if !symbol.is_empty()
            && symbol.iter().all(u8::is_ascii_alphabetic)
            && let Some(element) = plain(symbol)
        {
            return Ok(element);
        }
        let columns = line.get(12..16.min(line.len())).unwrap_or_default();
        let name = columns.trim_ascii();
        let found = match columns {
            // A symbol of one letter ends in column 14; before it there may be the digit of a hydrogen.
            [b' ' | b'0'..=b'9', letter, ..] if letter.is_ascii_alphabetic() => plain(&[*letter]),
            // Hydrogen takes all four columns.
            [b'H', _, third, fourth] if !third.is_ascii_whitespace() && !fourth.is_ascii_whitespace() => Some(1),
            // Ions have the name of their residue.
            [first, second, ..] if residue.eq_ignore_ascii_case(name) => plain(&[*first, *second]),
            // Many programs start the names of one letter's elements a column early. SE is selenium all the same.
            [first, second, ..] if elements::is_position(&[*first, *second]) && columns != b"SE  " => {
                let two = (name.len() == 2 && line.starts_with(b"HETATM")).then(|| plain(&[*first, *second])).flatten();
                two.filter(|&element| element <= elements::HEAVIEST).or_else(|| plain(&[*first]))
            }
            [first, second, ..] if *first != b'H' => plain(&[*first, *second]),
            _ => None,
        };
        if let Some(element) = found {
            return Ok(element);
        }
        match elements::find(name) {
            Some(ElementName::Plain(element)) => Ok(element),
            Some(ElementName::Label(element)) => {
                self.names.add(name, element);
                Ok(element)
            }
            None => Err(LineProblem::Element(shown(name))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str, options: Options) -> Result<Spheres, ImportError> {
        read(text.as_bytes(), "a.pdb", options)
    }

    /// A line of an atom: record, name in its four columns, residue, and the element's columns.
    fn atom(record: &str, name: &str, residue: &str, x: f64, element: &str) -> String {
        format!(
            "{record:<6}{:>5} {name:<4} {residue:<4}A   1    {x:8.3}{:8.3}{:8.3}{:24}{element:>2}\n",
            1, 0.0, -2.5, ""
        )
    }

    fn radii(found: &Spheres) -> Vec<f64> {
        found.spheres.iter().map(Sphere::radius).collect()
    }

    #[test]
    fn atoms_have_their_columns() {
        let text = "REMARK\n".to_owned()
            + &atom("ATOM", " CA ", "ALA", 1.25, " C")
            + "TER\n"
            + &atom("HETATM", "CA  ", " CA", -7.5, "CA")
            + "CONECT\nEND\n";
        let found = parse(&text, Options { scale: 2.0, ..Options::default() }).unwrap();
        let sphere = |x: f64, radius: f64| Sphere::new(DVec3::new(x, 0.0, -5.0), radius).unwrap();
        assert_eq!(found.spheres, [sphere(2.5, 3.54), sphere(-15.0, 5.24)]);
        assert!(found.notes.is_empty() && found.warnings.is_empty(), "{:?} {:?}", found.notes, found.warnings);
        // Cut off after the coordinates, and with the line ends of another system.
        let short = text.lines().map(|line| format!("{}\r\n", &line[..line.len().min(54)])).collect::<String>();
        let cut = parse(&short, Options { scale: 2.0, ..Options::default() }).unwrap();
        assert_eq!(cut.spheres, found.spheres);
    }

    #[test]
    fn without_an_elements_column_the_name_tells() {
        for (record, name, residue, radius) in [
            ("ATOM", " CA ", "GLY", 1.77),
            ("ATOM", " OXT", "GLY", 1.50),
            ("ATOM", "1HB ", "GLY", 1.20),
            ("ATOM", "HG11", "VAL", 1.20),
            ("ATOM", "HO5'", "DA", 1.20),
            ("ATOM", " SD ", "MET", 1.89),
            ("ATOM", "CA  ", "GLY", 1.77),
            ("ATOM", "N   ", "GLY", 1.66),
            ("HETATM", "CA  ", " CA", 2.62),
            ("HETATM", "FE  ", "HEM", 2.44),
            ("ATOM", "ZN  ", " ZN", 2.39),
            ("HETATM", " D  ", "LIG", 1.20),
            ("ATOM", "SE  ", "MSE", 1.82),
            ("ATOM", "NH1 ", "ARG", 1.66),
            ("ATOM", "OG1 ", "THR", 1.50),
            ("HETATM", "SG  ", "LIG", 1.89),
            ("ATOM", "CL  ", "LIG", 1.82),
            ("HETATM", "HG  ", "LIG", 2.45),
            ("HETATM", "H12 ", "LIG", 1.20),
        ] {
            // What old files have in the element's columns is no element.
            for element in ["", "17", " 6"] {
                let name_of = |text: &str| parse(text, Options::default()).map(|found| radii(&found));
                let text = atom(record, name, residue, 0.0, element);
                assert_eq!(name_of(&text).unwrap(), [radius], "{text}");
            }
        }
        let error = parse(&atom("ATOM", "??", "LIG", 0.0, ""), Options::default()).unwrap_err().to_string();
        assert!(error.starts_with("a.pdb:1: unknown element \"??\""), "{error}");
    }

    #[test]
    fn water_is_small_and_pale_unless_its_radius_is_given() {
        let text = atom("HETATM", " O  ", "HOH", 0.0, " O") + &atom("ATOM", " OW ", "SOL", 1.0, "");
        let found = parse(&text, Options::default()).unwrap();
        assert_eq!((radii(&found), &found.colors[..]), (vec![0.75, 0.75], &[WATER][..]));
        assert_eq!(found.notes, ["2 atoms of water are drawn small and pale"]);
        let given = parse(&text, Options { radius: Some(1.0), ..Options::default() }).unwrap();
        assert_eq!((radii(&given), given.colors.len(), given.notes.len()), (vec![1.0, 1.0], 1, 0));
        assert_ne!(given.colors, [WATER]);
    }

    #[test]
    fn one_model_of_several_is_read() {
        let model = |x: f64| atom("ATOM", " N  ", "GLY", x, " N");
        let models = format!("MODEL 1\n{}{}ENDMDL\nMODEL 2\n{}ENDMDL\nEND\n", model(1.0), model(2.0), model(3.0));
        // As some programs write a trajectory.
        let ends = format!("{}{}END\n{}END\n", model(1.0), model(2.0), model(3.0));
        for (text, line) in [(models, 6), (ends, 4)] {
            let xs = |frame| {
                let found = parse(&text, Options { frame, ..Options::default() })?;
                Ok::<_, ImportError>((found.spheres.iter().map(|s| s.center().x).collect::<Vec<_>>(), found.notes))
            };
            let note = format!("model 1 is drawn; another one begins in line {line} (--frame)");
            assert_eq!(xs(1).unwrap(), (vec![1.0, 2.0], vec![note]));
            assert_eq!(xs(2).unwrap(), (vec![3.0], vec![]));
            let error = xs(3).unwrap_err().to_string();
            assert!(error.ends_with("there is no frame 3; the file has 2"), "{error}");
        }
    }

    #[test]
    fn what_is_no_number_is_told_with_its_columns() {
        let good = atom("ATOM", " N  ", "GLY", 1.0, " N");
        for (bad, found) in [("  1.0x  ", "1.0x"), ("        ", ""), ("     nan", "nan")] {
            let text = good.clone() + &good.replace("   1.000", bad);
            let error = parse(&text, Options::default()).unwrap_err().to_string();
            let number = format!("a.pdb:2: expected a number in columns 31 to 38, found \"{found}\"");
            assert!(error == number || (bad.contains("nan") && error.starts_with("a.pdb:2: position")), "{error}");
        }
        let error = parse(&"x".repeat(1 << 20), Options::default()).unwrap_err().to_string();
        assert_eq!(error, "a.pdb:1: a line is longer than 65535 bytes");
        assert!(parse("ATOM", Options::default()).is_err());
    }
}

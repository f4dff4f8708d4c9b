//! The chemical elements: symbol, radius and colour.
//!
//! Radii are van der Waals radii in angstrom, from S. Alvarez, "A cartography of the van der Waals territories", Dalton
//! Transactions 42, 8617 (2013); the elements without one there (Pm, Po to Ra, Fm and beyond) have 2. Colours are those
//! of the Jmol viewer, the element page of its documentation; Ds and beyond, without one there, share one pink.

use glam::DVec3;

/// What a name stands for: the position in the table, which is the atomic number, 0 for a dummy atom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ElementName {
    /// A symbol or an atomic number, as expected.
    Plain(u8),
    /// A label, read by a rule that could be wrong about it.
    Label(u8),
}

/// Finds what a name stands for. `docs/scene-format.md` has the rule for those who write files:
///
/// 1. A number is the atomic number.
/// 2. Else the first run of letters counts. As a whole and in any case it is a symbol, `D` or `T`, or names a dummy
///    atom.
/// 3. In capitals alone or small letters alone, two to four: the first two are the symbol if there is one, else the
///    first. Here `CA`, `CD1`, `HG2`, which look like a position in a protein, are their first letter; so are they
///    under 2, but for a name of no more than the two letters and an element up to uranium.
/// 4. With a capital first: the symbol of two letters before another capital; of two letters that are no symbol, the
///    first.
///
/// Two letters look like a position in a protein where the first is H, or one of C, N, O, S with A, B, D, E, G, H or Z,
/// for the Greek letters.
pub(crate) fn find(name: &[u8]) -> Option<ElementName> {
    if name.first()?.is_ascii_digit() && name.iter().all(u8::is_ascii_digit) {
        let number = std::str::from_utf8(name).ok()?.parse::<u8>().ok()?;
        return match usize::from(number) {
            0 => Some(ElementName::Label(0)),
            n if n < ELEMENTS.len() => Some(ElementName::Plain(number)),
            _ => None,
        };
    }
    let start = name.iter().position(|byte| !byte.is_ascii_digit())?;
    let letters = &name[start..];
    let length = letters.iter().position(|byte| !byte.is_ascii_alphabetic()).unwrap_or(letters.len());
    let letters = &letters[..length];
    let bare = length == name.len();
    let small = |at: usize| letters.get(at).is_some_and(u8::is_ascii_lowercase);
    let capital = |at: usize| letters.get(at).is_some_and(u8::is_ascii_uppercase);
    let one_case = (0..length).all(capital) || (0..length).all(small);
    if let Some(element) = by_symbol(letters) {
        match (bare, one_case && is_position(letters)) {
            (true, false) => return Some(ElementName::Plain(element)),
            (false, true) => {}
            // SG is sulfur's position and not seaborgium.
            (true, true) if element > HEAVIEST => {}
            _ => return Some(ElementName::Label(element)),
        }
    }
    if [&b"D"[..], b"T"].iter().any(|isotope| letters.eq_ignore_ascii_case(isotope)) {
        return Some(if bare { ElementName::Plain(1) } else { ElementName::Label(1) });
    }
    if DUMMIES.iter().any(|dummy| letters.eq_ignore_ascii_case(dummy.as_bytes())) {
        return Some(ElementName::Label(0));
    }
    let first = || by_symbol(&letters[..1]);
    let element = if one_case && (2..=4).contains(&length) {
        by_symbol(&letters[..2]).filter(|_| !is_position(&letters[..2])).or_else(first)
    } else if capital(0) && small(1) && capital(2) {
        by_symbol(&letters[..2])
    } else if capital(0) && small(1) && length == 2 {
        first()
    } else {
        None
    };
    element.map(ElementName::Label)
}

/// Names that were found before, so that [`find`] is asked once for most.
#[derive(Clone)]
pub(crate) struct Found([(u64, Option<ElementName>); 64]);

impl Default for Found {
    fn default() -> Self {
        Self([(0, None); 64])
    }
}

impl Found {
    /// What [`find`] gives.
    #[inline]
    pub(crate) fn find(&mut self, name: &[u8]) -> Option<ElementName> {
        if !(1..8).contains(&name.len()) {
            return find(name);
        }
        // The bytes and how many they are: no two names of up to seven bytes have the same key, and none has the key 0.
        let key = name.iter().fold(name.len() as u64, |key, &byte| key << 8 | u64::from(byte));
        let place = (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 58) as usize;
        let (known, element) = &mut self.0[place];
        if *known != key {
            (*known, *element) = (key, find(name));
        }
        *element
    }
}

/// Uranium: heavier elements do not occur in molecules.
pub(super) const HEAVIEST: u8 = 92;

/// Whether two letters look like a position in a protein.
pub(super) fn is_position(letters: &[u8]) -> bool {
    let [first, second] = letters else { return false };
    match first.to_ascii_uppercase() {
        b'H' => true,
        b'C' | b'N' | b'O' | b'S' => b"ABDEGHZ".contains(&second.to_ascii_uppercase()),
        _ => false,
    }
}

/// Names of points that are no atoms: of unknown kind, of centers, of ghosts, of lone pairs and other sites of charge.
const DUMMIES: [&str; 10] = ["X", "XX", "DU", "DUM", "Q", "BQ", "EP", "LP", "M", "MW"];

/// The element with this symbol of one or two letters, in any case.
fn by_symbol(letters: &[u8]) -> Option<u8> {
    let place = |letter: &u8| usize::from(letter.to_ascii_uppercase().wrapping_sub(b'A'));
    let (first, second) = match letters {
        [first] => (place(first), 0),
        [first, second] => (place(first), 1 + place(second)),
        _ => return None,
    };
    SYMBOLS.get(first)?.get(second).copied().filter(|&element| element != 0)
}

/// The element for each first letter and second letter, from 1; no second letter is 0. No element is 0.
const SYMBOLS: [[u8; 27]; 26] = {
    let mut symbols = [[0; 27]; 26];
    let mut number = 1;
    while number < ELEMENTS.len() {
        let symbol = ELEMENTS[number].0.as_bytes();
        let second = if symbol.len() == 1 { 0 } else { symbol[1] - b'a' + 1 };
        #[expect(clippy::cast_possible_truncation, reason = "there are 118 elements")]
        let element = number as u8;
        symbols[(symbol[0] - b'A') as usize][second as usize] = element;
        number += 1;
    }
    symbols
};

/// What an element that [`find`] gave is called in messages.
pub(crate) fn symbol(element: u8) -> &'static str {
    ELEMENTS[usize::from(element)].0
}

/// The van der Waals radius in angstrom of an element that [`find`] gave.
pub(crate) fn radius(element: u8) -> f64 {
    ELEMENTS[usize::from(element)].1
}

/// The colour of an element that [`find`] gave.
pub(crate) fn color(element: u8) -> DVec3 {
    let [_, red, green, blue] = ELEMENTS[usize::from(element)].2.to_be_bytes();
    DVec3::new(red.into(), green.into(), blue.into()) / 255.0
}

/// Symbol, radius in angstrom, colour as 0xRRGGBB; in the order of the atomic number. A dummy atom is small and grey.
#[rustfmt::skip]
const ELEMENTS: [(&str, f64, u32); 119] = [
    ("a dummy atom", 0.5, 0x808080),
    ("H", 1.20, 0xffffff), ("He", 1.43, 0xd9ffff), ("Li", 2.12, 0xcc80ff), ("Be", 1.98, 0xc2ff00),
    ("B", 1.91, 0xffb5b5), ("C", 1.77, 0x909090), ("N", 1.66, 0x3050f8), ("O", 1.50, 0xff0d0d),
    ("F", 1.46, 0x90e050), ("Ne", 1.58, 0xb3e3f5), ("Na", 2.50, 0xab5cf2), ("Mg", 2.51, 0x8aff00),
    ("Al", 2.25, 0xbfa6a6), ("Si", 2.19, 0xf0c8a0), ("P", 1.90, 0xff8000), ("S", 1.89, 0xffff30),
    ("Cl", 1.82, 0x1ff01f), ("Ar", 1.83, 0x80d1e3), ("K", 2.73, 0x8f40d4), ("Ca", 2.62, 0x3dff00),
    ("Sc", 2.58, 0xe6e6e6), ("Ti", 2.46, 0xbfc2c7), ("V", 2.42, 0xa6a6ab), ("Cr", 2.45, 0x8a99c7),
    ("Mn", 2.45, 0x9c7ac7), ("Fe", 2.44, 0xe06633), ("Co", 2.40, 0xf090a0), ("Ni", 2.40, 0x50d050),
    ("Cu", 2.38, 0xc88033), ("Zn", 2.39, 0x7d80b0), ("Ga", 2.32, 0xc28f8f), ("Ge", 2.29, 0x668f8f),
    ("As", 1.88, 0xbd80e3), ("Se", 1.82, 0xffa100), ("Br", 1.86, 0xa62929), ("Kr", 2.25, 0x5cb8d1),
    ("Rb", 3.21, 0x702eb0), ("Sr", 2.84, 0x00ff00), ("Y", 2.75, 0x94ffff), ("Zr", 2.52, 0x94e0e0),
    ("Nb", 2.56, 0x73c2c9), ("Mo", 2.45, 0x54b5b5), ("Tc", 2.44, 0x3b9e9e), ("Ru", 2.46, 0x248f8f),
    ("Rh", 2.44, 0x0a7d8c), ("Pd", 2.15, 0x006985), ("Ag", 2.53, 0xc0c0c0), ("Cd", 2.49, 0xffd98f),
    ("In", 2.43, 0xa67573), ("Sn", 2.42, 0x668080), ("Sb", 2.47, 0x9e63b5), ("Te", 1.99, 0xd47a00),
    ("I", 2.04, 0x940094), ("Xe", 2.06, 0x429eb0), ("Cs", 3.48, 0x57178f), ("Ba", 3.03, 0x00c900),
    ("La", 2.98, 0x70d4ff), ("Ce", 2.88, 0xffffc7), ("Pr", 2.92, 0xd9ffc7), ("Nd", 2.95, 0xc7ffc7),
    ("Pm", 2.0, 0xa3ffc7), ("Sm", 2.90, 0x8fffc7), ("Eu", 2.87, 0x61ffc7), ("Gd", 2.83, 0x45ffc7),
    ("Tb", 2.79, 0x30ffc7), ("Dy", 2.87, 0x1fffc7), ("Ho", 2.81, 0x00ff9c), ("Er", 2.83, 0x00e675),
    ("Tm", 2.79, 0x00d452), ("Yb", 2.80, 0x00bf38), ("Lu", 2.74, 0x00ab24), ("Hf", 2.63, 0x4dc2ff),
    ("Ta", 2.53, 0x4da6ff), ("W", 2.57, 0x2194d6), ("Re", 2.49, 0x267dab), ("Os", 2.48, 0x266696),
    ("Ir", 2.41, 0x175487), ("Pt", 2.29, 0xd0d0e0), ("Au", 2.32, 0xffd123), ("Hg", 2.45, 0xb8b8d0),
    ("Tl", 2.47, 0xa6544d), ("Pb", 2.60, 0x575961), ("Bi", 2.54, 0x9e4fb5), ("Po", 2.0, 0xab5c00),
    ("At", 2.0, 0x754f45), ("Rn", 2.0, 0x428296), ("Fr", 2.0, 0x420066), ("Ra", 2.0, 0x007d00),
    ("Ac", 2.80, 0x70abfa), ("Th", 2.93, 0x00baff), ("Pa", 2.88, 0x00a1ff), ("U", 2.71, 0x008fff),
    ("Np", 2.82, 0x0080ff), ("Pu", 2.81, 0x006bff), ("Am", 2.83, 0x545cf2), ("Cm", 3.05, 0x785ce3),
    ("Bk", 3.40, 0x8a4fe3), ("Cf", 3.05, 0xa136d4), ("Es", 2.70, 0xb31fd4), ("Fm", 2.0, 0xb31fba),
    ("Md", 2.0, 0xb30da6), ("No", 2.0, 0xbd0d87), ("Lr", 2.0, 0xc70066), ("Rf", 2.0, 0xcc0059),
    ("Db", 2.0, 0xd1004f), ("Sg", 2.0, 0xd90045), ("Bh", 2.0, 0xe00038), ("Hs", 2.0, 0xe6002e),
    ("Mt", 2.0, 0xeb0026), ("Ds", 2.0, 0xff1493), ("Rg", 2.0, 0xff1493), ("Cn", 2.0, 0xff1493),
    ("Nh", 2.0, 0xff1493), ("Fl", 2.0, 0xff1493), ("Mc", 2.0, 0xff1493), ("Lv", 2.0, 0xff1493),
    ("Ts", 2.0, 0xff1493), ("Og", 2.0, 0xff1493),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn number(name: &str) -> Option<u8> {
        find(name.as_bytes()).map(|(ElementName::Plain(number) | ElementName::Label(number))| number)
    }

    #[test]
    fn symbols_and_numbers_are_plain() {
        for (name, number) in
            [("H", 1), ("C", 6), ("c", 6), ("Cl", 17), ("CL", 17), ("8", 8), ("U", 92), ("118", 118), ("D", 1)]
        {
            assert_eq!(find(name.as_bytes()), Some(ElementName::Plain(number)), "{name}");
        }
        for name in ["", "119", "400", "1.5", "99999999999999999999", "-1", "Å", "\0", "'"] {
            assert_eq!(number(name), None, "{name}");
        }
    }

    #[test]
    fn labels_are_read_by_the_rule() {
        for (expected, names) in [
            (0, "X X1 Xx Du Q Bq MW 0"),
            (1, "HW1 HW2 hw H_ 2H D2 1HB HO2' HG1"),
            (6, "C1 C.ar 13C CB CG1 CD1 CE1 CA1 CAA"),
            (7, "NZ NE2"),
            (8, "OW Ow O2- OXT OG"),
            (11, "Na+"),
            (16, "SG1 SG"),
            (17, "CL1 CLA Cl1"),
            (20, "CA Ca2+ CaA"),
            (26, "FE1 Fe3+"),
        ] {
            for name in names.split(' ') {
                assert_eq!(find(name.as_bytes()), Some(ElementName::Label(expected)), "{name}");
            }
        }
        assert_eq!(find(b"Ca"), Some(ElementName::Plain(20)));
        for name in ["Qq", "Carbon", "Unobtainium", "Jx", "ZZ", "Rq7", "WATER", "Cab", "1e5", "x3y", "_C"] {
            let expected = (name == "x3y").then_some(0);
            assert_eq!(number(name), expected, "{name}");
        }
    }

    #[test]
    fn what_was_found_is_found_again() {
        let mut found = Found::default();
        let mut random = oracle::Random::new(4);
        for _ in 0..100_000 {
            let length = random.below(9);
            let name: Vec<u8> = (0..length).map(|_| random.pick(b"CaHOW1x9\0\xff")).collect();
            assert_eq!(found.find(&name), find(&name), "{name:?}");
        }
    }

    #[test]
    fn carbon_and_oxygen_are_as_published() {
        let (carbon, oxygen) = (6, 8);
        assert_eq!((radius(carbon), color(carbon)), (1.77, DVec3::splat(144.0 / 255.0)));
        assert_eq!((radius(oxygen), color(oxygen)), (1.50, DVec3::new(255.0, 13.0, 13.0) / 255.0));
    }

    #[test]
    fn every_radius_and_symbol_is_plausible_and_its_own() {
        for (index, (symbol, radius, _)) in ELEMENTS.iter().enumerate().skip(1) {
            assert!((1.0..4.0).contains(radius), "{symbol}: {radius}");
            assert_eq!(number(symbol).map(usize::from), Some(index), "{symbol}");
        }
    }
}

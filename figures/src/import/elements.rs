//! The chemical elements: symbol, radius and colour.
//!
//! Radii are van der Waals radii in angstrom, from S. Alvarez, "A cartography of the van der Waals territories", Dalton
//! Transactions 42, 8617 (2013); the elements without one there (Pm, Po to Ra, Fm and beyond) have 2. Colours are those of
//! the Jmol viewer, the element page of its documentation; Ds and beyond, without one there, share one pink.

use glam::DVec3;

/// Returns the position of the element in the table: by its symbol in any case, or by its atomic number.
pub(crate) fn find(name: &[u8]) -> Option<u8> {
    let number = if name.first()?.is_ascii_digit() {
        std::str::from_utf8(name).ok()?.parse::<usize>().ok()?.checked_sub(1)?
    } else {
        ELEMENTS.iter().position(|(symbol, ..)| symbol.as_bytes().eq_ignore_ascii_case(name))?
    };
    u8::try_from(number).ok().filter(|&number| usize::from(number) < ELEMENTS.len())
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

/// Symbol, radius in angstrom, colour as 0xRRGGBB; in the order of the atomic number.
#[rustfmt::skip]
const ELEMENTS: [(&str, f64, u32); 118] = [
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

    #[test]
    fn elements_are_found_by_symbol_and_number() {
        for (name, number) in
            [("H", 1), ("C", 6), ("c", 6), ("Cl", 17), ("CL", 17), ("8", 8), ("U", 92), ("118", 118)]
        {
            assert_eq!(find(name.as_bytes()), Some(number - 1), "{name}");
        }
        for name in ["", "X", "Xx", "CA1", "0", "119", "400", "1.5", "99999999999999999999"] {
            assert_eq!(find(name.as_bytes()), None, "{name}");
        }
    }

    #[test]
    fn carbon_and_oxygen_are_as_published() {
        let carbon = find(b"C").unwrap();
        assert_eq!((radius(carbon), color(carbon)), (1.77, DVec3::splat(144.0 / 255.0)));
        let oxygen = find(b"O").unwrap();
        assert_eq!((radius(oxygen), color(oxygen)), (1.50, DVec3::new(255.0, 13.0, 13.0) / 255.0));
    }

    #[test]
    fn every_radius_and_symbol_is_plausible_and_its_own() {
        for (index, (symbol, radius, _)) in ELEMENTS.iter().enumerate() {
            assert!((1.0..4.0).contains(radius), "{symbol}: {radius}");
            assert_eq!(find(symbol.as_bytes()).map(usize::from), Some(index), "{symbol}");
        }
    }
}

//! Random 3 x 3 matrices of every class that is hard for a pseudo-inverse, made on purpose.

use glam::{DMat3, DVec3};

use crate::Random;

fn matrix(random: &mut Random, mut entry: impl FnMut(&mut Random) -> f64) -> DMat3 {
    DMat3::from_cols_array(&[(); 9].map(|()| entry(random)))
}

fn vector(random: &mut Random, mut entry: impl FnMut(&mut Random) -> f64) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| entry(random)))
}

/// The matrix with its rows and columns shuffled, transposed or not, and some signs changed.
fn shuffled(random: &mut Random, m: DMat3) -> DMat3 {
    let mut m = m;
    for _ in 0..2 {
        let mut columns = [m.x_axis, m.y_axis, m.z_axis];
        random.shuffle(&mut columns);
        m = DMat3::from_cols_array_2d(&columns.map(|column| (column * random.sign()).to_array()));
        if random.one_in(2) {
            m = m.transpose();
        }
    }
    m
}

/// A class of matrices: its name, and one more of its kind.
pub type Class = (&'static str, fn(&mut Random) -> DMat3);

/// Every class, named.
pub const CLASSES: &[Class] = &[
    ("benign", benign),
    ("affine", affine),
    ("small_integers", small_integers),
    ("graded", graded),
    ("ill_conditioned", ill_conditioned),
    ("cancelling_determinant", cancelling_determinant),
    ("rank_two", rank_two),
    ("rank_one", rank_one),
    ("rank_zero", rank_zero),
    ("last_bits", last_bits),
    ("hilbert", hilbert),
    ("any_exponent", any_exponent),
    ("any_exponent_singular", any_exponent_singular),
    ("both_ends", both_ends),
    ("ends_of_the_range", ends_of_the_range),
    ("subnormal", subnormal),
    ("sparse", sparse),
    ("permuted_diagonal", permuted_diagonal),
    ("midpoints", midpoints),
];

fn benign(random: &mut Random) -> DMat3 {
    matrix(random, Random::uniform)
}

/// Rotation times scale, as in scenes; also the vertices of a triangle somewhere.
fn affine(random: &mut Random) -> DMat3 {
    let axis = random.point().normalize_or(DVec3::X);
    let rotation = DMat3::from_axis_angle(axis, 3.0 * random.uniform());
    match random.below(3) {
        0 => rotation,
        1 => rotation * DMat3::from_diagonal(vector(random, |r| 10f64.powf(2.0 * r.uniform()))),
        _ => {
            let far = 100.0 * random.point();
            DMat3::from_cols(far, far + random.point(), far + random.point())
        }
    }
}

fn small_integers(random: &mut Random) -> DMat3 {
    let limit = 1 + random.bits() % 12;
    matrix(random, |r| r.small(limit))
}

/// Rows and columns scaled by anything from 1e-100 to 1e100.
fn graded(random: &mut Random) -> DMat3 {
    let core = match random.below(4) {
        0 => small_integers(random),
        1 => last_bits(random),
        _ => benign(random),
    };
    let decade = |r: &mut Random| 10f64.powf(100.0 * r.uniform());
    let (rows, columns) = (vector(random, decade), vector(random, decade));
    DMat3::from_diagonal(rows) * core * DMat3::from_diagonal(columns)
}

/// A matrix of rank 1 or 2, rounded, plus noise of 2^-10 to 2^-60.
fn ill_conditioned(random: &mut Random) -> DMat3 {
    let mut m = outer(random.point(), random.point());
    if random.one_in(2) {
        m += outer(random.point(), random.point());
    }
    let noise = random.power(-60..-9);
    let m = m + matrix(random, Random::uniform) * noise;
    m * random.power(-100..101)
}

/// Determinants that lose some 40 bits, while the cofactors lose none: double-double just about decides the entries.
fn cancelling_determinant(random: &mut Random) -> DMat3 {
    let mut pair = || outer(random.point(), random.point());
    let m = pair() + pair();
    let noise = random.power(-44..-33);
    m + matrix(random, Random::uniform) * noise
}

fn outer(u: DVec3, v: DVec3) -> DMat3 {
    DMat3::from_cols(u * v.x, u * v.y, u * v.z)
}

/// Exactly singular, nearly always of rank 2.
fn rank_two(random: &mut Random) -> DMat3 {
    let integer = |r: &mut Random| r.small(1 << 25);
    let m = match random.below(6) {
        // A product of integers that is exact.
        0 => {
            outer(vector(random, integer), vector(random, integer))
                + outer(vector(random, integer), vector(random, integer))
        }
        // Small integers.
        1 => {
            let limit = 1 + random.bits() % 20;
            let digit = |r: &mut Random| r.small(limit);
            outer(vector(random, digit), vector(random, digit)) + outer(vector(random, digit), vector(random, digit))
        }
        // A column twice, up to a power of two.
        2 => {
            let (u, v) = (random.point(), random.point());
            DMat3::from_cols(u, v, u * random.power(-40..41))
        }
        // A sum of two columns, or a difference, exact in 50 bits each.
        3 => {
            let short = |r: &mut Random| r.small(1 << 50);
            let (u, v) = (vector(random, short), vector(random, short));
            DMat3::from_cols(u, v, u + v * random.sign() * random.power(0..2))
        }
        // A column and a row of zeros: a 2 x 2 inverse.
        4 => {
            let [a, b, c, d] = [(); 4].map(|()| random.uniform());
            DMat3::from_cols_array(&[a, b, 0.0, c, d, 0.0, 0.0, 0.0, 0.0])
        }
        // One column of zeros.
        _ => DMat3::from_cols(random.point(), random.point(), DVec3::ZERO),
    };
    let scale = random.power(-100..101);
    shuffled(random, m * scale)
}

/// Exactly of rank 1, in a few cases 0.
fn rank_one(random: &mut Random) -> DMat3 {
    let m = match random.below(4) {
        0 => outer(vector(random, |r| r.small(1 << 26)), vector(random, |r| r.small(1 << 26))),
        1 => outer(vector(random, |r| r.small(9)), vector(random, |r| r.small(9))),
        2 => outer(random.point(), vector(random, |r| r.sign() * r.power(-20..21))),
        _ => DMat3::from_cols(random.point(), DVec3::ZERO, DVec3::ZERO),
    };
    let scale = random.power(-200..201);
    shuffled(random, m * scale)
}

fn rank_zero(random: &mut Random) -> DMat3 {
    matrix(random, |r| 0.0 * r.sign())
}

/// A singular matrix with one to three entries moved by a few units in the last place.
fn last_bits(random: &mut Random) -> DMat3 {
    let m = if random.one_in(4) { rank_one(random) } else { rank_two(random) };
    let mut entries = m.to_cols_array();
    for _ in 0..random.integer(1..4) {
        let k = random.below(9);
        if entries[k] != 0.0 {
            let moved = entries[k].to_bits().wrapping_add_signed(random.integer(-2..3).into());
            entries[k] = f64::from_bits(moved);
        }
    }
    DMat3::from_cols_array(&entries)
}

/// Pieces of Hilbert's matrix `1 / (i + j + 1)`: rounded entries, or whole numbers after multiplication by 360360.
fn hilbert(random: &mut Random) -> DMat3 {
    let (first, step) = (random.integer(1..2001), random.integer(1..4));
    let whole = random.one_in(2);
    let mut m = DMat3::ZERO;
    for i in 0..3u8 {
        for j in 0..3u8 {
            let n = f64::from(first + step * i32::from(i + j));
            m.col_mut(j.into())[i.into()] = if whole { (360_360.0 / n).floor() } else { 1.0 / n };
        }
    }
    shuffled(random, m)
}

fn any_exponent(random: &mut Random) -> DMat3 {
    matrix(random, Random::finite)
}

/// Exactly singular, with exponents from end to end.
fn any_exponent_singular(random: &mut Random) -> DMat3 {
    let two = [random.finite_point(), random.finite_point()];
    let m = match random.below(3) {
        0 => DMat3::from_cols(two[0], two[1], DVec3::ZERO),
        1 => DMat3::from_cols(two[0], two[1], two[0]),
        _ => DMat3::from_cols(two[0], -two[0], two[0]),
    };
    shuffled(random, m)
}

/// The largest and the smallest doubles in one matrix: the longest integers. Regular, or a column twice.
fn both_ends(random: &mut Random) -> DMat3 {
    let entry = |r: &mut Random| match r.below(4) {
        0 => r.sign() * f64::from_bits(r.bits() % 16),
        1 => r.sign() * f64::MAX,
        _ => r.sign() * f64::from_bits(f64::MAX.to_bits() - r.bits() % (1 << 53)),
    };
    let [u, v, w] = [(); 3].map(|()| vector(random, entry));
    let m = DMat3::from_cols(u, v, if random.one_in(2) { u } else { w });
    shuffled(random, m)
}

/// Benign or singular matrices scaled so that they, or their inverses, overflow and underflow.
fn ends_of_the_range(random: &mut Random) -> DMat3 {
    let m = match random.below(4) {
        0 => rank_two(random),
        1 => rank_one(random),
        2 => affine(random),
        _ => small_integers(random),
    };
    let top = m.to_cols_array().into_iter().fold(0.0, |top: f64, x| top.max(x.abs()));
    let unit = if top > 0.0 { m * (1.0 / top) } else { m };
    let exponent = if random.one_in(2) { random.integer(1015..1024) } else { random.integer(-1074..-1009) };
    (unit * 0.999) * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
}

/// Subnormal entries, alone or with ordinary ones.
fn subnormal(random: &mut Random) -> DMat3 {
    let bits = random.integer(1..55);
    let all = random.one_in(2);
    matrix(random, |r| {
        let tiny = r.sign() * f64::from_bits(r.bits() >> (64 - bits));
        if all || r.one_in(2) { tiny } else { r.uniform() * r.power(-1000..4) }
    })
}

/// Few entries that are not zero, zeros of both signs.
fn sparse(random: &mut Random) -> DMat3 {
    matrix(random, |r| match r.below(8) {
        0 => r.sign(),
        1 => r.sign() * r.power(-1074..1024),
        2 => r.uniform(),
        3 => r.finite(),
        _ => 0.0 * r.sign(),
    })
}

fn permuted_diagonal(random: &mut Random) -> DMat3 {
    let diagonal = match random.below(4) {
        0 => vector(random, Random::sign),
        1 => vector(random, |r| r.power(-1074..1024)),
        2 => random.point(),
        _ => random.finite_point(),
    };
    shuffled(random, DMat3::from_diagonal(diagonal))
}

/// Inverses with an entry exactly halfway between two doubles, or one unit of the last place of the minor beside it.
fn midpoints(random: &mut Random) -> DMat3 {
    let m = if random.one_in(2) {
        // The inverse of this triangle holds a c - b = M, an odd number of 54 bits.
        let wanted = (1_i64 << 53 | 1 | i64::try_from(random.bits() >> 11).expect("53 bits"))
            + i64::from(random.integer(-1..2)) * i64::from(random.integer(0..2));
        let a = i64::from(random.integer(1 << 26..1 << 27));
        let c = wanted / a + i64::from(random.integer(-2..3));
        let b = a * c - wanted;
        DMat3::from_cols_array(&[1.0, 0.0, 0.0, a as f64, 1.0, 0.0, b as f64, c as f64, 1.0])
    } else {
        DMat3::from_cols_array(&[1.0, 0.0, 0.0, random.uniform(), 1.0, 0.0, random.uniform(), 0.0, random.small(1)])
    };
    // Powers of two at rows and columns keep the halfway points, down to the subnormals and up to overflow.
    let limit = [0, 30, 520][random.below(3)];
    let power = |r: &mut Random| r.power(-limit..limit + 1);
    let (rows, columns) = (vector(random, power), vector(random, power));
    let m = DMat3::from_diagonal(rows) * m * DMat3::from_diagonal(columns);
    let m = if m.is_finite() { m } else { DMat3::from_diagonal(rows) };
    shuffled(random, m)
}

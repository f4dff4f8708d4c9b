//! Random 3 x 3 matrices of every class that is hard for a pseudo-inverse, made on purpose.

use glam::{DMat3, DVec3};

/// The generator `SplitMix64`: small, fast, and the same numbers on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer from `low` to `high`, both included.
    pub(crate) fn integer(&mut self, low: i64, high: i64) -> i64 {
        low + i64::try_from(self.bits() % u64::try_from(high - low + 1).unwrap()).unwrap()
    }

    fn small(&mut self, limit: i64) -> f64 {
        self.integer(-limit, limit) as f64
    }

    /// A number in -1..1 with a full mantissa.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2f64.powi(-52) - 1.0
    }

    /// Any finite double, each bit pattern as likely as any other.
    fn finite(&mut self) -> f64 {
        loop {
            let x = f64::from_bits(self.bits());
            if x.is_finite() {
                return x;
            }
        }
    }

    fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    fn power(&mut self, low: i64, high: i64) -> f64 {
        2f64.powi(i32::try_from(self.integer(low, high)).unwrap())
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.bits().is_multiple_of(n)
    }

    fn matrix(&mut self, mut entry: impl FnMut(&mut Self) -> f64) -> DMat3 {
        DMat3::from_cols_array(&[(); 9].map(|()| entry(self)))
    }

    fn vector(&mut self, mut entry: impl FnMut(&mut Self) -> f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| entry(self)))
    }

    /// The matrix with its rows and columns shuffled, transposed or not, and some signs changed.
    fn shuffled(&mut self, m: DMat3) -> DMat3 {
        let mut m = m;
        for _ in 0..2 {
            let mut columns = [m.x_axis, m.y_axis, m.z_axis];
            for k in [2, 1] {
                let other = usize::try_from(self.integer(0, k)).unwrap();
                columns.swap(usize::try_from(k).unwrap(), other);
            }
            m = DMat3::from_cols(columns[0] * self.sign(), columns[1] * self.sign(), columns[2] * self.sign());
            if self.one_in(2) {
                m = m.transpose();
            }
        }
        m
    }
}

/// A class of matrices: its name, and one more of its kind.
pub(crate) type Class = (&'static str, fn(&mut Random) -> DMat3);

/// Every class, named.
pub(crate) const CLASSES: &[Class] = &[
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
    random.matrix(Random::unit)
}

/// Rotation times scale, as in scenes; also the vertices of a triangle somewhere.
fn affine(random: &mut Random) -> DMat3 {
    let axis = random.vector(Random::unit).normalize_or(DVec3::X);
    let rotation = DMat3::from_axis_angle(axis, 3.0 * random.unit());
    match random.integer(0, 2) {
        0 => rotation,
        1 => rotation * DMat3::from_diagonal(random.vector(|r| 10f64.powf(2.0 * r.unit()))),
        _ => {
            let far = 100.0 * random.vector(Random::unit);
            DMat3::from_cols(far, far + random.vector(Random::unit), far + random.vector(Random::unit))
        }
    }
}

fn small_integers(random: &mut Random) -> DMat3 {
    let limit = random.integer(1, 12);
    random.matrix(|r| r.small(limit))
}

/// Rows and columns scaled by anything from 1e-100 to 1e100.
fn graded(random: &mut Random) -> DMat3 {
    let core = match random.integer(0, 3) {
        0 => small_integers(random),
        1 => last_bits(random),
        _ => benign(random),
    };
    let decade = |r: &mut Random| 10f64.powf(100.0 * r.unit());
    let (rows, columns) = (random.vector(decade), random.vector(decade));
    DMat3::from_diagonal(rows) * core * DMat3::from_diagonal(columns)
}

/// A matrix of rank 1 or 2, rounded, plus noise of 2^-10 to 2^-60.
fn ill_conditioned(random: &mut Random) -> DMat3 {
    let mut m = outer(random.vector(Random::unit), random.vector(Random::unit));
    if random.one_in(2) {
        m += outer(random.vector(Random::unit), random.vector(Random::unit));
    }
    let noise = random.power(-60, -10);
    let m = m + random.matrix(Random::unit) * noise;
    m * random.power(-100, 100)
}

/// Determinants that lose some 40 bits, while the cofactors lose none: double-double just about decides the entries.
fn cancelling_determinant(random: &mut Random) -> DMat3 {
    let mut pair = || outer(random.vector(Random::unit), random.vector(Random::unit));
    let m = pair() + pair();
    let noise = random.power(-44, -34);
    m + random.matrix(Random::unit) * noise
}

fn outer(u: DVec3, v: DVec3) -> DMat3 {
    DMat3::from_cols(u * v.x, u * v.y, u * v.z)
}

/// Exactly singular, nearly always of rank 2.
fn rank_two(random: &mut Random) -> DMat3 {
    let integer = |r: &mut Random| r.small(1 << 25);
    let m = match random.integer(0, 5) {
        // A product of integers that is exact.
        0 => {
            outer(random.vector(integer), random.vector(integer))
                + outer(random.vector(integer), random.vector(integer))
        }
        // Small integers.
        1 => {
            let limit = random.integer(1, 20);
            let digit = |r: &mut Random| r.small(limit);
            outer(random.vector(digit), random.vector(digit)) + outer(random.vector(digit), random.vector(digit))
        }
        // A column twice, up to a power of two.
        2 => {
            let (u, v) = (random.vector(Random::unit), random.vector(Random::unit));
            DMat3::from_cols(u, v, u * random.power(-40, 40))
        }
        // A sum of two columns, or a difference, exact in 50 bits each.
        3 => {
            let short = |r: &mut Random| r.small(1 << 50);
            let (u, v) = (random.vector(short), random.vector(short));
            DMat3::from_cols(u, v, u + v * random.sign() * random.power(0, 1))
        }
        // A column and a row of zeros: a 2 x 2 inverse.
        4 => {
            let [a, b, c, d] = [(); 4].map(|()| random.unit());
            DMat3::from_cols_array(&[a, b, 0.0, c, d, 0.0, 0.0, 0.0, 0.0])
        }
        // One column of zeros.
        _ => DMat3::from_cols(random.vector(Random::unit), random.vector(Random::unit), DVec3::ZERO),
    };
    let scale = random.power(-100, 100);
    random.shuffled(m * scale)
}

/// Exactly of rank 1, in a few cases 0.
fn rank_one(random: &mut Random) -> DMat3 {
    let m = match random.integer(0, 3) {
        0 => outer(random.vector(|r| r.small(1 << 26)), random.vector(|r| r.small(1 << 26))),
        1 => outer(random.vector(|r| r.small(9)), random.vector(|r| r.small(9))),
        2 => outer(random.vector(Random::unit), random.vector(|r| r.sign() * r.power(-20, 20))),
        _ => DMat3::from_cols(random.vector(Random::unit), DVec3::ZERO, DVec3::ZERO),
    };
    let scale = random.power(-200, 200);
    random.shuffled(m * scale)
}

fn rank_zero(random: &mut Random) -> DMat3 {
    random.matrix(|r| 0.0 * r.sign())
}

/// A singular matrix with one to three entries moved by a few units in the last place.
fn last_bits(random: &mut Random) -> DMat3 {
    let m = if random.one_in(4) { rank_one(random) } else { rank_two(random) };
    let mut entries = m.to_cols_array();
    for _ in 0..random.integer(1, 3) {
        let k = usize::try_from(random.integer(0, 8)).unwrap();
        if entries[k] != 0.0 {
            let moved = entries[k].to_bits().wrapping_add_signed(random.integer(-2, 2));
            entries[k] = f64::from_bits(moved);
        }
    }
    DMat3::from_cols_array(&entries)
}

/// Pieces of Hilbert's matrix `1 / (i + j + 1)`: rounded entries, or whole numbers after multiplication by 360360.
fn hilbert(random: &mut Random) -> DMat3 {
    let (first, step) = (random.integer(1, 2000), random.integer(1, 3));
    let whole = random.one_in(2);
    let mut m = DMat3::ZERO;
    for i in 0..3u8 {
        for j in 0..3u8 {
            let n = (first + step * i64::from(i + j)) as f64;
            m.col_mut(j.into())[i.into()] = if whole { (360_360.0 / n).floor() } else { 1.0 / n };
        }
    }
    random.shuffled(m)
}

fn any_exponent(random: &mut Random) -> DMat3 {
    random.matrix(Random::finite)
}

/// Exactly singular, with exponents from end to end.
fn any_exponent_singular(random: &mut Random) -> DMat3 {
    let two = [random.vector(Random::finite), random.vector(Random::finite)];
    let m = match random.integer(0, 2) {
        0 => DMat3::from_cols(two[0], two[1], DVec3::ZERO),
        1 => DMat3::from_cols(two[0], two[1], two[0]),
        _ => DMat3::from_cols(two[0], -two[0], two[0]),
    };
    random.shuffled(m)
}

/// The largest and the smallest doubles in one matrix: the longest integers. Regular, or a column twice.
fn both_ends(random: &mut Random) -> DMat3 {
    let entry = |r: &mut Random| match r.integer(0, 3) {
        0 => r.sign() * f64::from_bits(r.bits() % 16),
        1 => r.sign() * f64::MAX,
        _ => r.sign() * f64::from_bits(f64::MAX.to_bits() - r.bits() % (1 << 53)),
    };
    let [u, v, w] = [(); 3].map(|()| random.vector(entry));
    let m = DMat3::from_cols(u, v, if random.one_in(2) { u } else { w });
    random.shuffled(m)
}

/// Benign or singular matrices scaled so that they, or their inverses, overflow and underflow.
fn ends_of_the_range(random: &mut Random) -> DMat3 {
    let m = match random.integer(0, 3) {
        0 => rank_two(random),
        1 => rank_one(random),
        2 => affine(random),
        _ => small_integers(random),
    };
    let top = m.to_cols_array().into_iter().fold(0.0, |top: f64, x| top.max(x.abs()));
    let unit = if top > 0.0 { m * (1.0 / top) } else { m };
    let exponent = if random.one_in(2) { random.integer(1015, 1023) } else { random.integer(-1074, -1010) };
    let half = 2f64.powi(i32::try_from(exponent / 2).unwrap());
    let rest = 2f64.powi(i32::try_from(exponent - exponent / 2).unwrap());
    (unit * 0.999) * half * rest
}

/// Subnormal entries, alone or with ordinary ones.
fn subnormal(random: &mut Random) -> DMat3 {
    let bits = u32::try_from(random.integer(1, 54)).unwrap();
    let all = random.one_in(2);
    random.matrix(|r| {
        let tiny = r.sign() * f64::from_bits(r.bits() >> (64 - bits));
        if all || r.one_in(2) { tiny } else { r.unit() * r.power(-1000, 3) }
    })
}

/// Few entries that are not zero, zeros of both signs.
fn sparse(random: &mut Random) -> DMat3 {
    random.matrix(|r| match r.integer(0, 7) {
        0 => r.sign(),
        1 => r.sign() * r.power(-1074, 1023),
        2 => r.unit(),
        3 => r.finite(),
        _ => 0.0 * r.sign(),
    })
}

fn permuted_diagonal(random: &mut Random) -> DMat3 {
    let diagonal = match random.integer(0, 3) {
        0 => random.vector(Random::sign),
        1 => random.vector(|r| r.power(-1074, 1023)),
        2 => random.vector(Random::unit),
        _ => random.vector(Random::finite),
    };
    random.shuffled(DMat3::from_diagonal(diagonal))
}

/// Inverses with an entry exactly halfway between two doubles, or one unit of the last place of the minor beside it.
fn midpoints(random: &mut Random) -> DMat3 {
    let m = if random.one_in(2) {
        // The inverse of this triangle holds a c - b = M, an odd number of 54 bits.
        let wanted =
            (1 << 53) + random.integer(0, (1 << 52) - 1) * 2 + 1 + random.integer(-1, 1) * random.integer(0, 1);
        let a = random.integer(1 << 26, (1 << 27) - 1);
        let c = wanted / a + random.integer(-2, 2);
        let b = a * c - wanted;
        DMat3::from_cols_array(&[1.0, 0.0, 0.0, a as f64, 1.0, 0.0, b as f64, c as f64, 1.0])
    } else {
        DMat3::from_cols_array(&[1.0, 0.0, 0.0, random.unit(), 1.0, 0.0, random.unit(), 0.0, random.small(1)])
    };
    // Powers of two at rows and columns keep the halfway points, down to the subnormals and up to overflow.
    let limit = [0, 30, 520][usize::try_from(random.integer(0, 2)).unwrap()];
    let power = |r: &mut Random| r.power(-limit, limit);
    let (rows, columns) = (random.vector(power), random.vector(power));
    let m = DMat3::from_diagonal(rows) * m * DMat3::from_diagonal(columns);
    let m = if m.is_finite() { m } else { DMat3::from_diagonal(rows) };
    random.shuffled(m)
}

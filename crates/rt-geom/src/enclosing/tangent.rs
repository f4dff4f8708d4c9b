//! The minimal sphere of at most five spheres, given that of four of them.
//!
//! A sphere of radius R touches sphere i from inside if `|x - c_i| = R - r_i`. With the origin at the center of the
//! largest sphere, `p_i = c_i - c_0`, `s_i = r_i - r_0 <= 0` and `rho = R - r_0`, the difference of the squares of the
//! equations i and 0 is linear, `p_i . x = h_i + s_i rho` with `h_i = (|p_i|² - s_i²) / 2`. The center lies in the
//! plane, line or point that the centers span, so the dual basis `k_i` of the `p_i` gives
//! `x = sum k_i (h_i + s_i rho) = a + rho q`, and `|x| = rho` is a quadratic equation for `rho`. The same `k_i` give
//! the barycentric coordinates of x; the sphere is the minimal one of its spheres if none of them is negative.

use std::ops::{Add, Div, Mul, Neg, Range, Sub};

use glam::DVec3;
use rt_math::exact::DoubleDouble;
use rt_math::exact::vector::{FromDifference, Product, cross, difference, dot};

use crate::Sphere;

/// Within these limits of the largest reach no fourth power over- or underflows harmfully, in double-double either.
pub(super) const ORDINARY: Range<f64> = 1e-40..1e50;
/// The same for a number between the square of the largest reach and half of it.
pub(super) const ORDINARY_SQUARES: Range<f64> = 1e-80..0.5e100;

/// A real number at some precision.
pub(super) trait SolverNumber:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + FromDifference
    + Product<Self, Self>
{
    const ZERO: Self;
    const ONE: Self;
    /// A sphere that sticks out by less than this share of the radius counts as inside while the support is sought:
    /// some ten rounding errors. No proof rests on it.
    const INSIDE: f64;
    fn from(value: f64) -> Self;
    /// The square root; NaN if negative.
    fn sqrt(self) -> Self;
    fn is_finite(self) -> bool;
    /// Whether this is the smaller; false for NaN.
    fn below(self, other: Self) -> bool;
    /// The nearest double.
    fn round(self) -> f64;
}

impl SolverNumber for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const INSIDE: Self = 2e-15;
    #[inline(always)]
    fn from(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn round(self) -> f64 {
        self
    }
}

/// The number of the cold path, where hardware does not matter.
pub(super) type Wide = DoubleDouble<false>;

impl SolverNumber for Wide {
    const ZERO: Self = Self::ZERO;
    const ONE: Self = Self::new(1.0);
    const INSIDE: f64 = 1e-29;
    fn from(value: f64) -> Self {
        Self::new(value)
    }
    fn sqrt(self) -> Self {
        if self.high() < 0.0 { Self::new(f64::NAN) } else { Self::sqrt(self) }
    }
    fn is_finite(self) -> bool {
        self.high().is_finite() && self.low().is_finite()
    }
    fn below(self, other: Self) -> bool {
        self.high() < other.high() || (self.high() == other.high() && self.low() < other.low())
    }
    fn round(self) -> f64 {
        self.high()
    }
}

/// The sphere that one to four spheres touch from inside, with its center in the flat that their centers span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent<T> {
    /// The spheres' places in the set, the largest sphere first. Those beyond `len` repeat some of them.
    index: [usize; 4],
    len: usize,
    /// The center less that of the first sphere.
    pub(super) x: [T; 3],
    /// The radius less that of the first sphere.
    pub(super) rho: T,
    /// Barycentric coordinates of the center in terms of the spheres' centers: their sum is 1.
    pub(super) weight: [T; 4],
    /// The dual basis of the centers less the first one.
    pub(super) dual: [[T; 3]; 3],
    /// The derivative of `x` by `rho`, as far as the linear equations say.
    pub(super) q: [T; 3],
}

impl<T: SolverNumber> Tangent<T> {
    /// One sphere is its own minimal sphere.
    #[inline(always)]
    pub(super) fn single(index: usize) -> Self {
        let zero = [T::ZERO; 3];
        Self {
            index: [index; 4],
            len: 1,
            x: zero,
            rho: T::ZERO,
            weight: [T::ONE, T::ZERO, T::ZERO, T::ZERO],
            dual: [zero; 3],
            q: zero,
        }
    }

    /// The minimal sphere of at most four spheres, if it touches all of them.
    #[inline(always)]
    pub(super) fn of(places: &[usize], spheres: &[Sphere]) -> Option<Self> {
        let mut all = Self::single(places[0]);
        for &place in &places[1..] {
            all.push(place, spheres);
        }
        (all.solve(spheres) && all.most_negative(usize::MAX).is_none()).then_some(all)
    }

    /// The places of the spheres, the largest first.
    #[inline(always)]
    pub(super) fn support(&self) -> &[usize] {
        &self.index[..self.len]
    }

    /// The places of the spheres, the largest first; if they are fewer than four, some are repeated.
    #[inline(always)]
    pub(super) fn padded(&self) -> [usize; 4] {
        self.index
    }

    /// The same for a set that holds the spheres of `padded` alone.
    pub(super) fn renumbered(&self) -> Self {
        Self { index: [0, 1, 2, 3], ..*self }
    }

    /// Whether a sphere is of the support.
    #[inline(always)]
    pub(super) fn has(&self, index: usize) -> bool {
        let [a, b, c, d] = self.index;
        (a == index) | (b == index) | (c == index) | (d == index)
    }

    /// Adds a sphere without solving.
    #[inline(always)]
    fn push(&mut self, index: usize, spheres: &[Sphere]) {
        // (Without a branch: which is larger cannot be predicted.)
        let both = [self.index[0], index];
        let larger = usize::from(spheres[index].radius() > spheres[both[0]].radius());
        self.index[self.len] = both[1 - larger];
        self.index[0] = both[larger];
        self.len += 1;
    }

    /// Takes the sphere at `place` out, without solving.
    #[inline(always)]
    fn remove(&mut self, place: usize, spheres: &[Sphere]) -> usize {
        let out = self.index[place];
        self.len -= 1;
        self.index[place] = self.index[self.len];
        if place == 0 {
            for other in 1..self.len {
                if spheres[self.index[other]].radius() > spheres[self.index[0]].radius() {
                    self.index.swap(0, other);
                }
            }
        }
        let [first, ..] = self.index;
        self.index = self.index.map(|index| if index == out { first } else { index });
        out
    }

    /// Solves for the center and the radius. False if no sphere was found that all touch from inside: if that is for
    /// the want of a root, nothing has changed. Coordinates of the center may be negative.
    #[inline(always)]
    fn solve(&mut self, spheres: &[Sphere]) -> bool {
        let base = &spheres[self.index[0]];
        let (c0, r0) = (base.center(), base.radius());
        let zero = [T::ZERO; 3];
        if self.len == 1 {
            *self = Self::single(self.index[0]);
            return true;
        }
        let (p1, s1, h1) = relative::<T>(&spheres[self.index[1]], c0, r0);
        if self.len == 2 {
            let p2 = dot(&p1, &p1);
            let length = p2.sqrt();
            let inverse = T::ONE / p2;
            let rho = (length + s1) * T::from(0.5);
            let share = rho * (length * inverse);
            let dual = times(p1, inverse);
            self.x = [p1[0] * share, p1[1] * share, p1[2] * share];
            self.rho = rho;
            self.weight = [T::ONE - share, share, T::ZERO, T::ZERO];
            self.dual = [dual, zero, zero];
            self.q = [dual[0] * s1, dual[1] * s1, dual[2] * s1];
            // If the first contains the second there is no such sphere, or their difference is zero.
            return T::ZERO.below(rho) && share.is_finite();
        }
        let (p2, s2, h2) = relative::<T>(&spheres[self.index[2]], c0, r0);
        let n = cross(&p1, &p2);
        if self.len == 3 {
            return self.finish(
                dot(&n, &n),
                [cross(&p2, &n), cross(&n, &p1), zero],
                [h1, h2, T::ZERO],
                [s1, s2, T::ZERO],
            );
        }
        let (p3, s3, h3) = relative::<T>(&spheres[self.index[3]], c0, r0);
        self.finish(dot(&n, &p3), [cross(&p2, &p3), cross(&p3, &p1), n], [h1, h2, h3], [s1, s2, s3])
    }

    /// Solves the quadratic for `rho`, given the dual basis times `scale`. (It is divided out as late as can be: the
    /// processor does other things meanwhile.)
    #[inline(always)]
    fn finish(&mut self, scale: T, dual: [[T; 3]; 3], h: [T; 3], s: [T; 3]) -> bool {
        let inverse = T::ONE / scale;
        let (a, q) = (times(combine(h, &dual), inverse), times(combine(s, &dual), inverse));
        // (q.q - 1) rho² + 2 a.q rho + a.a = 0: the smallest root that is not negative, without cancellation.
        let (second, first, constant) = (dot(&q, &q) - T::ONE, dot(&a, &q), dot(&a, &a));
        let root = (first * first - second * constant).sqrt();
        let (numerator, denominator) =
            if T::ZERO.below(first) { (first + root, -second) } else { (constant, root - first) };
        let rho = numerator / denominator;
        if rho.below(T::ZERO) | !rho.is_finite() {
            return false;
        }
        self.dual = dual.map(|k| times(k, inverse));
        let x = [a[0] + rho * q[0], a[1] + rho * q[1], a[2] + rho * q[2]];
        let [k1, k2, k3] = &self.dual;
        let (w1, w2, w3) = (dot(k1, &x), dot(k2, &x), dot(k3, &x));
        self.x = x;
        self.rho = rho;
        self.weight = [T::ONE - (w1 + w2 + w3), w1, w2, w3];
        self.q = q;
        self.weight[0].is_finite()
    }

    /// The place of the most negative coordinate, other than that of the sphere `keep`; `None` if none is negative.
    #[inline(always)]
    fn most_negative(&self, keep: usize) -> Option<usize> {
        // Those beyond `len` are zero. (Without a branch: which it is cannot be predicted.)
        let mut least = T::ZERO;
        let mut found = usize::MAX;
        for place in 0..4 {
            let less = self.weight[place].below(least) & (self.index[place] != keep);
            least = if less { self.weight[place] } else { least };
            found = if less { place } else { found };
        }
        (found < 4).then_some(found)
    }

    /// The center less `origin`, and the radius.
    #[inline(always)]
    pub(super) fn sphere(&self, spheres: &[Sphere], origin: DVec3) -> ([T; 3], T) {
        let first = &spheres[self.index[0]];
        let from = difference::<T>(first.center(), origin);
        let center = [from[0] + self.x[0], from[1] + self.x[1], from[2] + self.x[2]];
        (center, self.rho + T::from(first.radius()))
    }

    /// How far `sphere` sticks out: its reach from the center less the radius.
    #[inline(always)]
    pub(super) fn excess(&self, sphere: &Sphere, spheres: &[Sphere]) -> T {
        let (from, radius) = self.sphere(spheres, sphere.center());
        dot(&from, &from).sqrt() + (T::from(sphere.radius()) - radius)
    }

    /// The place in `old`, the spheres that were solved last, of the one that leaves first for one more: weight moves
    /// to that one and off the others in proportion to its barycentric coordinates among them, and that of one runs out
    /// first.
    #[inline(always)]
    fn leaves(&self, old: [usize; 4], index: usize, spheres: &[Sphere]) -> usize {
        let p = difference::<T>(spheres[index].center(), spheres[old[0]].center());
        let [k1, k2, k3] = self.dual;
        let (k1, k2, k3) = (dot(&k1, &p), dot(&k2, &p), dot(&k3, &p));
        let share = [T::ONE - (k1 + k2 + k3), k1, k2, k3];
        // weight[i] / share[i] < weight[out] / share[out], without dividing
        let mut out = 0;
        let mut some = T::ZERO.below(share[0]);
        for place in 1..4 {
            let sooner = !some | (self.weight[place] * share[out]).below(self.weight[out] * share[place]);
            if T::ZERO.below(share[place]) & sooner {
                (out, some) = (place, true);
            }
        }
        out
    }

    /// Becomes the minimal sphere of these spheres and one more that sticks out of theirs.
    ///
    /// Drops what the signs of the coordinates say must go, checks that what was dropped lies inside, and otherwise
    /// tries all subsets.
    #[inline(never)]
    pub(super) fn add(&mut self, index: usize, spheres: &[Sphere]) {
        let (old, old_len) = (self.index, self.len);
        let radius = |of: &Self| of.rho + T::from(spheres[of.index[0]].radius());
        let old_radius = radius(self);
        let mut dropped = [index; 4];
        let mut drops = 0;
        if self.len == 4 {
            let leaves = self.leaves(old, index, spheres);
            dropped[0] = self.remove(leaves, spheres);
            drops = 1;
        }
        self.push(index, spheres);
        let solved = loop {
            if !self.solve(spheres) {
                if self.len < 4 || drops > 0 {
                    break false;
                }
                // No sphere touches all four.
                let leaves = old[self.leaves(old, index, spheres)];
                let place = self.index.iter().position(|&other| other == leaves).unwrap_or(0);
                dropped[0] = self.remove(place, spheres);
                drops = 1;
                continue;
            }
            let Some(place) = self.most_negative(index) else { break true };
            dropped[drops] = self.remove(place, spheres);
            drops += 1;
        };
        let good = solved
            && old_radius.below(radius(self))
            && dropped[..drops]
                .iter()
                .all(|&out| self.excess(&spheres[out], spheres).below(radius(self) * T::from(T::INSIDE)));
        if !good {
            *self = Self::best_subset(&old[..old_len], index, spheres);
        }
    }

    /// Returns the minimal sphere of these spheres and one more: of all subsets with the new one, the one whose
    /// sphere, grown until it encloses all, is smallest.
    #[cold]
    #[inline(never)]
    fn best_subset(old: &[usize], index: usize, spheres: &[Sphere]) -> Self {
        let mut best = Self::single(index);
        let mut least = best.grown(old, index, spheres);
        for mask in 1_u32..1 << old.len() {
            if mask.count_ones() == 4 {
                continue;
            }
            let mut subset = Self::single(index);
            for (place, &other) in old.iter().enumerate() {
                if mask >> place & 1 == 1 {
                    subset.push(other, spheres);
                }
            }
            if subset.solve(spheres) {
                let grown = subset.grown(old, index, spheres);
                if grown.below(least) {
                    (best, least) = (subset, grown);
                }
            }
        }
        best
    }

    /// The radius that encloses `old` and one more around this center.
    fn grown(&self, old: &[usize], index: usize, spheres: &[Sphere]) -> T {
        let mut excess = T::ZERO;
        for &other in old.iter().chain([&index]) {
            let sticks_out = self.excess(&spheres[other], spheres);
            if excess.below(sticks_out) {
                excess = sticks_out;
            }
        }
        self.rho + T::from(spheres[self.index[0]].radius()) + excess
    }
}

/// `p`, `s` and `h` of a sphere: see the head of this file.
#[inline(always)]
fn relative<T: SolverNumber>(sphere: &Sphere, center: DVec3, radius: f64) -> ([T; 3], T, T) {
    let p = difference::<T>(sphere.center(), center);
    let s = T::from_difference(sphere.radius(), radius);
    (p, s, (dot(&p, &p) - s * s) * T::from(0.5))
}

#[inline(always)]
fn times<T: SolverNumber>(v: [T; 3], factor: T) -> [T; 3] {
    [v[0] * factor, v[1] * factor, v[2] * factor]
}

#[inline(always)]
fn combine<T: SolverNumber>(f: [T; 3], [a, b, c]: &[[T; 3]; 3]) -> [T; 3] {
    [
        f[0] * a[0] + f[1] * b[0] + f[2] * c[0],
        f[0] * a[1] + f[1] * b[1] + f[2] * c[1],
        f[0] * a[2] + f[1] * b[2] + f[2] * c[2],
    ]
}

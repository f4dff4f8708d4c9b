//! The minimal sphere of at most five spheres, by trying subsets.

use glam::{DMat3, DVec3};

use crate::Sphere;

/// At most four spheres and the minimal sphere that they touch from inside.
#[derive(Clone, Debug)]
pub(super) struct Basis {
    indices: [usize; 4],
    len: usize,
    center: DVec3,
    radius: f64,
}

impl Basis {
    /// The basis of one sphere: itself.
    pub(super) fn single(index: usize, sphere: &Sphere) -> Self {
        Self { indices: [index; 4], len: 1, center: sphere.center(), radius: sphere.radius() }
    }

    pub(super) fn indices(&self) -> &[usize] {
        &self.indices[..self.len]
    }

    pub(super) fn center(&self) -> DVec3 {
        self.center
    }

    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the basis of these spheres and one more that sticks out: of all subsets with the new one, the one
    /// whose sphere encloses all with the smallest radius.
    pub(super) fn with(&self, new: usize, spheres: &[Sphere]) -> Self {
        let mut best: Option<(Self, f64)> = None;
        for mask in 0_u32..1 << self.len {
            if mask.count_ones() > 3 {
                continue;
            }
            let mut subset = Self { indices: [new; 4], len: 1, center: DVec3::ZERO, radius: 0.0 };
            for (bit, &index) in self.indices().iter().enumerate() {
                if mask >> bit & 1 == 1 {
                    subset.indices[subset.len] = index;
                    subset.len += 1;
                }
            }
            if !subset.solve(spheres) {
                continue;
            }
            let reach = self.indices().iter().chain([&new]).fold(0.0_f64, |reach, &i| {
                reach.max((spheres[i].center() - subset.center).length() + spheres[i].radius())
            });
            if best.as_ref().is_none_or(|(_, least)| reach < *least) {
                best = Some((subset, reach));
            }
        }
        best.map_or_else(|| Self::single(new, &spheres[new]), |(basis, _)| basis)
    }

    /// Finds the sphere that all spheres of the basis touch from inside, with its center in the plane, line or point
    /// that their centers span. False if there is none.
    fn solve(&mut self, spheres: &[Sphere]) -> bool {
        // The largest sphere is the origin, so that the others have s <= 0 and nothing cancels.
        let largest = (0..self.len)
            .max_by(|&i, &j| spheres[self.indices[i]].radius().total_cmp(&spheres[self.indices[j]].radius()))
            .expect("a basis has at least one sphere");
        self.indices.swap(0, largest);
        let origin = spheres[self.indices[0]];
        let (mut p, mut s, mut h) = ([DVec3::ZERO; 3], [0.0; 3], [0.0; 3]);
        for i in 1..self.len {
            let sphere = spheres[self.indices[i]];
            p[i - 1] = sphere.center() - origin.center();
            s[i - 1] = sphere.radius() - origin.radius();
            let length = p[i - 1].length();
            h[i - 1] = 0.5 * (length - s[i - 1]) * (length + s[i - 1]);
            if length <= -s[i - 1] {
                return false;
            }
        }
        // The dual basis k of the differences: k_i . p_j = 1 if i = j, else 0.
        let k = match self.len {
            1 => [DVec3::ZERO; 3],
            2 => [p[0] / p[0].length_squared(), DVec3::ZERO, DVec3::ZERO],
            3 => {
                let n = p[0].cross(p[1]);
                let n2 = n.length_squared();
                [p[1].cross(n) / n2, n.cross(p[0]) / n2, DVec3::ZERO]
            }
            _ => {
                let m = DMat3::from_cols(p[0], p[1], p[2]).inverse().transpose();
                [m.x_axis, m.y_axis, m.z_axis]
            }
        };
        let at_zero = h[0] * k[0] + h[1] * k[1] + h[2] * k[2];
        let slope = s[0] * k[0] + s[1] * k[1] + s[2] * k[2];
        // |at_zero + slope rho| = rho, where rho is the radius less that of the largest sphere.
        let (a, b, c) = (slope.length_squared() - 1.0, at_zero.dot(slope), at_zero.length_squared());
        let discriminant = b * b - a * c;
        if self.len > 1 && !(discriminant >= 0.0) {
            return false;
        }
        let t = -(b + discriminant.sqrt().copysign(b));
        let rho = [t / a, c / t]
            .into_iter()
            .filter(|rho| rho.is_finite() && *rho >= 0.0)
            .fold(f64::INFINITY, f64::min);
        let rho = if self.len == 1 { 0.0 } else { rho };
        let offset = at_zero + rho * slope;
        self.center = origin.center() + offset;
        self.radius = origin.radius() + rho;
        self.center.is_finite() && self.radius.is_finite()
    }
}

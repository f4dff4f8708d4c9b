//! SphEng: the minimal sphere that encloses given spheres.
//!
//! Farthest-first pivoting. At most four of the spheres, the support, decide the answer: the minimal sphere of the
//! support is a lower bound of the minimal sphere of all. As long as some sphere sticks out of it, the one that
//! sticks out farthest joins the support, the minimal sphere of these at most five is found by trying their subsets,
//! and the radius grows. When nothing sticks out, that is the answer. (Welzl's recursion, which does this for points,
//! is wrong for spheres: K. Fischer and B. Gärtner, "The smallest enclosing ball of balls", 2004.)

mod basis;

use glam::DVec3;

use crate::Sphere;
use basis::Basis;

/// What [`enclosing_sphere`] gives: the sphere, the spheres that decide it, and how small any other could be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosing {
    /// The enclosing sphere: every given sphere lies inside it in exact arithmetic.
    pub sphere: Sphere,
    /// No sphere that encloses the given ones has a smaller radius than this.
    pub lower_bound: f64,
    support: [usize; 4],
    support_len: usize,
}

impl Enclosing {
    /// The indices of the spheres that decide the answer: one to four, ascending.
    pub fn support(&self) -> &[usize] {
        &self.support[..self.support_len]
    }
}

/// Returns the minimal sphere that encloses all `spheres`.
///
/// `None` if there are none, or if no sphere with a finite double radius encloses them.
pub fn enclosing_sphere(spheres: &[Sphere]) -> Option<Enclosing> {
    let first = spheres.first()?;
    let reach = farthest(spheres, first.center()).1;
    let (low, high) = (f64::from_bits(0x2D50_0000_0000_0000), f64::from_bits(0x58E0_0000_0000_0000)); // 1e-90, 1e120
    if reach == 0.0 || (low..high).contains(&reach) {
        return pivot(spheres, 1.0);
    }
    // Far from 1, squares would over- or underflow: solve a copy scaled by a power of two. Where scaling up would
    // overflow, all coordinates of that axis are equal (the set is smaller than their spacing).
    let exponent = if reach < 1.0 { 600 } else { -540 };
    let scale = 2.0_f64.powi(exponent);
    let mut collapsed = DVec3::ZERO;
    let scaled: Option<Vec<Sphere>> = spheres
        .iter()
        .map(|sphere| {
            let mut center = sphere.center() * scale;
            for axis in 0..3 {
                if !center[axis].is_finite() {
                    center[axis] = 0.0;
                    collapsed[axis] = sphere.center()[axis];
                }
            }
            Sphere::new(center, sphere.radius() * scale)
        })
        .collect();
    let mut answer = pivot(&scaled?, scale)?;
    let center = answer.sphere.center() / scale + collapsed;
    answer.sphere = Sphere::new(center, (answer.sphere.radius() / scale).next_up())?;
    answer.lower_bound = (answer.lower_bound / scale).next_down().max(0.0);
    Some(answer)
}

/// Returns the index of the sphere that reaches farthest from `center`, and how far.
fn farthest(spheres: &[Sphere], center: DVec3) -> (usize, f64) {
    let mut best = (0, -1.0);
    for (index, sphere) in spheres.iter().enumerate() {
        let reach = (sphere.center() - center).length() + sphere.radius();
        if reach.is_nan() || reach > best.1 {
            best = (index, reach);
        }
    }
    best
}

/// Relative error bound of a reach computed in f64, with a margin: see `docs/numerics.md`, section 8.
const REACH_ERROR: f64 = 8.0 * (f64::EPSILON / 2.0);

/// No set known needs more than a few dozen pivots.
const MAX_PIVOTS: usize = 100;

fn pivot(spheres: &[Sphere], _scale: f64) -> Option<Enclosing> {
    let mut basis = Basis::single(0, &spheres[0]);
    let mut best: Option<(Basis, f64)> = None;
    let mut stalled = 0;
    for _ in 0..MAX_PIVOTS {
        let (index, reach) = farthest(spheres, basis.center());
        if best.as_ref().is_none_or(|(_, least)| reach < *least) {
            best = Some((basis.clone(), reach));
        }
        if reach <= basis.radius() || basis.indices().contains(&index) {
            break;
        }
        let next = basis.with(index, spheres);
        stalled = if next.radius() > basis.radius() { 0 } else { stalled + 1 };
        if stalled == 3 {
            break;
        }
        basis = next;
    }
    let (basis, reach) = best?;
    let radius = (reach * (1.0 + REACH_ERROR)).next_up();
    let sphere = Sphere::new(basis.center(), radius)?;
    let mut support = [0; 4];
    let mut indices = basis.indices().to_vec();
    indices.sort_unstable();
    support[..indices.len()].copy_from_slice(&indices);
    let lower_bound = basis.indices().iter().map(|&i| spheres[i].radius()).fold(0.0, f64::max);
    Some(Enclosing { sphere, lower_bound, support, support_len: indices.len() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(x: f64, y: f64, z: f64, r: f64) -> Sphere {
        Sphere::new(DVec3::new(x, y, z), r).unwrap()
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-14 * b.abs()
    }

    #[test]
    fn nothing_has_no_enclosing_sphere() {
        assert!(enclosing_sphere(&[]).is_none());
    }

    #[test]
    fn one_sphere_encloses_itself() {
        let one = ball(1.0, 2.0, 3.0, 4.0);
        let answer = enclosing_sphere(&[one]).unwrap();
        assert_eq!(answer.sphere.center(), one.center());
        assert!(close(answer.sphere.radius(), 4.0));
        assert_eq!(answer.support(), [0]);
    }

    #[test]
    fn two_spheres_touch_from_inside() {
        for scale in [1e-290, 1e-200, 1.0, 1e150, 1e290] {
            let pair = [ball(-3.0 * scale, 0.0, 0.0, scale), ball(3.0 * scale, 0.0, 0.0, 2.0 * scale)];
            let answer = enclosing_sphere(&pair).unwrap();
            assert!(close(answer.sphere.radius(), 4.5 * scale), "{answer:?}");
            assert!(close(answer.sphere.center().x, 0.5 * scale), "{answer:?}");
            assert_eq!(answer.support(), [0, 1]);
        }
    }

    #[test]
    fn the_corners_of_a_cube_give_its_circumsphere() {
        let corners: Vec<_> =
            (0..8).map(|i| ball(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2), 0.0)).collect();
        let answer = enclosing_sphere(&corners).unwrap();
        assert!(close(answer.sphere.radius(), 0.75_f64.sqrt()), "{answer:?}");
    }
}

//! Farthest-first pivoting over at most 64 spheres, in registers.

use fearless_simd::Simd;
use glam::DVec3;
use rt_math::exact::U;

use super::pivot::Lanes;
use super::tangent::Tangent;
use crate::Sphere;

/// Turns the minimal sphere of some of the spheres in `lanes` into that of all of them: adds the sphere that sticks out
/// farthest, until none does. `place` tells from a lane the place in `spheres`.
#[inline(never)]
pub(super) fn pivot<S: Simd, const VECTORS: usize>(
    simd: S,
    tangent: &mut Tangent<f64>,
    lanes: &Lanes<S, VECTORS>,
    place: impl Fn(usize) -> usize,
    spheres: &[Sphere],
    origin: DVec3,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            for _ in 0..MAX_PIVOTS {
                let (center, radius) = tangent.sphere(spheres, origin);
                let (lane, measure) = lanes.farthest(simd, center, radius);
                let far = place(lane);
                if (measure <= radius * radius * TOUCHES) | tangent.has(far) {
                    break;
                }
                tangent.add(far, spheres);
            }
        },
    );
}

/// The measure of a sphere that touches from inside is below this share of the squared radius: rounding.
pub(super) const TOUCHES: f64 = 16.0 * U;

/// No set known needs more than a few dozen pivots. What is left to do after so many, the certificate sees.
const MAX_PIVOTS: usize = 100;

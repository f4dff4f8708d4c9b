//! Texture coordinates of a normal, from their definition.

use std::cmp::Ordering;

use crate::{Big, Vector, exact, long, pi, root, sign};

/// Returns the texture coordinates of a finite normal that is not zero, in 400 bits.
#[must_use]
pub fn uv(normal: impl Into<[f64; 3]>) -> [Big; 2] {
    let normal = normal.into();
    coordinates(&normal.map(|c| long(&exact(c))), normal.map(f64::is_sign_negative))
}

/// The same for a normal of 400 bits whose zeros have the given signs.
///
/// On the axis and on the plane of the seam the sign of zero decides, as in IEEE 754.
#[must_use]
pub fn coordinates([x, y, z]: &Vector, [x_negative, _, z_negative]: [bool; 3]) -> [Big; 2] {
    let half_turn = pi();
    let turn = &half_turn * long(&exact(2.0));
    let u = match (sign(z) == Ordering::Equal, x_negative, z_negative) {
        (true, false, _) => exact(0.5),
        (true, true, false) => exact(1.0),
        (true, true, true) => Big::ZERO,
        // Counted from the seam: equal to ½ + atan2(z, x) / turn, without its cancellation.
        (false, true, true) => (-z).atan2(&-x) / &turn,
        _ => long(&exact(0.5)) + z.atan2(x) / &turn,
    };
    let h = root(&(x * x + z * z));
    let on_axis = sign(&h) == Ordering::Equal;
    let v = if on_axis { exact(f64::from(sign(y) == Ordering::Less)) } else { h.atan2(y) / half_turn };
    [u, v]
}

#[test]
fn known_directions_have_known_coordinates() {
    let rounded = |normal: [f64; 3]| uv(normal).each_ref().map(crate::rounded);
    assert_eq!(rounded([3.0, 0.0, -3.0]), [0.375, 0.5]);
    assert_eq!(rounded([-1.0, 0.0, -0.0]), [0.0, 0.5]);
    assert_eq!(rounded([-1.0, 0.0, 0.0]), [1.0, 0.5]);
    assert_eq!(rounded([0.0, -2.0, 0.0]), [0.5, 1.0]);
}

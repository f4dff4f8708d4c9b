//! Angles, and the place on a map where a normal points.
//!
//! As in doubles, the angle comes from one octant, `atan(smaller / larger)`, and is counted from the nearest multiple
//! of a quarter turn. So it keeps its relative precision beside each of them.

use std::cmp::Ordering;
use std::sync::LazyLock;

use rt_math::exact::Ball;

use super::{constant, inverse_tangent, inverse_tangent_of_inverse};

/// π, by J. Machin's formula.
static PI: LazyLock<Ball<{ super::LONGEST }>> = LazyLock::new(|| {
    let arctangent = inverse_tangent_of_inverse::<false>;
    arctangent(5).scale(4) - arctangent(239).scale(2)
});

/// Returns `atan2(y, x) / π`, in `-1..=1`.
///
/// Exact at the multiples of a quarter turn if the zero is exact (it counts as +0: 0 for two zeros, 1 for `y = 0` and
/// `x < 0`), and at those of an eighth if the magnitudes are equal and exact. Beside the negative x axis, where the
/// angle jumps, a ball that reaches to both sides gives all angles; and so does one around the origin.
///
/// ```
/// use rt_math::exact::Ball;
/// use rt_shade::certified::half_turns;
///
/// let [one, minus_two] = [1, -2].map(Ball::<2>::from_integer);
/// assert_eq!(half_turns(&Ball::ZERO, &minus_two).ends(), (1.0, 1.0));
/// assert_eq!(half_turns(&minus_two, &(one + one)).ends(), (-0.25, -0.25));
/// assert_eq!(half_turns(&one, &minus_two).floor(), Some(0));
/// ```
#[must_use]
pub fn half_turns<const LIMBS: usize>(y: &Ball<LIMBS>, x: &Ball<LIMBS>) -> Ball<LIMBS> {
    let all = || Ball::ONE.hull(&-Ball::ONE);
    match from_quarter(y, x) {
        // The side decides between 1 and -1.
        Some((2, _)) if y.sign().is_none() => all(),
        Some((quarters, rest)) => Ball::from_integer(quarters).scale(-1) + rest,
        None => all(),
    }
}

/// Returns the texture coordinates `(u, v)` of an outward normal of any length, `u` modulo 1.
///
/// `u = 1/2 + atan2(z, x) / 2π` and `v = 1/2 - asin(y / |N|) / π` of the exact normal, as
/// [`texture_uv`](crate::texture_uv) rounds them; not `mirrored` reads `u` of the normal with `z` negated. An exact zero
/// counts as +0, also as the negated `z`: at a pole `u` is 1/2. Beside the seam `u` lies around 0, below it on the one
/// side and above it on the other, so that it keeps its precision; a whole turn makes no difference to a texture. If the
/// normal may point to a pole without being exactly that, `u` is all of `0..=1`.
#[must_use]
pub fn texture_uv<const LIMBS: usize>([x, y, z]: &[Ball<LIMBS>; 3], mirrored: bool) -> [Ball<LIMBS>; 2] {
    let half = Ball::ONE.scale(-1);
    let z = if mirrored { *z } else { -z };
    let u = match from_quarter(&z, x) {
        Some((2 | -2, rest)) => rest.scale(-1),
        Some((quarters, rest)) => half + Ball::from_integer(quarters).scale(-2) + rest.scale(-1),
        None => Ball::ZERO.hull(&Ball::ONE),
    };
    let from_axis = (x.square() + z.square()).sqrt();
    [u, half - half_turns(y, &from_axis)]
}

/// Returns the angle of `(x, y)` as a number of quarter turns, in `-2..=2`, and the half turns to add. If `y` has either
/// sign and `x` is negative, the quarter turns are 2, from where both sides are counted. `None` if the numbers do not
/// tell an octant and its neighbour.
fn from_quarter<const LIMBS: usize>(y: &Ball<LIMBS>, x: &Ball<LIMBS>) -> Option<(i64, Ball<LIMBS>)> {
    use Ordering::{Equal, Greater, Less};

    let (x_sign, y_sign) = (x.sign(), y.sign());
    if (x_sign, y_sign) == (Some(Equal), Some(Equal)) {
        return Some((0, Ball::ZERO));
    }
    let order = (y.abs() - x.abs()).sign();
    if order == Some(Greater) {
        let quarters = if y_sign? == Less { -1 } else { 1 };
        return Some((quarters, -share(x, y, order)?));
    }
    let quarters = match (x_sign?, y_sign) {
        (Greater, _) => 0,
        (Less, Some(Less)) => -2,
        (Less, _) => 2,
        (Equal, _) => return None,
    };
    Some((quarters, share(y, x, order)?))
}

/// Returns `atan(y / x) / π` for `|y|` that is at most `|x|`, or not certainly larger; `order` compares the magnitudes,
/// and `Equal` means exactly equal ones.
fn share<const LIMBS: usize>(y: &Ball<LIMBS>, x: &Ball<LIMBS>, order: Option<Ordering>) -> Option<Ball<LIMBS>> {
    let tangent = y / x;
    if order == Some(Ordering::Equal) {
        return Some(tangent.scale(-2));
    }
    let two = Ball::ONE.scale(1);
    let small = (two - tangent.abs()).sign() == Some(Ordering::Greater);
    let half = Ball::ONE.scale(-1);
    small.then(|| {
        let share = inverse_tangent::<false, LIMBS>(&tangent) / constant(&PI);
        // Any arc tangent is below a quarter turn, whatever a wide ball made of it.
        if (share.abs() - Ball::ONE).sign() == Some(Ordering::Less) { share } else { half.hull(&-half) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certified::truth::{assert_encloses, but_for, long, pi};
    use oracle::{Big, Random, exact, power_of_two};

    /// Bits that an angle of exact numbers may lose (`docs/numerics.md`, 13.3).
    const LOST: i32 = 10;

    /// A pair of numbers: any doubles, or near an axis, a diagonal, or each other.
    fn pair(rng: &mut Random) -> [f64; 2] {
        let x = rng.with_exponent(-3..3);
        let y = match rng.below(5) {
            0 => return [rng.with_exponent(-1000..1000), rng.with_exponent(-1000..1000)],
            1 => x * rng.with_exponent(-300..0),
            2 => rng.nudge(x, 3) * rng.sign(),
            3 => x * rng.sign(),
            _ => rng.with_exponent(-3..3),
        };
        if rng.one_in(2) { [x, y] } else { [y, x] }
    }

    fn angles_are_enclosed<const LIMBS: usize>(cases: usize) {
        let mut rng = Random::new(LIMBS as u64);
        for _ in 0..cases {
            let [y, x] = pair(&mut rng);
            let truth = long::<LIMBS>(&exact(y)).atan2(&long::<LIMBS>(&exact(x))) / pi::<LIMBS>();
            let found = half_turns(&Ball::<LIMBS>::from_f64(y), &Ball::from_f64(x));
            if y.abs() == x.abs() {
                let eighths = if x > 0.0 { 0.25 } else { 0.75 } * y.signum();
                assert_eq!((found.is_exact(), found.ends()), (true, (eighths, eighths)));
                continue;
            }
            assert_encloses(&found, &truth, &but_for::<LIMBS>(LOST, &truth));
            // Numbers that are not exact: the square roots of these.
            let [a, b] = [y, x].map(|c| long::<LIMBS>(&exact(c.abs())).sqrt());
            let [p, q] = [y, x].map(|c| Ball::<LIMBS>::from_f64(c.abs()).sqrt());
            let truth = a.atan2(&b) / pi::<LIMBS>();
            assert_encloses(&half_turns(&p, &q), &truth, &but_for::<LIMBS>(LOST, &truth));
        }
    }

    #[test]
    fn angles_are_enclosed_at_any_precision() {
        angles_are_enclosed::<1>(300);
        angles_are_enclosed::<2>(300);
        angles_are_enclosed::<4>(200);
        angles_are_enclosed::<32>(10);
    }

    #[test]
    fn an_angle_of_a_wide_ball_contains_those_of_its_numbers() {
        let mut rng = Random::new(5);
        let mut whole_turns = 0;
        for _ in 0..300 {
            let [y, x] = pair(&mut rng).map(|c| c.clamp(-1e9, 1e9));
            let radius = [y, x].map(|c| c * rng.with_exponent(-40..2));
            let [p, q] = [0, 1].map(|i| Ball::<2>::from_f64([y, x][i]).widen(&Ball::from_f64(radius[i])));
            let angle = half_turns(&p, &q);
            whole_turns += usize::from(angle.ends().1 - angle.ends().0 > 1.9);
            for share in [-0.99, 0.0, 0.7, 0.99] {
                let [b, a] = [0, 1].map(|i| [y, x][i] + radius[i] * share);
                let truth = long::<2>(&exact(b)).atan2(&long::<2>(&exact(a))) / pi::<2>();
                assert_encloses(&angle, &truth, &exact(4.0));
            }
        }
        assert!((20..250).contains(&whole_turns), "{whole_turns}");
    }

    #[test]
    fn multiples_of_a_quarter_turn_are_exact() {
        let [zero, x] = [Ball::<2>::ZERO, Ball::from_f64(3e-300)];
        for (y, x, expected) in
            [(zero, zero, 0.0), (zero, x, 0.0), (zero, -x, 1.0), (x, zero, 0.5), (-x, zero, -0.5), (-x, -x, -0.75)]
        {
            let found = half_turns(&y, &x);
            assert_eq!((found.is_exact(), found.ends()), (true, (expected, expected)), "{y:?} {x:?}");
        }
    }

    fn coordinates_are_enclosed<const LIMBS: usize>(cases: usize) {
        let mut rng = Random::new(100 + LIMBS as u64);
        for _ in 0..cases {
            let mut normal = [0; 3].map(|_| rng.with_exponent(-2..2));
            for c in &mut normal {
                if rng.one_in(3) {
                    *c *= rng.pick(&[0.0, 1e-12, 1e-100]);
                }
            }
            if normal == [0.0; 3] {
                continue;
            }
            // Positive zeros, also as -z.
            let [x, y, z] = normal.map(|c| c + 0.0);
            for (mirrored, z_read) in [(true, z), (false, 0.0 - z)] {
                let [u, v] = oracle::uv([x, y, z_read]);
                let [found_u, found_v] = texture_uv(&[x, y, z].map(Ball::<LIMBS>::from_f64), mirrored);
                let reference = power_of_two(-390);
                // Modulo 1.
                let u = if found_u.ends().1 < oracle::rounded(&u) - 0.5 { u - exact(1.0) } else { u };
                let within = |c: &Ball<LIMBS>, truth: &Big| {
                    let dust = Ball::ONE.scale(-390);
                    assert_encloses(
                        &c.widen(&dust),
                        truth,
                        &(but_for::<LIMBS>(LOST, &exact(1.0)) + &reference * exact(8.0)),
                    );
                };
                within(&found_u, &u);
                within(&found_v, &v);
            }
        }
    }

    #[test]
    fn texture_coordinates_are_enclosed() {
        coordinates_are_enclosed::<2>(300);
        coordinates_are_enclosed::<4>(300);
        coordinates_are_enclosed::<32>(30);
    }

    #[test]
    fn poles_and_the_seam_are_told_apart() {
        let [zero, one] = [Ball::<4>::ZERO, Ball::ONE];
        let dust = Ball::from_f64(1e-300);
        let uv = |x: Ball<4>, y: Ball<4>, z: Ball<4>| texture_uv(&[x, y, z], false).map(|c| c.ends());
        assert_eq!(uv(zero, one, zero), [(0.5, 0.5), (0.0, 0.0)], "the north pole");
        assert_eq!(uv(zero, -one, zero), [(0.5, 0.5), (1.0, 1.0)], "the south pole");
        assert_eq!(uv(-one, zero, zero), [(0.0, 0.0), (0.5, 0.5)], "the seam, modulo 1");
        let [below, above] = [-dust, dust].map(|z| uv(-one, zero, z)[0]);
        assert!(below.1 < 0.0 && above.0 > 0.0, "both sides of the seam: {below:?} {above:?}");
        let [u, _] = uv(-one, zero, zero.widen(&dust));
        assert!(u.0 < 0.0 && u.1 > 0.0 && u.1 < 1e-300, "an open side lies around the seam: {u:?}");
        let [u, v] = uv(zero.widen(&dust), one, zero.widen(&dust));
        assert!(u.0 <= 0.0 && u.1 >= 1.0 && v.0 <= 0.0 && v.1 < 1e-299, "an open pole: {u:?} {v:?}");
    }
}

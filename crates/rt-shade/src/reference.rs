//! What the tests compare with: the same functions evaluated to 320 bits, and rational numbers, by a library that shares no
//! code with ours.

use dashu::Integer;
use dashu::float::FBig;
use dashu::float::round::mode::HalfEven;
use dashu::rational::Relaxed;
use glam::DVec3;

/// A binary number of 320 bits.
pub(crate) type Big = FBig<HalfEven, 2>;

const BITS: usize = 320;

/// Returns the double exactly.
pub(crate) fn big(x: f64) -> Big {
    Big::try_from(x).expect("the number is finite").with_precision(BITS).value()
}

/// Returns the double as an exact rational number.
pub(crate) fn exact(x: f64) -> Relaxed {
    Relaxed::try_from(x).expect("the number is finite")
}

/// Returns a quotient of two integers.
pub(crate) fn ratio(n: usize, d: usize) -> Big {
    big(n as f64) / big(d as f64)
}

/// Returns pi.
pub(crate) fn pi() -> Big {
    Big::pi(BITS)
}

/// Returns the texture coordinates of a finite normal that is not zero, from their definition.
pub(crate) fn uv(normal: DVec3) -> (Big, Big) {
    let [x, y, z] = normal.to_array().map(big);
    let turn = pi() * big(2.0);
    let (x_negative, z_negative) = (normal.x.is_sign_negative(), normal.z.is_sign_negative());
    let u = if normal.z == 0.0 {
        // On the axis and on the plane of the seam the sign of zero decides, as in IEEE 754.
        big(match (x_negative, z_negative) {
            (false, _) => 0.5,
            (true, false) => 1.0,
            (true, true) => 0.0,
        })
    } else if x_negative && z_negative {
        (-&z).atan2(&-&x) / turn // equal to 1/2 + atan2(z, x) / turn, without its cancellation
    } else {
        big(0.5) + z.atan2(&x) / turn
    };
    let h = (&x * &x + &z * &z).sqrt();
    let v = if h == big(0.0) { big(if normal.y > 0.0 { 0.0 } else { 1.0 }) } else { h.atan2(&y) / pi() };
    (u, v)
}

/// Returns `base` to the power `exponent`, for a positive base.
pub(crate) fn power(base: f64, exponent: f64) -> Big {
    (big(base).ln() * big(exponent)).exp()
}

/// Returns the distance of `computed` from `exact`, in units in the last place of a double at `exact`.
pub(crate) fn ulps(computed: f64, exact: &Big) -> f64 {
    let difference = big(computed) - exact;
    let nearest = exact.to_f64().value().abs();
    let ulp_exponent = if nearest < f64::MIN_POSITIVE { -1074 } else { exponent_of(exact).max(-1022) - 52 };
    // Scaled to the size of 1 before it becomes a double.
    let unit = Big::from_parts(Integer::from(1), ulp_exponent);
    (difference / unit).to_f64().value().abs()
}

/// Returns the whole part of the logarithm to base 2.
fn exponent_of(x: &Big) -> isize {
    let (significand, exponent) = x.clone().into_repr().into_parts();
    let bits = isize::try_from(dashu::base::BitTest::bit_len(&significand)).expect("a small number");
    exponent + bits - 1
}

/// Returns the relative error of `hi + lo`.
pub(crate) fn pair_error((hi, lo): (f64, f64), exact: &Big) -> f64 {
    let difference = big(hi) + big(lo) - exact;
    if difference == big(0.0) { 0.0 } else { (difference / exact).to_f64().value().abs() }
}

//! Colours of a texture at coordinates that are enclosed.
//!
//! The samples are the doubles nearest to `sample / maxval`, as [`Texture::nearest`] returns them; what lies between them
//! is mathematics. `u` counts modulo 1, and `v` ends at the first and the last row.

use std::cmp::Ordering;

use rt_math::exact::Ball;

use crate::Texture;

/// Returns the colour of the texel at `(u, v)`, which is exact; `None` if the texel is open.
///
/// With `tie` a coordinate that may lie at the border of a texel is taken to lie there, and so in the texel that begins
/// there (for `v = 1`, in the last row); then the answer is `None` only for coordinates that are unknown. If a ball holds
/// several borders, as `u` next to a pole, its midpoint counts.
#[must_use]
pub fn nearest<const LIMBS: usize>(
    texture: &Texture,
    [u, v]: &[Ball<LIMBS>; 2],
    tie: bool,
) -> Option<[Ball<LIMBS>; 3]> {
    let (width, height) = (whole(texture.width()), whole(texture.height()));
    let place = |x: &Ball<LIMBS>| x.floor().or_else(|| if tie { taken_for_whole(x) } else { None });
    let column = place(&(u * Ball::from_integer(width)))?;
    let down = v * Ball::from_integer(height);
    // Beyond the first and the last border there is one row, whether the ball reaches over the edge or not.
    let row = if (down - Ball::ONE).sign() == Some(Ordering::Less) {
        0
    } else if matches!((down - Ball::from_integer(height - 1)).sign(), Some(Ordering::Equal | Ordering::Greater)) {
        height - 1
    } else {
        place(&down)?
    };
    Some(color(texture, column, row))
}

/// Returns the colour at `(u, v)`, interpolated linearly between the four nearest texel centers.
///
/// The cell between the centers may be open: the function is continuous, so each possible cell is evaluated with weights
/// within `0..=1`, and the answer encloses all.
#[must_use]
pub fn bilinear<const LIMBS: usize>(texture: &Texture, [u, v]: &[Ball<LIMBS>; 2]) -> [Ball<LIMBS>; 3] {
    let (width, height) = (whole(texture.width()), whole(texture.height()));
    let from_center = |x: &Ball<LIMBS>, size: i64| x * Ball::from_integer(size) - Ball::ONE.scale(-1);
    let (across, down) = (from_center(u, width), from_center(v, height));
    let (Some(columns), Some(rows)) = (cells(&across), cells(&down)) else {
        // Anything between the least and the largest sample.
        return [Ball::ZERO.hull(&Ball::ONE); 3];
    };
    let between = |a: &[Ball<LIMBS>; 3], b: &[Ball<LIMBS>; 3], weight: &Ball<LIMBS>| {
        [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * weight)
    };
    let at = |column: i64, row: i64| {
        let weights = [(across, column), (down, row)].map(|(x, k)| (x - Ball::from_integer(k)).clamp());
        let [upper, lower] = [row, row + 1]
            .map(|row| between(&color(texture, column, row), &color(texture, column + 1, row), &weights[0]));
        between(&upper, &lower, &weights[1])
    };
    let both = |cells: [i64; 2], at: &dyn Fn(i64) -> [Ball<LIMBS>; 3]| match cells {
        [first, second] if first == second => at(first),
        cells => {
            let [first, second] = cells.map(at);
            [0, 1, 2].map(|i| first[i].hull(&second[i]))
        }
    };
    both(rows, &|row| both(columns, &|column| at(column, row)))
}

/// The one or two whole numbers `k` for which `x` may be in `k..=k + 1`; `None` if there are more.
fn cells<const LIMBS: usize>(x: &Ball<LIMBS>) -> Option<[i64; 2]> {
    if let Some(k) = x.floor() {
        return Some([k, k]);
    }
    let k = x.nearest_integer()?;
    holds_no_other(x, k).then_some([k - 1, k])
}

/// Whether all of `x` lies between `k - 1` and `k + 1`.
fn holds_no_other<const LIMBS: usize>(x: &Ball<LIMBS>, k: i64) -> bool {
    let below = x - Ball::from_integer(k - 1);
    let above = Ball::from_integer(k + 1) - x;
    [below, above].iter().all(|x| x.sign() == Some(Ordering::Greater))
}

/// The whole number that the ball holds, or if there are several the floor of its midpoint.
fn taken_for_whole<const LIMBS: usize>(x: &Ball<LIMBS>) -> Option<i64> {
    let k = x.nearest_integer()?;
    if holds_no_other(x, k) { Some(k) } else { (x - Ball::ONE.scale(-1)).nearest_integer() }
}

/// The colour of a texel, of a column modulo the width and a row between the first and the last.
fn color<const LIMBS: usize>(texture: &Texture, column: i64, row: i64) -> [Ball<LIMBS>; 3] {
    let column = column.rem_euclid(whole(texture.width()));
    let row = row.clamp(0, whole(texture.height()) - 1);
    let [column, row] = [column, row].map(|x| usize::try_from(x).expect("inside the picture"));
    texture.color_at(column, row).to_array().map(Ball::from_f64)
}

/// A size as a number that may be negative.
fn whole(size: usize) -> i64 {
    i64::try_from(size).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certified::truth::{assert_encloses, big};
    use glam::DVec3;
    use oracle::{Big, Random, exact};

    fn any_texture(rng: &mut Random) -> Texture {
        let (width, height) = (rng.below(7) + 1, rng.below(7) + 1);
        let samples = (0..3 * width * height).map(|_| u16::try_from(rng.below(256)).expect("a byte")).collect();
        Texture::new(width, height, samples, 255).expect("the samples fit")
    }

    /// A coordinate in `0..=1` with few bits or many, and often at a border or a center.
    fn coordinate(rng: &mut Random, size: usize) -> f64 {
        let special = rng.below(2 * size + 1) as f64 / (2 * size) as f64;
        match rng.below(4) {
            0 => special,
            1 => rng.nudge(special, 2).clamp(oracle::scale(1.0, -60), 1.0),
            2 => rng.below(257) as f64 / 256.0,
            _ => rng.share(),
        }
    }

    fn floor(x: &Big) -> i64 {
        #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
        let floor = x.floor().to_f64().value() as i64;
        floor
    }

    fn texel(texture: &Texture, column: i64, row: i64) -> DVec3 {
        let (width, height) = (whole(texture.width()), whole(texture.height()));
        let [column, row] = [column.rem_euclid(width), row.clamp(0, height - 1)];
        let [column, row] = [column, row].map(|k| usize::try_from(k).expect("inside the picture"));
        texture.color_at(column, row)
    }

    fn size(n: usize) -> Big {
        exact(n as f64)
    }

    #[test]
    fn the_nearest_texel_is_the_one_that_holds_the_exact_coordinates() {
        let mut rng = Random::new(1);
        let (mut found, mut open) = (0, 0);
        for _ in 0..20_000 {
            let texture = any_texture(&mut rng);
            let coordinates = [coordinate(&mut rng, texture.width()), coordinate(&mut rng, texture.height())];
            let exactly = coordinates.map(Ball::<2>::from_f64);
            let [u, v] = coordinates.map(exact);
            let truth = texel(&texture, floor(&(u * size(texture.width()))), floor(&(v * size(texture.height()))));
            for tie in [false, true] {
                let color = nearest(&texture, &exactly, tie).expect("exact coordinates leave nothing open");
                assert_eq!(color.map(|c| c.ends()), truth.to_array().map(|c| (c, c)), "{coordinates:?}");
            }
            // A ball around another point that holds these coordinates: open, or the same texel.
            let radius = Ball::from_f64(rng.with_exponent(-120..-2));
            let shifted = exactly.map(|x| (x + radius * Ball::from_f64(rng.uniform())).widen(&radius));
            match nearest(&texture, &shifted, false) {
                Some(color) => {
                    assert_eq!(color.map(|c| c.ends()), truth.to_array().map(|c| (c, c)), "{coordinates:?}");
                    found += 1;
                }
                None => open += 1,
            }
        }
        assert!(found > 1000 && open > 1000, "{found} {open}");
    }

    #[test]
    fn a_tie_belongs_to_the_texel_that_begins_there() {
        let samples = (0..12).map(|i| u16::try_from(i / 3).expect("small"));
        let texture = Texture::new(2, 2, samples.collect(), 3).expect("the samples fit");
        let dust = Ball::<2>::ONE.scale(-100);
        let around = |x: f64| (Ball::from_f64(x) - dust.scale(-1)).widen(&dust);
        let at =
            |u: f64, v: f64, tie: bool| nearest(&texture, &[around(u), around(v)], tie).map(|c| c[0].ends().1 * 3.0);
        for (u, v, texel) in [(0.5, 0.25, 1.0), (0.25, 0.5, 2.0), (0.5, 0.5, 3.0), (0.0, 0.25, 0.0), (1.0, 0.75, 2.0)] {
            assert_eq!([at(u, v, false), at(u, v, true)], [None, Some(texel)], "{u} {v}");
        }
        // Rows end: a ball that reaches over the edge leaves nothing open.
        assert_eq!([at(0.25, 0.0, false), at(0.25, 1.0, false)], [Some(0.0), Some(2.0)]);
        assert_eq!(nearest(&texture, &[Ball::UNKNOWN, around(0.25)], true).map(|c| c[0].ends()), None);
        let all = Ball::ZERO.hull(&Ball::ONE);
        let at_pole = nearest(&texture, &[all, around(0.0)], true).expect("a tie");
        assert_eq!(at_pole[0].ends().1 * 3.0, 1.0, "as at an exact pole, u is 1/2");
    }

    #[test]
    fn bilinear_lookup_encloses_the_exact_mixture() {
        let mut rng = Random::new(2);
        for _ in 0..10_000 {
            let texture = any_texture(&mut rng);
            let coordinates = [coordinate(&mut rng, texture.width()), coordinate(&mut rng, texture.height())];
            let [u, v] = coordinates.map(exact);
            let (x, y) = (u * size(texture.width()) - exact(0.5), v * size(texture.height()) - exact(0.5));
            let (column, row) = (floor(&x), floor(&y));
            let (across, down) = (x.clone() - x.floor(), y.clone() - y.floor());
            let exactly = coordinates.map(Ball::<4>::from_f64);
            let radius = Ball::from_f64(rng.with_exponent(-200..-2));
            let shifted = exactly.map(|x| (x + radius * Ball::from_f64(rng.uniform())).widen(&radius));
            let (color, wide) = (bilinear(&texture, &exactly), bilinear(&texture, &shifted));
            let reach = big(&radius.abs()).1;
            for i in 0..3 {
                let mix = |row: i64| {
                    let [left, right] = [column, column + 1].map(|k| exact(texel(&texture, k, row)[i]));
                    &left + (&right - &left) * &across
                };
                let truth = mix(row) + (mix(row + 1) - mix(row)) * &down;
                assert!(color[i].is_exact(), "{coordinates:?}");
                assert_encloses(&color[i], &truth, &Big::ZERO);
                // Two texels differ by at most 1, so the slope is at most 14; a ball is twice as wide as its radius, the
                // shift as wide again, and two hulls double that each.
                assert_encloses(&wide[i], &truth, &(&reach * exact(14.0 * 16.0) + oracle::power_of_two(-240)));
            }
        }
        let grey = Texture::new(2, 1, vec![0, 255], 255).expect("the samples fit");
        let unknown = bilinear(&grey, &[Ball::<2>::UNKNOWN, Ball::ZERO]);
        assert!(unknown[0].ends().0 <= 0.0 && (1.0..1.001).contains(&unknown[0].ends().1));
    }
}

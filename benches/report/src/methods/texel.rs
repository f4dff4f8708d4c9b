//! The texel that a normal points at, in a map of the sphere. A case is the normal, of any length, not along the axis;
//! the verdict is the number of the texel, row by row; there is no value.

use std::array::from_fn;
use std::sync::LazyLock;

use rt_math::exact::Ball;
use rt_shade::color::to_sample;
use rt_shade::{Texture, certified, sphere_uv, texture_uv_within};

use super::mapping::textbook_coordinates;
use super::method::{Answer, Method};
use super::real::{Float, dvec3, normalized, vector};

/// Columns and rows of the map: no powers of two, and few enough for a byte.
pub(crate) const SIDE: u8 = 15;

/// Each texel is grey, its number as a byte.
static MAP: LazyLock<Texture> = LazyLock::new(|| {
    let side = usize::from(SIDE);
    Texture::from_bytes(side, side, (0..SIDE * SIDE).collect(), 255).expect("a byte for each texel")
});

/// Returns the methods that find a texel.
pub(crate) fn texel() -> Vec<Method<3, 0>> {
    vec![
        Method::new("textbook f32", "½ + atan2(z, x)/2π, ½ - asin(y)/π, of a unit normal", textbook::<f32>),
        Method::new("textbook", "½ + atan2(z, x)/2π, ½ - asin(y)/π, of a unit normal", textbook::<f64>),
        Method::ours("ours, not certified", |case| {
            let (u, v) = sphere_uv(dvec3(case, 0));
            number(MAP.nearest(u, v).x)
        }),
        Method::ours("ours", |case| {
            let (coordinates, errors) = texture_uv_within(dvec3(case, 0), 0.0, true);
            match MAP.nearest_within(coordinates, errors) {
                Some(color) => number(color.x),
                None => climb(case),
            }
        }),
    ]
}

fn textbook<T: Float>(case: &[f64; 3]) -> Answer<0> {
    let [u, v] = textbook_coordinates(normalized(vector::<T>(case, 0))).map(T::wide);
    number(MAP.nearest(u, v).x)
}

/// The number of a texel of this grey.
fn number(grey: f64) -> Answer<0> {
    Answer::without_values(u8::try_from(to_sample(grey, 255)).expect("a sample is at most 255"))
}

/// The texel by enclosures, as the renderer finds it where doubles leave it open.
#[cold]
#[inline(never)]
fn climb(case: &[f64; 3]) -> Answer<0> {
    let stages = [enclosed::<2>, enclosed::<8>, enclosed::<32>];
    let grey = stages.iter().find_map(|enclosed| enclosed(case, false)).or_else(|| enclosed::<32>(case, true));
    number(grey.unwrap_or(0.0))
}

/// The grey of the texel, if `64 LIMBS` bits decide, or with `tie` in any case.
fn enclosed<const LIMBS: usize>(case: &[f64; 3], tie: bool) -> Option<f64> {
    let normal: [Ball<LIMBS>; 3] = from_fn(|i| Ball::from_f64(case[i]));
    certified::nearest(&MAP, &certified::texture_uv(&normal, true), tie).map(|color| color[0].ends().0)
}

//! `SphEng`: the minimal sphere that encloses given spheres.
//!
//! Farthest-first pivoting. At most four of the spheres, the support, decide the answer: the minimal sphere of the
//! support is a lower bound of the minimal sphere of all. As long as some sphere sticks out of it, the one that
//! sticks out farthest joins the support, the minimal sphere of these at most five is found by trying their subsets,
//! and the radius grows. When nothing sticks out, that is the answer. (Welzl's recursion, which does this for points,
//! is wrong for spheres: K. Fischer and B. Gärtner, "The smallest enclosing ball of balls", 2004.)

mod apart;
mod certify;
mod exact;
mod extreme;
pub(crate) mod nodes;
mod pivot;
mod refine;
mod scan;
mod tangent;

use fearless_simd::{Level, Simd};
use glam::DVec3;
use rt_math::exact::U;

use crate::Sphere;
use crate::simd::dispatch;
use certify::Bracket;
use extreme::extreme;
use pivot::{LANES, SphereLanes, pivot};
use stage::{Stage, decided};
use tangent::{ORDINARY_SQUARES, Tangent};

/// Counts, in tests only, which stage decided, and how often exact integers were asked: so that tests can show that
/// every one is reached, and that none goes on for long.
mod stage {
    rt_math::count_stages! {
        /// What decides a radius.
        Stage {
            /// Reaches in double-double: no double lies within their error.
            DoubleDouble,
            /// Exact integers.
            Integers,
            /// The support was sought again in double-double.
            Refined,
            /// A question to exact integers.
            Question,
        }
    }
}

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
    fn single(index: usize, sphere: &Sphere) -> Self {
        Self { sphere: *sphere, lower_bound: sphere.radius(), support: [index; 4], support_len: 1 }
    }

    /// The indices of the spheres that decide the answer: one to four, ascending.
    #[must_use]
    pub fn support(&self) -> &[usize] {
        &self.support[..self.support_len]
    }
}

/// Returns the minimal sphere that encloses all `spheres`.
///
/// `None` if there are none, or if no sphere with a finite double radius encloses them.
///
/// ```
/// use rt_geom::{Sphere, enclosing_sphere};
///
/// let ball = |x, radius| Sphere::new([x, 0.0, 0.0], radius).unwrap();
/// let found = enclosing_sphere(&[ball(-3.0, 1.0), ball(0.5, 2.0), ball(2.0, 2.0)]).unwrap();
/// assert_eq!((found.sphere, found.support()), (ball(0.0, 4.0), &[0, 2][..]));
/// ```
#[must_use]
pub fn enclosing_sphere(spheres: &[Sphere]) -> Option<Enclosing> {
    enclosing_at(Level::new(), spheres)
}

/// [`enclosing_sphere`] with the instructions of a given level; the bits of the answer do not depend on it.
fn enclosing_at(level: Level, spheres: &[Sphere]) -> Option<Enclosing> {
    dispatch!(level, simd => enclosing(simd, spheres))
}

#[inline(always)]
fn enclosing<S: Simd>(simd: S, spheres: &[Sphere]) -> Option<Enclosing> {
    match spheres {
        [] => None,
        [one] => Some(Enclosing::single(0, one)),
        [a, b] => two(simd, spheres, a, b),
        [_, _, _] | [_, _, _, _] => simd.vectorize(
            #[inline(always)]
            || apart::three_or_four(simd, spheres),
        ),
        // Each in a function of its own, for the compiler's sake.
        _ if spheres.len() <= LANES => simd.vectorize(
            #[inline(always)]
            || few_spheres::<S, 1>(simd, spheres),
        ),
        _ if spheres.len() <= 2 * LANES => simd.vectorize(
            #[inline(always)]
            || few_spheres::<S, 2>(simd, spheres),
        ),
        _ if spheres.len() <= 8 * LANES => simd.vectorize(
            #[inline(always)]
            || few_spheres::<S, 8>(simd, spheres),
        ),
        _ => simd.vectorize(
            #[inline(always)]
            || many_spheres(simd, spheres),
        ),
    }
}

/// Two spheres, in closed form.
#[inline(always)]
fn two<S: Simd>(simd: S, spheres: &[Sphere], a: &Sphere, b: &Sphere) -> Option<Enclosing> {
    match certify::pair(simd, a, b) {
        Some((bracket, bound)) => finish(spheres, &bracket, bound, &[0, 1]),
        None => simd.vectorize(
            #[inline(always)]
            || few_spheres::<S, 1>(simd, spheres),
        ),
    }
}

/// At most eight spheres to a vector, without touching the heap.
#[inline(always)]
fn few_spheres<S: Simd, const VECTORS: usize>(simd: S, spheres: &[Sphere]) -> Option<Enclosing> {
    let origin = spheres[0].center();
    let lanes = SphereLanes::<S, VECTORS>::new(simd, spheres.iter(), origin);
    let (far, square) = lanes.farthest_from_mean(simd);
    if !ORDINARY_SQUARES.contains(&square) {
        return extreme(spheres, enclosing_sphere);
    }
    let mut tangent = Tangent::single(far);
    pivot(simd, &mut tangent, &lanes, |lane| lane, spheres, origin);
    let (mut bracket, bound) = certify::certify(simd, &tangent, spheres);
    // Who else is close enough to the boundary to stick out?
    let (center, limit) = near(&tangent, &bracket, spheres, origin);
    let mut near = lanes.beyond(simd, center, limit) & (u64::MAX >> (64 - spheres.len()));
    let [a, b, c, d] = tangent.padded();
    near &= !((1 << a) | (1 << b) | (1 << c) | (1 << d));
    let before = bracket.high;
    while near != 0 {
        let mut four = [near.trailing_zeros() as usize; 4];
        for index in &mut four {
            if near != 0 {
                *index = near.trailing_zeros() as usize;
                near &= near - 1;
            }
        }
        bracket.enclose(simd, four.map(|index| &spheres[index]));
    }
    if bracket.high > before || doubtful(&bracket, bound) {
        return refined(spheres, &tangent, &bracket, bound);
    }
    finish(spheres, &bracket, bound, tangent.support())
}

/// More spheres than registers hold.
#[inline(always)]
fn many_spheres<S: Simd>(simd: S, spheres: &[Sphere]) -> Option<Enclosing> {
    let origin = spheres[0].center();
    let answer = scan::support(
        simd,
        spheres,
        origin,
        #[inline(always)]
        |tangent, blocks| {
            let (mut bracket, bound) = certify::certify(simd, &tangent, spheres);
            let (center, limit) = near(&tangent, &bracket, spheres, origin);
            let before = bracket.high;
            let mut four = [tangent.support()[0]; 4];
            let mut held = 0;
            blocks.beyond(simd, center, limit, |index| {
                four[held] = index;
                held += 1;
                if held == 4 {
                    bracket.enclose(simd, four.map(|index| &spheres[index]));
                    held = 0;
                }
            });
            bracket.enclose(simd, four.map(|index| &spheres[index]));
            if bracket.high > before || doubtful(&bracket, bound) {
                return refined(spheres, &tangent, &bracket, bound);
            }
            finish(spheres, &bracket, bound, tangent.support())
        },
    );
    answer.unwrap_or_else(|| extreme(spheres, enclosing_sphere))
}

/// The center of `tangent` less `origin`, and a limit: what reaches less far from there lies inside `bracket`.
#[inline(always)]
fn near(tangent: &Tangent<f64>, bracket: &Bracket, spheres: &[Sphere], origin: DVec3) -> ([f64; 3], f64) {
    let (center, _) = tangent.sphere(spheres, origin);
    let shift = (bracket.center - origin) - DVec3::from(center);
    // The margin is a share of the radius, however far the center has moved.
    (center, bracket.low * (1.0 - 64.0 * U) - shift.abs().element_sum())
}

/// Whether the gap between the radius and its lower bound is more than what rounding the center to doubles costs.
#[inline(always)]
fn doubtful(bracket: &Bracket, bound: f64) -> bool {
    let spacing = bracket.center.abs().max_element() * (2.0 * U);
    let close = bracket.high - bound <= bracket.high * (6.0 * U) + spacing;
    !close
}

/// The answer of the cold path, or of the fast one if that is better.
#[cold]
#[inline(never)]
fn refined(spheres: &[Sphere], tangent: &Tangent<f64>, fast: &Bracket, fast_bound: f64) -> Option<Enclosing> {
    decided(Stage::Refined);
    let (better, bracket, bound) = refine::refine(spheres, tangent.support());
    let bound = if fast_bound > bound { fast_bound } else { bound };
    if fast.high < bracket.high {
        return finish(spheres, fast, bound, tangent.support());
    }
    finish(spheres, &bracket, bound, better.support())
}

#[inline(always)]
fn finish(spheres: &[Sphere], bracket: &Bracket, lower_bound: f64, support: &[usize]) -> Option<Enclosing> {
    let radius = if bracket.low < bracket.high {
        decided(Stage::Integers);
        bracket.settle(spheres)
    } else {
        decided(Stage::DoubleDouble);
        bracket.high
    };
    let sphere = Sphere::new(bracket.center, radius).ok()?;
    let (support, support_len) = sorted(support);
    Some(Enclosing { sphere, lower_bound, support, support_len })
}

/// The places in ascending order, the first one repeated, and how many there are. (A network of minima and maxima: the
/// order cannot be predicted, so a branch would cost more.)
fn sorted(support: &[usize]) -> ([usize; 4], usize) {
    let at = |place: usize| support.get(place).copied().unwrap_or(usize::MAX);
    let order = |a: usize, b: usize| (a.min(b), a.max(b));
    let ((a, b), (c, d)) = (order(at(0), at(1)), order(at(2), at(3)));
    let ((a, c), (b, d)) = (order(a, c), order(b, d));
    let (b, c) = order(b, c);
    ([a, b, c, d].map(|place| if place == usize::MAX { a } else { place }), support.len())
}

#[cfg(test)]
mod tests {
    use super::exact::contains_exactly;
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
    fn every_level_gives_the_same_bits() {
        let mut random = oracle::Random::new(1);
        let mut unit = || random.share();
        for count in [2, 3, 8, 9, 64, 65, 3000] {
            for round in 0..200 {
                let grid = if round % 2 == 0 { 1e9 } else { 4.0 };
                let set: Vec<_> = (0..count)
                    .map(|_| ball((unit() * grid).round(), (unit() * grid).round(), unit() * grid, unit()))
                    .collect();
                let best = enclosing_at(Level::new(), &set);
                #[cfg(target_arch = "x86_64")]
                let avx2 = Level::new().as_avx2().map(Level::Avx2);
                #[cfg(not(target_arch = "x86_64"))]
                let avx2 = None;
                for level in std::iter::once(Level::baseline()).chain(avx2) {
                    assert_eq!(enclosing_at(level, &set), best, "{level:?} {set:?}");
                }
                if count > 64 && round == 9 {
                    break;
                }
            }
        }
    }

    #[test]
    fn whole_numbers_stay_whole() {
        // Only exact integers can tell that 2 encloses and that no larger double is needed.
        let pair = [ball(-1.0, 0.0, 0.0, 1.0), ball(1.0, 0.0, 0.0, 1.0)];
        assert_eq!(enclosing_sphere(&pair).unwrap().sphere, ball(0.0, 0.0, 0.0, 2.0));
        let five = [ball(3.0, 4.0, 0.0, 0.0), ball(-5.0, 0.0, 0.0, 0.0), ball(4.0, -3.0, 0.0, 0.0)];
        assert_eq!(enclosing_sphere(&five).unwrap().sphere.radius(), 5.0);
    }

    #[test]
    fn every_stage_of_the_certificate_is_reached_and_decides() {
        stage::decisions();
        // A reach that is a double: only integers can tell that it is no more.
        let exact = [ball(-1.0, 0.0, 0.0, 1.0), ball(1.0, 0.0, 0.0, 1.0)];
        assert_eq!(enclosing_sphere(&exact).unwrap().sphere.radius(), 2.0);
        assert_eq!(stage::decisions()[..3], [0, 1, 0]);
        // √(1 + 2⁻¹²⁰): only integers can tell that it is more than 1.
        let tiny = (-60.0_f64).exp2();
        let more = [ball(-1.0, -tiny, 0.0, 0.0), ball(1.0, tiny, 0.0, 0.0)];
        assert_eq!(enclosing_sphere(&more).unwrap().sphere.radius(), 1.0_f64.next_up());
        assert_eq!(stage::decisions()[..3], [0, 1, 0]);
        // The same with more spheres, by the other two paths.
        for count in [10, 1000] {
            for (pair, radius) in [(exact, 2.0), (more, 1.0_f64.next_up())] {
                let mut set = vec![ball(0.0, 0.0, 0.0, 0.5); count];
                set[1..3].copy_from_slice(&pair);
                assert_eq!(enclosing_sphere(&set).unwrap().sphere.radius(), radius, "{count} {pair:?}");
                let [_, integers, ..] = stage::decisions();
                assert_eq!(integers, 1, "{count} {pair:?}");
            }
        }
        // An irrational radius.
        let ordinary = [ball(0.0, 0.0, 0.0, 0.25), ball(1.0, 1.0, 0.0, 0.5), ball(0.0, 1.0, 2.0, 0.0)];
        assert!(enclosing_sphere(&ordinary).is_some());
        assert_eq!(stage::decisions()[..3], [1, 0, 0]);
        // Where a sphere touches a larger one from inside, but for rounding, the support is in doubt.
        let mut random = oracle::Random::new(3);
        let mut unit = || random.share();
        for _ in 0..1000 {
            let (big, radius) = (DVec3::new(unit(), unit(), unit()), 0.5 * unit());
            let mut set = vec![Sphere::new(big, 1.0).unwrap()];
            for _ in 0..3 {
                let way = DVec3::new(unit() - 0.5, unit() - 0.5, unit() - 0.5).normalize();
                let out = 10.0_f64.powf(-17.0 * unit());
                set.push(Sphere::new(big + (1.0 - radius + out) * way, radius).unwrap());
            }
            assert!(enclosing_sphere(&set).is_some());
        }
        let [doubles, _, refined, _] = stage::decisions();
        assert!(doubles > 900 && refined > 0, "{doubles} {refined}");
    }

    /// Numbers in 0..1.
    fn units() -> impl FnMut() -> f64 {
        let mut random = oracle::Random::new(4);
        move || random.share()
    }

    /// So many spheres of this size: points, equal balls, any balls, or on a grid with reaches that are whole numbers.
    fn some_at(kind: usize, count: usize, offset: DVec3, size: f64, mut unit: impl FnMut() -> f64) -> Vec<Sphere> {
        (0..count)
            .map(|_| {
                let mut both = || 2.0 * unit() - 1.0;
                let mut center = DVec3::new(both(), both(), both());
                let mut radius = [0.0, 0.5, both().abs(), 0.0][kind];
                if kind == 3 {
                    (center, radius) = ((center * 4.0).round() * 3.0, (both() * 3.0).round().abs());
                }
                Sphere::new(offset + center * size, radius * size).unwrap()
            })
            .collect()
    }

    #[test]
    fn exact_integers_are_asked_a_bounded_number_of_questions() {
        let mut unit = units();
        let mut counts = [2, 2, 3, 4, 16].into_iter().cycle();
        let mut most = 0.0_f64;
        for offset in (0..=300).step_by(4).filter(|&decade| decade == 0 || decade >= 8) {
            for scale in (-300..=300).step_by(20) {
                for kind in 0..4 {
                    let count = counts.next().unwrap();
                    let distance = if offset == 0 { 0.0 } else { 10.0_f64.powi(offset) };
                    // The size is any, or one that shows at this offset.
                    let near = match offset {
                        0 => f64::from_bits(1) * 1000.0_f64.powf(unit()),
                        decade => 10.0_f64.powf(f64::from(decade) - 18.0 * unit()),
                    };
                    for size in [10.0_f64.powi(scale), near] {
                        let offset = distance * DVec3::new(unit(), unit(), unit());
                        let set = some_at(kind, count, offset, size, &mut unit);
                        stage::decisions();
                        let answer = enclosing_sphere(&set).unwrap();
                        let [.., questions] = stage::decisions();
                        most = most.max(questions as f64 / count as f64);
                        // Three a sphere; and three more where a scaled copy is solved first.
                        assert!(questions <= 6 * count, "{questions} {set:?}");
                        let (center, radius) = (answer.sphere.center(), answer.sphere.radius());
                        let holds = |radius| set.iter().all(|s| contains_exactly(center, radius, s));
                        assert!(holds(radius) && !(radius > 0.0 && holds(radius.next_down())), "{set:?}");
                        assert!(answer.lower_bound <= radius, "{set:?}");
                    }
                }
            }
        }
        assert!(most >= 1.0, "{most}");
    }

    #[test]
    fn of_the_doubles_around_a_center_the_best_is_taken() {
        // Doubles are whole numbers here. The true center is half-way along two axes.
        let far = 2.0_f64.powi(52);
        let points =
            |at: &[(f64, f64)]| -> Vec<Sphere> { at.iter().map(|&(x, y)| ball(far + x, far + y, 0.0, 0.0)).collect() };
        // From (0, 0) and (1, 1) the points reach √2.
        let pair = enclosing_sphere(&points(&[(0.0, 0.0), (1.0, 1.0)])).unwrap();
        assert_eq!(pair.sphere.radius(), 1.0, "{pair:?}");
        let three = enclosing_sphere(&points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])).unwrap();
        assert_eq!(three.sphere.radius(), 1.0, "{three:?}");
    }

    #[test]
    fn far_from_the_origin_doubles_decide_nearly_always() {
        let mut unit = units();
        stage::decisions();
        for count in 2..=4 {
            for decade in [8, 10, 12, 13] {
                for _ in 0..250 {
                    let offset = 10.0_f64.powi(decade) * DVec3::new(unit(), unit(), unit());
                    let set = some_at(2, count, offset, 1.0, &mut unit);
                    let answer = enclosing_sphere(&set).unwrap();
                    // Rounding the center costs no more than it must.
                    let spacing = answer.sphere.center().abs().max_element() * (2.0 * U);
                    let gap = answer.sphere.radius() - answer.lower_bound;
                    assert!(gap <= spacing + 1e-15, "{gap:e} {spacing:e} {set:?}");
                }
            }
        }
        let [doubles, integers, refined, _] = stage::decisions();
        assert!(doubles > 2950 && integers < 10 && refined < 60, "{doubles} {integers} {refined}");
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

//! Certified samples: a byte is taken only if every number within the bound of its error rounds to it.
//!
//! A pixel that is not certain in doubles climbs: to vectors that are good to a few ulp with exact sides, and then to
//! enclosures with 128, 512 and 2,048 bits. What is still open is taken for an exact tie, and counted.

use glam::DVec3;
use rt_geom::{Hit, Ray};
use rt_math::exact::{Ball, U};
use rt_shade::color::{clamp, to_sample};
use rt_shade::{PointLight, Shaded};
use serde::Serialize;

use crate::objects::Objects;
use crate::scene::Scene;
use crate::seen::Seen;

/// How many samples each stage has decided, all of a pixel by the stage that decided its last byte.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Certified {
    /// In doubles with a bound.
    pub doubles: u64,
    /// From vectors in double-double, with exact sides.
    pub double_double: u64,
    /// By enclosures with 128, 512 and 2,048 bits.
    pub enclosures: [u64; 3],
    /// Taken for an exact tie, since 2,048 bits left them open.
    pub undecided: u64,
}

impl Certified {
    /// The sum of two counts.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            doubles: self.doubles + other.doubles,
            double_double: self.double_double + other.double_double,
            enclosures: [0, 1, 2].map(|i| self.enclosures[i] + other.enclosures[i]),
            undecided: self.undecided + other.undecided,
        }
    }
}

/// A scene's pixels, and how they came about.
pub(crate) struct Certifier<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) objects: &'a Objects,
    pub(crate) maxval: u16,
    pub(crate) counts: Certified,
}

impl Certifier<'_> {
    /// The samples of a pixel whose rays see these hits, in these colours (one for each hit).
    pub(crate) fn pixel(&mut self, rays: &[Ray], hits: &[Option<Hit>], shaded: &[Shaded]) -> [u16; 3] {
        let count = rays.len() as u64;
        if shaded.is_empty() {
            // The mean of equal colours, or of none.
            self.counts.doubles += count;
            if self.scene.transparent {
                return [0; 3];
            }
            return self.scene.background.to_array().map(|channel| to_sample(channel, self.maxval));
        }
        if let Some(samples) = certain(self.mean(hits, shaded), self.colors(rays, shaded), self.maxval) {
            self.counts.doubles += count;
            return samples;
        }
        self.climb(rays, hits, shaded)
    }

    /// How many colours a pixel is the mean of: one for each ray or, without a background, for each that hits.
    fn colors(&self, rays: &[Ray], shaded: &[Shaded]) -> usize {
        if self.scene.transparent { shaded.len() } else { rays.len() }
    }

    /// The sum of a pixel's clamped colours, and a bound of its error without the rounding of the sum.
    fn mean(&self, hits: &[Option<Hit>], shaded: &[Shaded]) -> Shaded {
        let mut shaded = shaded.iter();
        let mut sum = Shaded { color: DVec3::ZERO, error: 0.0 };
        for hit in hits {
            let color = match hit {
                None if self.scene.transparent => continue,
                None => self.scene.background,
                Some(_) => {
                    let Shaded { color, error } = *shaded.next().expect("one for each hit");
                    sum.error += error;
                    color
                }
            };
            // Each sample is clamped before the mean, so that one bright highlight does not outshine its pixel.
            sum.color += clamp(color);
        }
        sum
    }

    /// The stages after doubles.
    #[cold]
    #[inline(never)]
    fn climb(&mut self, rays: &[Ray], hits: &[Option<Hit>], shaded: &[Shaded]) -> [u16; 3] {
        let count = rays.len() as u64;
        let lights = &self.scene.lights;
        let mut next = shaded.iter();
        let shaded: Vec<Shaded> = (rays.iter().zip(hits))
            .filter_map(|(ray, hit)| Some((ray, (*hit)?)))
            .map(|(ray, hit)| match next.next() {
                Some(&exact) if exact.error == 0.0 => exact,
                _ => Seen::new(self.scene, self.objects, ray, hit).refined(lights),
            })
            .collect();
        if let Some(samples) = certain(self.mean(hits, &shaded), self.colors(rays, &shaded), self.maxval) {
            self.counts.double_double += count;
            return samples;
        }
        let pixel = Pixel { certifier: self, rays, hits, shaded: &shaded, lights };
        type Stage = fn(&Pixel) -> Option<[u16; 3]>;
        let stages: [Stage; 3] =
            [|pixel| pixel.enclosed::<2>(None), |pixel| pixel.enclosed::<8>(None), |pixel| pixel.enclosed::<32>(None)];
        let decided = stages.iter().enumerate().find_map(|(stage, enclosed)| Some((stage, enclosed(&pixel)?)));
        match decided {
            Some((stage, samples)) => {
                self.counts.enclosures[stage] += count;
                samples
            }
            None => {
                let samples = pixel.enclosed::<32>(Some(&mut 0)).unwrap_or([0; 3]);
                self.counts.undecided += count;
                samples
            }
        }
    }
}

/// A pixel that doubles leave open.
struct Pixel<'a> {
    certifier: &'a Certifier<'a>,
    rays: &'a [Ray],
    hits: &'a [Option<Hit>],
    /// One for each hit.
    shaded: &'a [Shaded],
    lights: &'a [PointLight],
}

impl Pixel<'_> {
    /// The samples, if `64 LIMBS` bits decide; with `ties`, what is open is taken for equality.
    fn enclosed<const LIMBS: usize>(&self, mut ties: Option<&mut u32>) -> Option<[u16; 3]> {
        let Certifier { scene, objects, maxval, .. } = *self.certifier;
        let known = |color: DVec3| clamp(color).to_array().map(Ball::<LIMBS>::from_f64);
        let mut sum = [Ball::<LIMBS>::ZERO; 3];
        let mut shaded = self.shaded.iter();
        for (ray, hit) in self.rays.iter().zip(self.hits) {
            let color = match (hit, hit.and_then(|_| shaded.next())) {
                (None, _) if scene.transparent => continue,
                (None, _) => known(scene.background),
                (Some(_), Some(exact)) if exact.error == 0.0 => known(exact.color),
                (Some(hit), _) => {
                    let seen = Seen::new(scene, objects, ray, *hit);
                    seen.enclosed(self.lights, ties.as_deref_mut())?.map(|channel| channel.clamp())
                }
            };
            sum = [0, 1, 2].map(|i| sum[i] + color[i]);
        }
        // ⌊maxval sum / n + ½⌋
        let count = Ball::from_integer(self.certifier.colors(self.rays, self.shaded) as i64);
        let scaled = sum.map(|sum| sum * Ball::from_integer(maxval.into()) / count + Ball::ONE.scale(-1));
        let mut samples = [0; 3];
        for (sample, scaled) in samples.iter_mut().zip(&scaled) {
            // At the whole number itself a byte rounds up.
            let floor = scaled.floor().or_else(|| ties.is_some().then(|| scaled.nearest_integer())?)?;
            *sample = u16::try_from(floor.clamp(0, maxval.into())).expect("a number in the range of maxval");
        }
        Some(samples)
    }
}

/// The samples of a mean of `count` colours in `0..=1`, if none of the numbers within the bound of the error of their
/// sum has other ones.
///
/// `maxval sum / count + ½` is rounded three times, and the sum once for each colour after the first.
fn certain(Shaded { color, error }: Shaded, count: usize, maxval: u16) -> Option<[u16; 3]> {
    if count == 1 && error == 0.0 {
        return Some(color.to_array().map(|channel| to_sample(channel, maxval)));
    }
    let (count, most) = (count as f64, f64::from(maxval));
    let slack = 1.01 * most * (error / count + (count + 4.0) * U);
    let scaled = color.to_array().map(|channel| most * (channel / count) + 0.5);
    // Not negative, since the slack is below ¼; a cast saturates.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from ¼ to maxval + ¾")]
    let [low, high] = [-slack, slack].map(|slack| scaled.map(|scaled| (scaled + slack) as u16));
    // False for NaN.
    (slack < 0.25 && low == high).then_some(low)
}

#[cfg(test)]
mod tests {
    use oracle::{Big, Random, cases, exact};

    use super::*;

    /// `2 maxval sum + count`, of which the byte is the quotient with `2 count`.
    fn doubled(sum: &Big, count: usize, maxval: u16) -> Big {
        exact(2.0 * f64::from(maxval)) * sum + exact(count as f64)
    }

    #[test]
    fn no_wrong_byte_is_certain() {
        let mut random = Random::new(1);
        let (mut taken, mut beside) = (0, 0);
        for _ in 0..cases(1_000_000) {
            let (count, maxval) = (1 + random.below(64), random.pick(&[1, 255, 65535]));
            // Colours whose mean is next to the middle between two bytes.
            let byte = 1.0 + random.below(usize::from(maxval)) as f64;
            let middle = (byte - 0.5) / f64::from(maxval);
            let spread = random.pick(&[0.0, 1.0]) * middle.min(1.0 - middle);
            let mut colors: Vec<f64> =
                (1..count).map(|_| (middle + spread * random.uniform()).clamp(0.0, 1.0)).collect();
            let rest = count as f64 * middle - colors.iter().sum::<f64>();
            let dust = random.sign() * random.power(-60..-20) * random.share();
            colors.push((rest + random.pick(&[0.0, 1.0]) * dust).clamp(0.0, 1.0));
            random.shuffle(&mut colors);
            let error = if random.one_in(3) { 0.0 } else { random.power(-60..-20) };
            // As the certifier adds them up.
            let sum = colors.iter().fold(0.0, |sum, color| sum + color);
            let shaded = Shaded { color: DVec3::splat(sum), error };
            let Some(bytes) = certain(shaded, count, maxval) else { continue };
            taken += 1;
            let truth = colors.iter().fold(exact(0.0), |sum, &color| sum + exact(color));
            for off in [-error, 0.0, error] {
                let doubled = doubled(&(&truth + exact(off)), count, maxval);
                let [low, high] = [0.0, 1.0].map(|more| exact(2.0 * count as f64 * (f64::from(bytes[0]) + more)));
                assert!(low <= doubled && doubled < high, "{colors:?} {error:e} of {maxval}: {bytes:?}");
            }
            beside += usize::from((sum / count as f64 - middle).abs() * f64::from(maxval) < 1e-9);
        }
        assert!(taken > cases(1_000_000) / 4 && beside > cases(1_000_000) / 50, "{taken} {beside}");
    }

    #[test]
    fn what_is_unknown_is_not_certain() {
        for error in [f64::NAN, f64::INFINITY, 0.01] {
            for count in [1, 4] {
                assert_eq!(certain(Shaded { color: DVec3::splat(0.3), error }, count, 255), None, "{error} {count}");
            }
        }
        assert_eq!(certain(Shaded { color: DVec3::ONE, error: 1e-15 }, 1, 65535), Some([65535; 3]));
        assert_eq!(certain(Shaded { color: DVec3::ZERO, error: 1e-15 }, 1, 65535), Some([0; 3]));
        // Exactly one half is a byte for one colour that is exact, and open for a sum, which was rounded.
        assert_eq!(certain(Shaded { color: DVec3::splat(0.5), error: 0.0 }, 1, 255), Some([128; 3]));
        assert_eq!(certain(Shaded { color: DVec3::splat(1.0), error: 0.0 }, 2, 255), None);
    }
}

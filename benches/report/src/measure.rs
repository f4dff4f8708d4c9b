//! Time and error of every method of a kernel, from the same cases in the same run.

use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::cases::Class;
use super::methods::{Answer, Method, Run};
use super::progress::progress;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Effort {
    /// Cases in each class.
    pub(super) cases: usize,
    /// Times that each method is timed on each class, in turn with the others.
    pub(super) rounds: usize,
    /// Nanoseconds that one timing takes at least.
    pub(super) timing: u64,
    /// Spheres in the largest cloud.
    pub(super) spheres: usize,
    /// Rows of a picture; it is 4 to 3 wide.
    pub(super) rows: u32,
}

/// All that was measured of one kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Kernel {
    pub(super) name: String,
    /// What the verdict is, or nothing if there is none.
    pub(super) verdict: Option<String>,
    /// What the values are, or nothing if there are none.
    pub(super) values: Option<String>,
    /// Whether a verdict that is too high costs time alone, as in a cull.
    pub(super) one_sided: bool,
    pub(super) methods: Vec<Measured>,
}

/// All that was measured of one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Measured {
    pub(super) name: String,
    pub(super) source: String,
    pub(super) ours: bool,
    pub(super) has_values: bool,
    /// One for each class; the first is the ordinary one.
    pub(super) classes: Vec<Cell>,
}

/// What was measured of one method on one class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Cell {
    pub(super) class: String,
    pub(super) errors: Errors,
    /// Nanoseconds for one case.
    pub(super) time: Time,
}

/// What the rounds of a timing gave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Time {
    pub(super) median: f64,
    pub(super) least: f64,
    /// The 95th percentile.
    pub(super) p95: f64,
}

/// A timing is noisy if its 95th percentile is above its median by more than this share.
pub(super) const NOISY: f64 = 0.10;

impl Time {
    /// Returns the percentiles of at least one time.
    pub(super) fn of(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        let percentile = |p: usize| times[(times.len() - 1) * p / 100];
        Self { median: percentile(50), least: percentile(0), p95: percentile(95) }
    }

    /// By which share the 95th percentile is above the median.
    pub(super) fn spread(&self) -> f64 {
        self.p95 / self.median - 1.0
    }

    pub(super) fn is_noisy(&self) -> bool {
        self.spread() > NOISY
    }
}

/// Errors, which are the same in every run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Errors {
    pub(super) cases: usize,
    pub(super) wrong_verdicts: usize,
    /// Those of them that are too low: a hit or a root lost, a rank too small.
    pub(super) lost: usize,
    /// Values where the verdict was right.
    pub(super) values: usize,
    /// Those that are not the double nearest to the exact value.
    pub(super) not_nearest: usize,
    /// Those that are NaN where there is a value.
    pub(super) nan: usize,
    /// Distance to the nearest double, in doubles; NaN counts as [`NAN_DISTANCE`].
    pub(super) median_ulp: f64,
    pub(super) max_ulp: f64,
    /// The case with the largest error, and the first with a wrong verdict, as the bits of its numbers.
    pub(super) worst: Option<String>,
    pub(super) first_wrong: Option<String>,
}

/// Above all distances between doubles.
pub(super) const NAN_DISTANCE: f64 = 18_446_744_073_709_551_616.0;

impl Measured {
    /// A method of which nothing was measured yet.
    pub(super) fn new(name: &str, source: &str, ours: bool, has_values: bool) -> Self {
        Self { name: name.to_owned(), source: source.to_owned(), ours, has_values, classes: Vec::new() }
    }

    /// Returns the errors of all classes together; the median is that of the ordinary class.
    pub(super) fn total(&self) -> Errors {
        let mut total = Errors { median_ulp: self.classes[0].errors.median_ulp, ..Errors::default() };
        for Cell { errors, .. } in &self.classes {
            total.cases += errors.cases;
            total.wrong_verdicts += errors.wrong_verdicts;
            total.lost += errors.lost;
            total.values += errors.values;
            total.not_nearest += errors.not_nearest;
            total.nan += errors.nan;
            total.max_ulp = total.max_ulp.max(errors.max_ulp);
        }
        total
    }

    /// Nanoseconds for one ordinary case.
    pub(super) fn time(&self) -> Time {
        self.classes[0].time
    }
}

/// Measures all methods of a kernel on all classes. An answer counts as `judge` sees it.
pub(super) fn kernel<const M: usize, const N: usize>(
    [name, verdict, values]: [&str; 3],
    methods: &[Method<M, N>],
    classes: &[Class<M>],
    reference: fn(&[f64; M]) -> Answer<N>,
    judge: fn(&[f64; M], Answer<N>) -> Answer<N>,
    effort: Effort,
) -> Kernel {
    progress(name);
    let described = |text: &str| (!text.is_empty()).then(|| text.to_owned());
    let unmeasured = |method: &Method<M, N>| {
        let Method { name, source, ours, has_values, .. } = *method;
        Measured::new(name, source, ours, has_values)
    };
    let mut measured: Vec<Measured> = methods.iter().map(unmeasured).collect();
    for class in classes {
        let truths: Vec<Answer<N>> = class.cases.par_iter().map(reference).collect();
        let mut answers = vec![Answer::without_values(0); class.cases.len()];
        let runs: Vec<Run<'_, N>> = methods.iter().map(|method| (method.prepare)(&class.cases)).collect();
        let times = take_turns(methods.len(), class.cases.len(), effort, |i| {
            black_box(&runs[i])(&mut answers);
            black_box(&mut answers);
        });
        for ((method, measured), time) in methods.iter().zip(&mut measured).zip(times) {
            measured.classes.push(Cell {
                class: class.name.to_owned(),
                errors: errors(method, &class.cases, &truths, judge),
                time,
            });
        }
    }
    Kernel {
        name: name.to_owned(),
        verdict: described(verdict),
        values: described(values),
        one_sided: false,
        methods: measured,
    }
}

/// Returns the nanoseconds for one case, of each of `count` methods, which take turns. `run` runs one over all cases.
pub(super) fn take_turns(count: usize, cases: usize, effort: Effort, mut run: impl FnMut(usize)) -> Vec<Time> {
    let mut time = |method: usize, passes: u64| {
        let start = Instant::now();
        (0..passes).for_each(|_| run(method));
        start.elapsed().as_nanos() as f64
    };
    let passes: Vec<u64> = (0..count)
        .map(|method| {
            time(method, 1);
            let once = time(method, 1).max(1.0);
            #[expect(clippy::cast_possible_truncation, reason = "a number of passes")]
            let passes = (effort.timing as f64 / once).ceil() as u64;
            passes.max(1)
        })
        .collect();
    let mut times = vec![Vec::new(); count];
    for _ in 0..effort.rounds {
        for ((method, &passes), times) in passes.iter().enumerate().zip(&mut times) {
            times.push(time(method, passes) / passes as f64 / cases as f64);
        }
    }
    times.into_iter().map(Time::of).collect()
}

/// Returns the bits of the numbers, from which a case can be run again.
pub(super) fn hexadecimal(case: &[f64]) -> String {
    let words: Vec<String> = case.iter().map(|x| format!("{:016x}", x.to_bits())).collect();
    words.join(" ")
}

/// Judges the answers of a method.
pub(super) fn errors<const M: usize, const N: usize>(
    method: &Method<M, N>,
    cases: &[[f64; M]],
    truths: &[Answer<N>],
    judge: fn(&[f64; M], Answer<N>) -> Answer<N>,
) -> Errors {
    let mut answers = vec![Answer::without_values(0); cases.len()];
    (method.prepare)(cases)(&mut answers);
    let mut errors = Errors { cases: cases.len(), ..Errors::default() };
    let mut distances = Vec::new();
    for ((case, &answer), truth) in cases.iter().zip(&answers).zip(truths) {
        let answer = judge(case, answer);
        let bits = || Some(hexadecimal(case));
        if answer.verdict != truth.verdict {
            errors.wrong_verdicts += 1;
            errors.lost += usize::from(answer.verdict < truth.verdict);
            errors.first_wrong = errors.first_wrong.or_else(bits);
            continue;
        }
        for (&value, &exact) in answer.values.iter().zip(&truth.values) {
            if exact.is_nan() || !method.has_values {
                continue;
            }
            let distance = distance(value, exact);
            if distance > errors.max_ulp {
                (errors.max_ulp, errors.worst) = (distance, bits());
            }
            errors.not_nearest += usize::from(distance > 0.0);
            errors.nan += usize::from(value.is_nan());
            distances.push(distance);
        }
    }
    distances.sort_by(f64::total_cmp);
    errors.values = distances.len();
    errors.median_ulp = distances.get(distances.len() / 2).copied().unwrap_or(0.0);
    errors
}

/// Returns how many doubles `x` is away from `exact`; the zeros are one number, infinity is next to the largest.
fn distance(x: f64, exact: f64) -> f64 {
    if x.is_nan() {
        return NAN_DISTANCE;
    }
    let position = |x: f64| {
        let size = (x.to_bits() & (u64::MAX >> 1)).cast_signed();
        i128::from(if x < 0.0 { -size } else { size })
    };
    (position(x) - position(exact)).unsigned_abs() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_doubles() {
        assert_eq!(distance(1.0, 1.0), 0.0);
        assert_eq!(distance(-0.0, 0.0), 0.0);
        assert_eq!(distance(1.0 + f64::EPSILON, 1.0), 1.0);
        assert_eq!(distance(-f64::from_bits(1), f64::from_bits(1)), 2.0);
        assert_eq!(distance(f64::MAX, f64::INFINITY), 1.0);
        assert_eq!(distance(f64::NAN, 0.0), NAN_DISTANCE);
        assert!(distance(f64::NEG_INFINITY, f64::INFINITY) < NAN_DISTANCE);
    }
}

//! The methods that the report compares: the textbook's and the literature's, restated here, beside ours.
//!
//! Each is a plain function of the numbers of one case, in the form in which its source gives it: none is tuned, and
//! none is made safer than its source makes it. Those that are generic run in `f32` and in `f64`.

mod barycentric;
mod enclosing;
mod inside;
mod mapping;
mod phong;
mod plane;
mod pseudo_inverse;
mod quadratic;
pub(super) mod real;
mod reflection;
mod sphere;
mod triangle;

pub(super) use barycentric::barycentric;
pub(super) use enclosing::{COUNT, enclosing};
pub(super) use inside::inside;
pub(super) use mapping::{mapping, textbook_coordinates};
pub(super) use phong::{MATERIAL, phong, terms};
pub(super) use plane::plane;
pub(super) use pseudo_inverse::pseudo_inverse;
pub(super) use quadratic::quadratic;
pub(super) use reflection::reflection;
pub(super) use sphere::{sphere, textbook_roots};
pub(super) use triangle::{crossing, triangle};

/// What a method answers for one case: a verdict, and values that mean something only with the right verdict.
///
/// What the numbers are is said where each kernel is defined. Where there is no value, it is NaN.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer<const N: usize> {
    pub(super) verdict: u8,
    pub(super) values: [f64; N],
}

impl<const N: usize> Answer<N> {
    /// A verdict without values: a miss.
    pub(super) fn without_values(verdict: u8) -> Self {
        Self { verdict, values: [f64::NAN; N] }
    }
}

/// Runs a method over many cases; the loop and the method are compiled together.
type Run<const M: usize, const N: usize> = Box<dyn Fn(&[[f64; M]], &mut [Answer<N>])>;

/// A method of a kernel whose cases are `M` numbers and whose answers hold `N` values.
pub(super) struct Method<const M: usize, const N: usize> {
    /// What it is called in tables and plots.
    pub(super) name: &'static str,
    /// Where it is from.
    pub(super) source: &'static str,
    /// Whether it is one of this project's own kernels.
    pub(super) ours: bool,
    /// Whether it gives values, or the verdict alone.
    pub(super) has_values: bool,
    pub(super) run: Run<M, N>,
}

impl<const M: usize, const N: usize> Method<M, N> {
    fn new(
        name: &'static str,
        source: &'static str,
        method: impl Fn(&[f64; M]) -> Answer<N> + 'static,
    ) -> Self {
        let run: Run<M, N> = Box::new(move |cases, answers| {
            for (case, answer) in cases.iter().zip(answers) {
                *answer = method(case);
            }
        });
        Self { name, source, ours: false, has_values: true, run }
    }

    fn ours(name: &'static str, method: impl Fn(&[f64; M]) -> Answer<N> + 'static) -> Self {
        Self { ours: true, ..Self::new(name, "this project", method) }
    }

    fn verdict_alone(self) -> Self {
        Self { has_values: false, ..self }
    }
}

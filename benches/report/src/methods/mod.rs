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

/// Runs a method over the cases that it was prepared for; the loop and the method are compiled together.
pub(super) type Run<'a, const N: usize> = Box<dyn Fn(&mut [Answer<N>]) + 'a>;

/// Brings cases into the form that a method takes, before time is taken.
type Prepare<const M: usize, const N: usize> = Box<dyn for<'a> Fn(&'a [[f64; M]]) -> Run<'a, N>>;

fn prepare<const M: usize, const N: usize>(
    prepare: impl for<'a> Fn(&'a [[f64; M]]) -> Run<'a, N> + 'static,
) -> Prepare<M, N> {
    Box::new(prepare)
}

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
    pub(super) prepare: Prepare<M, N>,
}

impl<const M: usize, const N: usize> Method<M, N> {
    fn new(name: &'static str, source: &'static str, method: impl Fn(&[f64; M]) -> Answer<N> + Copy + 'static) -> Self {
        let prepare = prepare(move |cases| {
            Box::new(move |answers| {
                for (case, answer) in cases.iter().zip(answers) {
                    *answer = method(case);
                }
            })
        });
        Self { name, source, ours: false, has_values: true, prepare }
    }

    fn ours(name: &'static str, method: impl Fn(&[f64; M]) -> Answer<N> + Copy + 'static) -> Self {
        Self { ours: true, ..Self::new(name, "this project", method) }
    }

    /// A kernel of ours that takes checked shapes, which are built before time is taken, as in a scene.
    fn ours_on<S: 'static>(
        name: &'static str,
        build: impl Fn(&[f64; M]) -> S + Copy + 'static,
        method: impl Fn(&S) -> Answer<N> + Copy + 'static,
    ) -> Self {
        let prepare = prepare(move |cases| {
            let shapes: Vec<S> = cases.iter().map(build).collect();
            Box::new(move |answers| {
                for (shape, answer) in shapes.iter().zip(answers) {
                    *answer = method(shape);
                }
            })
        });
        Self { name, source: "this project", ours: true, has_values: true, prepare }
    }

    fn verdict_alone(self) -> Self {
        Self { has_values: false, ..self }
    }
}

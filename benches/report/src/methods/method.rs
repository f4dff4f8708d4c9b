//! A method and its answers.

/// What a method answers for one case: a verdict, and values that mean something only with the right verdict.
///
/// What the numbers are is said where each kernel is defined. Where there is no value, it is NaN.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Answer<const N: usize> {
    pub(crate) verdict: u8,
    pub(crate) values: [f64; N],
}

impl<const N: usize> Answer<N> {
    /// A verdict without values: a miss.
    pub(crate) fn without_values(verdict: u8) -> Self {
        Self { verdict, values: [f64::NAN; N] }
    }
}

/// Runs a method over the cases that it was prepared for; the loop and the method are compiled together.
pub(crate) type Run<'a, const N: usize> = Box<dyn Fn(&mut [Answer<N>]) + 'a>;

/// Brings cases into the form that a method takes, before time is taken.
type Prepare<const M: usize, const N: usize> = Box<dyn for<'a> Fn(&'a [[f64; M]]) -> Run<'a, N>>;

fn prepare<const M: usize, const N: usize>(
    prepare: impl for<'a> Fn(&'a [[f64; M]]) -> Run<'a, N> + 'static,
) -> Prepare<M, N> {
    Box::new(prepare)
}

/// A method of a kernel whose cases are `M` numbers and whose answers hold `N` values.
pub(crate) struct Method<const M: usize, const N: usize> {
    /// What it is called in tables and plots.
    pub(crate) name: &'static str,
    /// Where it is from.
    pub(crate) source: &'static str,
    /// Whether it is one of this project's own kernels.
    pub(crate) ours: bool,
    /// Whether it gives values, or the verdict alone.
    pub(crate) has_values: bool,
    pub(crate) prepare: Prepare<M, N>,
}

impl<const M: usize, const N: usize> Method<M, N> {
    pub(super) fn new(
        name: &'static str,
        source: &'static str,
        method: impl Fn(&[f64; M]) -> Answer<N> + Copy + 'static,
    ) -> Self {
        let prepare = prepare(move |cases| {
            Box::new(move |answers| {
                for (case, answer) in cases.iter().zip(answers) {
                    *answer = method(case);
                }
            })
        });
        Self { name, source, ours: false, has_values: N > 0, prepare }
    }

    pub(super) fn ours(name: &'static str, method: impl Fn(&[f64; M]) -> Answer<N> + Copy + 'static) -> Self {
        Self { ours: true, ..Self::new(name, "this project", method) }
    }

    /// A kernel of ours that takes checked shapes, which are built before time is taken, as in a scene.
    pub(super) fn ours_on<S: 'static>(
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
        Self { name, source: "this project", ours: true, has_values: N > 0, prepare }
    }

    /// The method without its values.
    pub(super) fn verdict_alone(self) -> Self {
        Self { has_values: false, ..self }
    }
}

//! The kernels of the report: each with its methods, its cases and its reference.

use super::cull::cull;
use super::measure::{Effort, Kernel, kernel};
use super::methods::Answer;
use super::{cases, methods, reference};

/// Measures every kernel whose answers are a verdict, values, or both.
pub(super) fn kernels(effort: Effort) -> Vec<Kernel> {
    fn as_is<const M: usize, const N: usize>(_: &[f64; M], answer: Answer<N>) -> Answer<N> {
        answer
    }
    let n = effort.cases;
    // One name: the methods, the cases and the reference of a kernel are called alike.
    macro_rules! measured {
        ($kernel:ident, $description:expr) => {
            kernel($description, &methods::$kernel(), &cases::$kernel(n), reference::$kernel, as_is, effort)
        };
    }
    vec![
        measured!(quadratic, ["quadratic", "number of roots", "roots"]),
        measured!(sphere, ["ray and sphere", "hit or miss", "t of the nearest hit"]),
        measured!(triangle, ["ray and triangle", "hit or miss", "t of the hit"]),
        kernel(
            ["barycentric coordinates", "hit or miss", "weights of the vertices"],
            &methods::barycentric(),
            &cases::triangle(n),
            reference::barycentric,
            as_is,
            effort,
        ),
        measured!(inside, ["point in triangle", "inside or outside", ""]),
        measured!(plane, ["plane of a triangle", "", "coefficients"]),
        measured!(pseudo_inverse, ["pseudo-inverse", "rank", "entries"]),
        measured!(reflection, ["reflection", "", "components"]),
        measured!(phong, ["Phong's light", "byte", ""]),
        measured!(mapping, ["texture coordinates", "", "u and v"]),
        measured!(texel, ["texture lookup", "texel", ""]),
        kernel(
            ["enclosing sphere", "all inside", "radius"],
            &methods::enclosing(),
            &cases::enclosing(n.div_ceil(4)),
            reference::enclosing,
            reference::judge_enclosing,
            effort,
        ),
        cull(effort),
    ]
}

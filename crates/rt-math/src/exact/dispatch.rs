//! Hardware fused multiply-add, chosen at run time: the one place of the dispatch.

/// Whether the processor has the fused multiply-add, found once and remembered.
///
/// A build with `--cfg rt_math_without_fma` in `RUSTFLAGS` says no, so that the other side can be measured and tested.
#[inline(always)]
#[must_use]
pub fn has_fma() -> bool {
    #[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
    let found = std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(any(target_arch = "x86_64", target_arch = "x86")))]
    let found = cfg!(target_arch = "aarch64");
    found && !cfg!(rt_math_without_fma)
}

/// Defines a function whose body is compiled with and without hardware FMA, and chosen at run time.
///
/// `kernel` is a function generic over `const FMA: bool`, marked `#[inline(always)]` together with all that it calls
/// on its hot path, so that it is compiled anew inside each caller. Cold parts are ordinary `#[cold] #[inline(never)]`
/// functions, which exist once. `kernel` must give the same result for either value.
///
/// - FMA compiled in (`-C target-feature=+fma`), or 64-bit ARM: `kernel::<true>`. It is not inlined either: arguments
///   in registers cannot stall on a vector load of what was just stored as scalars.
/// - x86 otherwise: a call that cannot be inlined of `kernel::<true>`, compiled for FMA, or `kernel::<false>`. The
///   choice costs one relaxed load and a predictable branch, the call one to two nanoseconds: put the dispatch around
///   a whole kernel, not around its parts, and a cheap filter that decides most cases before it.
/// - elsewhere: a direct call of `kernel::<false>`.
///
/// ```
/// use rt_math::exact::{DoubleDouble, two_prod};
///
/// #[inline(always)]
/// fn determinant_kernel<const FMA: bool>(a: f64, b: f64, c: f64, d: f64) -> f64 {
///     (DoubleDouble::<FMA>::product(a, d) - DoubleDouble::product(b, c)).high()
/// }
///
/// rt_math::fma_dispatch! {
///     /// Returns `a d - b c` without cancellation.
///     pub fn determinant(a: f64, b: f64, c: f64, d: f64) -> f64 = determinant_kernel;
/// }
///
/// assert_eq!(determinant(1.0 + 1e-15, 1.0, 1.0, 1.0 - 1e-15), determinant_kernel::<false>(1.0 + 1e-15, 1.0, 1.0, 1.0 - 1e-15));
/// ```
#[macro_export]
macro_rules! fma_dispatch {
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident($($argument:ident: $kind:ty),* $(,)?) $(-> $result:ty)? = $kernel:ident;
    ) => {
        $(#[$attribute])*
        #[cfg_attr(any(target_feature = "fma", target_arch = "aarch64"), inline(never))]
        #[cfg_attr(not(any(target_feature = "fma", target_arch = "aarch64")), inline)]
        $visibility fn $name($($argument: $kind),*) $(-> $result)? {
            #[cfg(any(target_feature = "fma", target_arch = "aarch64"))]
            {
                $kernel::<true>($($argument),*)
            }
            #[cfg(all(any(target_arch = "x86_64", target_arch = "x86"), not(target_feature = "fma")))]
            {
                #[target_feature(enable = "fma")]
                fn fused($($argument: $kind),*) $(-> $result)? {
                    $kernel::<true>($($argument),*)
                }
                #[inline(never)]
                fn plain($($argument: $kind),*) $(-> $result)? {
                    $kernel::<false>($($argument),*)
                }
                if $crate::exact::has_fma() {
                    #[expect(unsafe_code, reason = "the only way into a function compiled for a CPU feature")]
                    // SAFETY: `has_fma` has found the feature on this processor.
                    unsafe {
                        fused($($argument),*)
                    }
                } else {
                    plain($($argument),*)
                }
            }
            #[cfg(not(any(
                target_feature = "fma",
                target_arch = "aarch64",
                target_arch = "x86_64",
                target_arch = "x86"
            )))]
            {
                $kernel::<false>($($argument),*)
            }
        }
    };
}

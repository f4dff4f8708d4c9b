//! The choice of an instruction set, made once for a kernel, and what the set offers.

use std::ops::Mul;

#[cfg(not(any(target_feature = "sse2", all(target_arch = "aarch64", target_feature = "neon"))))]
use fearless_simd::Fallback as Baseline;
#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
use fearless_simd::Neon as Baseline;
#[cfg(target_feature = "sse2")]
use fearless_simd::Sse2 as Baseline;
use fearless_simd::{Simd, prelude::*};
use rt_math::exact::two_prod_with;

/// Compiles a kernel for each instruction set that earns its copy, and runs the copy for the processor.
///
/// On x86 these are AVX-512, AVX2 (with fused multiply-add) and the baseline, SSE2; on
/// 64-bit Arm NEON alone. All give the same bits. There are two forms:
///
/// - `dispatch!(level, simd => expression)` runs an expression with the instructions of a `Level`, of which every
///   kernel in the expression takes `simd`. What the expression uses passes through memory.
/// - `dispatch! { fn name(argument: Type, ..) -> Type = kernel; }` defines a function that calls
///   `kernel::<FMA, S>(simd, argument, ..)`. The arguments pass in registers: for kernels of a few nanoseconds, with
///   vectors of four lanes at most, so without a copy for AVX-512.
///
/// Kernels are `#[inline(always)]`, together with all that they call on the hot path.
macro_rules! dispatch {
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $name:ident($($argument:ident: $kind:ty),* $(,)?) -> $result:ty = $kernel:ident;
    ) => {
        $(#[$attribute])*
        #[inline]
        $visibility fn $name($($argument: $kind),*) -> $result {
            fearless_simd::kernel!(
                #[inline]
                fn avx2(simd: Avx2, $($argument: $kind),*) -> $result {
                    $kernel::<true, _>(simd, $($argument),*)
                }
            );
            #[inline(never)]
            fn plain($($argument: $kind),*) -> $result {
                const FMA: bool = cfg!(all(target_arch = "aarch64", target_feature = "neon"));
                $kernel::<FMA, _>($crate::simd::baseline(), $($argument),*)
            }
            #[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
            if rt_math::exact::has_fma() && let Some(simd) = fearless_simd::Level::new().as_avx2() {
                return avx2(simd, $($argument),*);
            }
            plain($($argument),*)
        }
    };
    ($level:expr, $simd:ident => $run:expr) => {{
        let level: fearless_simd::Level = $level;
        #[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
        {
            if let Some($simd) = level.as_avx512() {
                fearless_simd::Simd::vectorize(
                    $simd,
                    #[inline(always)]
                    || $run,
                )
            } else if let Some($simd) = level.as_avx2() {
                fearless_simd::Simd::vectorize(
                    $simd,
                    #[inline(always)]
                    || $run,
                )
            } else {
                let $simd = $crate::simd::baseline();
                fearless_simd::Simd::vectorize(
                    $simd,
                    #[inline(always)]
                    || $run,
                )
            }
        }
        #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
        {
            // The baseline is the only level, and others would take as long to compile.
            let _ = level;
            let $simd = $crate::simd::baseline();
            fearless_simd::Simd::vectorize(
                $simd,
                #[inline(always)]
                || $run,
            )
        }
        #[cfg(not(any(
            target_arch = "x86_64",
            target_arch = "x86",
            all(target_arch = "aarch64", target_feature = "neon")
        )))]
        fearless_simd::dispatch!(level, $simd => $run)
    }};
}
pub(crate) use dispatch;

/// What every processor has for which this is compiled, without run-time checks.
#[cfg(target_feature = "sse2")]
#[inline(always)]
pub(crate) fn baseline() -> Baseline {
    fearless_simd::Level::baseline().as_sse2().expect("the compiler was told that it is there")
}

/// What every processor has for which this is compiled, without run-time checks.
#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
#[inline(always)]
pub(crate) fn baseline() -> Baseline {
    fearless_simd::Level::baseline().as_neon().expect("the compiler was told that it is there")
}

/// What every processor has for which this is compiled, without run-time checks.
#[cfg(not(any(target_feature = "sse2", all(target_arch = "aarch64", target_feature = "neon"))))]
#[inline(always)]
pub(crate) fn baseline() -> Baseline {
    Baseline::new()
}

/// Whether the instructions of this level have a fused multiply-add; known when compiled.
#[inline(always)]
pub(crate) fn has_fma<S: Simd>(simd: S) -> bool {
    #[cfg(target_arch = "x86_64")]
    return simd.level().as_avx2().is_some();
    #[cfg(target_arch = "aarch64")]
    return simd.level().as_neon().is_some();
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    return false;
}

/// [`rt_math::exact::two_prod`] in every lane.
#[inline(always)]
pub(crate) fn two_prod<const FMA: bool, S: Simd, V>(a: V, b: V) -> (V, V)
where
    V: SimdFloat<S, Element = f64> + Mul<f64, Output = V>,
{
    two_prod_with::<FMA, _>(
        a,
        b,
        #[inline(always)]
        |a, b, c| a.mul_sub_precise(b, c),
    )
}

/// Asks for cache lines that are likely to be read soon.
#[inline(always)]
pub(crate) fn prefetch_lines<T>(start: *const T, lines: usize) {
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (start, lines);
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        for line in 0..lines {
            #[expect(unsafe_code, reason = "the intrinsic takes a raw pointer")]
            // SAFETY: a prefetch has no effect but on the caches, whatever the address.
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(start.cast::<i8>().wrapping_add(64 * line));
            }
        }
    }
}

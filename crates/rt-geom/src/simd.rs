//! What an instruction set offers.

use fearless_simd::Simd;

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

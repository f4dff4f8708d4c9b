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

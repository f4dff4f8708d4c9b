//! Counts, in tests only, which stage decided: so that tests can show that every one is reached.

/// Defines the stages of a crate's kernels, `decided`, which notes one, and in tests `decisions`, which gives the
/// counts of all stages, in their order, since its last call on this thread. Compiled to nothing outside the tests of
/// the crate.
#[doc(hidden)]
#[macro_export]
macro_rules! count_stages {
    ($(#[$attribute:meta])* $name:ident { $($(#[$doc:meta])* $stage:ident,)* }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy)]
        pub(crate) enum $name {
            $($(#[$doc])* $stage,)*
        }

        /// Notes that `stage` has decided.
        #[inline(always)]
        pub(crate) fn decided(stage: $name) {
            #[cfg(test)]
            COUNTS.with_borrow_mut(|counts| counts[stage as usize] += 1);
            #[cfg(not(test))]
            let _ = stage;
        }

        #[cfg(test)]
        const STAGES: usize = [$($name::$stage),*].len();

        #[cfg(test)]
        std::thread_local! {
            static COUNTS: std::cell::RefCell<[usize; STAGES]> = const { std::cell::RefCell::new([0; STAGES]) };
        }

        /// The decisions of the stages, in their order, since the last call on this thread.
        #[cfg(test)]
        pub(crate) fn decisions() -> [usize; STAGES] {
            COUNTS.take()
        }
    };
}

count_stages! {
    /// What decides an answer.
    Stage {
        /// Doubles and an error bound.
        Filter,
        /// Double-double.
        DoubleDouble,
        /// Three doubles, where a sum cancels.
        Triple,
        /// Fixed-point numbers within a window.
        Fixed,
        /// Integers of any size.
        Integers,
    }
}

//! Counts, in tests only, which stage decided: so that tests can show that every one is reached.

/// What decides a radius.
#[derive(Clone, Copy)]
pub(super) enum Stage {
    /// Reaches in double-double: no double lies within their error.
    DoubleDouble,
    /// Exact integers.
    Integers,
    /// The support was sought again in double-double.
    Refined,
}

/// Notes that `stage` has decided; nothing at all outside tests.
#[inline(always)]
pub(super) fn decided(stage: Stage) {
    #[cfg(test)]
    counter::COUNTS.with_borrow_mut(|counts| counts[stage as usize] += 1);
    #[cfg(not(test))]
    let _ = stage;
}

#[cfg(test)]
pub(super) use counter::decisions;

#[cfg(test)]
mod counter {
    use std::cell::RefCell;

    thread_local! {
        pub(super) static COUNTS: RefCell<[usize; 3]> = const { RefCell::new([0; 3]) };
    }

    /// The decisions of the stages, in their order, since the last call on this thread.
    pub(crate) fn decisions() -> [usize; 3] {
        COUNTS.take()
    }
}

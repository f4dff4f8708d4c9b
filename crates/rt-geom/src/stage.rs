//! Counts, in tests only, which stage decided: so that tests can show that every one is reached.

/// What decides an answer after the filter.
#[derive(Clone, Copy)]
pub(crate) enum Stage {
    /// Double-double.
    DoubleDouble,
    /// Fixed-point numbers within a window.
    Fixed,
    /// Integers of any size.
    Integers,
}

/// Notes that `stage` has decided; nothing at all outside tests.
#[inline(always)]
pub(crate) fn decided(stage: Stage) {
    #[cfg(test)]
    counter::COUNTS.with_borrow_mut(|counts| counts[stage as usize] += 1);
    #[cfg(not(test))]
    let _ = stage;
}

#[cfg(test)]
pub(crate) use counter::decisions;

#[cfg(test)]
mod counter {
    use std::cell::RefCell;

    thread_local! {
        pub(super) static COUNTS: RefCell<[usize; 3]> = const { RefCell::new([0; 3]) };
    }

    /// The decisions of double-double, fixed-point numbers and integers since the last call on this thread.
    pub(crate) fn decisions() -> [usize; 3] {
        COUNTS.take()
    }
}

//! Counts, in tests only, which stage decided and how often exact integers were asked: so that tests can show that
//! every stage is reached, and that none goes on for long.

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

/// Notes that exact integers were asked one question more; nothing at all outside tests.
#[inline(always)]
pub(super) fn asked() {
    #[cfg(test)]
    counter::QUESTIONS.set(counter::QUESTIONS.get() + 1);
}

#[cfg(test)]
pub(super) use counter::{decisions, questions};

#[cfg(test)]
mod counter {
    use std::cell::{Cell, RefCell};

    thread_local! {
        pub(super) static COUNTS: RefCell<[usize; 3]> = const { RefCell::new([0; 3]) };
        pub(super) static QUESTIONS: Cell<usize> = const { Cell::new(0) };
    }

    /// The decisions of the stages, in their order, since the last call on this thread.
    pub(crate) fn decisions() -> [usize; 3] {
        COUNTS.take()
    }

    /// The questions to exact integers since the last call on this thread.
    pub(crate) fn questions() -> usize {
        QUESTIONS.take()
    }
}

//! Counts, in tests only, which stage decided: so that tests can show that every one is reached.

rt_math::count_stages! {
    /// What decides an answer after the filter.
    Stage {
        /// Double-double.
        DoubleDouble,
        /// Fixed-point numbers within a window.
        Fixed,
        /// Integers of any size.
        Integers,
    }
}

//! Counts, in tests only, which stage decided and how often exact integers were asked: so that tests can show that
//! every stage is reached, and that none goes on for long.

rt_math::count_stages! {
    /// What decides a radius.
    Stage {
        /// Reaches in double-double: no double lies within their error.
        DoubleDouble,
        /// Exact integers.
        Integers,
        /// The support was sought again in double-double.
        Refined,
        /// A question to exact integers.
        Question,
    }
}

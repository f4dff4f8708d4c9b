//! Which parameters a range holds.

use std::ops::Range;

/// Whether a range holds `t`: the rule as documented, word for word.
#[must_use]
pub fn holds(within: &Range<f64>, t: f64) -> bool {
    if within.start.is_nan() || within.end.is_nan() {
        return false;
    }
    let empty = within.start.total_cmp(&within.end).is_ge();
    let from = within.start.total_cmp(&t).is_le();
    let to = within.end == f64::INFINITY || t.total_cmp(&within.end).is_lt();
    !empty && from && to
}

#[test]
fn ends_are_as_documented() {
    assert!(holds(&(0.0..1.0), 0.0) && !holds(&(0.0..1.0), 1.0) && !holds(&(0.0..1.0), -0.0));
    assert!(holds(&(0.0..f64::INFINITY), f64::INFINITY) && !holds(&(1.0..1.0), 1.0) && !holds(&(f64::NAN..1.0), 0.0));
}

//! Two reports compared: errors must be equal, times alike.

use super::Report;

/// Returns one line for each difference: any in the errors, and times that differ by more than `factor`, if given.
pub(super) fn differences(stored: &Report, new: &Report, factor: Option<f64>) -> Vec<String> {
    let mut differences = Vec::new();
    if stored.kernels.len() != new.kernels.len() {
        differences.push(format!("{} kernels, now {}", stored.kernels.len(), new.kernels.len()));
    }
    for (old, new) in stored.kernels.iter().zip(&new.kernels) {
        if old.methods.len() != new.methods.len() || old.name != new.name {
            differences.push(format!("{}: other methods, now of {}", old.name, new.name));
            continue;
        }
        for (old_method, new_method) in old.methods.iter().zip(&new.methods) {
            if old_method.classes.len() != new_method.classes.len() || old_method.name != new_method.name {
                differences.push(format!("{}, {}: now {}", old.name, old_method.name, new_method.name));
                continue;
            }
            for (was, is) in old_method.classes.iter().zip(&new_method.classes) {
                let place = format!("{}, {}, {}", old.name, old_method.name, was.class);
                if was.class != is.class || was.errors != is.errors {
                    let worst = |errors: &super::measure::Errors| {
                        format!("{} wrong, {} ulp at most", errors.wrong_verdicts, errors.max_ulp)
                    };
                    differences.push(format!("{place}: {}, now {}", worst(&was.errors), worst(&is.errors)));
                }
                let ratio = is.median / was.median;
                if factor.is_some_and(|factor| !(1.0 / factor..=factor).contains(&ratio)) {
                    differences.push(format!("{place}: {:.1} ns, now {:.1} ns", was.median, is.median));
                }
            }
        }
    }
    for (was, is) in stored.trees.iter().zip(&new.trees) {
        if (&was.method, was.spheres, was.different, was.tests)
            != (&is.method, is.spheres, is.different, is.tests)
        {
            differences.push(format!(
                "{} in {} spheres: {} other hits, now {}",
                was.method, was.spheres, was.different, is.different
            ));
        }
    }
    differences
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Effort, measure};

    #[test]
    fn errors_are_the_same_in_two_runs_and_a_difference_is_told() {
        let effort = Effort { cases: 8, rounds: 1, timing: 1 };
        let (first, second) = (measure(effort), measure(effort));
        assert_eq!(differences(&first, &second, None), Vec::<String>::new());
        let mut broken = second;
        broken.kernels[0].methods[0].classes[0].errors.wrong_verdicts += 1;
        broken.kernels[1].methods[0].classes[0].median = 3.0 * first.kernels[1].methods[0].classes[0].median;
        assert_eq!(differences(&first, &broken, None).len(), 1);
        let all = differences(&first, &broken, Some(2.0));
        assert!(all.iter().any(|line| line.starts_with("ray and sphere")), "{all:?}");
    }
}

//! Two reports compared: errors must be equal, times alike. And one report on its own: whether it has all that text
//! needs.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

use super::measure::Time;
use super::results::Report;

/// Returns one line for each difference: any in the errors, and times that differ by more than `factor`, if given.
pub(super) fn differences(stored: &Report, new: &Report, factor: Option<f64>) -> Vec<String> {
    let (old, new) = (entries(stored), entries(new));
    let mut differences = Vec::new();
    for Entry { place, errors, time } in &old {
        match new.iter().find(|entry| entry.place == *place) {
            None => differences.push(format!("{place}: no longer measured")),
            Some(entry) => {
                if *errors != entry.errors {
                    differences.push(format!("{place}: {errors}, now {}", entry.errors));
                }
                let ratio = entry.time.median / time.median;
                if factor.is_some_and(|factor| !(1.0 / factor..=factor).contains(&ratio)) {
                    let (was, is) = (time.median, entry.time.median);
                    differences.push(format!("{place}: {was:.1} ns, now {is:.1} ns"));
                }
            }
        }
    }
    let added = new.iter().filter(|entry| !old.iter().any(|known| known.place == entry.place));
    differences.extend(added.map(|entry| format!("{}: not in the stored report", entry.place)));
    differences
}

/// One measurement: where, all its errors in words, and its time.
struct Entry {
    place: String,
    errors: String,
    time: Time,
}

fn entries(report: &Report) -> Vec<Entry> {
    let mut entries = Vec::new();
    for kernel in &report.kernels {
        for method in &kernel.methods {
            for cell in &method.classes {
                let e = &cell.errors;
                let case = |case: &Option<String>| case.clone().unwrap_or("none".to_owned());
                entries.push(Entry {
                    place: format!("{}, {}, {}", kernel.name, method.name, cell.class),
                    errors: format!(
                        "{} wrong ({} lost) of {}, {} of {} values not nearest, {} NaN, {} ulp in the middle, {} at most, \
                         first wrong {}, worst {}",
                        e.wrong_verdicts,
                        e.lost,
                        e.cases,
                        e.not_nearest,
                        e.values,
                        e.nan,
                        e.median_ulp,
                        e.max_ulp,
                        case(&e.first_wrong),
                        case(&e.worst),
                    ),
                    time: cell.time,
                });
            }
        }
    }
    entries.extend(report.trees.iter().map(|row| Entry {
        place: format!("{} in {} spheres", row.method, row.spheres),
        errors: format!("{} other hits of {}, {:?} tests", row.different, row.compared, row.tests),
        time: row.time,
    }));
    for pictured in &report.pictures {
        entries.extend(pictured.methods.iter().map(|painted| Entry {
            place: format!("{}, {}", pictured.scene, painted.method),
            errors: format!("{} of {} x {} pixels wrong", painted.wrong_pixels, pictured.width, pictured.height),
            time: painted.time,
        }));
    }
    entries
}

/// Tells what a report lacks that its text is made of.
pub(super) fn whole(report: &Report) -> Result<(), String> {
    let Report { kernels, trees, pictures, .. } = report;
    for kernel in kernels {
        let classes = kernel.methods.first().map_or(0, |method| method.classes.len());
        if classes == 0 || kernel.methods.iter().any(|method| method.classes.len() != classes) {
            return Err(format!("expected every method of {:?} with the same classes", kernel.name));
        }
        if kernel.methods.iter().flat_map(|method| &method.classes).any(|cell| cell.errors.cases == 0) {
            return Err(format!("expected at least one case in each class of {:?}", kernel.name));
        }
    }
    if kernels.is_empty() || trees.is_empty() || pictures.is_empty() {
        return Err("expected at least one kernel, one tree and one picture".to_owned());
    }
    if let Some(empty) =
        pictures.iter().find(|pictured| pictured.methods.is_empty() || pictured.width * pictured.height == 0)
    {
        return Err(format!("expected methods and pixels in {:?}", empty.scene));
    }
    for painted in pictures.iter().flat_map(|pictured| &pictured.methods) {
        if painted.png.as_ref().is_some_and(|png| BASE64_STANDARD.decode(png).is_err()) {
            return Err(format!("expected a picture in base64 for {:?}", painted.method));
        }
    }
    let times = entries(report).into_iter().find(|entry| !(entry.time.median > 0.0 && entry.time.p95.is_finite()));
    times.map_or(Ok(()), |entry| Err(format!("expected a time above 0 for {}", entry.place)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Effort;

    const TINY: Effort = Effort { cases: 8, rounds: 1, timing: 1, spheres: 100, rows: 6 };

    #[test]
    fn errors_are_the_same_for_any_number_of_threads_and_a_difference_is_told() {
        let with_threads = |count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().expect("threads can be had");
            pool.install(|| Report::measure(TINY))
        };
        let (first, second) = (with_threads(1), with_threads(2));
        assert_eq!(differences(&first, &second, None), Vec::<String>::new());
        assert_eq!(whole(&first), Ok(()));

        let mut broken = second.clone();
        broken.kernels[0].methods[0].classes[0].errors.wrong_verdicts += 1;
        broken.kernels[1].methods[0].classes[0].time.median *= 1e6;
        broken.pictures[0].methods[0].wrong_pixels += 1;
        broken.trees[0].different += 1;
        let told = differences(&first, &broken, None);
        assert_eq!(told.len(), 3, "{told:?}");
        assert!(told[0].starts_with("quadratic, textbook f32, ordinary: "), "{told:?}");
        let told = differences(&first, &broken, Some(1e5));
        assert!(told.iter().any(|line| line.starts_with("ray and sphere") && line.contains(" ns, now ")), "{told:?}");

        let mut shorter = second.clone();
        shorter.kernels.remove(0);
        assert!(differences(&first, &shorter, None).iter().any(|line| line.ends_with("no longer measured")));
        assert!(differences(&shorter, &first, None).iter().any(|line| line.ends_with("not in the stored report")));

        let mut hollow = second;
        hollow.kernels[0].methods[1].classes.clear();
        assert!(whole(&hollow).is_err_and(|problem| problem.contains("quadratic")));
    }
}

//! What a report says, made from the measurements alone: first which method to choose, then everything.

use super::markup::{Block, Picture};
use super::measure::{Cell, Errors, Kernel, Measured, NAN_DISTANCE, NOISY, Time};
use super::pictures::plot::totals;
use super::pictures::{self, Group, HARD, SHOWN, shown};
use super::plot::work_precision;
use super::results::Report;
use super::svg::percent;
use super::trees::{self, Growth};

/// Returns the whole text.
pub(super) fn blocks(report: &Report) -> Vec<Block> {
    let mut blocks = vec![
        Block::Title("Speed against error".to_owned()),
        Block::Paragraph(
            "Which method for which need, and what the hard cases cost. Whatever comes: the method with the fewest \
             errors over all classes of cases, and the fastest of those. If all is ordinary: the fastest whose \
             verdicts are right and whose values are within 10⁴ ulp there."
                .to_owned(),
        ),
        Block::Contents,
        which(report),
        Block::Paragraph(format!(
            "Times are nanoseconds; \"slower\" and \"faster\" are against the textbook's method on the same cases. \
             Ordinary magnitude: all classes but {}. An error is the number of doubles between a value and the one \
             nearest to the exact value (ulp); verdicts are counted apart, and 0 wrong of N mean a share below 3/N \
             with 95 % confidence. A cull may keep too much: only what it drops is wrong.",
            EXTREME.map(|class| format!("\"{class}\"")).join(", ")
        )),
        Block::Paragraph(
            "Light is judged by the byte of its brightness and a texture by the texel: \"ours\" gives those of the \
             exact formula, at every border, and climbs to longer numbers where a bound leaves them open; \"not \
             certified\" is the same kernel without that. A sphere whose center is three doubles is in general larger \
             than the minimal one, whatever the method: ours encloses every sphere, exactly, with the least double \
             that does so around its center."
                .to_owned(),
        ),
        Block::Paragraph(savings(&report.trees)),
        provenance(report),
        Block::Heading("whole pictures".to_owned()),
        Block::Plot(
            "pictures.svg".to_owned(),
            "wrong pixels against rays a second".to_owned(),
            pictures::plot::plot(&report.pictures),
        ),
        pictured(report),
    ];
    for (name, _, text) in HARD {
        blocks.extend(stability(report, name, text));
    }
    blocks.extend(certified(report));
    blocks.push(Block::Heading("what the trees cost and save".to_owned()));
    let growth_shows = "time of a ray against the number of spheres".to_owned();
    blocks.push(Block::Plot("trees.svg".to_owned(), growth_shows, trees::plot(&report.trees)));
    blocks.push(growth(&report.trees));
    for kernel in &report.kernels {
        blocks.push(Block::Heading(kernel.name.clone()));
        let shows = format!("{}: time against error", kernel.name);
        blocks.push(Block::Plot(plot_file(&kernel.name), shows, work_precision(kernel)));
        blocks.push(methods(kernel));
        blocks.push(classes(kernel));
        blocks.push(worst(kernel));
    }
    blocks
}

/// A row of a table.
fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

/// The name of a kernel's plot, in letters that every file system takes.
fn plot_file(kernel: &str) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() { Some(c.to_ascii_lowercase()) } else { (c != '\'').then_some('-') }
    };
    kernel.chars().filter_map(plain).collect::<String>() + ".svg"
}

fn provenance(report: &Report) -> Block {
    let machine = &report.machine;
    let (year, month, day) = date(machine.seconds_since_1970);
    let (spread, noisy, timings) = spread(report);
    let mark = if spread > NOISY { " **A noisy run: read times with care.**" } else { "" };
    Block::Paragraph(format!(
        "Measured {year}-{month:02}-{day:02} on {} ({} threads, FMA {}, load {}), {}, version {}, commit {}: {} cases \
         in a class, medians of {} rounds in which the methods took turns. The 95th percentile of a timing is {} above \
         its median, in the middle; {noisy} of {timings} timings are noisy (above 10 %, marked ~).{mark}",
        machine.processor,
        machine.threads,
        if machine.fma { "found" } else { "not found" },
        machine.load.map_or("unknown".to_owned(), |load| format!("{load:.1}")),
        machine.compiler,
        machine.version,
        machine.commit,
        report.effort.cases,
        report.effort.rounds,
        percent(spread),
    ))
}

/// Returns the spread of times in the middle, how many are noisy, and of how many.
fn spread(report: &Report) -> (f64, usize, usize) {
    let kernels = report.kernels.iter().flat_map(|kernel| &kernel.methods);
    let mut times: Vec<Time> = kernels.flat_map(|method| &method.classes).map(|cell| cell.time).collect();
    times.extend(report.trees.iter().map(|row| row.time));
    times.extend(report.pictures.iter().flat_map(|pictured| &pictured.methods).map(|painted| painted.time));
    let mut spreads: Vec<f64> = times.iter().map(Time::spread).collect();
    spreads.sort_by(f64::total_cmp);
    let middle = spreads.get(spreads.len() / 2).copied().unwrap_or(0.0);
    (middle, times.iter().filter(|time| time.is_noisy()).count(), times.len())
}

/// Says what the trees cost and save in the largest cloud.
fn savings(trees: &[Growth]) -> String {
    let largest = trees.iter().map(|row| row.spheres).max().unwrap_or(0);
    let row = |name: &str| trees.iter().find(|row| row.spheres == largest && row.method == name);
    let names = ["plain loop", "SphereTree, as listed", "SphereTree, sorted", "Bvh", "Bvh, batch"].map(row);
    let [Some(plain), Some(listed), Some(sorted), Some(fast), Some(batch)] = names else {
        return "No tree was measured.".to_owned();
    };
    let faster = |row: &Growth| {
        let ratio = plain.time.median / row.time.median;
        if ratio >= 1.0 { format!("{ratio:.0} times faster") } else { format!("{:.1} times slower", 1.0 / ratio) }
    };
    let paid = 1e9 * fast.build / (plain.time.median - fast.time.median);
    format!(
        "**Trees**, in a cloud of {largest} spheres: the `Bvh` takes {:.0} ms to build, which {:.0} rays pay back, \
         and finds the closest hit {} than the plain loop, {} in batches. The report's tree takes {:.0} ms and is {} \
         if it sorts the spheres first; as they are listed, in random order, it is {}. Hits that differ from the plain \
         loop's: {}.",
        1e3 * fast.build,
        paid.ceil(),
        faster(fast),
        faster(batch),
        1e3 * sorted.build,
        faster(sorted),
        faster(listed),
        trees.iter().map(|row| row.different).sum::<usize>(),
    )
}

/// Classes whose numbers are not of ordinary magnitude.
const EXTREME: [&str; 3] = ["subnormal", "whole range", "graded"];

/// Says how a time compares with another, in the words of all this project's documents.
fn against(time: f64, other: f64) -> String {
    let ratio = time / other;
    if (0.95..1.05).contains(&ratio) {
        "as fast".to_owned()
    } else if ratio > 1.0 {
        format!("{ratio:.1} times slower")
    } else {
        format!("{:.1} times faster", 1.0 / ratio)
    }
}

/// Returns the table of the method to choose for each need, and of what hard cases cost it.
fn which(report: &Report) -> Block {
    let head = [
        "kernel",
        "take, whatever comes",
        "its dearest class of ordinary magnitude",
        "its dearest class of all",
        "take, if all is ordinary",
        "what that gets wrong in hard ones",
    ];
    let choices = report.kernels.iter().filter_map(Choice::new);
    Block::Table([row(head)].into_iter().chain(choices.map(|choice| choice.row())).collect())
}

/// The methods of a kernel to choose from.
struct Choice<'a> {
    kernel: &'a Kernel,
    /// What times are compared with.
    textbook: Option<&'a Measured>,
    /// Whatever comes.
    safe: &'a Measured,
    /// If all is ordinary.
    quick: &'a Measured,
}

const NO_ORDER: &str = "no count and no distance is NaN";

impl<'a> Choice<'a> {
    /// `None` if no method gives all that the kernel has.
    fn new(kernel: &'a Kernel) -> Option<Self> {
        let full: Vec<&Measured> =
            kernel.methods.iter().filter(|method| method.has_values || kernel.values.is_none()).collect();
        let textbook = kernel.methods.iter().find(|method| !method.ours && !method.name.ends_with("f32"));
        let worst = |method: &Measured| {
            let total = method.total();
            (wrong(kernel, &total), total.max_ulp)
        };
        let best = full.iter().map(|method| worst(method)).min_by(|a, b| a.partial_cmp(b).expect(NO_ORDER));
        let safest: Vec<&Measured> = full.iter().copied().filter(|method| Some(worst(method)) == best).collect();
        let easy = |errors: &Errors| wrong(kernel, errors) == 0 && errors.max_ulp <= 1e4;
        let ordinary: Vec<&Measured> = full.iter().copied().filter(|method| easy(&method.classes[0].errors)).collect();
        let safe = fastest(&safest, Measured::total)?;
        let quick = fastest(&ordinary, |method| method.classes[0].errors.clone()).unwrap_or(safe);
        Some(Self { kernel, textbook, safe, quick })
    }

    fn row(&self) -> Vec<String> {
        let Self { kernel, safe, quick, .. } = self;
        let off = |max_ulp: f64| match max_ulp {
            d if d >= NAN_DISTANCE => "NaN".to_owned(),
            d => format!("up to {} ulp", ulp(d)),
        };
        let total = safe.total();
        let within = if total.max_ulp > 0.0 { format!(", {}", off(total.max_ulp)) } else { String::new() };
        let errors = quick.total();
        let mut gets_wrong = Vec::new();
        if wrong(kernel, &errors) > 0 {
            gets_wrong.push(format!("{} of verdicts", percent(wrong(kernel, &errors) as f64 / errors.cases as f64)));
        }
        if errors.max_ulp > 0.0 {
            gets_wrong.push(off(errors.max_ulp));
        }
        let same = quick.name == safe.name;
        vec![
            kernel.name.clone(),
            format!("{}, {}{within}", safe.name, self.compared(safe, 0)),
            self.dearest(|class| !EXTREME.contains(&class)),
            self.dearest(|_| true),
            if same { "the same".to_owned() } else { format!("{}, {}", quick.name, self.compared(quick, 0)) },
            if gets_wrong.is_empty() { "nothing".to_owned() } else { gets_wrong.join(", ") },
        ]
    }

    /// The time of a method on a class, against the textbook's.
    fn compared(&self, method: &Measured, class: usize) -> String {
        let time = method.classes[class].time.median;
        let than = self.textbook.map_or(String::new(), |other| match other.name == method.name {
            true => " (the textbook's)".to_owned(),
            false => format!(" ({})", against(time, other.classes[class].time.median)),
        });
        format!("{time:.1} ns{than}")
    }

    /// The class, of some, on which the safe method is slowest against the textbook.
    fn dearest(&self, of: impl Fn(&str) -> bool) -> String {
        let classes = &self.safe.classes;
        let ratio = |class: usize| {
            classes[class].time.median / self.textbook.map_or(1.0, |other| other.classes[class].time.median)
        };
        let some = (0..classes.len()).filter(|&class| of(&classes[class].class));
        let dearest = some.max_by(|&a, &b| ratio(a).total_cmp(&ratio(b)));
        dearest.map_or(String::new(), |class| format!("{}: {}", classes[class].class, self.compared(self.safe, class)))
    }
}

/// Verdicts that count as wrong.
fn wrong(kernel: &Kernel, errors: &Errors) -> usize {
    if kernel.one_sided { errors.lost } else { errors.wrong_verdicts }
}

/// The fastest of some methods. What noise may have made slower counts as equally fast; then errors decide.
fn fastest<'a>(candidates: &[&'a Measured], errors: impl Fn(&Measured) -> Errors) -> Option<&'a Measured> {
    let time = |method: &Measured| method.time().median;
    let least = candidates.iter().map(|method| time(method)).fold(f64::INFINITY, f64::min);
    let fast = candidates.iter().copied().filter(|method| time(method) <= (1.0 + NOISY) * least);
    let cost = |method: &Measured| {
        let errors = errors(method);
        (errors.wrong_verdicts, errors.max_ulp, time(method))
    };
    fast.min_by(|a, b| cost(a).partial_cmp(&cost(b)).expect(NO_ORDER))
}

/// Returns the table of all methods on all scenes.
fn pictured(report: &Report) -> Block {
    let mut head = vec!["scene: wrong pixels in a million, ns a ray".to_owned()];
    head.extend(report.pictures[0].methods.iter().map(|painted| painted.method.clone()));
    let mut rows = vec![head];
    for scene in report.pictures.iter().filter(|scene| scene.group != Group::Certified) {
        let pixels = scene.width as usize * scene.height as usize;
        let mut row = vec![format!("{} (objects: {}, pixels: {pixels})", scene.scene, scene.objects)];
        row.extend(
            scene.methods.iter().map(|painted| {
                format!("{}, {}", in_a_million(painted.wrong_pixels, pixels), nanoseconds(&painted.time))
            }),
        );
        rows.push(row);
    }
    for (group, name) in
        [(Group::Figures, "the six figures"), (Group::Crowd, "the crowd"), (Group::Hard, "the hard scenes")]
    {
        let mut row = vec![format!("**{name}** together, million rays a second")];
        row.extend(
            totals(&report.pictures, group)
                .iter()
                .map(|total| format!("{}, {:.2}", in_a_million(total.wrong, total.pixels), total.speed())),
        );
        rows.push(row);
    }
    Block::Table(rows)
}

/// Returns the families of scenes in which every byte of ours is certified, and the one whose pictures are kept.
fn certified(report: &Report) -> Vec<Block> {
    let head = ["scene (pixels)", "textbook, wrong", "ours, wrong", "textbook, ns a ray", "ours, ns a ray", "ours is"];
    let mut rows = vec![row(head)];
    for scene in report.pictures.iter().filter(|scene| scene.group == Group::Certified) {
        let method = |name: &str| scene.methods.iter().find(|painted| painted.method == name);
        let (Some(textbook), Some(ours)) = (method(SHOWN[0]), method(SHOWN[1])) else { continue };
        let pixels = scene.width as usize * scene.height as usize;
        rows.push(vec![
            format!("{} ({pixels})", scene.scene),
            percent(textbook.wrong_pixels as f64 / pixels as f64),
            ours.wrong_pixels.to_string(),
            nanoseconds(&textbook.time),
            nanoseconds(&ours.time),
            against(ours.time.median, textbook.time.median),
        ]);
    }
    if rows.len() == 1 {
        return Vec::new();
    }
    let text = "Families of scenes from easy to hard, small, with one sample a pixel. A pixel is right if all three bytes are those \
                of the exact picture. Ours shows that each of its bytes is; where doubles do not, it computes on, which is \
                what the last column shows.";
    let mut blocks =
        vec![Block::Heading("certified pictures".to_owned()), Block::Paragraph(text.to_owned()), Block::Table(rows)];
    let about =
        "Through a telescope that magnifies a ball of radius 1 to the whole picture, with the lights beside the ball.";
    blocks.extend(stability(report, &shown(), about));
    blocks
}

fn in_a_million(wrong: usize, of: usize) -> String {
    match wrong {
        0 => format!("0 (below {:.0})", (3e6 / of as f64).ceil()),
        _ => format!("{:.0}", 1e6 * wrong as f64 / of as f64),
    }
}

/// Returns what a hard scene shows, drawn by the textbook and by ours.
fn stability(report: &Report, name: &str, text: &str) -> Vec<Block> {
    let Some(scene) = report.pictures.iter().find(|pictured| pictured.scene == name) else {
        return Vec::new();
    };
    let pixels = scene.width as usize * scene.height as usize;
    let shown = scene.methods.iter().filter(|painted| SHOWN.contains(&painted.method.as_str()));
    let pictures = shown.filter_map(|painted| {
        let method = if painted.ours { "ours" } else { "textbook" };
        Some(Picture {
            file: format!("{}-{method}.png", name.replace(' ', "-")),
            caption: format!("{name}, {method}: {} of {pixels} pixels wrong", painted.wrong_pixels),
            png: painted.png.clone()?,
        })
    });
    let pictures = pictures.collect();
    vec![Block::Heading(name.to_owned()), Block::Paragraph(text.to_owned()), Block::Pictures(pictures)]
}

fn growth(trees: &[Growth]) -> Block {
    let head =
        ["spheres", "method", "build, ms", "ns a ray", "against the plain loop", "sphere tests a ray", "other hits"];
    let mut rows = vec![row(head)];
    for row in trees {
        let plain = trees.iter().find(|other| other.spheres == row.spheres).map_or(f64::NAN, |r| r.time.median);
        rows.push(vec![
            row.spheres.to_string(),
            row.method.clone(),
            format!("{:.2}", 1e3 * row.build),
            nanoseconds(&row.time),
            against(row.time.median, plain),
            row.tests.map_or("–".to_owned(), |tests| format!("{tests:.1}")),
            format!("{} of {}", row.different, row.compared),
        ]);
    }
    Block::Table(rows)
}

/// A median, the least time and the 95th percentile, and a mark if they are far apart.
fn nanoseconds(time: &Time) -> String {
    let digits = usize::from(time.median < 1000.0);
    let mark = if time.is_noisy() { " ~" } else { "" };
    format!("{:.digits$} ({:.digits$}–{:.digits$}){mark}", time.median, time.least, time.p95)
}

fn methods(kernel: &Kernel) -> Block {
    let head = [
        "method",
        "source",
        "ns (least–p95)",
        "wrong verdicts",
        "of them lost",
        "not nearest",
        "NaN",
        "median ulp",
        "largest ulp",
    ];
    let mut rows = vec![row(head)];
    for method in &kernel.methods {
        let total = method.total();
        let verdict = |text: String| if kernel.verdict.is_some() { text } else { "–".to_owned() };
        let value = |text: String| if total.values > 0 { text } else { "–".to_owned() };
        rows.push(vec![
            method.name.clone(),
            method.source.clone(),
            nanoseconds(&method.time()),
            verdict(match total.wrong_verdicts {
                0 => format!("0 of {}, so below {}", total.cases, percent(3.0 / total.cases as f64)),
                wrong => format!("{wrong} of {}", total.cases),
            }),
            verdict(total.lost.to_string()),
            value(percent(total.not_nearest as f64 / total.values.max(1) as f64)),
            value(total.nan.to_string()),
            value(ulp(total.median_ulp)),
            value(ulp(total.max_ulp)),
        ]);
    }
    Block::Table(rows)
}

/// Returns the table with a row for each class and a column for each method.
fn classes(kernel: &Kernel) -> Block {
    let mut head = vec![
        match (&kernel.verdict, &kernel.values) {
            (Some(_), Some(_)) => "class (cases): ns, wrong verdicts, largest ulp",
            (Some(_), None) => "class (cases): ns, wrong verdicts (of them lost)",
            _ => "class (cases): ns, largest ulp",
        }
        .to_owned(),
    ];
    head.extend(kernel.methods.iter().map(|method| method.name.clone()));
    let mut rows = vec![head];
    for (i, first) in kernel.methods[0].classes.iter().enumerate() {
        let mut row = vec![format!("{} ({})", first.class, first.errors.cases)];
        row.extend(kernel.methods.iter().map(|method| {
            let Cell { errors, time, .. } = &method.classes[i];
            let mut cell = format!("{:.1}{}", time.median, if time.is_noisy() { "~" } else { "" });
            if kernel.verdict.is_some() {
                cell += &format!(", {}", errors.wrong_verdicts);
            }
            if kernel.values.is_none() {
                cell += &format!(" ({})", errors.lost);
            }
            if errors.values > 0 {
                cell += &format!(", {}", ulp(errors.max_ulp));
            }
            cell
        }));
        rows.push(row);
    }
    Block::Table(rows)
}

/// Returns the cases that break each method, as the bits of their numbers.
fn worst(kernel: &Kernel) -> Block {
    let head = ["method", "class", "what", "the case's doubles, as bits"];
    let mut rows = vec![row(head)];
    for method in &kernel.methods {
        let wrong = method.classes.iter().find_map(|cell| Some((cell, cell.errors.first_wrong.as_ref()?)));
        let far = method
            .classes
            .iter()
            .filter_map(|cell| Some((cell, cell.errors.worst.as_ref()?)))
            .max_by(|(a, _), (b, _)| a.errors.max_ulp.total_cmp(&b.errors.max_ulp));
        let far = far.map(|(cell, case)| (cell, case, ulp(cell.errors.max_ulp) + " ulp"));
        let wrong = wrong.map(|(cell, case)| (cell, case, "wrong verdict".to_owned()));
        for (cell, case, what) in wrong.into_iter().chain(far) {
            rows.push(vec![method.name.clone(), cell.class.clone(), what, case.clone()]);
        }
    }
    Block::Table(rows)
}

/// Says a number of doubles.
pub(super) fn ulp(distance: f64) -> String {
    match distance {
        d if d >= NAN_DISTANCE => "NaN".to_owned(),
        d if d < 1e4 => format!("{d}"),
        d => format!("{d:.0e}"),
    }
}

/// Returns year, month and day (Howard Hinnant, "chrono-compatible low-level date algorithms").
fn date(seconds: u64) -> (u64, u64, u64) {
    let days = seconds / 86_400 + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (era * 400 + year_of_era + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_have_their_dates() {
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(date(951_782_400), (2000, 2, 29));
        assert_eq!(date(1_767_225_599), (2025, 12, 31));
        assert_eq!(date(1_767_225_600), (2026, 1, 1));
    }

    #[test]
    fn no_wrong_pixel_is_a_bound() {
        assert_eq!(in_a_million(0, 40_000), "0 (below 75)");
        assert_eq!(in_a_million(3, 40_000), "75");
    }

    #[test]
    fn times_are_compared_in_words() {
        let said = [(30.0, 10.0), (10.0, 25.0), (10.2, 10.0)].map(|(time, other)| against(time, other));
        assert_eq!(said, ["3.0 times slower", "2.5 times faster", "as fast"]);
    }

    #[test]
    fn plots_have_plain_names() {
        assert_eq!(plot_file("Phong's light"), "phongs-light.svg");
    }
}

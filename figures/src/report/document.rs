//! The text of a report, once as Markdown and once as a page of its own, made from the measurements alone.

use super::Report;
use super::measure::{Cell, Errors, Kernel, Measured, NAN_DISTANCE};
use super::plot::{escape, percent, work_precision};
use super::trees;

/// A piece of text.
pub(super) enum Block {
    Title(String),
    Heading(String),
    Paragraph(String),
    /// The first row is the head.
    Table(Vec<Vec<String>>),
    /// A picture's file name and its SVG.
    Plot(String, String),
}

/// Returns the whole text.
pub(super) fn blocks(report: &Report) -> Vec<Block> {
    let mut blocks = vec![Block::Title("Speed against error".to_owned()), provenance(report), which(report)];
    blocks.push(Block::Paragraph(
        "An error is the number of doubles between a value and the one nearest to the exact value (ulp); verdicts are \
         counted apart. Wrong verdicts of 0 in N cases mean a share below 3/N with 95 % confidence. Times are medians, \
         methods taking turns on the same cases; those of our kernels include building checked shapes."
            .to_owned(),
    ));
    blocks.push(Block::Heading("what the trees cost and save".to_owned()));
    blocks.push(Block::Plot("trees.svg".to_owned(), trees::plot(&report.trees)));
    blocks.push(growth(report));
    for kernel in &report.kernels {
        blocks.push(Block::Heading(kernel.name.clone()));
        let file = format!("{}.svg", kernel.name.replace(' ', "-"));
        blocks.push(Block::Plot(file, work_precision(kernel)));
        blocks.push(methods(kernel));
        blocks.push(classes(kernel));
        blocks.push(worst(kernel));
    }
    blocks
}

fn provenance(report: &Report) -> Block {
    let machine = &report.machine;
    let (year, month, day) = date(machine.seconds_since_1970);
    let spread = spread(report);
    let noisy = if spread > 0.10 { " **Noisy**: read times with care." } else { "" };
    Block::Paragraph(format!(
        "Measured {year}-{month:02}-{day:02} on {} ({} threads, FMA {}), {}, version {}: {} cases in each class, {} rounds. \
         The middle method's times spread by {} between the median and the 95th percentile.{noisy}",
        machine.processor,
        machine.threads,
        if machine.fma { "found" } else { "not found" },
        machine.compiler,
        machine.version,
        report.effort.cases,
        report.effort.rounds,
        percent(spread),
    ))
}

/// Returns the median, over all methods and classes, of what the 95th percentile of a time is above its median.
fn spread(report: &Report) -> f64 {
    let methods = report.kernels.iter().flat_map(|kernel| &kernel.methods);
    let mut spreads: Vec<f64> =
        methods.flat_map(|method| &method.classes).map(|cell| cell.p95 / cell.median - 1.0).collect();
    spreads.sort_by(f64::total_cmp);
    spreads.get(spreads.len() / 2).copied().unwrap_or(0.0)
}

/// Returns the table of the method to choose for each level of error.
fn which(report: &Report) -> Block {
    let mut rows = vec![
        ["kernel", "no error found", "at most 2 ulp, no wrong verdict", "fastest, ordinary cases right"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for kernel in &report.kernels {
        let fastest = |good: &dyn Fn(&Measured) -> bool| {
            let full = |method: &&Measured| method.has_values || kernel.values.is_none();
            let candidates = kernel.methods.iter().filter(full).filter(|method| good(method));
            let best = candidates.min_by(|a, b| a.time().total_cmp(&b.time()));
            best.map_or("none".to_owned(), |method| format!("{}, {:.1} ns", method.name, method.time()))
        };
        let sound = |errors: &Errors, ulp: f64| errors.wrong_verdicts == 0 && errors.max_ulp <= ulp;
        rows.push(vec![
            kernel.name.clone(),
            fastest(&|method| sound(&method.total(), 0.0)),
            fastest(&|method| sound(&method.total(), 2.0)),
            fastest(&|method| method.classes[0].errors.wrong_verdicts == 0),
        ]);
    }
    Block::Table(rows)
}

fn growth(report: &Report) -> Block {
    let head = [
        "spheres",
        "method",
        "build, ms",
        "ns a ray",
        "faster than the plain loop",
        "sphere tests a ray",
        "other hits",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for row in &report.trees {
        let plain =
            report.trees.iter().find(|other| other.spheres == row.spheres).map_or(f64::NAN, |r| r.median);
        rows.push(vec![
            row.spheres.to_string(),
            row.method.clone(),
            format!("{:.2}", 1e3 * row.build),
            format!("{:.0}", row.median),
            format!("{:.1}", plain / row.median),
            row.tests.map_or("–".to_owned(), |tests| format!("{tests:.1}")),
            format!("{} of {}", row.different, row.compared),
        ]);
    }
    Block::Table(rows)
}

fn methods(kernel: &Kernel) -> Block {
    let head =
        ["method", "source", "ns", "wrong verdicts", "not nearest", "NaN", "median ulp", "largest ulp"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for method in &kernel.methods {
        let total = method.total();
        let value = |text: String| if total.values > 0 { text } else { "–".to_owned() };
        rows.push(vec![
            method.name.clone(),
            method.source.clone(),
            format!("{:.1}", method.time()),
            kernel
                .verdict
                .as_ref()
                .map_or("–".to_owned(), |_| format!("{} of {}", total.wrong_verdicts, total.cases)),
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
    let mut head = vec!["class: ns, wrong verdicts, largest ulp".to_owned()];
    head.extend(kernel.methods.iter().map(|method| method.name.clone()));
    let mut rows = vec![head];
    for (i, first) in kernel.methods[0].classes.iter().enumerate() {
        let mut row = vec![format!("{} ({})", first.class, first.errors.cases)];
        row.extend(kernel.methods.iter().map(|method| {
            let Cell { errors, median, .. } = &method.classes[i];
            let mut cell = format!("{median:.1}");
            if kernel.verdict.is_some() {
                cell += &format!(", {}", errors.wrong_verdicts);
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
    let mut rows = vec![["method", "class", "what", "case"].map(str::to_owned).to_vec()];
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
            rows.push(vec![method.name.clone(), cell.class.clone(), what, case.join(" ")]);
        }
    }
    Block::Table(rows)
}

fn ulp(distance: f64) -> String {
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

/// Returns the plots and the names of their files.
pub(super) fn plots(blocks: &[Block]) -> impl Iterator<Item = (&str, &str)> {
    blocks.iter().filter_map(|block| match block {
        Block::Plot(name, svg) => Some((name.as_str(), svg.as_str())),
        _ => None,
    })
}

/// Returns the text as Markdown; plots are linked.
pub(super) fn markdown(blocks: &[Block]) -> String {
    let mut text = String::new();
    for block in blocks {
        text += &match block {
            Block::Title(title) => format!("# {title}\n\n"),
            Block::Heading(heading) => format!("## {heading}\n\n"),
            Block::Paragraph(paragraph) => format!("{paragraph}\n\n"),
            Block::Plot(name, _) => format!("![time against error]({name})\n\n"),
            Block::Table(rows) => {
                let line = |row: &Vec<String>| {
                    let cells: Vec<String> = row.iter().map(|cell| cell.replace('|', "\\|")).collect();
                    format!("| {} |\n", cells.join(" | "))
                };
                let rule = format!("|{}\n", " --- |".repeat(rows[0].len()));
                line(&rows[0]) + &rule + &rows[1..].iter().map(line).collect::<String>() + "\n"
            }
        };
    }
    text
}

/// Returns the text as one page with everything in it.
pub(super) fn html(blocks: &[Block]) -> String {
    let mut text = "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
        <meta name=\"viewport\" content=\"width=device-width\">\n<title>Speed against error</title>\n<style>\n\
        :root { color-scheme: light dark; }\n\
        body { font: 15px/1.45 sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }\n\
        table { border-collapse: collapse; display: block; overflow-x: auto; margin: 1rem 0; font-size: 13px; }\n\
        th, td { border: 1px solid #8886; padding: 0.2rem 0.5rem; text-align: left; }\n\
        svg { max-width: 100%; height: auto; }\n</style>\n"
        .to_owned();
    for block in blocks {
        text += &match block {
            Block::Title(title) => format!("<h1>{}</h1>\n", escape(title)),
            Block::Heading(heading) => format!("<h2>{}</h2>\n", escape(heading)),
            Block::Paragraph(paragraph) => format!("<p>{}</p>\n", escape(paragraph).replace("**", "")),
            Block::Plot(_, svg) => svg.clone(),
            Block::Table(rows) => {
                let line = |row: &Vec<String>, cell: &str| {
                    let cells = row.iter().map(|text| format!("<{cell}>{}</{cell}>", escape(text)));
                    format!("<tr>{}</tr>\n", cells.collect::<String>())
                };
                let body: String = rows[1..].iter().map(|row| line(row, "td")).collect();
                format!("<table>\n{}{body}</table>\n", line(&rows[0], "th"))
            }
        };
    }
    text + "</html>\n"
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
    fn nothing_breaks_a_page() {
        let blocks = [Block::Table(vec![vec!["a".into()], vec!["<b> & |c|".into()]])];
        assert!(html(&blocks).contains("<td>&lt;b&gt; &amp; |c|</td>"));
    }
}

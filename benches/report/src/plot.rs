//! Work-precision diagrams as SVG: error across, time up, one point a method.
//!
//! A mark is at the largest error on ordinary cases, and a line leads from it to the largest error on all classes. An
//! error of zero has its own column at the left, NaN one at the right; the scale between them is logarithmic. A method
//! is hollow if another is no worse in time, both errors and wrong verdicts; those that no other beats in time and
//! ordinary error are joined. A triangle marks wrong verdicts, a whisker leads from the least time to the 95th
//! percentile. Marks have numbers, and the key below names them. Blue and orange are Okabe and Ito's, distinct for
//! colour-blind readers too; colours follow the reader's light or dark setting.

use std::fmt::Write;

use super::labels::Labels;
use super::measure::{Errors, Kernel, Measured, NAN_DISTANCE};
use super::svg::{
    LEFT, RIGHT, axes, below, caption, key, key_height, level, percent, power_of_ten, shape, style, upright, upward,
};

const TOP: f64 = 36.0;
const BOTTOM: f64 = 286.0;
/// Width of the columns for zero and for NaN.
const COLUMN: f64 = 38.0;
/// Where the key begins.
const KEY: f64 = BOTTOM + 104.0;

/// A method's place in a diagram.
struct PlotPoint<'a> {
    method: &'a Measured,
    /// Where its error on ordinary cases and on all is, and its time.
    x: f64,
    x_all: f64,
    y: f64,
    /// Where the least time and the 95th percentile are.
    whisker: [f64; 2],
    /// The share of wrong verdicts, of a cull those that are lost.
    wrong: f64,
    /// Nanoseconds, error on ordinary cases, on all, and the share of wrong verdicts.
    costs: [f64; 4],
    dominated: bool,
    on_front: bool,
}

/// Returns the diagram of a kernel. Without values the error is the share of wrong verdicts.
pub(super) fn work_precision(kernel: &Kernel) -> String {
    let by_share = kernel.values.is_none();
    let (decades, label) = if by_share {
        ((0, 6), "wrong verdicts in a million")
    } else {
        ((0, 19), "largest error, in units of the last place")
    };
    let mut points: Vec<PlotPoint> = kernel
        .methods
        .iter()
        .map(|method| {
            let error = |errors: &Errors| {
                if by_share { 1e6 * share(errors) } else { errors.max_ulp }
            };
            let total = method.total();
            let (ordinary, all) = (error(&method.classes[0].errors), error(&total));
            let wrong = if kernel.one_sided { total.lost as f64 / total.cases as f64 } else { share(&total) };
            let costs = [method.time().median, ordinary, all, wrong];
            let [x, x_all] = [ordinary, all].map(|error| across(error, decades));
            PlotPoint { method, x, x_all, y: 0.0, whisker: [0.0; 2], wrong, costs, dominated: false, on_front: false }
        })
        .collect();
    let times = points.iter().map(|point| point.method.time().median);
    let (low, high) = times.fold((f64::MAX, 0.0f64), |(low, high), t| (low.min(t), high.max(t)));
    let (low, high) = (low.log10() - 0.15, high.log10() + 0.2);
    for i in 0..points.len() {
        let point = &points[i];
        let beaten_in = |costs: &[usize]| {
            points.iter().any(|other| {
                let no_worse = costs.iter().all(|&k| other.costs[k] <= point.costs[k]);
                let better = costs.iter().any(|&k| other.costs[k] < point.costs[k]);
                // A verdict alone is no replacement for a value.
                no_worse && better && (other.method.has_values || !point.method.has_values)
            })
        };
        let (dominated, on_front) = (beaten_in(&[0, 1, 2, 3]), !beaten_in(&[0, 1]));
        let up = |time: f64| TOP + (BOTTOM - TOP) * (high - time.log10()) / (high - low);
        let time = point.method.time();
        let (y, whisker) = (up(time.median), [time.least, time.p95.min(10f64.powf(high))].map(up));
        points[i] = PlotPoint { dominated, on_front, y, whisker, ..points[i] };
    }

    let mut svg = String::new();
    frame(&mut svg, kernel, decades, label, (low, high));
    let front = join_front(&mut svg, &points);
    marks(&mut svg, &points, &front);
    svg.push_str("</svg>\n");
    svg
}

fn share(errors: &Errors) -> f64 {
    errors.wrong_verdicts as f64 / errors.cases as f64
}

/// Returns where an error is drawn.
fn across(error: f64, (first, last): (i32, i32)) -> f64 {
    let (start, end) = (LEFT + COLUMN, RIGHT - COLUMN);
    if error == 0.0 {
        LEFT + COLUMN / 2.0
    } else if error >= NAN_DISTANCE {
        RIGHT - COLUMN / 2.0
    } else {
        let part = (error.max(1.0).log10() - f64::from(first)) / f64::from(last - first);
        start + 8.0 + (end - start - 16.0) * part
    }
}

fn frame(svg: &mut String, kernel: &Kernel, decades: (i32, i32), label: &str, (low, high): (f64, f64)) {
    svg.push_str(&style(&kernel.name, KEY + key_height(kernel.methods.len())));
    let under = BOTTOM + 17.0;
    let (first, last) = decades;
    for decade in (first..=last).step_by(if last > 9 { 3 } else { 1 }) {
        let x = across(10f64.powi(decade), decades);
        upright(svg, x, TOP, BOTTOM);
        below(svg, x, under, power_of_ten(decade));
    }
    for (text, x) in [("0", across(0.0, decades)), ("NaN", across(NAN_DISTANCE, decades))] {
        if text == "0" || last > 9 {
            below(svg, x, under, text);
        }
    }
    // Two or three lines within a decade would not show that the axis is logarithmic.
    let digits: &[f64] = if high - low < 1.0 { &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0] } else { &[1.0, 2.0, 5.0] };
    let ticks = (-1..8).flat_map(|decade| digits.iter().map(move |digit| digit * 10f64.powi(decade)));
    for tick in ticks.filter(|tick| (low..high).contains(&tick.log10())) {
        level(svg, TOP + (BOTTOM - TOP) * (high - tick.log10()) / (high - low), tick);
    }
    let zero = LEFT + COLUMN;
    // Writing to a string cannot fail.
    let _ = writeln!(svg, r#"<line class="axis" x1="{zero}" y1="{TOP}" x2="{zero}" y2="{BOTTOM}"/>"#);
    axes(svg, TOP, BOTTOM);
    caption(svg, BOTTOM + 36.0, label);
    caption(svg, BOTTOM + 52.0, "mark: in ordinary cases; line: up to all classes");
    caption(svg, BOTTOM + 68.0, "blue: this project; filled: beaten by none");
    caption(svg, BOTTOM + 84.0, "triangle: wrong verdicts, their share in brackets");
    upward(svg, (TOP + BOTTOM) / 2.0, "nanoseconds, ordinary cases");
}

/// Joins the points that no other beats, as steps, and returns them.
fn join_front(svg: &mut String, points: &[PlotPoint]) -> Vec<(f64, f64)> {
    let mut front: Vec<(f64, f64)> =
        points.iter().filter(|point| point.on_front).map(|point| (point.x, point.y)).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let path: Vec<String> = front.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
    let _ = writeln!(svg, r#"<path class="front" d="M {}"/>"#, path.join(" L "));
    front
}

fn marks(svg: &mut String, points: &[PlotPoint], front: &[(f64, f64)]) {
    let mut labels = Labels::new([LEFT + 1.0, RIGHT, TOP, BOTTOM - 1.0], points.iter().map(|point| (point.x, point.y)));
    labels.avoid((LEFT + COLUMN, TOP), (LEFT + COLUMN, BOTTOM));
    for pair in front.windows(2) {
        labels.avoid(pair[0], pair[1]);
    }
    for point in points {
        labels.avoid((point.x, point.y), (point.x_all, point.y));
        labels.avoid((point.x, point.whisker[0]), (point.x, point.whisker[1]));
    }
    let (mut numbers, mut names) = (String::new(), Vec::new());
    for (i, point) in points.iter().enumerate() {
        let PlotPoint { x, y, method, wrong, .. } = *point;
        let class =
            format!("{}{}", if method.ours { "ours" } else { "other" }, if point.dominated { " hollow" } else { "" });
        let [least, p95] = point.whisker;
        let _ = writeln!(
            svg,
            r#"<path class="{class} reach" d="M {x:.1} {y:.1} H {:.1} M {x:.1} {least:.1} V {p95:.1}"/><path class="{class}" d="{}"/>"#,
            point.x_all,
            shape((x, y), wrong > 0.0)
        );
        numbers += &labels.place((x, y), i + 1);
        let share = if wrong > 0.0 { format!(" ({} wrong)", percent(wrong)) } else { String::new() };
        let time = method.time().median;
        names.push((format!("{}: {time:.1} ns{share}", method.name), class, wrong > 0.0));
    }
    // Numbers come last, so that no line crosses them.
    svg.push_str(&numbers);
    key(svg, KEY, &names);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_and_nan_have_columns_of_their_own() {
        let decades = (0, 19);
        let places = [0.0, 1.0, 1e3, 1e18, NAN_DISTANCE].map(|error| across(error, decades));
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
        assert!(places[0] < LEFT + COLUMN && places[1] > LEFT + COLUMN);
        assert!(places[3] < RIGHT - COLUMN && places[4] > RIGHT - COLUMN);
    }
}

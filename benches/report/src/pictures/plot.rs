//! Wrong pixels against rays per second as SVG: one panel for each group of scenes, one mark a method.

use std::fmt::Write;

use super::results::{Group, Pictured};
use crate::labels::Labels;
use crate::svg::{
    LEFT, RIGHT, axes, below, caption, escape, key, key_height, level, power_of_ten, shape, style, upright, upward,
};

/// A method's sums over a group of scenes.
pub(crate) struct Total {
    pub(crate) method: String,
    pub(crate) ours: bool,
    pub(crate) wrong: usize,
    pub(crate) pixels: usize,
    seconds: f64,
}

impl Total {
    /// Rays in a second, in millions.
    pub(crate) fn speed(&self) -> f64 {
        self.pixels as f64 / self.seconds / 1e6
    }

    /// Wrong pixels in a million.
    pub(crate) fn wrong_in_a_million(&self) -> f64 {
        1e6 * self.wrong as f64 / self.pixels as f64
    }
}

/// Adds up the scenes of a group for each method.
pub(crate) fn totals(pictures: &[Pictured], group: Group) -> Vec<Total> {
    let mut totals: Vec<Total> = Vec::new();
    for pictured in pictures.iter().filter(|pictured| pictured.group == group) {
        let pixels = pictured.width as usize * pictured.height as usize;
        for painted in &pictured.methods {
            let seconds = painted.time.median * 1e-9 * pixels as f64;
            if let Some(total) = totals.iter_mut().find(|total| total.method == painted.method) {
                total.wrong += painted.wrong_pixels;
                total.pixels += pixels;
                total.seconds += seconds;
            } else {
                let (method, wrong) = (painted.method.clone(), painted.wrong_pixels);
                totals.push(Total { method, ours: painted.ours, wrong, pixels, seconds });
            }
        }
    }
    totals
}

/// Height of a panel, and where the first begins.
const PANEL: f64 = 150.0;
const GAP: f64 = 44.0;
const TOP: f64 = 54.0;
/// Width of the column for no wrong pixel at all.
const COLUMN: f64 = 52.0;

/// Returns the diagram: one panel below the other.
pub(crate) fn plot(pictures: &[Pictured]) -> String {
    let groups = [Group::Figures, Group::Crowd, Group::Hard].map(|group| (group, totals(pictures, group)));
    let bottom = TOP + 3.0 * PANEL + 2.0 * GAP;
    let key_at = bottom + 74.0;
    let names: Vec<_> = groups[0]
        .1
        .iter()
        .map(|total| {
            let class = if total.ours { "ours" } else { "other" };
            (total.method.clone(), class.to_owned(), !total.ours)
        })
        .collect();
    let mut svg = style("whole pictures: errors and speed", key_at + key_height(names.len()));
    for (i, (group, totals)) in groups.iter().enumerate() {
        panel(&mut svg, TOP + i as f64 * (PANEL + GAP), title(*group, pictures), totals);
    }
    upward(&mut svg, (TOP + bottom) / 2.0, "million rays a second, one thread");
    caption(&mut svg, bottom + 36.0, "wrong pixels in a million (0: none, and fewer");
    caption(&mut svg, bottom + 52.0, "than below it, with 95 % confidence)");
    key(&mut svg, key_at, &names);
    svg + "</svg>\n"
}

/// What a group is called over its panel.
fn title(group: Group, pictures: &[Pictured]) -> String {
    match group {
        Group::Figures => "the six figures".to_owned(),
        Group::Crowd => {
            let crowd = pictures.iter().find(|pictured| pictured.group == Group::Crowd);
            format!("{} spheres", crowd.map_or(0, |pictured| pictured.objects))
        }
        Group::Hard => "far, edges, ground".to_owned(),
        Group::Certified => "to the last byte".to_owned(),
    }
}

fn panel(svg: &mut String, top: f64, title: String, totals: &[Total]) {
    let bottom = top + PANEL;
    let speeds = totals.iter().map(|total| total.speed().log10());
    let (low, high) = speeds.fold((f64::MAX, f64::MIN), |(low, high), speed| (low.min(speed), high.max(speed)));
    let (low, high) = (low - 0.2, high + 0.2);
    let y = |speed: f64| top + PANEL * (high - speed.log10()) / (high - low);
    let x = |wrong: f64| {
        let (start, end) = (LEFT + COLUMN + 8.0, RIGHT - 12.0);
        if wrong == 0.0 { LEFT + 22.0 } else { start + (end - start) * wrong.max(1.0).log10() / 6.0 }
    };
    // Writing to a string cannot fail.
    let _ = writeln!(svg, r#"<text x="{LEFT}" y="{:.1}" font-weight="bold">{}</text>"#, top - 7.0, escape(&title));
    let ticks = (-3..5).flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(decade)));
    for tick in ticks.filter(|tick| (low..high).contains(&tick.log10())) {
        level(svg, y(tick), tick);
    }
    let under = bottom + 15.0;
    for decade in [0, 2, 4, 6] {
        let at = x(10f64.powi(decade));
        upright(svg, at, top, bottom);
        below(svg, at, under, power_of_ten(decade));
    }
    let bound = totals.first().map_or(f64::NAN, |total| 3e6 / total.pixels as f64).ceil();
    let zero = x(0.0);
    let _ = writeln!(svg, r#"<text class="small" x="{zero}" y="{under}" text-anchor="middle">0 (&lt; {bound})</text>"#);
    let rule = LEFT + COLUMN;
    let _ = writeln!(svg, r#"<line class="axis" x1="{rule}" y1="{top}" x2="{rule}" y2="{bottom}"/>"#);
    axes(svg, top, bottom);
    let place = |total: &Total| (x(total.wrong_in_a_million()), y(total.speed()));
    let mut labels = Labels::new([LEFT + 1.0, RIGHT, top, bottom - 1.0], totals.iter().map(place));
    labels.avoid((rule, top), (rule, bottom));
    let mut numbers = String::new();
    for (i, total) in totals.iter().enumerate() {
        let class = if total.ours { "ours" } else { "other" };
        let _ = writeln!(svg, r#"<path class="{class}" d="{}"/>"#, shape(place(total), !total.ours));
        numbers += &labels.place(place(total), i + 1);
    }
    svg.push_str(&numbers);
}

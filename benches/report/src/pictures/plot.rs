//! Wrong pixels against rays per second as SVG: one panel for each group of scenes, one mark a method.

use std::fmt::Write;

use super::results::{Group, Pictured};
use crate::labels::Labels;
use crate::svg::{escape, style};

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

const LEFT: f64 = 70.0;
const PANEL: f64 = 236.0;
const GAP: f64 = 6.0;
const TOP: f64 = 72.0;
const BOTTOM: f64 = 366.0;
/// Width of the column for no wrong pixel at all.
const COLUMN: f64 = 46.0;

/// Returns the diagram.
pub(crate) fn plot(pictures: &[Pictured]) -> String {
    let groups = [Group::Figures, Group::Crowd, Group::Hard].map(|group| (group, totals(pictures, group)));
    let speeds = groups.iter().flat_map(|(_, totals)| totals).map(Total::speed);
    let (low, high) = speeds.fold((f64::MAX, f64::MIN), |(low, high), speed| (low.min(speed), high.max(speed)));
    let (low, high) = (low.log10() - 0.15, high.log10() + 0.15);
    let y = |speed: f64| TOP + (BOTTOM - TOP) * (high - speed.log10()) / (high - low);

    let mut svg = style("whole pictures: wrong pixels against speed");
    // Writing to a string cannot fail.
    let ticks = (-3..5).flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(decade)));
    for tick in ticks.filter(|tick| (low..high).contains(&tick.log10())) {
        let (y, end) = (y(tick), LEFT + 3.0 * PANEL + 2.0 * GAP);
        let _ = writeln!(svg, r#"<line class="grid" x1="{LEFT}" y1="{y:.1}" x2="{end}" y2="{y:.1}"/>"#);
        let _ = writeln!(svg, r#"<text x="{}" y="{:.1}" text-anchor="end">{tick}</text>"#, LEFT - 8.0, y + 4.0);
    }
    for (i, (group, totals)) in groups.iter().enumerate() {
        let left = LEFT + i as f64 * (PANEL + GAP);
        panel(&mut svg, left, title(*group, pictures), totals, &y);
    }
    let middle = LEFT + 1.5 * PANEL + GAP;
    let _ = writeln!(
        svg,
        r#"<text x="{middle}" y="{}" text-anchor="middle">wrong pixels in a million (0: none, and with 95 % confidence fewer than below it)</text>"#,
        BOTTOM + 52.0
    );
    let _ = writeln!(
        svg,
        r#"<text transform="translate(18 {}) rotate(-90)" text-anchor="middle">million rays a second, one thread</text>"#,
        (TOP + BOTTOM) / 2.0
    );
    let _ = writeln!(
        svg,
        r#"<text x="{middle}" y="432" text-anchor="middle" font-size="12">blue discs: this project · orange triangles: others</text>"#
    );
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

fn panel(svg: &mut String, left: f64, title: String, totals: &[Total], y: &dyn Fn(f64) -> f64) {
    let x = |wrong: f64| {
        let (start, end) = (left + COLUMN + 8.0, left + PANEL - 12.0);
        if wrong == 0.0 { left + 16.0 } else { start + (end - start) * wrong.max(1.0).log10() / 6.0 }
    };
    let _ = writeln!(
        svg,
        r#"<text x="{}" y="{}" text-anchor="middle" font-weight="bold">{}</text>"#,
        left + PANEL / 2.0,
        TOP - 10.0,
        escape(&title)
    );
    for (decade, text) in [(0, "1"), (2, "100"), (4, "10⁴"), (6, "10⁶")] {
        let at = x(10f64.powi(decade));
        let _ = writeln!(svg, r#"<line class="grid" x1="{at:.1}" y1="{TOP}" x2="{at:.1}" y2="{BOTTOM}"/>"#);
        let _ = writeln!(svg, r#"<text x="{at:.1}" y="{}" text-anchor="middle">{text}</text>"#, BOTTOM + 17.0);
    }
    let zero = x(0.0);
    let bound = totals.first().map_or(f64::NAN, |total| 3e6 / total.pixels as f64);
    let _ = writeln!(svg, r#"<text x="{zero}" y="{}" text-anchor="middle">0</text>"#, BOTTOM + 17.0);
    let _ = writeln!(
        svg,
        r#"<text x="{zero}" y="{}" text-anchor="middle" font-size="11">&lt; {}</text>"#,
        BOTTOM + 31.0,
        bound.ceil()
    );
    let rule = left + COLUMN - 8.0;
    let _ = writeln!(svg, r#"<line class="axis" x1="{rule}" y1="{TOP}" x2="{rule}" y2="{BOTTOM}"/>"#);
    let _ = writeln!(svg, r#"<path class="axis" d="M {left} {TOP} V {BOTTOM} H {}"/>"#, left + PANEL);
    let place = |total: &Total| (x(total.wrong_in_a_million()), y(total.speed()));
    let mut labels = Labels::new(left, left + PANEL, totals.iter().map(place));
    let mut names = String::new();
    for total in totals {
        let (x, y) = place(total);
        let class = if total.ours { "mark ours" } else { "mark other" };
        let shape = if total.ours {
            format!("M {:.1} {y:.1} a 6 6 0 1 0 12 0 a 6 6 0 1 0 -12 0 z", x - 6.0)
        } else {
            format!("M {x:.1} {:.1} l 7 12 h -14 z", y - 7.0)
        };
        let _ = writeln!(svg, r#"<path class="{class}" d="{shape}"/>"#);
        names += &labels.place((x, y), &total.method);
    }
    svg.push_str(&names);
}

//! What all diagrams share: their beginning, their key, and text in them.
//!
//! They are as wide as a narrow screen, so that their text is read there as it is written. Colours stand in a style
//! block, once plainly and once for dark screens, which viewers without media queries pass over.

use std::fmt::{Display, Write};

/// Width of a diagram, and where its axes begin and end.
pub(super) const WIDTH: f64 = 400.0;
pub(super) const LEFT: f64 = 46.0;
pub(super) const RIGHT: f64 = WIDTH - 8.0;

/// Height of a line of the key.
const LINE: f64 = 19.0;

/// Returns the beginning of a diagram: size, colours, title.
pub(super) fn style(title: &str, height: f64) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img">
<title>{title}</title>
<style>
svg {{ font: 13px sans-serif; }}
text {{ fill: #1b1b1b; }}
.small {{ font-size: 12px; }}
.title {{ font-size: 15px; font-weight: bold; }}
.paper {{ fill: #ffffff; }}
.grid {{ stroke: #d9d9d9; stroke-width: 1; }}
.axis {{ stroke: #1b1b1b; stroke-width: 1; fill: none; }}
.front {{ stroke: #1b1b1b; stroke-width: 1.5; stroke-dasharray: 5 4; fill: none; opacity: 0.6; }}
.ours {{ stroke: #0072b2; fill: #0072b2; stroke-width: 2; }}
.other {{ stroke: #d55e00; fill: #d55e00; stroke-width: 2; }}
.reach {{ stroke-width: 1.2; }}
.hollow {{ fill: #ffffff; }}
.line {{ fill: none; }}
@media (prefers-color-scheme: dark) {{
text {{ fill: #e8e8e8; }}
.paper, .hollow {{ fill: #16181c; }}
.grid {{ stroke: #3a3d42; }}
.axis, .front {{ stroke: #e8e8e8; }}
.ours {{ stroke: #56b4e9; fill: #56b4e9; }}
.other {{ stroke: #e69f00; fill: #e69f00; }}
.ours.hollow, .other.hollow {{ fill: #16181c; }}
.ours.line, .other.line {{ fill: none; }}
}}
</style>
<rect class="paper" width="{WIDTH}" height="{height}"/>
<text class="title" x="{LEFT}" y="22">{title}</text>
"#,
        title = escape(title),
    )
}

/// A mark: a disc, or a triangle for what is wrong at times.
pub(super) fn shape((x, y): (f64, f64), triangle: bool) -> String {
    if triangle {
        format!("M {x:.1} {:.1} l 7 12 h -14 z", y - 7.0)
    } else {
        format!("M {:.1} {y:.1} a 6 6 0 1 0 12 0 a 6 6 0 1 0 -12 0 z", x - 6.0)
    }
}

/// Adds the key below a diagram: numbers, marks and names, a line each, from `top` on. A name comes with the classes of
/// its mark and whether it is a triangle.
pub(super) fn key(svg: &mut String, top: f64, names: &[(String, String, bool)]) {
    for (i, (name, class, triangle)) in names.iter().enumerate() {
        let y = top + LINE * i as f64;
        // Writing to a string cannot fail.
        let _ = writeln!(
            svg,
            r#"<text x="{:.1}" y="{:.1}" text-anchor="end">{}</text><path class="{class}" d="{}"/><text x="{:.1}" y="{:.1}">{}</text>"#,
            LEFT - 18.0,
            y + 4.5,
            i + 1,
            shape((LEFT - 5.0, y), *triangle),
            LEFT + 10.0,
            y + 4.5,
            escape(name),
        );
    }
}

/// The height of a key.
pub(super) fn key_height(names: usize) -> f64 {
    LINE * names as f64
}

/// Adds a line of the grid at the height `y`, and its label to the left.
pub(super) fn level(svg: &mut String, y: f64, label: impl Display) {
    let end = LEFT - 5.0;
    let _ = writeln!(svg, r#"<line class="grid" x1="{LEFT}" y1="{y:.1}" x2="{RIGHT}" y2="{y:.1}"/>"#);
    let _ = writeln!(svg, r#"<text class="small" x="{end}" y="{:.1}" text-anchor="end">{label}</text>"#, y + 4.0);
}

/// Adds a line of the grid at `x`, from `top` to `bottom`.
pub(super) fn upright(svg: &mut String, x: f64, top: f64, bottom: f64) {
    let _ = writeln!(svg, r#"<line class="grid" x1="{x:.1}" y1="{top}" x2="{x:.1}" y2="{bottom}"/>"#);
}

/// Adds a label below the axis.
pub(super) fn below(svg: &mut String, x: f64, y: f64, label: impl Display) {
    let _ = writeln!(svg, r#"<text class="small" x="{x:.1}" y="{y}" text-anchor="middle">{label}</text>"#);
}

/// Adds both axes.
pub(super) fn axes(svg: &mut String, top: f64, bottom: f64) {
    let _ = writeln!(svg, r#"<path class="axis" d="M {LEFT} {top} V {bottom} H {RIGHT}"/>"#);
}

/// Adds a line of text in the middle between the axes' ends.
pub(super) fn caption(svg: &mut String, y: f64, text: &str) {
    let middle = (LEFT + RIGHT) / 2.0;
    let _ =
        writeln!(svg, r#"<text class="small" x="{middle}" y="{y:.1}" text-anchor="middle">{}</text>"#, escape(text));
}

/// Adds the title of the axis that points up.
pub(super) fn upward(svg: &mut String, middle: f64, text: &str) {
    let _ = writeln!(
        svg,
        r#"<text class="small" transform="translate(12 {middle:.1}) rotate(-90)" text-anchor="middle">{}</text>"#,
        escape(text)
    );
}

/// A power of ten in few letters.
pub(super) fn power_of_ten(exponent: i32) -> String {
    let digit = |c: char| {
        if c == '-' { '⁻' } else { "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c as usize - '0' as usize).unwrap_or(c) }
    };
    match exponent {
        0..3 => format!("{}", 10i32.pow(exponent.unsigned_abs())),
        _ => format!("10{}", exponent.to_string().chars().map(digit).collect::<String>()),
    }
}

/// Returns a share in percent, with at least one digit that is not zero.
pub(super) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent >= 9.95 {
        format!("{percent:.0} %")
    } else if percent >= 0.095 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.2} %")
    }
}

/// Returns the text with what XML would take for markup replaced.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_break_the_markup() {
        assert_eq!(escape(r#"a < b & "c""#), "a &lt; b &amp; &quot;c&quot;");
    }

    #[test]
    fn powers_are_short() {
        assert_eq!([0, 2, 3, 18, -2].map(power_of_ten), ["1", "100", "10³", "10¹⁸", "10⁻²"]);
    }
}

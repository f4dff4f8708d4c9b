//! What all diagrams share: their beginning, and text in them.

/// Size of a diagram, and where its axes begin.
pub(super) const WIDTH: f64 = 800.0;
pub(super) const HEIGHT: f64 = 440.0;
pub(super) const LEFT: f64 = 70.0;

/// Returns the beginning of a diagram: size, colours, title.
pub(super) fn style(title: &str) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" role="img">
<title>{title}</title>
<style>
svg {{ --ink: #1b1b1b; --paper: #ffffff; --grid: #d9d9d9; --ours: #0072b2; --other: #d55e00; background: var(--paper); font: 13px sans-serif; }}
@media (prefers-color-scheme: dark) {{ svg {{ --ink: #e8e8e8; --paper: #16181c; --grid: #3a3d42; --ours: #56b4e9; --other: #e69f00; }} }}
text {{ fill: var(--ink); }}
.grid {{ stroke: var(--grid); stroke-width: 1; }}
.axis {{ stroke: var(--ink); stroke-width: 1; fill: none; }}
.front {{ stroke: var(--ink); stroke-width: 1.5; stroke-dasharray: 5 4; fill: none; opacity: 0.6; }}
.ours {{ stroke: var(--ours); fill: var(--ours); }}
.other {{ stroke: var(--other); fill: var(--other); }}
.mark {{ stroke-width: 2; }}
.mark.reach {{ stroke-width: 1.2; }}
.hollow {{ fill: var(--paper); }}
.name {{ stroke: var(--paper); stroke-width: 4; paint-order: stroke; }}
</style>
<rect width="{WIDTH}" height="{HEIGHT}" fill="var(--paper)"/>
<text x="{LEFT}" y="24" font-size="16" font-weight="bold">{title}</text>
"#,
        title = escape(title),
    )
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
}

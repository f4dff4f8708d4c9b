//! Where the numbers of marks go in a diagram: beside them, and neither on each other nor on a line.

/// Half the width and half the height of a number, in pixels, of the font that diagrams use.
const HALF_DIGIT: f64 = 4.2;
const HALF_LINE: f64 = 6.5;

/// What is taken in a diagram, as boxes: left, right, top, bottom.
pub(super) struct Labels {
    taken: Vec<[f64; 4]>,
    area: [f64; 4],
}

impl Labels {
    /// Numbers may stand in an area, and not on a mark.
    pub(super) fn new(area: [f64; 4], marks: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let taken = marks.into_iter().map(|(x, y)| [x - 7.0, x + 7.0, y - 7.0, y + 6.5]).collect();
        Self { taken, area }
    }

    /// Keeps numbers off a line.
    pub(super) fn avoid(&mut self, (x0, y0): (f64, f64), (x1, y1): (f64, f64)) {
        let steps = ((x1 - x0).hypot(y1 - y0) / 4.0).ceil().max(1.0);
        let mut share = 0.0;
        while share <= steps {
            let (x, y) = (x0 + (x1 - x0) * share / steps, y0 + (y1 - y0) * share / steps);
            self.taken.push([x - 1.5, x + 1.5, y - 1.5, y + 1.5]);
            share += 1.0;
        }
    }

    /// Returns the SVG of a mark's number, as near to the mark as there is room.
    pub(super) fn place(&mut self, (x, y): (f64, f64), number: usize) -> String {
        let text = number.to_string();
        let half = HALF_DIGIT * text.len() as f64;
        let around = |(x, y): (f64, f64)| [x - half, x + half, y - HALF_LINE, y + HALF_LINE];
        let apart = |a: &[f64; 4], b: &[f64; 4]| a[1] <= b[0] || b[1] <= a[0] || a[3] <= b[2] || b[3] <= a[2];
        let rings = (0..12).map(|ring| 9.0 + 4.0 * f64::from(ring));
        let places = rings.flat_map(|away| {
            let (side, over) = (away + half, away + HALF_LINE);
            [
                (side, 0.0),
                (-side, 0.0),
                (0.0, -over),
                (0.0, over),
                (side, -over),
                (-side, -over),
                (side, over),
                (-side, over),
                (side, -over / 2.0),
                (-side, over / 2.0),
            ]
        });
        let free = |place: &(f64, f64)| {
            let [left, right, top, bottom] = around(*place);
            left >= self.area[0]
                && right <= self.area[1]
                && top >= self.area[2]
                && bottom <= self.area[3]
                && self.taken.iter().all(|taken| apart(&[left, right, top, bottom], taken))
        };
        let place = places.map(|(dx, dy)| (x + dx, y + dy)).find(free).unwrap_or((x, y));
        self.taken.push(around(place));
        let (left, top) = (place.0 - half, place.1 - HALF_LINE);
        // What is behind a number is hidden: a grid goes around it.
        format!(
            r#"<rect class="paper" x="{left:.1}" y="{top:.1}" width="{:.1}" height="{}"/><text x="{:.1}" y="{:.1}" text-anchor="middle">{text}</text>"#,
            2.0 * half,
            2.0 * HALF_LINE,
            place.0,
            place.1 + 4.5
        ) + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_marks_in_one_place_do_not_meet() {
        let mut labels = Labels::new([0.0, 300.0, 0.0, 100.0], [(100.0, 50.0), (100.0, 52.0)]);
        labels.avoid((100.0, 50.0), (300.0, 50.0));
        let places: Vec<String> = (1..9).map(|number| labels.place((100.0, 50.0), number)).collect();
        assert!(places[0].contains(r#"x="86.8""#), "the right is taken by the line: {}", places[0]);
        for (i, one) in labels.taken.iter().enumerate().skip(labels.taken.len() - 8) {
            for other in &labels.taken[..i] {
                let apart = one[1] <= other[0] || other[1] <= one[0] || one[3] <= other[2] || other[3] <= one[2];
                assert!(apart, "{one:?} {other:?}");
            }
        }
    }
}

//! Where the names of marks go in a plot: beside them, and not on each other.

use super::svg::escape;

/// Width of a letter and height of a line, in pixels, of the font that plots use.
const LETTER: f64 = 6.6;
const LINE: f64 = 14.0;
/// From the middle of a mark to its name.
const AWAY: f64 = 11.0;

/// What is taken in a plot: left, right, top, bottom.
pub(super) struct Labels {
    taken: Vec<[f64; 4]>,
    left: f64,
    right: f64,
}

impl Labels {
    /// Names may stand between `left` and `right`, and not on a mark.
    pub(super) fn new(left: f64, right: f64, marks: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let taken = marks.into_iter().map(|(x, y)| [x - 7.0, x + 7.0, y - 6.0, y + 6.0]).collect();
        Self { taken, left, right }
    }

    /// Returns the SVG of a mark's name, as near to the mark as there is room; on it if there is none.
    pub(super) fn place(&mut self, (x, y): (f64, f64), name: &str) -> String {
        let width = LETTER * name.chars().count() as f64;
        let shifts = (0..12).flat_map(|step| [-1.0, 1.0].map(|sign| sign * 5.0 * f64::from(step)));
        let places = shifts.flat_map(|shift| [(false, shift), (true, shift)]);
        let area = |(to_left, shift): (bool, f64)| {
            let start = if to_left { x - AWAY - width } else { x + AWAY };
            [start, start + width, y + shift - LINE / 2.0, y + shift + LINE / 2.0]
        };
        let free = |place: &(bool, f64)| {
            let [left, right, top, bottom] = area(*place);
            let apart =
                |other: &[f64; 4]| right <= other[0] || other[1] <= left || bottom <= other[2] || other[3] <= top;
            left >= self.left && right <= self.right && self.taken.iter().all(apart)
        };
        let place = places.into_iter().find(free).unwrap_or((x > (self.left + self.right) / 2.0, 0.0));
        self.taken.push(area(place));
        let (anchor, at) = if place.0 { ("end", x - AWAY) } else { ("start", x + AWAY) };
        let baseline = y + place.1 + 4.5;
        let name = escape(name);
        format!(r#"<text class="name" x="{at:.1}" y="{baseline:.1}" text-anchor="{anchor}">{name}</text>"#) + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_marks_in_one_place_do_not_meet() {
        let mut labels = Labels::new(0.0, 300.0, [(100.0, 50.0), (100.0, 52.0)]);
        let first = labels.place((100.0, 50.0), "one method");
        let second = labels.place((100.0, 52.0), "another");
        assert!(first.contains(r#"x="111.0" y="54.5""#), "{first}");
        assert!(second.contains(r#"x="89.0" y="56.5" text-anchor="end""#), "{second}");
        let third = labels.place((100.0, 52.0), "a third");
        assert!(!third.contains(r#"y="56.5""#), "{third}");
    }
}

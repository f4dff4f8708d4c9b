//! Rows of the hostile corpus: a case as the bits of its doubles, its exact verdict, and its correctly rounded values.
//!
//! A row is words in a line: the kernel, the input, the verdict, the values. A number is the 16 hexadecimal digits of
//! its bits. `tests/corpus/README.md` lists the kernels, the order of their numbers and the words of their verdicts.

use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;

use crate::{
    Big, Crossing, Place, Projection, Quadratic, Reflection, Vector, dot, exact, is_rounded_quotient, is_rounding_of,
    quotient, rounded, sign, sphere_equation, sub, vector,
};

/// What is asked of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// `a b c`: the real roots of `a x² + b x + c`.
    Quadratic,
    /// Two vectors: the sign of their inner product.
    DotSign,
    /// Origin, direction, center, radius: the roots of the whole line.
    RaySphere,
    /// Origin, direction, vertices: where the ray meets the closed triangle, `t` and the weights of the vertices.
    RayTriangle,
    /// Point, vertices: where the point's projection lies.
    InsideTriangle,
    /// A vector and a normal: the vector mirrored.
    Reflect,
}

impl Question {
    /// All questions.
    pub const ALL: [Self; 6] =
        [Self::Quadratic, Self::DotSign, Self::RaySphere, Self::RayTriangle, Self::InsideTriangle, Self::Reflect];

    /// The first word of a row.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Quadratic => "quadratic",
            Self::DotSign => "dot_sign",
            Self::RaySphere => "ray_sphere",
            Self::RayTriangle => "ray_triangle",
            Self::InsideTriangle => "inside_triangle",
            Self::Reflect => "reflect",
        }
    }

    /// How many numbers a case has.
    #[must_use]
    pub fn inputs(self) -> usize {
        match self {
            Self::Quadratic => 3,
            Self::DotSign | Self::Reflect => 6,
            Self::RaySphere => 10,
            Self::RayTriangle => 15,
            Self::InsideTriangle => 12,
        }
    }
}

/// A case and its answer.
#[derive(Clone, Debug)]
pub struct Row {
    /// What is asked.
    pub question: Question,
    /// The case: finite numbers.
    pub input: Vec<f64>,
    /// The exact verdict.
    pub verdict: String,
    /// The correctly rounded values.
    pub values: Vec<f64>,
}

impl Row {
    /// Answers a case exactly.
    #[must_use]
    pub fn judged(question: Question, input: &[f64]) -> Self {
        let part = |from: usize| vector([input[from], input[from + 1], input[from + 2]]);
        let (verdict, values) = match question {
            Question::Quadratic => {
                let [a, b, c] = [0, 1, 2].map(|i| exact(input[i]));
                roots(&Quadratic { a, b, c })
            }
            Question::DotSign => {
                let word = match sign(&dot(&part(0), &part(3))) {
                    Ordering::Less => "negative",
                    Ordering::Equal => "zero",
                    Ordering::Greater => "positive",
                };
                (word.to_owned(), Vec::new())
            }
            Question::RaySphere => roots(&sphere_equation(&part(3), &sub(&part(0), &part(6)), &exact(input[9]))),
            Question::RayTriangle => crossing(&part(3), [6, 9, 12].map(|from| sub(&part(from), &part(0)))),
            Question::InsideTriangle => {
                let point = |from: usize| [input[from], input[from + 1], input[from + 2]];
                match Projection::new(point(0), [3, 6, 9].map(point)).place() {
                    Place::Miss => ("outside".to_owned(), Vec::new()),
                    place => (word(place), Vec::new()),
                }
            }
            Question::Reflect => {
                let Reflection { numerators, denominator } =
                    Reflection::new([input[0], input[1], input[2]], [input[3], input[4], input[5]]);
                ("mirrored".to_owned(), numerators.iter().map(|n| nearest(n, &denominator)).collect())
            }
        };
        Self { question, input: input.to_vec(), verdict, values }
    }

    /// Whether both rows have the same bits and words.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        self.to_string() == other.to_string()
    }
}

/// The double nearest to a quotient; that it is, is decided in exact numbers.
fn nearest(numerator: &Big, denominator: &Big) -> f64 {
    let x = rounded(&quotient(numerator, denominator));
    assert!(is_rounded_quotient(x, numerator, denominator), "{x:e} is not the nearest");
    x
}

/// How many real roots there are, and the doubles nearest to them; that they are, is decided in exact numbers.
fn roots(equation: &Quadratic) -> (String, Vec<f64>) {
    let nearest_root = |larger: bool, root: &Big| {
        let x = rounded(root);
        assert!(is_rounding_of(x, |m| equation.compare(larger, m)), "{x:e} is not the nearest");
        x
    };
    let (word, values) = match equation.count() {
        None => ("all", Vec::new()),
        Some(0) => ("none", Vec::new()),
        Some(1) if sign(&equation.a) == Ordering::Equal => ("one", vec![nearest(&-&equation.c, &equation.b)]),
        Some(1) => ("one", vec![nearest(&-&equation.b, &(exact(2.0) * &equation.a))]),
        Some(_) => {
            let [low, high] = equation.roots();
            ("two", vec![nearest_root(false, &low), nearest_root(true, &high)])
        }
    };
    (word.to_owned(), values)
}

/// Where a ray meets a triangle, `t` and the weights.
fn crossing(direction: &Vector, seen: [Vector; 3]) -> (String, Vec<f64>) {
    let crossing = Crossing::new(direction, seen);
    let place = crossing.place();
    if !place.is_hit() {
        return (word(place), Vec::new());
    }
    if !crossing.is_ahead() {
        return (word(Place::Miss), Vec::new());
    }
    let quotients = [&crossing.height].into_iter().chain(&crossing.volumes);
    (word(place), quotients.map(|numerator| nearest(numerator, &crossing.slope)).collect())
}

fn word(place: Place) -> String {
    match place {
        Place::Degenerate => "degenerate".to_owned(),
        Place::Parallel => "parallel".to_owned(),
        Place::Miss => "miss".to_owned(),
        Place::Interior => "interior".to_owned(),
        Place::Edge(i) => format!("edge{i}"),
        Place::Vertex(i) => format!("vertex{i}"),
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.question.name())?;
        self.input.iter().try_for_each(|x| write!(f, " {:016x}", x.to_bits()))?;
        write!(f, " {}", self.verdict)?;
        self.values.iter().try_for_each(|x| write!(f, " {:016x}", x.to_bits()))
    }
}

impl FromStr for Row {
    type Err = String;

    /// Reads a row as it stands, whether its answer is right or not.
    fn from_str(line: &str) -> Result<Self, String> {
        let mut words = line.split_ascii_whitespace();
        let name = words.next().unwrap_or_default();
        let question = Question::ALL.into_iter().find(|question| question.name() == name);
        let question = question.ok_or_else(|| format!("expected the name of a kernel, found {name:?}"))?;
        let number = |word: &str| match u64::from_str_radix(word, 16) {
            Ok(bits) if word.len() == 16 => Ok(f64::from_bits(bits)),
            _ => Err(format!("expected 16 hexadecimal digits, found {word:?}")),
        };
        let input: Vec<f64> = words.by_ref().take(question.inputs()).map(number).collect::<Result<_, _>>()?;
        if input.len() < question.inputs() || input.iter().any(|x| !x.is_finite()) {
            return Err(format!("expected {} finite numbers after {name}", question.inputs()));
        }
        let verdict = words.next().unwrap_or_default().to_owned();
        let values = words.map(number).collect::<Result<_, _>>()?;
        Ok(Self { question, input, verdict, values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_as_they_are_written() {
        let row = Row::judged(Question::Quadratic, &[1.0, -3.0, 2.0]);
        let text = "quadratic 3ff0000000000000 c008000000000000 4000000000000000 two 3ff0000000000000 4000000000000000";
        assert_eq!(row.to_string(), text);
        assert!(text.parse::<Row>().is_ok_and(|read| read.is(&row)));
        assert!("cubic 1".parse::<Row>().is_err_and(|problem| problem.contains("\"cubic\"")));
        assert!("quadratic 1 2 3 none".parse::<Row>().is_err_and(|problem| problem.contains("16 hexadecimal digits")));
        assert!("dot_sign 3ff0000000000000".parse::<Row>().is_err_and(|problem| problem.contains("6 finite numbers")));
    }

    #[test]
    fn known_cases_have_their_verdicts() {
        let judged = |question, input: &[f64]| {
            let row = Row::judged(question, input);
            (row.verdict, row.values)
        };
        let answer = |verdict: &str, values: &[f64]| (verdict.to_owned(), values.to_vec());
        let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let ray = |x: f64, z: f64| [&[x, 0.5, 1.0, 0.0, 0.0, z][..], &square].concat();
        assert_eq!(judged(Question::RayTriangle, &ray(0.5, -1.0)), answer("edge1", &[1.0, 0.0, 0.5, 0.5]));
        assert_eq!(judged(Question::RayTriangle, &ray(0.5, 1.0)), answer("miss", &[]));
        assert_eq!(judged(Question::InsideTriangle, &[&[0.0, 1.0, 9.0][..], &square].concat()), answer("vertex2", &[]));
        let sphere = [1.0, 0.0, 5.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0];
        assert_eq!(judged(Question::RaySphere, &sphere), answer("one", &[5.0]));
        assert_eq!(judged(Question::DotSign, &[1.0, 1e-30, 1.0, 1.0, 1.0, -1.0]), answer("positive", &[]));
        assert_eq!(judged(Question::Reflect, &[1.0, -1.0, 0.0, 0.0, 5.0, 0.0]), answer("mirrored", &[1.0, 1.0, 0.0]));
    }
}

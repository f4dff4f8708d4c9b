//! The hostile corpus: the report's cases with their exact answers, a row each, for others to measure themselves
//! against, and what the report's methods make of them.
//!
//! `tests/corpus/` holds what this writes.

use std::fmt::Write;

use oracle::corpus::{Question, Row};
use rayon::prelude::*;

use super::cases::{self, Class};
use super::document::ulp;
use super::measure::errors;
use super::methods::{self, Answer, Method};
use super::random::{Random, cross, join, size};
use super::reference;

/// Returns the files of the corpus, with so many rows for each class, by their names: one for each kernel, and the
/// scores of all methods.
pub(super) fn files(rows: usize) -> Vec<(String, String)> {
    let mut scores = String::from(
        "# What each method makes of the corpus\n\nA verdict is a hit or a miss, a number of roots, a sign, inside or outside. Values are \
         compared where the verdict is right; the largest error is a number of doubles.\n\n\
         | kernel | method | wrong verdicts | not the nearest double | NaN | largest error |\n\
         | --- | --- | ---: | ---: | ---: | ---: |\n",
    );
    let mut files = vec![
        file(Question::Quadratic, &cases::quadratic(rows), &methods::quadratic(), reference::quadratic, &mut scores),
        file(Question::DotSign, &dots(rows), &methods::dot_sign(), dot_reference, &mut scores),
        file(Question::RaySphere, &cases::sphere(rows), &methods::sphere(), reference::sphere, &mut scores),
        file(Question::RayTriangle, &cases::triangle(rows), &methods::triangle(), reference::triangle, &mut scores),
        file(Question::InsideTriangle, &cases::inside(rows), &methods::inside(), reference::inside, &mut scores),
        file(Question::Reflect, &cases::reflection(rows), &methods::reflection(), reference::reflection, &mut scores),
    ];
    files.push(("scores.md".to_owned(), scores));
    files
}

/// Returns a kernel's file, and adds the lines of its methods to the scores.
fn file<const M: usize, const N: usize>(
    question: Question,
    classes: &[Class<M>],
    methods: &[Method<M, N>],
    reference: fn(&[f64; M]) -> Answer<N>,
    scores: &mut String,
) -> (String, String) {
    let mut text = String::new();
    for class in classes {
        let rows: Vec<String> =
            class.cases.par_iter().map(|case| Row::judged(question, case).to_string() + "\n").collect();
        text += &format!("# {}\n{}", class.name, rows.concat());
    }
    let cases: Vec<[f64; M]> = classes.iter().flat_map(|class| class.cases.iter().copied()).collect();
    let truths: Vec<Answer<N>> = cases.par_iter().map(reference).collect();
    for method in methods {
        let e = errors(method, &cases, &truths, |_, answer| answer);
        let values = match e.values {
            0 => "– | – | –".to_owned(),
            n => format!("{} of {n} | {} | {}", e.not_nearest, e.nan, ulp(e.max_ulp)),
        };
        let verdicts = match question {
            Question::Reflect => "–".to_owned(),
            _ => format!("{} of {}", e.wrong_verdicts, e.cases),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(scores, "| {} | {} | {verdicts} | {values} |", question.name(), method.name);
    }
    (format!("{}.txt", question.name()), text)
}

/// Pairs of vectors whose inner product is easy, zero, nearly zero, or made of numbers of any size.
fn dots(rows: usize) -> Vec<Class<6>> {
    let class = |name, make: fn(&mut Random) -> [f64; 6]| cases::class(name, rows, |_| true, make);
    vec![
        class("ordinary", |r| join(&[&r.vector(1.0), &r.vector(1.0)])),
        class("orthogonal", |r| {
            let (a, b) = (r.whole_vector(999_999), r.whole_vector(999));
            join(&[&a, &cross(a, b)])
        }),
        class("nearly orthogonal", |r| {
            let (a, b) = (r.vector(1.0), r.vector(1.0));
            join(&[&a, &cross(a, b)])
        }),
        class("one term lost", |r| {
            let (x, y, small) = (r.uniform(), r.uniform(), size(r.within(-300.0, -17.0)));
            join(&[&[x, r.sign() * small, y], &[y, small, -x]])
        }),
        class("whole range", |r| [0; 6].map(|_| r.exponent(-307.0, 307.0))),
        class("subnormal", |r| join::<6>(&[&r.whole_vector(20), &r.whole_vector(20)]).map(|x| x * f64::from_bits(1))),
        class("along an axis, signed zeros", |r| join(&[&r.signed_vector(1), &r.signed_vector(1)])),
    ]
}

/// The sign of an inner product.
fn dot_reference(case: &[f64; 6]) -> Answer<0> {
    let part = |from: usize| oracle::vector([case[from], case[from + 1], case[from + 2]]);
    methods::signed(oracle::sign(&oracle::dot(&part(0), &part(3))))
}

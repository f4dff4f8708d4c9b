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
        "# What each method makes of the corpus\n\nA verdict is a hit or a miss, a number of roots, a sign, inside \
         or outside. Values are compared where the verdict is right; the largest error is a number of doubles.\n\n\
         | kernel | method | wrong verdicts | not the nearest double | NaN | largest error |\n\
         | --- | --- | ---: | ---: | ---: | ---: |\n",
    );
    let mut files = vec![
        file(
            Question::Quadratic,
            &with(cases::quadratic(rows), root_ties(rows)),
            &methods::quadratic(),
            reference::quadratic,
            &mut scores,
        ),
        file(Question::DotSign, &dots(rows), &methods::dot_sign(), dot_reference, &mut scores),
        file(
            Question::RaySphere,
            &with(cases::sphere(rows), sphere_ties(rows)),
            &methods::sphere(),
            reference::sphere,
            &mut scores,
        ),
        file(
            Question::RayTriangle,
            &with(cases::triangle(rows), triangle_ties(rows)),
            &methods::triangle(),
            reference::triangle,
            &mut scores,
        ),
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

fn with<const M: usize>(mut classes: Vec<Class<M>>, last: Class<M>) -> Vec<Class<M>> {
    classes.push(last);
    classes
}

/// Values that lie exactly halfway between two doubles, or beside that by less than `2^-100` of themselves.
const TIES: &str = "halfway between two doubles";

fn ties<const M: usize>(rows: usize, make: fn(&mut Random) -> [f64; M]) -> Class<M> {
    cases::class(TIES, rows, |_| true, make)
}

/// Roots below the normal numbers: halves of the least.
fn root_ties(rows: usize) -> Class<3> {
    ties(rows, |r| {
        let odd = (2.0 * r.whole(-999, 999) + 1.0) * f64::from_bits(1);
        if r.one_in(2) { [0.0, 2.0, odd] } else { [2.0, odd, 0.0] }
    })
}

/// `t` is the difference of two doubles: the height of the origin and the radius. A ray that passes slightly off the
/// center hits slightly later.
fn sphere_ties(rows: usize) -> Class<10> {
    ties(rows, |r| {
        let (height, radius) = (r.within(4.0, 8.0), r.within(1.0, 2.0));
        let aside = if r.one_in(2) { 0.0 } else { size(r.within(-40.0, -20.0)) };
        join(&[&[aside, 0.0, height], &[0.0, 0.0, -1.0], &[0.0; 3], &[radius]])
    })
}

/// `t` is the sum of two doubles: the heights of the origin and of the plane, which is tilted by an ulp in some cases.
/// One weight of the point hit is tiny.
fn triangle_ties(rows: usize) -> Class<15> {
    ties(rows, |r| {
        let (height, depth) = (r.within(4.0, 8.0), r.within(1.0, 2.0));
        let depths = if r.one_in(2) { [depth; 3] } else { [depth, depth, depth.next_up()] };
        let inward = size(r.within(-60.0, -16.0));
        let [a, b, c] = [[-4.0, 0.0, -depths[0]], [4.0, 0.0, -depths[1]], [0.0, 8.0, -depths[2]]];
        join(&[&[0.25, inward, height], &[0.0, 0.0, -1.0], &a, &b, &c])
    })
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

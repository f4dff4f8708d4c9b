//! Every row of `tests/corpus/` has the oracle's answer, and the crates give that answer, bit for bit.

use std::fs;
use std::path::Path;

use glam::DVec3;
use oracle::corpus::{Question, Row};
use rt_geom::{AHEAD, PointInTriangle, Ray, Sphere, Triangle, Verdict, inside_triangle};
use rt_math::exact::dot_sign;
use rt_math::{Roots, reflect, solve_quadratic};

/// The lines of all files that are rows, with their places.
fn lines() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
    let mut lines = Vec::new();
    for name in oracle::files::names(&folder).into_iter().filter(|name| name.ends_with(".txt")) {
        let text = fs::read_to_string(folder.join(&name)).expect("a file of the corpus is text");
        let rows = text.lines().enumerate().filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        lines.extend(rows.map(|(i, line)| (format!("tests/corpus/{name}:{}", i + 1), line.to_owned())));
    }
    lines
}

#[test]
fn every_row_has_the_oracles_answer_and_the_crates_give_it() {
    let mut counts = [0; Question::ALL.len()];
    for (place, line) in lines() {
        let row: Row = line.parse().unwrap_or_else(|problem| panic!("{place}: {problem}"));
        let judged = Row::judged(row.question, &row.input);
        assert!(row.is(&judged), "{place}: the exact answer is\n{judged}");
        let (verdict, values) = answer(&row);
        let ours = Row { verdict, values, ..row.clone() };
        assert!(ours.is(&judged), "{place}: the crates answer\n{ours}\ninstead of\n{judged}");
        let kind = Question::ALL.iter().position(|&question| question == row.question);
        counts[kind.expect("a question is among all")] += 1;
    }
    assert!(counts.iter().all(|&count| count >= 100), "{counts:?} rows of {:?}", Question::ALL);
}

/// What the crates answer, in the words of a row.
fn answer(row: &Row) -> (String, Vec<f64>) {
    let part = |from: usize| DVec3::from_slice(&row.input[from..]);
    let triangle = |from: usize| Triangle::new(part(from), part(from + 3), part(from + 6)).expect("rows are finite");
    let ray = || Ray::new(part(0), part(3)).expect("a row has a direction");
    match row.question {
        Question::Quadratic => roots(solve_quadratic(row.input[0], row.input[1], row.input[2])),
        Question::DotSign => {
            let sign = dot_sign(part(0), part(3)).expect("rows are finite");
            (["negative", "zero", "positive"][(sign as i8 + 1).unsigned_abs() as usize].to_owned(), Vec::new())
        }
        Question::RaySphere => {
            let (ray, sphere) = (ray(), Sphere::new(part(6), row.input[9]).expect("a row's radius is not negative"));
            let found = roots(sphere.roots(&ray));
            let nearest = found.1.iter().copied().find(|t| t.is_sign_positive());
            assert_eq!(sphere.closest(&ray, AHEAD), nearest, "{row}");
            assert_eq!(sphere.any(&ray, AHEAD), nearest.is_some(), "{row}");
            found
        }
        Question::RayTriangle => {
            let (ray, triangle) = (ray(), triangle(6));
            let hit = triangle.closest_with_barycentric(&ray, AHEAD);
            assert_eq!(triangle.closest(&ray, AHEAD), hit.map(|(t, _)| t), "{row}");
            assert_eq!(triangle.any(&ray, AHEAD), hit.is_some(), "{row}");
            let word = match triangle.verdict(&ray) {
                Verdict::Edge(i) => format!("edge{i}"),
                Verdict::Vertex(i) => format!("vertex{i}"),
                other => format!("{other:?}").to_lowercase(),
            };
            (word, hit.map_or(Vec::new(), |(t, [u, v, w])| vec![t, u, v, w]))
        }
        // The crate does not say which edge or vertex, nor why a point is outside.
        Question::InsideTriangle => {
            let fits = match inside_triangle(part(0), &triangle(3)) {
                PointInTriangle::Interior => row.verdict == "interior",
                PointInTriangle::Edge => row.verdict.starts_with("edge"),
                PointInTriangle::Vertex => row.verdict.starts_with("vertex"),
                PointInTriangle::Outside => ["outside", "degenerate"].contains(&row.verdict.as_str()),
            };
            (if fits { row.verdict.clone() } else { "another".to_owned() }, Vec::new())
        }
        Question::Reflect => ("mirrored".to_owned(), reflect(part(0), part(3)).to_array().to_vec()),
    }
}

fn roots(roots: Roots) -> (String, Vec<f64>) {
    let (word, values) = match roots {
        Roots::None => ("none", Vec::new()),
        Roots::One(x) => ("one", vec![x]),
        Roots::Two(x, y) => ("two", vec![x, y]),
        Roots::All => ("all", Vec::new()),
    };
    (word.to_owned(), values)
}

//! The roots of a quadratic whose discriminant the textbook loses: `cargo run -p rt-math --example roots_without_cancellation`.

use rt_math::{Roots, solve_quadratic};

fn main() {
    let (a, b, c): (f64, f64, f64) = (94_906_265.625, -2.0 * 94_906_267.0, 94_906_268.375);
    let discriminant = b * b - 4.0 * a * c;
    println!("textbook: b² - 4ac = {discriminant}, so one root, {}", -b / (2.0 * a));
    let roots = solve_quadratic(a, b, c);
    assert!(matches!(roots, Roots::Two(_, _)), "there are two");
    for root in roots {
        println!("exact:    {root}");
    }
    println!("the smallest positive one: {:?}", roots.smallest_positive());
}

#[test]
fn the_example_runs() {
    main();
}

//! The constants of the code and those of the proofs in `docs/proofs` are the same: neither changes without the other.
//!
//! Both are read as they are written, so that private constants and numbers in the midst of a formula count as well.

use std::collections::BTreeMap;
use std::fs;
use std::iter::Peekable;
use std::path::Path;
use std::str::Chars;

/// A file of `docs/proofs`; and of each of its constants the name, the file of the code under `crates`, and what stands
/// before and behind the value there.
type File = (&'static str, &'static [(&'static str, &'static str, &'static str, &'static str)]);

const FILES: &[File] = &[
    (
        "Angles",
        &[
            ("TURN_SHARE", "rt-shade/src/mapping.rs", "(share(", ", h_square)"),
            ("HALF_SHARE", "rt-shade/src/mapping.rs", "share(", ", length_square)"),
            ("COORDINATE_ROUNDING", "rt-shade/src/mapping.rs", "turns * relative + ", " } else"),
            ("LARGEST_PART", "rt-shade/src/mapping.rs", "relative <= ", " && square"),
        ],
    ),
    (
        "Area",
        &[
            ("PER_TERM", "../figures/src/import/polygon.rs", "let error = (", " * count + "),
            ("AT_ONCE", "../figures/src/import/polygon.rs", " * count + ", ") * U * size"),
            ("FACING", "../figures/src/import/polygon.rs", "if area[axis].abs() > ", " * error && size"),
        ],
    ),
    ("Balance", &[("PULL_ERROR", "rt-geom/src/enclosing/certify.rs", "let pull = pull / total + ", " + 2.0 * step")]),
    ("Balls", &[("BALL_SLACK", "rt-geom/src/bvh/cull.rs", "const BALL_SLACK: f32 = ", " * U;")]),
    (
        "Cancelling",
        &[
            ("LARGEST", "rt-math/src/pseudo_inverse/regular.rs", "const LARGEST: f64 = ", ";"),
            ("CANCELLING_ERROR", "rt-math/src/pseudo_inverse/regular.rs", "const CANCELLING_ERROR: f64 = ", ";"),
        ],
    ),
    (
        "Boxes",
        &[
            ("BOX_SLACK", "rt-geom/src/bvh/cull.rs", "const BOX_SLACK: f32 = ", " * U;"),
            ("MAX_INVERSE", "rt-geom/src/bvh/cull.rs", "const MAX_INVERSE: f32 = ", ";"),
            ("KEY_SHIFT", "rt-geom/src/bvh/cull.rs", "const KEY_SHIFT: f32 = ", ";"),
            ("REACH", "rt-geom/src/bvh/cull.rs", "const REACH: f64 = ", ";"),
            ("ROUNDING", "rt-geom/src/bvh/cull.rs", "const ROUNDING: f64 = ", ";"),
        ],
    ),
    ("Candidates", &[("CANDIDATE", "rt-geom/src/sphere/finish.rs", "error: ((", " * self.error) * self.inverse_a)")]),
    (
        "Color",
        &[
            ("POWER_FACTOR", "rt-shade/src/phong.rs", "let near = (", " * growth + "),
            ("POWER_ROUNDING", "rt-shade/src/phong.rs", "* growth + ", ") * power + UNDERFLOW"),
            ("LARGEST_GROWTH", "rt-shade/src/phong.rs", "(growth <= ", ") { near"),
            ("WIDE_FACTOR", "rt-shade/src/phong.rs", "if shininess >= 1.0 { ", " * (alignment.abs() + error)"),
            ("DIFFUSE_ROUNDING", "rt-shade/src/phong.rs", "(cosine_error + ", ") + surface_error"),
            ("SUM_ROUNDINGS", "rt-shade/src/phong.rs", "(2 * lights + ", ") as f64 * U"),
            ("UNDERFLOW", "rt-shade/src/phong.rs", "const UNDERFLOW: f64 = ", ";"),
        ],
    ),
    (
        "Crown",
        &[
            ("PARAMETER_ERROR", "rt-geom/src/bvh/crown.rs", "const PARAMETER_ERROR: f64 = ", ";"),
            ("UNDERFLOW", "rt-geom/src/bvh/crown.rs", "const UNDERFLOW: f64 = ", ";"),
            ("FARTHEST", "rt-geom/src/bvh/crown.rs", "const FARTHEST: f64 = ", ";"),
            ("SHORTEST", "rt-geom/src/bvh/crown.rs", "const SHORTEST: f64 = ", ";"),
        ],
    ),
    ("CrownBox", &[]),
    (
        "Determinant",
        &[
            ("BOUND_FACTOR", "rt-math/src/pseudo_inverse/regular.rs", "let bound = ", " * U * (sum("),
            ("TAU_LIMIT", "rt-math/src/pseudo_inverse/regular.rs", "const TAU_LIMIT: f64 = ", ";"),
            ("ETA_LIMIT", "rt-math/src/pseudo_inverse/regular.rs", "const ETA_LIMIT: f64 = ", ";"),
        ],
    ),
    (
        "Dot",
        &[
            ("ERROR", "rt-math/src/exact/dot.rs", "const ERROR: f64 = ", ";"),
            ("DIFFERENCE_ERROR", "rt-math/src/exact/dot.rs", "const DIFFERENCE_ERROR: f64 = ", ";"),
            ("ERROR_FLOOR", "rt-math/src/exact/dot.rs", "const ERROR_FLOOR: f64 = ", ";"),
        ],
    ),
    (
        "DoubleDouble",
        &[
            ("SUM", "rt-math/src/exact/double_double.rs", "| `+`, `-` | ", " u²"),
            ("PRODUCT", "rt-math/src/exact/double_double.rs", "| `*` | ", " u²"),
            ("QUOTIENT", "rt-math/src/exact/double_double.rs", "| `/` | ", " u²"),
            ("ROOT", "rt-math/src/exact/double_double.rs", "| `sqrt` | ", " u²"),
        ],
    ),
    ("Enclosure", &[("LIMB_BITS", "rt-math/src/exact/ball.rs", "const BITS: i64 = ", " * LIMBS as i64;")]),
    (
        "ErrorFree",
        &[("LEAST_PRODUCT", "rt-math/src/exact/error_free.rs", "`a b` is zero or at least ", " in magnitude")],
    ),
    ("Frame", &[("COORDINATE_ERROR", "rt-geom/src/bvh/node.rs", "pub(super) const COORDINATE_ERROR: f64 = ", ";")]),
    ("Kept", &[]),
    (
        "Fixed",
        &[
            ("ERROR", "rt-math/src/exact/fixed.rs", "const ERROR: f64 = ", ";"),
            ("SAFE_LEAST", "rt-math/src/exact/fixed.rs", "const SAFE: core::ops::Range<i32> = ", ".."),
            ("SMALL", "rt-math/src/exact/fixed.rs", "const SMALL: i32 = ", ";"),
            ("CUT", "rt-math/src/pseudo_inverse/fixed.rs", "const CUT: f64 = ", ";"),
        ],
    ),
    (
        "Light",
        &[
            ("UNIT_ERROR", "rt-shade/src/phong.rs", "const UNIT_ERROR: f64 = ", ";"),
            ("UNIT_FACTOR", "rt-shade/src/phong.rs", "{ 0.0 } else { ", " * error * inverse_length"),
            ("INCIDENT_ERROR", "rt-shade/src/phong.rs", "const INCIDENT_ERROR: f64 = ", ";"),
            ("LARGEST_ERROR", "rt-shade/src/phong.rs", "const LARGEST_ERROR: f64 = ", ";"),
            ("COSINE_FACTOR", "rt-shade/src/phong.rs", "let error = ", " * (incident + normal) + COSINE_ROUNDING"),
            ("COSINE_ROUNDING", "rt-shade/src/phong.rs", "const COSINE_ROUNDING: f64 = ", ";"),
            ("ALIGNMENT_FACTOR", "rt-shade/src/phong.rs", "    ", " * (incident + 4.0 * normal) + ALIGNMENT_ROUNDING"),
            ("ALIGNMENT_ROUNDING", "rt-shade/src/phong.rs", "const ALIGNMENT_ROUNDING: f64 = ", ";"),
        ],
    ),
    (
        "Limbs",
        &[
            ("DOT_LIMBS", "rt-math/src/exact/dot.rs", "sized_sign::<", ">(a, b, n) // of any"),
            ("DOT_NARROW_LIMBS", "rt-math/src/exact/dot.rs", "sized_sign::<", ">(a, b, n)\n"),
            ("DOT_NARROW", "rt-math/src/exact/dot.rs", "if bits <= ", " {\n        sized_sign"),
            ("QUADRATIC_LIMBS", "rt-math/src/quadratic.rs", "sized::<", ">(a, b, c)"),
            ("INVERSE_LIMBS", "rt-math/src/pseudo_inverse/integers.rs", "else { pseudo_inverse_sized::<", ">(m) }"),
            (
                "INVERSE_NARROW_LIMBS",
                "rt-math/src/pseudo_inverse/integers.rs",
                "(m) { pseudo_inverse_sized::<",
                ">(m) }",
            ),
            ("INVERSE_NARROW", "rt-math/src/pseudo_inverse/integers.rs", "const NARROW: u64 = ", ";"),
            ("WHOLE_BITS", "rt-math/src/pseudo_inverse/whole.rs", "const BITS: i32 = ", ";"),
            ("REFLECT_LIMBS", "rt-math/src/reflect.rs", "else { sized::<", ">(v, n) }"),
            ("REFLECT_NARROW_LIMBS", "rt-math/src/reflect.rs", "{ sized::<", ">(v, n) } else"),
            ("REFLECT_NARROW", "rt-math/src/reflect.rs", "if bits <= ", " { sized"),
            ("SPHERE_LIMBS", "rt-geom/src/sphere/exact.rs", "const ANY_LIMBS: usize = ", ";"),
            ("SIDE_LIMBS", "rt-geom/src/sphere/exact.rs", "type SideInteger = Dyadic<", ">;"),
            ("TRIANGLE_LIMBS", "rt-geom/src/triangle/exact.rs", "const ANY_LIMBS: usize = ", ";"),
            ("TRIANGLE_NARROW_LIMBS", "rt-geom/src/triangle/exact.rs", "const NARROW_LIMBS: usize = ", ";"),
            ("TRIANGLE_NARROW", "rt-geom/src/triangle/exact.rs", "const NARROW: i32 = ", ";"),
            ("NORMAL_LIMBS", "rt-geom/src/triangle/exact.rs", "type NormalInteger = Dyadic<", ">;"),
            ("LOCATE_LIMBS", "rt-geom/src/triangle/locate.rs", "const ANY_LIMBS: usize = ", ";"),
            ("LOCATE_NARROW_LIMBS", "rt-geom/src/triangle/locate.rs", "const NARROW_LIMBS: usize = ", ";"),
            ("LOCATE_NARROW", "rt-geom/src/triangle/locate.rs", "const NARROW: i32 = ", ";"),
            ("REACH_LIMBS", "rt-geom/src/enclosing/exact.rs", "type ReachInteger = Dyadic<", ">;"),
            ("AREA_LIMBS", "../figures/src/import/polygon.rs", "type AreaInteger = Dyadic<", ">;"),
            ("SURFACE_LIMBS", "rt-geom/src/surface/exact.rs", "type Number = Dyadic<", ">;"),
            ("SURFACE_SIDE_LIMBS", "rt-geom/src/surface/exact.rs", "type SideNumber = Dyadic<", ">;"),
            ("CROSSING_LIMBS", "rt-geom/src/crossings.rs", "type Number = Dyadic<", ">;"),
            ("WINDOW_SPARE", "rt-math/src/exact/fixed.rs", "const BITS: i32 = 64 * LIMBS as i32 - ", ";"),
            ("MOST_LIMBS", "rt-math/src/exact/fixed.rs", "pub const MOST_LIMBS: usize = ", ";"),
            ("LONG_LIMBS", "rt-math/src/exact/fixed.rs", "type Long = Dyadic<", ">;"),
        ],
    ),
    (
        "Line",
        &[
            ("LINE_ERROR", "rt-geom/src/bvh/cull.rs", "const LINE_ERROR: f64 = ", ";"),
            ("MAX_LINE_ERROR", "rt-geom/src/bvh/cull.rs", "const MAX_LINE_ERROR: f64 = ", ";"),
        ],
    ),
    (
        "Locate",
        &[
            ("FARTHEST", "rt-geom/src/triangle/locate.rs", "const FARTHEST: f64 = ", ";"),
            ("UNDERFLOW", "rt-geom/src/triangle/locate.rs", "const UNDERFLOW: f64 = ", ";"),
            (
                "TURN_ERROR",
                "rt-geom/src/triangle/locate.rs",
                "let error = ",
                " * (edge * edge * edge) * far + UNDERFLOW;\n    certain_signs([turn(",
            ),
            ("TURN_ERROR_2", "rt-geom/src/triangle/locate.rs", "let relative = ", " * (edge"),
            ("VOLUME_ERROR", "rt-geom/src/triangle/locate.rs", "let error = ", " * (edge * edge) * far + UNDERFLOW;"),
        ],
    ),
    (
        "Near",
        &[
            ("NEAR_ERROR", "rt-geom/src/enclosing/mod.rs", "bracket.low * (1.0 - ", ") - shift.abs()"),
            ("INSIDE", "rt-geom/src/enclosing/apart.rs", "const INSIDE: f64 = ", ";"),
        ],
    ),
    (
        "Nodes",
        &[
            ("NODE_ERROR", "rt-geom/src/enclosing/nodes.rs", "let limit = best.1 * (1.0 - ", ");"),
            ("SETTLED", "rt-geom/src/enclosing/certify.rs", "if reach * (1.0 + ", ") <= radius {"),
            ("ENCLOSED", "rt-geom/src/enclosing/certify.rs", "if rough < bracket.low * (1.0 - ", ") {"),
            ("EXTREME", "rt-geom/src/enclosing/extreme.rs", "if reach > most * (1.0 - ", ") && !contains_exactly"),
            ("BALANCED", "rt-geom/src/enclosing/nodes.rs", "pull.length() <= total * ", " && highest"),
        ],
    ),
    ("Norm", &[]),
    (
        "Points",
        &[
            ("AT_WAY", "rt-geom/src/ray.rs", "most `u (", " |t direction|"),
            ("AT_POINT", "rt-geom/src/ray.rs", "|t direction| + ", " |point|)"),
            ("SPHERE_NORMAL", "rt-geom/src/sphere/mod.rs", "Within `", " * 2^-53` of the exact unit vector"),
            ("TRIANGLE_NORMAL", "rt-geom/src/triangle/mod.rs", "Within `", " * 2^-53` of the exact one in"),
            ("HIT_NORMAL", "rt-geom/src/surface/mod.rs", "Within `", " * 2^-53` of the exact one, for"),
            ("CERTAIN_NORMAL", "rt-geom/src/triangle/exact.rs", "max_abs(n) >= ", " * largest * largest"),
            ("DIVISION", "rt-geom/src/surface/mod.rs", "sphere.radius() + ", " * U,"),
            ("TAKEN", "rt-geom/src/surface/mod.rs", "normal.error <= ", " * U)"),
        ],
    ),
    (
        "Ordinary",
        &[
            ("ORDINARY_START", "rt-geom/src/enclosing/tangent.rs", "const ORDINARY: Range<f64> = ", ".."),
            ("ORDINARY_END", "rt-geom/src/enclosing/tangent.rs", "const ORDINARY: Range<f64> = 1e-40..", ";"),
            ("SQUARES_START", "rt-geom/src/enclosing/tangent.rs", "const ORDINARY_SQUARES: Range<f64> = ", ".."),
            ("SQUARES_END", "rt-geom/src/enclosing/tangent.rs", "const ORDINARY_SQUARES: Range<f64> = 1e-80..", ";"),
        ],
    ),
    (
        "LowerBound",
        &[
            ("BALANCE", "rt-geom/src/enclosing/certify.rs", "const BALANCE: f64 = ", ";"),
            ("MEAN_ERROR", "rt-geom/src/enclosing/certify.rs", "let doubt = ", " * mean.abs();"),
            ("BOUND_ERROR", "rt-geom/src/enclosing/certify.rs", "let below = mean - slack * (1.0 + ", ");"),
        ],
    ),
    (
        "Pair",
        &[
            ("PAIR_ERROR", "rt-geom/src/enclosing/certify.rs", "const PAIR_ERROR: f64 = ", ";"),
            ("NEARLY_INSIDE", "rt-geom/src/enclosing/certify.rs", "const NEARLY_INSIDE: f64 = ", ";"),
            ("AWAY_ERROR", "rt-geom/src/enclosing/certify.rs", "REACH_ERROR + bend + ", " * (away + U * size);"),
        ],
    ),
    ("PairCenter", &[]),
    (
        "Polygon",
        &[(
            "TURN_ERROR",
            "../figures/src/import/polygon.rs",
            "let error = ",
            " * (left.abs() + right.abs()) + f64::MIN_POSITIVE;",
        )],
    ),
    (
        "Quadratic",
        &[
            ("CANCELLATION", "rt-math/src/quadratic.rs", "const CANCELLATION: f64 = ", ";"),
            ("D_FLOOR", "rt-math/src/quadratic.rs", "const D_FLOOR: f64 = ", ";"),
        ],
    ),
    (
        "QuadraticRange",
        &[
            ("ORDINARY_LEAST", "rt-math/src/quadratic.rs", "const ORDINARY: core::ops::Range<f64> = ", ".."),
            ("ORDINARY_END", "rt-math/src/quadratic.rs", "power_of_two(-256)..", ";"),
            ("LOPSIDED", "rt-math/src/quadratic.rs", "const LOPSIDED: i32 = ", ";"),
        ],
    ),
    (
        "QuadraticRoots",
        &[("DOUBLE_DOUBLE_ERROR", "rt-math/src/quadratic.rs", "const DOUBLE_DOUBLE_ERROR: f64 = ", ";")],
    ),
    ("Reach", &[("REACH_ERROR", "rt-geom/src/enclosing/certify.rs", "const REACH_ERROR: f64 = ", ";")]),
    ("Ray", &[("LONGEST", "rt-geom/src/ray.rs", "const LONGEST: f64 = ", ";")]),
    (
        "Reciprocal",
        &[
            ("ETA_FACTOR", "rt-math/src/pseudo_inverse/regular.rs", "let eta = ", " * eta_0"),
            ("ETA_ROUNDING", "rt-math/src/pseudo_inverse/regular.rs", "eta_0 + ", " * (U * U"),
            ("LOW_ROUNDING", "rt-math/src/pseudo_inverse/regular.rs", "r.abs() * (eta + ", ")) })"),
            ("TERMS_FACTOR", "rt-math/src/pseudo_inverse/regular.rs", "times(sum, low, ", " * terms"),
            ("ENTRIES_FACTOR", "rt-math/src/pseudo_inverse/regular.rs", "* terms + ", " * ((b[k]"),
        ],
    ),
    (
        "Refinement",
        &[
            ("REST_ERROR", "rt-geom/src/triangle/finish.rs", "const REST_ERROR: f64 = ", ";"),
            ("SOLUTION_ERROR", "rt-geom/src/triangle/finish.rs", "const SOLUTION_ERROR: f64 = ", ";"),
            ("FIRST_WEIGHT", "rt-geom/src/triangle/finish.rs", "[(alpha, ", " * error)"),
            ("LEAST_WEIGHT", "rt-geom/src/triangle/filter.rs", "|&weight| weight >= ", ")"),
        ],
    ),
    ("ReachScalar", &[]),
    ("Reflect", &[("ERROR", "rt-math/src/reflect.rs", "const ERROR: f64 = ", ";")]),
    (
        "ReflectRange",
        &[
            ("WINDOW", "rt-math/src/reflect.rs", "const WINDOW: f64 = ", ";"),
            ("ERROR_FLOOR", "rt-math/src/reflect.rs", "const ERROR_FLOOR: f64 = ", ";"),
        ],
    ),
    ("Round", &[]),
    (
        "Scan",
        &[
            ("REACH_ERROR", "rt-geom/src/enclosing/scan.rs", "const REACH_ERROR: f64 = ", ";"),
            ("MEASURE_ERROR", "rt-geom/src/enclosing/scan.rs", "const MEASURE_ERROR: f64 = ", ";"),
            ("SKIPPED", "rt-geom/src/enclosing/scan.rs", "limit - self.way - ", " * (limit + self.way)"),
            ("MAX_ROUNDS", "rt-geom/src/enclosing/scan.rs", "const MAX_ROUNDS: usize = ", ";"),
        ],
    ),
    (
        "Series",
        &[
            (
                "STEPS",
                "rt-shade/src/certified/mod.rs",
                "const fn halvings(limbs: usize) -> usize {\n    ",
                " + limbs.isqrt()",
            ),
            ("LONGEST", "rt-shade/src/certified/mod.rs", "const LONGEST: usize = ", ";"),
            ("EXP_STEPS", "rt-shade/src/certified/power.rs", "let steps = ", " + (4 * limbs)"),
            ("LOWEST", "rt-shade/src/certified/power.rs", "const LOWEST: f64 = ", ";"),
            ("LEAST", "rt-shade/src/certified/power.rs", "const LEAST: i32 = ", ";"),
        ],
    ),
    ("Single", &[("UNIT", "rt-geom/src/bvh/cull.rs", "const U: f32 = ", ";")]),
    ("Spacing", &[("SPACING", "rt-geom/src/enclosing/certify.rs", "const SPACING: f64 = ", ";")]),
    (
        "Samples",
        &[
            ("PLACE_ROUNDING", "rt-shade/src/texture.rs", "(u_error + ", ") * width"),
            ("BILINEAR_FACTOR", "rt-shade/src/texture.rs", "let error = ", " * (width * u_error + height * v_error)"),
            ("BILINEAR_ROUNDINGS", "rt-shade/src/texture.rs", "3.0 * height + ", ") * U;"),
            ("MIXED_FACTOR", "../figures/src/seen.rs", "interpolate(colors, weights), (", " * error + "),
            ("MIXED_ROUNDING", "../figures/src/seen.rs", "* error + ", ") * brightest"),
            ("BYTE_FACTOR", "../figures/src/certify.rs", "let slack = ", " * most * (error"),
            ("BYTE_ROUNDINGS", "../figures/src/certify.rs", "(count + ", ") * U);"),
        ],
    ),
    (
        "Sphere",
        &[
            ("SMALLEST", "rt-geom/src/sphere/filter.rs", "const SMALLEST: f64 = ", ";"),
            ("LARGEST", "rt-geom/src/sphere/filter.rs", "const LARGEST: f64 = ", ";"),
            ("ERROR", "rt-geom/src/sphere/filter.rs", "const ERROR: f64 = ", ";"),
            ("SIDE_ERROR", "rt-geom/src/sphere/mod.rs", "let error = ", " * (square + radius_square) + UNDERFLOW;"),
            ("UNDERFLOW", "rt-geom/src/sphere/mod.rs", "const UNDERFLOW: f64 = ", ";"),
            ("FIRST_AHEAD", "rt-geom/src/sphere/finish.rs", "self.c.abs() > ", " * self.squares;"),
        ],
    ),
    (
        "SphereExact",
        &[
            ("FARTHEST", "rt-geom/src/sphere/exact.rs", "const FARTHEST: f64 = ", ";"),
            ("UNDERFLOW", "rt-geom/src/sphere/exact.rs", "const UNDERFLOW: f64 = ", ";"),
            ("DELTA_ERROR", "rt-geom/src/sphere/exact.rs", "let error = ", " * ((reach_square.high()"),
            ("SIDE_ERROR", "rt-geom/src/sphere/exact.rs", "let error = ", " * (square.high()"),
        ],
    ),
    (
        "SphereStep",
        &[
            ("RESIDUAL_ERROR", "rt-geom/src/sphere/finish.rs", "const RESIDUAL_ERROR: f64 = ", ";"),
            ("LARGEST_SLACK", "rt-geom/src/sphere/finish.rs", "if slack > ", " {"),
            ("SLACK_FACTOR", "rt-geom/src/sphere/finish.rs", "let relative = ", " * slack"),
        ],
    ),
    ("Steps", &[]),
    (
        "SphereTree",
        &[
            ("MARGIN", "rt-geom/src/sphere_tree.rs", "const MARGIN: f64 = ", ";"),
            ("UNDERFLOW", "rt-geom/src/sphere_tree.rs", "const UNDERFLOW: f64 = ", ";"),
            ("LONGEST", "rt-geom/src/sphere_tree.rs", "const LONGEST: f64 = ", ";"),
        ],
    ),
    ("Step", &[("STEP_ERROR", "rt-geom/src/enclosing/certify.rs", "still.select(none, bend + ", " * length);")]),
    (
        "SurfaceFilter",
        &[
            ("WAY_ERROR", "rt-geom/src/surface/filter.rs", "const WAY_ERROR: f64 = ", ";"),
            ("POINT_ERROR", "rt-geom/src/surface/filter.rs", "const POINT_ERROR: f64 = ", ";"),
            ("PRODUCT_ERROR", "rt-geom/src/surface/filter.rs", "const PRODUCT_ERROR: f64 = ", ";"),
            ("UNDERFLOW", "rt-geom/src/surface/filter.rs", "const UNDERFLOW: f64 = ", ";"),
        ],
    ),
    (
        "SurfaceFinish",
        &[
            ("RESIDUAL_ERROR", "rt-geom/src/surface/finish.rs", "const RESIDUAL_ERROR: f64 = ", ";"),
            ("SLOPE_ERROR", "rt-geom/src/surface/finish.rs", "const SLOPE_ERROR: f64 = ", ";"),
            ("DELTA_ERROR", "rt-geom/src/surface/finish.rs", "const DELTA_ERROR: f64 = ", ";"),
            ("CERTAIN", "rt-geom/src/surface/finish.rs", "!(delta > ", " * delta_error)"),
            ("ROOT_ERROR", "rt-geom/src/surface/finish.rs", "let sqrt_error = ", " * delta_error / sqrt"),
            ("ROOT_ROUNDING", "rt-geom/src/surface/finish.rs", "delta_error / sqrt + ", " * sqrt;"),
            ("LARGE_FACTOR", "rt-geom/src/surface/finish.rs", "let large = (sum / a, ", " * (sum_error / a)"),
            ("LARGE_ROUNDING", "rt-geom/src/surface/finish.rs", "(sum_error / a) + ", " * (sum / a))"),
            ("SMALL_FACTOR", "rt-geom/src/surface/finish.rs", "(f.abs() / sum, ", " * (f_error / sum"),
            ("SMALL_ROUNDING", "rt-geom/src/surface/finish.rs", "(sum_error / sum)) + ", " * (f.abs() / sum))"),
            ("HALF_BELOW", "rt-geom/src/surface/finish.rs", "near.0.abs() + near.1 < ", " * spacing"),
            ("HALF_ABOVE", "rt-geom/src/surface/finish.rs", "near.0.abs() - near.1 > ", " * spacing"),
            ("FARTHEST", "rt-geom/src/surface/finish.rs", "const FARTHEST: f64 = ", ";"),
            ("UNDERFLOW", "rt-geom/src/surface/finish.rs", "const UNDERFLOW: f64 = ", ";"),
        ],
    ),
    (
        "SurfaceSide",
        &[
            ("HEIGHT_ERROR", "rt-geom/src/surface/finish.rs", "const HEIGHT_ERROR: f64 = ", ";"),
            ("SLOPE_ERROR", "rt-geom/src/surface/finish.rs", "const SLOPE_ERROR: f64 = ", ";"),
            ("CERTAIN_SLOPE", "rt-geom/src/surface/finish.rs", "!(slope.abs() > ", " * slope_error)"),
            ("STEP_FACTOR", "rt-geom/src/surface/finish.rs", "let error = ", " * (height_error + step"),
            ("STEP_ROUNDING", "rt-geom/src/surface/finish.rs", "/ slope.abs() + ", " * step.abs()"),
            ("VECTOR_ERROR", "rt-geom/src/surface/finish.rs", "U * size + ", " * (size + way)"),
            ("SIDE_ERROR", "rt-geom/src/surface/finish.rs", "normal.error * way.error + ", " * n * w)"),
            ("UNDERFLOW", "rt-geom/src/surface/finish.rs", "const UNDERFLOW: f64 = ", ";"),
        ],
    ),
    (
        "SurfaceWeights",
        &[
            ("PART_FACTOR", "rt-geom/src/surface/filter.rs", "let part_error = edge * (", " * (hit.point_error"),
            ("SUM_FACTOR", "rt-geom/src/surface/filter.rs", "let error = ", " * (part_error"),
            ("NORMAL_FACTOR", "rt-geom/src/surface/filter.rs", "(part_error + ", " * hit.normal_error)"),
            ("ROUNDINGS", "rt-geom/src/surface/filter.rs", "/ length + ", ";"),
            ("LARGEST_NORMAL_ERROR", "rt-geom/src/surface/filter.rs", "hit.normal_error <= length * ", ";"),
        ],
    ),
    (
        "Tile",
        &[
            ("SLACK", "rt-geom/src/bvh/tile.rs", "const SLACK: f32 = ", " * U;"),
            ("REACH", "rt-geom/src/bvh/tile.rs", "const REACH: f64 = ", ";"),
            ("END_ROUNDING", "rt-geom/src/bvh/tile.rs", "let end = end.mul_add(f32x16::splat(simd, ", " * U), end)"),
            ("OUTSIDE", "rt-geom/src/bvh/tile.rs", "(self.slack + ", " * self.farthest * outside.reduce_max())"),
            ("IN_FRONT", "rt-geom/src/bvh/tile.rs", "(tile.last + ", " * tile.slack)"),
            ("LEAST_NORMAL", "rt-geom/src/bvh/tile.rs", "const LEAST_NORMAL: f32 = ", ";"),
        ],
    ),
    (
        "Triangle",
        &[
            ("SHORTEST", "rt-geom/src/triangle/mod.rs", "const SHORTEST: f64 = ", ";"),
            ("FARTHEST", "rt-geom/src/triangle/mod.rs", "const FARTHEST: f64 = ", ";"),
            ("ERROR", "rt-geom/src/triangle/filter.rs", "const ERROR: f64 = ", ";"),
            ("PLANE_ERROR", "rt-geom/src/triangle/exact.rs", "slope.abs() > (", " * triangle.edge)"),
            ("UNDERFLOW", "rt-geom/src/triangle/exact.rs", "const UNDERFLOW: f64 = ", ";"),
            ("AREA_ERROR", "rt-geom/src/triangle/mod.rs", "area > ", " * self.edge * self.edge;"),
        ],
    ),
    (
        "TriangleExact",
        &[
            (
                "VOLUME_ERROR",
                "rt-geom/src/triangle/exact.rs",
                "let error = ",
                " * ray.reach() * size * size + UNDERFLOW;",
            ),
            ("SUM_FACTOR", "rt-geom/src/triangle/exact.rs", "certain(u + v + w, ", " * error)"),
            ("UNDERFLOW", "rt-geom/src/triangle/exact.rs", "const UNDERFLOW: f64 = ", ";"),
        ],
    ),
    ("Twice", &[]),
    (
        "Weights",
        &[
            ("WEIGHT_FACTOR", "rt-geom/src/triangle/locate.rs", "let error = ", " * (turn_error"),
            ("DIVISION_ERROR", "rt-geom/src/triangle/locate.rs", "error + ", " * size + UNDERFLOW_WEIGHT"),
            ("UNDERFLOW_WEIGHT", "rt-geom/src/triangle/locate.rs", "const UNDERFLOW_WEIGHT: f64 = ", ";"),
        ],
    ),
];

#[test]
fn constants_of_the_code_are_those_of_the_proofs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &Path| fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    for (file, constants) in FILES {
        let proofs = read(&root.join(format!("docs/proofs/{file}.v")));
        let proved: BTreeMap<_, _> = proofs.lines().filter_map(definition).collect();
        let coded = constants.iter().map(|(name, path, before, after)| {
            let code = read(&root.join("crates").join(path));
            (
                *name,
                between(&code, before, after).unwrap_or_else(|| panic!("{path} has not one {before:?} .. {after:?}")),
            )
        });
        assert_eq!(proved, coded.collect(), "docs/proofs/{file}.v on the left, the code on the right");
    }
}

/// Numbers in the midst of formulas, which a proof has as numbers, too, or `docs/numerics.md` in a lemma on paper: the
/// file under `docs`, what stands before and behind the value there, and the same of the code.
type Number = (&'static str, [&'static str; 2], &'static str, [&'static str; 2]);

const NUMBERS: &[Number] = &[
    ("proofs/Candidates.v", ["CANDIDATE := ", "."], "rt-geom/src/sphere/lanes.rs", ["((error * ", ") * rays.inverse"]),
    ("proofs/Light.v", ["(e + ", " * u * norm1 o1"], "rt-shade/src/phong.rs", ["errors.point + ", " * U * norm(seen"]),
    ("proofs/Light.v", ["(e + ", " * u * norm1 o1"], "rt-shade/src/phong_batch.rs", ["point_error[i] += ", " * U"]),
    (
        "proofs/Line.v",
        ["RN (RN (", " + RN (RN (Rabs"],
        "rt-geom/src/bvh/cull.rs",
        ["error = (", " + sum(origin.abs())"],
    ),
    (
        "proofs/Locate.v",
        ["TURN_ERROR_2 := ", "."],
        "rt-geom/src/triangle/locate.rs",
        ["let error = ", " * (edge * edge * edge) * far + UNDERFLOW;\n    certain_signs(turns.map"],
    ),
    ("proofs/Points.v", ["SPHERE_NORMAL := ", "."], "rt-geom/src/surface/finish.rs", ["length(), error: ", " * U }"]),
    ("proofs/Samples.v", ["q) + (", " * w + 3 * h"], "rt-shade/src/texture.rs", ["v_error) + (", " * width + 3.0"]),
    ("proofs/Samples.v", ["(3 * w + ", " * h + BIL"], "rt-shade/src/texture.rs", ["(3.0 * width + ", " * height + 9"]),
    (
        "proofs/SphereStep.v",
        ["LARGEST_SLACK := ", "."],
        "rt-geom/src/sphere/lanes.rs",
        ["simd_le(f64x8::splat(simd, ", "));"],
    ),
    ("proofs/SphereStep.v", ["SLACK_FACTOR := ", "."], "rt-geom/src/sphere/lanes.rs", ["slack * ", " * half_inverse"]),
    ("proofs/SurfaceFinish.v", ["r) + ", " * (eta * sqrt"], "rt-geom/src/surface/finish.rs", ["s) + ", " * n_error"]),
    ("proofs/SurfaceFinish.v", ["dn) + ", " * (eta * dn)"], "rt-geom/src/surface/finish.rs", ["(d) + ", " * n_error"]),
    ("proofs/SurfaceFinish.v", ["sz + ", " * (Rabs g"], "rt-geom/src/surface/finish.rs", ["size + ", " * g.abs()"]),
    (
        "proofs/SurfaceSide.v",
        ["(He : (1 - 16 * u) * (", " * (nu * w"],
        "rt-geom/src/surface/finish.rs",
        ["error = ", " * (normal.error"],
    ),
    ("numerics.md", ["`TERMS_ERROR = ", " u³`"], "rt-math/src/reflect.rs", ["TERMS_ERROR: f64 = ", " * U * U * U;"]),
    ("numerics.md", ["`LOW_ERROR = ", " u`"], "rt-math/src/reflect.rs", ["LOW_ERROR: f64 = ", " * U;"]),
    ("numerics.md", ["`QUOTIENT_ERROR = ", " u²`"], "rt-math/src/reflect.rs", ["QUOTIENT_ERROR: f64 = ", " * U * U;"]),
    ("numerics.md", ["q_error = ", " u² M +"], "rt-geom/src/sphere/exact.rs", ["q_error = ", " * U * U * product"]),
    ("numerics.md", [" u² M + ", " u² q"], "rt-geom/src/sphere/exact.rs", ["product + ", " * U * U * q.high()"]),
    ("numerics.md", ["γ' by ", " D E/sum error"], "rt-geom/src/triangle/finish.rs", ["error = ", " * (self.crossing"]),
    ("numerics.md", ["offset, `", "u + 2|e|"], "rt-geom/src/enclosing/certify.rs", ["total + ", " * U + 2.0 * step"]),
    ("numerics.md", ["`16u + ", "|e|/min|v|`"], "rt-geom/src/enclosing/certify.rs", ["* U + ", " * step.length"]),
    ("numerics.md", ["`L = m - ", "M|g|`"], "rt-geom/src/enclosing/certify.rs", ["mean + (", " * most * pull"]),
    ("numerics.md", ["2 M G) <= ", " G/b"], "rt-geom/src/enclosing/certify.rs", ["gap * (", " / BALANCE"]),
    ("numerics.md", ["slack times `1 + ", "u`"], "rt-geom/src/enclosing/certify.rs", ["slack * (1.0 + ", " * U)"]),
    ("numerics.md", ["of the pull, `", "u²`"], "rt-geom/src/enclosing/refine.rs", ["round() + ", " * U * U;"]),
    (
        "numerics.md",
        ["of the mean, `", "u²`"],
        "rt-geom/src/enclosing/refine.rs",
        ["(1.0 + 8.0 * U) + most * (", " * U * U)"],
    ),
    ("numerics.md", ["`|x - x*| <= ", "M` first"], "rt-geom/src/enclosing/refine.rs", [".min(", " * most)"]),
];

#[test]
fn numbers_of_the_code_are_those_of_the_lemmas() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (lemmas, [before, after], path, [code_before, code_after]) in NUMBERS {
        let value = |path: &Path, before, after| {
            let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            between(&text, before, after).unwrap_or_else(|| panic!("{path:?} has not one {before:?} .. {after:?}"))
        };
        let stated = value(&root.join("docs").join(lemmas), before, after);
        let coded = value(&root.join("crates").join(path), code_before, code_after);
        assert_eq!(stated, coded, "{lemmas} on the left, {path} on the right: {code_before:?} .. {code_after:?}");
    }
}

#[test]
fn every_file_of_proofs_is_compared() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/proofs");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<_> = files.filter(|path| path.extension().is_some_and(|extension| extension == "v")).collect();
    found.sort();
    let names = found.iter().map(|path| path.file_stem().unwrap().to_str().unwrap()).filter(|&name| name != "Rounding");
    let mut listed: Vec<_> = FILES.iter().map(|(name, _)| *name).collect();
    listed.sort_unstable();
    assert!(names.eq(listed), "{found:?}");
}

/// The value that stands in a text between two others, if one does, or several that are equal.
fn between(text: &str, before: &str, after: &str) -> Option<f64> {
    let mut values = text.match_indices(before).filter_map(|(at, _)| {
        let (value, _) = text[at + before.len()..].split_once(after)?;
        (value.len() < 40).then(|| evaluated(value)).flatten()
    });
    values.next().filter(|&value| values.all(|other| other == value))
}

/// `Definition NAME := value.` with a name in capitals.
fn definition(line: &str) -> Option<(&str, f64)> {
    let (name, value) = line.strip_prefix("Definition ")?.split_once(" := ")?;
    let is_constant = name.len() > 1 && name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
    let value = || evaluated(value.strip_suffix('.')?.trim_end_matches("%Z"));
    is_constant.then(|| (name, value().unwrap_or_else(|| panic!("not evaluated: {line}"))))
}

type Input<'a> = Peekable<Chars<'a>>;

/// The value of an expression as either language writes it.
fn evaluated(text: &str) -> Option<f64> {
    let input = &mut text.chars().peekable();
    let value = sum(input)?;
    next(input).is_none().then_some(value)
}

fn next(input: &mut Input) -> Option<char> {
    while input.next_if(|c| c.is_whitespace()).is_some() {}
    input.peek().copied()
}

fn sum(input: &mut Input) -> Option<f64> {
    let mut value = product(input)?;
    while let Some(sign @ ('+' | '-')) = next(input) {
        input.next();
        let term = product(input)?;
        value = if sign == '+' { value + term } else { value - term };
    }
    Some(value)
}

fn product(input: &mut Input) -> Option<f64> {
    let mut value = factor(input)?;
    while let Some(sign @ ('*' | '/')) = next(input) {
        input.next();
        let factor = factor(input)?;
        value = if sign == '*' { value * factor } else { value / factor };
    }
    Some(value)
}

/// An atom, and perhaps the type it is cast to.
fn factor(input: &mut Input) -> Option<f64> {
    let value = atom(input)?;
    let mut rest = input.clone();
    if next(&mut rest) == Some('a') && ["as f32", "as f64"].contains(&&*rest.by_ref().take(6).collect::<String>()) {
        *input = rest;
    }
    Some(value)
}

/// A number, a word for one, a power of two, a sum or a shifted one in parentheses, or the opposite of a factor.
fn atom(input: &mut Input) -> Option<f64> {
    match next(input)? {
        '(' => {
            input.next();
            let mut value = sum(input)?;
            next(input)?;
            if input.next_if_eq(&'<').is_some() {
                input.next_if_eq(&'<')?;
                value *= sum(input)?.exp2();
                next(input)?;
            }
            (input.next() == Some(')')).then_some(value)
        }
        '-' => {
            input.next();
            Some(-factor(input)?)
        }
        c if c.is_ascii_digit() => {
            let mut digits = String::new();
            while let Some(digit) = input.next_if(|c| c.is_ascii_digit() || "._e".contains(*c)) {
                digits.push(digit);
                if digit == 'e'
                    && let Some(sign) = input.next_if_eq(&'-')
                {
                    digits.push(sign);
                }
            }
            if input.next_if_eq(&'u').is_some() {
                // u64
                while input.next_if(char::is_ascii_digit).is_some() {}
            }
            // 2⁻⁹⁶⁸ in a docstring
            let mut exponent = String::new();
            while let Some(c) = input.next_if(|c| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(*c)) {
                exponent.push("-0123456789".chars().nth("⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c)?)?);
            }
            let value: f64 = digits.replace('_', "").parse().ok()?;
            if exponent.is_empty() { Some(value) } else { Some(value.powi(exponent.parse().ok()?)) }
        }
        _ => {
            let mut word = String::new();
            while let Some(letter) = input.next_if(|c| c.is_ascii_alphanumeric() || "_:".contains(*c)) {
                word.push(letter);
            }
            match word.as_str() {
                "u" | "U" => Some(f64::EPSILON / 2.0),
                "bp" | "power_of_two" => Some(factor(input)?.exp2()),
                "f64::MIN_POSITIVE" => Some(f64::MIN_POSITIVE),
                _ => None,
            }
        }
    }
}

#[test]
fn both_ways_of_writing_are_read() {
    let value = Some(17.0 * 2f64.powi(-53));
    assert_eq!([evaluated("17 * u"), evaluated("17.0 * U")], [value, value]);
    assert_eq!(definition("Definition A_2 := (1 - 4 * u) * bp (-3)."), Some(("A_2", 0.125 - 2f64.powi(-54))));
    assert_eq!([evaluated("power_of_two(-968)"), evaluated("2⁻⁹⁶⁸")], [Some(2f64.powi(-968)); 2]);
    assert_eq!([evaluated("1.0 / (1u64 << 46) as f64"), evaluated("bp (-46)")], [Some(2f64.powi(-46)); 2]);
    assert_eq!([evaluated("16 / 10"), evaluated("1.6"), evaluated("1e-40")], [Some(1.6), Some(1.6), Some(1e-40)]);
    assert_eq!([definition("Definition tsum := tdot a b."), evaluated("2 +").map(|x| ("", x))], [None, None]);
    assert_eq!(between("let a = 1.0; let b = 7.0 * U * a;", "let b = ", " * a"), Some(7.0 * 2f64.powi(-53)));
    assert_eq!(between("e = 1; e = 2;", "e = ", ";"), None);
}

//! Measures every contestant in one process: builds, then interleaved rounds of each ray set.
//!
//! trees [--scenes a,b] [--sizes 1e3,1e5] [--huge] [--only name,...] [--rounds n] [--check n]
//!       [--distant d] [--ratios]
//!
//! `--ratios` prints instead how many times faster ours is than `rtcIntersect1` (`embree high`), as a
//! Markdown table with geometric means; for batches also against `rtcIntersect1M` and packets.
//! `--huge` adds 1e7 spheres; `--check` sets how many rays of a set the f64 referee answers;
//! `--distant` adds camera rays from `d` units in front of the scene, where f32 runs out of digits.
//! `--only` takes beginnings of names; `=name` asks for exactly that one. Times are the process's
//! CPU time, so that other work on the machine costs cache and memory bandwidth but not minutes.

use trees::reference::{Answer, Reference};
use trees::{Contestant, Hit, Ray, Tracer, contestants, memory};

#[global_allocator]
static ALLOCATOR: memory::Counting = memory::Counting;

struct Options {
    scenes: Vec<String>,
    sizes: Vec<usize>,
    only: Vec<String>,
    rounds: usize,
    check: usize,
    distant: Option<f32>,
    ratios: bool,
}

fn options() -> Options {
    let mut o = Options {
        scenes: trees::workload::SCENES.map(String::from).to_vec(),
        sizes: vec![1_000, 100_000, 1_000_000],
        only: Vec::new(),
        rounds: 2,
        check: 20_000,
        distant: None,
        ratios: false,
    };
    let mut args = std::env::args().skip(1);
    while let Some(flag) = args.next() {
        if flag == "--huge" {
            o.sizes.push(10_000_000);
            continue;
        }
        if flag == "--ratios" {
            o.ratios = true;
            continue;
        }
        let value = args.next().unwrap_or_else(|| panic!("{flag} wants a value"));
        let list = || value.split(',').map(String::from).collect::<Vec<_>>();
        let number = |v: &str| v.parse::<f64>().expect("a number") as usize;
        match flag.as_str() {
            "--scenes" => o.scenes = list(),
            "--sizes" => o.sizes = list().iter().map(|v| number(v)).collect(),
            "--only" => o.only = list(),
            "--rounds" => o.rounds = number(&value),
            "--distant" => o.distant = Some(number(&value) as f32),
            "--check" => o.check = number(&value),
            other => panic!("no option {other}"),
        }
    }
    o
}

struct Built<'a> {
    contestant: &'a Contestant,
    tracer: Box<dyn Tracer>,
    seconds: f64,
    resident: usize,
    peak: usize,
}

fn build<'a>(contestant: &'a Contestant, spheres: &[trees::workload::Sphere]) -> Built<'a> {
    let once = || {
        let before = memory::live();
        memory::reset_peak();
        let start = trees::cpu_seconds();
        let tracer = (contestant.build)(spheres);
        let seconds = trees::cpu_seconds() - start;
        let (resident, peak) = (memory::live() - before, memory::peak() - before);
        Built { contestant, tracer, seconds, resident, peak }
    };
    // Small builds are repeated: the best of several is what is reported.
    let mut best = once();
    let mut spent = best.seconds;
    for _ in 0..8 {
        if spent > 0.25 {
            break;
        }
        let next = once();
        spent += next.seconds;
        if next.seconds < best.seconds {
            best = next;
        }
    }
    best
}

struct RaySet {
    name: &'static str,
    rays: Vec<Ray>,
    /// Any-hit instead of closest-hit.
    any: bool,
}

/// What one contestant did on one ray set; no `seconds` where it did not take part.
#[derive(Default)]
struct Row {
    seconds: Vec<f64>,
    rays: usize,
    hits: usize,
    sum: f64,
    faults: Faults,
}

#[derive(Default)]
struct Faults {
    checked: usize,
    verdict: usize,
    id: usize,
    /// Both hit, but the distances differ by more than 1e-3 of the distance.
    gross: usize,
    error: Vec<f64>,
    /// Largest absolute error of `t`.
    absolute: f64,
}

/// `hits` holds the answers to every `thin`-th ray; rays in between are not compared.
fn compare(hits: &[Hit], thin: usize, answers: &[(usize, Answer)]) -> Faults {
    let mut f = Faults::default();
    for &(i, answer) in answers.iter().filter(|(i, _)| i % thin == 0) {
        f.checked += 1;
        let hit = hits[i / thin];
        match answer {
            Some((t, id)) if hit.is_hit() => {
                f.id += usize::from(id != hit.id);
                let absolute = (f64::from(hit.t) - t).abs();
                f.absolute = f.absolute.max(absolute);
                let error = absolute / t;
                f.gross += usize::from(error > 1e-3);
                f.error.push(error);
            }
            answer => f.verdict += usize::from(answer.is_some() != hit.is_hit()),
        }
    }
    f.error.sort_by(f64::total_cmp);
    f
}

fn run(set: &RaySet, field: &[Built], answers: &[(usize, Answer)], rounds: usize) -> Vec<Row> {
    let mut hits = vec![Hit::MISS; set.rays.len()];
    let thinned: Vec<Ray> = set.rays.iter().step_by(contestants::THIN).copied().collect();
    let mut rows: Vec<Option<Row>> = field.iter().map(|_| None).collect();
    for round in 0..rounds {
        for (b, row) in field.iter().zip(&mut rows) {
            // A contestant that turns out slow gets one round.
            let slow = row.as_ref().is_some_and(|r| r.seconds[0] > 2.5);
            if slow || (b.contestant.camera_only && !matches!(set.name, "camera" | "distant")) {
                continue;
            }
            let (rays, thin) = if b.contestant.slow { (&thinned, contestants::THIN) } else { (&set.rays, 1) };
            let hits = &mut hits[..rays.len()];
            let start = trees::cpu_seconds();
            let count = if set.any {
                let Some(n) = b.tracer.occluded(rays) else { continue };
                n
            } else {
                b.tracer.closest(rays, hits);
                0
            };
            let seconds = trees::cpu_seconds() - start;
            if round == 0 {
                let mut first = Row { rays: rays.len(), hits: count, ..Row::default() };
                if !set.any {
                    let met = hits.iter().filter(|h| h.is_hit());
                    first.hits = met.clone().count();
                    first.sum = met.map(|h| f64::from(h.t)).sum();
                    first.faults = compare(hits, thin, answers);
                }
                first.seconds.push(seconds);
                *row = Some(first);
            } else if let Some(row) = row {
                row.seconds.push(seconds);
            }
        }
    }
    rows.into_iter().map(Option::unwrap_or_default).collect()
}

/// Towards the face of the cube that the camera sees, from `d` units before it; `t` is about 1.
fn distant(d: f32) -> Vec<Ray> {
    let far = |r: Ray| {
        let [u, v, _] = r.direction;
        Ray { origin: [0.0, 0.0, d - 2.0], direction: [2.0 * u, 2.0 * v, -d] }
    };
    trees::workload::camera_rays(1024).into_iter().map(far).collect()
}

fn main() {
    let o = options();
    let all = contestants::all();
    let wanted = |c: &&Contestant| {
        o.only.is_empty()
            || o.only.iter().any(|w| match w.strip_prefix('=') {
                Some(exact) => c.name == exact,
                None => c.name.starts_with(w.as_str()),
            })
    };
    let field: Vec<&Contestant> = all.iter().filter(wanted).collect();
    println!("# {}; Rust code compiled with {}", contestants::describe_embree(), features());
    let mut sets = vec![
        RaySet { name: "camera", rays: trees::workload::camera_rays(1024), any: false },
        RaySet { name: "random", rays: trees::workload::random_rays(1_000_000), any: false },
        RaySet { name: "occlusion", rays: trees::workload::random_rays(1_000_000), any: true },
    ];
    sets.extend(o.distant.map(|d| RaySet { name: "distant", rays: distant(d), any: false }));
    if !o.ratios {
        println!(
            "scene\tspheres\tset\tcontestant\tMrays/s\tMsph/s\tB/sphere\tpeak_B/sphere\tspread\trays\thits\tsum_t\tchecked\twrong_verdict\twrong_id\tgross_t\tt_median\tt_p99.9\tt_max\tt_abs_max"
        );
    }
    let mut ratios = Ratios::default();
    for scene in &o.scenes {
        for &n in &o.sizes {
            let spheres = trees::workload::spheres(scene, n);
            let built: Vec<Built> = field.iter().map(|c| build(c, &spheres)).collect();
            let reference = Reference::new(&spheres);
            let met = |ray: &Ray| reference.closest(ray).map(|(t, _)| (*ray, t));
            let hits: Vec<_> = trees::workload::camera_rays(512).iter().filter_map(met).collect();
            sets.retain(|set| set.name != "bounce");
            sets.push(RaySet { name: "bounce", rays: trees::workload::bounce_rays(&hits), any: false });
            for set in sets.iter().filter(|set| !set.rays.is_empty()) {
                let step = (set.rays.len() / o.check.max(1)).max(1);
                let picked = (0..set.rays.len()).skip(step / 2).step_by(step);
                let answers: Vec<(usize, Answer)> =
                    if set.any { Vec::new() } else { picked.map(|i| (i, reference.closest(&set.rays[i]))).collect() };
                let rows = run(set, &built, &answers, o.rounds);
                if o.ratios {
                    ratios.add(scene, n, set, &built, &rows);
                    continue;
                }
                for (b, row) in built.iter().zip(rows) {
                    if row.seconds.is_empty() {
                        continue;
                    }
                    let best = row.seconds.iter().copied().fold(f64::INFINITY, f64::min);
                    let worst = row.seconds.iter().copied().fold(0.0, f64::max);
                    let per = |bytes: usize| bytes as f64 / spheres.len() as f64;
                    let e = &row.faults.error;
                    let at = |q: f64| e.get((q * (e.len().max(1) - 1) as f64) as usize).copied().unwrap_or(0.0);
                    println!(
                        "{scene}\t{n}\t{}\t{}\t{:.3}\t{:.3}\t{:.1}\t{:.1}\t{:.2}\t{}\t{}\t{:.6e}\t{}\t{}\t{}\t{}\t{:.1e}\t{:.1e}\t{:.1e}\t{:.1e}",
                        set.name,
                        b.contestant.name,
                        row.rays as f64 / best / 1e6,
                        spheres.len() as f64 / b.seconds / 1e6,
                        per(b.resident),
                        per(b.peak),
                        worst / best,
                        row.rays,
                        row.hits,
                        row.sum,
                        row.faults.checked,
                        row.faults.verdict,
                        row.faults.id,
                        row.faults.gross,
                        at(0.5),
                        at(0.999),
                        at(1.0),
                        row.faults.absolute,
                    );
                }
            }
        }
    }
    if o.ratios {
        ratios.print();
    }
}

/// Columns of `--ratios`: title, ours, and the peers of which the best counts.
const RATIOS: [(&str, &str, &[&str]); 5] = [
    ("single", "ours single", &SINGLE),
    ("batch", "ours batch", &SINGLE),
    ("batch / best in any mode", "ours batch", &ANY_MODE),
    ("single, AVX2", "ours single avx2", &SINGLE),
    ("batch, AVX2", "ours batch avx2", &SINGLE),
];
const SINGLE: [&str; 3] = ["embree high", "embree4", "obvhs cwbvh medium"];
const ANY_MODE: [&str; 7] = [
    "embree high",
    "embree4",
    "obvhs cwbvh medium",
    "embree stream 1024",
    "embree packet16 4x4",
    "embree4 packet8 4x2",
    "embree4 packet16 4x4",
];

/// The table of `--ratios`.
#[derive(Default)]
struct Ratios {
    lines: Vec<String>,
    /// Of each column the ratios of closest hits and of any hits.
    columns: [[Vec<f64>; 2]; RATIOS.len()],
    wrong: usize,
    checked: usize,
}

impl Ratios {
    fn add(&mut self, scene: &str, n: usize, set: &RaySet, built: &[Built], rows: &[Row]) {
        let rate = |name: &str| {
            let at = built.iter().position(|b| b.contestant.name == name)?;
            let best = rows[at].seconds.iter().copied().reduce(f64::min)?;
            Some(rows[at].rays as f64 / best / 1e6)
        };
        let faults = |names: &str| {
            let ours = built.iter().zip(rows).filter(|(b, _)| b.contestant.name.starts_with(names));
            let faults = ours.map(|(_, row)| (row.faults.checked, row.faults.verdict + row.faults.id));
            faults.fold((0, 0), |sum, fault| (sum.0 + fault.0, sum.1 + fault.1))
        };
        let (checked, wrong) = faults("ours");
        self.checked += checked;
        self.wrong += wrong;
        let embree = rate("embree high").unwrap_or(f64::NAN);
        let mut line = format!("| {scene} | {n} | {} | {embree:.2} |", set.name);
        for ((_, ours, peers), column) in RATIOS.iter().zip(&mut self.columns) {
            match (rate(ours), peers.iter().filter_map(|peer| rate(peer)).reduce(f64::max)) {
                (Some(ours), Some(peer)) => {
                    column[usize::from(set.any)].push(ours / peer);
                    line += &format!(" {:.2} |", ours / peer);
                }
                _ => line += " |",
            }
        }
        self.lines.push(line);
    }

    fn print(&self) {
        print!("| scene | spheres | rays | Embree, Mrays/s |");
        RATIOS.iter().for_each(|(title, ..)| print!(" {title} |"));
        println!("\n| --- | ---: | --- | ---: |{}", " ---: |".repeat(RATIOS.len()));
        self.lines.iter().for_each(|line| println!("{line}"));
        for (any, title) in ["closest hit", "any hit"].into_iter().enumerate() {
            let mean = |v: &Vec<f64>| (v.iter().map(|r| r.ln()).sum::<f64>() / v.len() as f64).exp();
            let least = |v: &Vec<f64>| v.iter().copied().fold(f64::INFINITY, f64::min);
            let cells = self.columns.iter().map(|column| match &column[any] {
                v if v.is_empty() => String::from(" |"),
                v => format!(" {:.2} (least {:.2}) |", mean(v), least(v)),
            });
            println!("| **geometric mean** | | {title} | |{}", cells.collect::<String>());
        }
        println!("\n{} of {} answers of ours differ from the plain loop's in f64.", self.wrong, self.checked);
    }
}

fn features() -> &'static str {
    if cfg!(target_feature = "avx512f") {
        "AVX-512"
    } else if cfg!(target_feature = "avx2") {
        "AVX2"
    } else {
        "the x86-64 baseline"
    }
}

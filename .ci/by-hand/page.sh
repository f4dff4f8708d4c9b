#!/usr/bin/env bash
# The page docs/report/try.html in headless Chromium: its exact answers must be the oracle's on 10^5 cases, and its
# pictures those of whole numbers alone; redraws are timed, and screenshots taken, to be looked at. The gate does not
# run this; it runs `cargo test --test corpus`, which holds the crates to the same oracle.
#
# Usage: .ci/by-hand/page.sh [FOLDER FOR SCREENSHOTS]; the result goes to docs/report/try-result.txt
set -euo pipefail
cd "$(dirname "$0")/../.."

command -v chromium >/dev/null || { echo "needs chromium: apt-get install chromium" >&2; exit 1; }
shots=${1:-target/page}
mkdir -p "$shots"
shots=$(cd "$shots" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

browser() {
    rm -rf "$work/profile"
    mkdir "$work/profile"
    chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking \
        --disable-component-update --disable-sync --hide-scrollbars --user-data-dir="$work/profile" "$@" 2>>"$work/log"
}

cargo run --release --quiet -p report -- --corpus 3200 --out "$work/cases"
{
    sed '$d' docs/report/try.html
    echo '<script type="text/plain" id="cases">'
    cat "$work"/cases/{quadratic,ray_sphere,ray_triangle}.txt
    echo '</script><pre id="result"></pre><script>'
    cat <<'SCRIPT'
"use strict";
const lines = [], said = line => lines.push(line);
const kernels = { quadratic: [3, exactQuadratic], ray_sphere: [10, exactSphere], ray_triangle: [15, exactTriangle] };
const counts = {};
for (const line of $("cases").textContent.split("\n")) {
  if (line === "" || line[0] === "#") continue;
  const [name, ...words] = line.split(" "), [inputs, answer] = kernels[name];
  const count = counts[name] ??= { cases: 0, differ: 0 };
  const found = answer(words.slice(0, inputs).map(word => fromBits(BigInt("0x" + word))));
  count.cases++;
  const same = [found.verdict, ...found.values.map(hex)].join(" ") === words.slice(inputs).join(" ");
  if (!same && count.differ++ < 3) said(`differs: ${line}`);
}
$("cases").remove();
let cases = 0, differ = 0;
for (const [name, count] of Object.entries(counts)) {
  said(`${name}: ${count.differ} of ${count.cases} answers differ from the oracle's`);
  cases += count.cases; differ += count.differ;
}
said(`all kernels: ${differ} of ${cases}`);
// Settings from one end of the sliders to the other, the first as the page opens.
const settings = (scene, count) => Array.from({ length: count }, (_, n) => {
  const share = k => (n * 0.6180339887 + k * 0.3819 + n * k * 0.7548776662) % 1;
  const value = (s, k) => n === 0 ? s.start : s.low + (s.high - s.low) * share(k);
  return Object.fromEntries(scene.sliders.map((s, k) => [s.key, value(s, k)]));
});
let pixels = 0, others = 0;
const scenes = Object.values(SCENES).flatMap(scene => settings(scene, 12).map(values => scene.make(values)));
// In whole numbers rays are tangent and meet edges and vertices; an eye on a sphere; what lies behind or coincides.
const ball = (center, radius) => ({ center, radius }), triangle = (...vertices) => ({ vertices });
const ray = (x, y) => [Math.round(8 * x), Math.round(8 * y), -8], eye = [0, 0, 0];
scenes.push(
  { eye, ray, objects: [ball([0, 0, -5], 3), triangle([-4, -4, -4], [4, -4, -4], [-4, 4, -4]), ball([0, 0, -5], 3)] },
  { eye, ray, objects: [8, -8].map(y => triangle([-8, 0, -8], [8, 0, -8], [0, y, -8])) },
  { eye, ray, objects: [triangle([-9, -9, 5], [9, -9, 5], [0, 9, 5]), ball([0, 0, 9], 3), ball([0, -1, 0], 1)] },
  { eye, ray, objects: [triangle([0, 0, 0], [3, 0, -3], [0, 3, -3]), ball([0, 0, -4], 0), ball(eye, 2)] },
);
for (const made of scenes) {
  const { exact } = draw(made, SPHERE_METHODS.textbook, TRIANGLE_METHODS["Möller–Trumbore"]);
  for (let k = 0; k < WIDTH * HEIGHT; k += 7) {
    const d = made.ray(...centered(k % WIDTH, Math.floor(k / WIDTH)));
    let best = 0, least = Infinity;
    made.objects.forEach((object, index) => {
      const { t } = exactly(object, made.eye, d);
      if (t !== null && (best === 0 || t < least)) { best = index + 1; least = t; }
    });
    pixels++; others += best !== exact.id[k];
  }
}
// Certain signs of sums that cancel to their last bits.
let signs = 0, wrongSigns = 0, undecided = 0, seed = 1;
const random = () => { seed = (seed * 16807) % 2147483647; return seed / 1073741823.5 - 1 + seed * 2 ** -60; };
for (let n = 0; n < 20000; n++) {
  const d = [random(), random(), random()], v = [random(), 0.1 * random(), 0.1 * random()];
  const [[x, y, z, p, q], e] = whole([...d, v[0], v[1]]);
  // n_2 = -(d_0 n_0 + d_1 n_1) / d_2 as a pair
  const third = roundQuotient(-(x * p + y * q), z, e), [l, i] = parts(third), at = Math.min(i, 2 * e);
  const rest = -((x * p + y * q) << BigInt(2 * e - at + 200)) - (z * l << BigInt(i + e - at + 200));
  const low2 = roundQuotient(rest, z, at - 200 - e) + (n % 2 ? third * 2 ** (-85 - n % 30) : 0);
  const normal = Float64Array.from([v[0], v[1], third, 0, 0, low2]);
  const [[a, b, c, r0, r1, r2, r3], f] = whole([...d, v[0], v[1], third, low2]);
  const value = certainDot(d, normal), exact = sign(a * r0 + b * r1 + c * (r2 + r3));
  signs++;
  if (Math.abs(value) > SLACK * size) wrongSigns += Math.sign(value) !== exact; else undecided++;
}
said(`signs: ${wrongSigns} of ${signs} differ, ${undecided} are left to whole numbers`);
said(`pictures: ${others} of ${pixels} pixels differ from those of whole numbers alone`);
for (const name of Object.keys(SCENES)) {
  chooseScene(name);
  // The least of three: another process may have had the processor.
  const times = settings(SCENES[name], 100).map(values => {
    state.values = values;
    return Math.min(redraw().time, redraw().time, redraw().time);
  });
  const late = times.filter(time => time > 150).length;
  times.sort((a, b) => a - b);
  const [middle, p95, most] = [50, 95, 99].map(i => times[i].toFixed(0));
  said(`${name}: a redraw takes ${middle} ms in the middle, ${p95} at the 95th percentile, ${most} at most; ` +
    `${late} of 100 above 150 ms`);
}
said(differ + others + wrongSigns === 0 && cases >= 1e5 ? "passed" : "FAILED");
$("result").textContent = lines.join("\n");
SCRIPT
    echo '</script></html>'
} >"$work/check.html"

browser --dump-dom "file://$work/check.html" | sed -n '/<pre id="result">/,/<\/pre>/{s/<[^>]*>//g;p}' >"$work/result"
processor=$(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -n 1)
{
    echo "docs/report/try.html by .ci/by-hand/page.sh, $(date +%F)"
    echo "$(chromium --version 2>/dev/null | cut -d' ' -f1,2) on ${processor:-an unknown processor}, 200 x 150 pixels"
    cat "$work/result"
} | tee docs/report/try-result.txt

shot() { browser --window-size="$2" --screenshot="$shots/$1.png" "${@:4}" "file://$PWD/docs/report/$3"; }
for scene in ball edge ground; do
    shot "$scene-light" 1200,1500 "try.html#$scene"
    shot "$scene-dark" 1200,1500 "try.html#$scene" --blink-settings=preferredColorScheme=0
    shot "$scene-narrow" 400,2600 "try.html#$scene"
done
echo "screenshots: $shots"
grep -qx passed "$work/result" || { cat "$work/log" >&2; exit 1; }

#!/usr/bin/env bash
# The page docs/report/try.html in headless Chromium: its exact answers must be the oracle's on 10^5 cases, and its pictures those of whole
# numbers alone; redraws are timed, and screenshots taken, to be looked at. The gate runs `cargo test --test corpus`, which holds the crates
# to the same oracle, and not this.
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
  const [name, ...words] = line.split(" "), [inputs, answer] = kernels[name], count = counts[name] ??= { cases: 0, differ: 0 };
  const found = answer(words.slice(0, inputs).map(word => fromBits(BigInt("0x" + word))));
  count.cases++;
  if ([found.verdict, ...found.values.map(hex)].join(" ") !== words.slice(inputs).join(" ") && count.differ++ < 3) said(`differs: ${line}`);
}
$("cases").remove();
let cases = 0, differ = 0;
for (const [name, count] of Object.entries(counts)) {
  said(`${name}: ${count.differ} of ${count.cases} answers differ from the oracle's`);
  cases += count.cases; differ += count.differ;
}
said(`all kernels: ${differ} of ${cases}`);
// Settings from one end of the sliders to the other, the first as the page opens.
const settings = (scene, count) => Array.from({ length: count }, (_, n) => Object.fromEntries(scene.sliders.map((s, k) =>
  [s.key, n === 0 ? s.start : s.low + (s.high - s.low) * ((n * 0.6180339887 + k * 0.3819 + n * k * 0.7548776662) % 1)])));
let pixels = 0, others = 0;
for (const scene of Object.values(SCENES)) for (const values of settings(scene, 12)) {
  const made = scene.make(values), { exact } = draw(made, SPHERE_METHODS.textbook, TRIANGLE_METHODS["Möller–Trumbore"]);
  for (let k = 0; k < WIDTH * HEIGHT; k += 7) {
    const d = made.ray(...centered(k % WIDTH, Math.floor(k / WIDTH)));
    let best = 0, least = Infinity;
    made.objects.forEach((object, index) => { const { t } = exactly(object, made.eye, d); if (t !== null && (best === 0 || t < least)) { best = index + 1; least = t; } });
    pixels++; others += best !== exact.id[k];
  }
}
said(`pictures: ${others} of ${pixels} pixels differ from those of whole numbers alone`);
for (const name of Object.keys(SCENES)) {
  chooseScene(name);
  const times = settings(SCENES[name], 100).map(values => { state.values = values; return redraw().time; });
  const late = times.filter(time => time > 150).length;
  times.sort((a, b) => a - b);
  said(`${name}: a redraw takes ${times[50].toFixed(0)} ms in the middle, ${times[95].toFixed(0)} ms at the 95th percentile, ${times[99].toFixed(0)} ms at most; ${late} of 100 above 150 ms`);
}
said(differ + others === 0 && cases >= 1e5 ? "passed" : "FAILED");
$("result").textContent = lines.join("\n");
SCRIPT
    echo '</script></html>'
} >"$work/check.html"

browser --dump-dom "file://$work/check.html" | sed -n '/<pre id="result">/,/<\/pre>/p' | sed 's/<[^>]*>//g' >"$work/result"
processor=$(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -n 1)
{
    echo "docs/report/try.html by .ci/by-hand/page.sh, $(date +%F), $(chromium --version 2>/dev/null | cut -d' ' -f1,2), ${processor:-unknown processor}"
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

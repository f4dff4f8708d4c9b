#!/usr/bin/env python3
"""Times whole programs on the same scene: ours, Tachyon and POV-Ray, one thread each, 1024 x 1024 pixels.

    compare.py make FOLDER SET COUNT     writes the scene in each program's own format
    compare.py run FOLDER SET COUNT      runs each three times and adds the best to FOLDER/results.jsonl
    compare.py table FOLDER              prints the results as Markdown

SET is uniform, flake, packed or mixed. README.md beside this file has the conditions.
"""

import json
import math
import os
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../..")
FIGURES = os.environ.get("FIGURES", os.path.join(ROOT, "target/release/figures"))
SETS = ["uniform", "flake", "packed", "mixed"]
SIDE = 1024

OURS = """[camera]
fov = 53.13010235415598
[[light]]
position = [5, 5, 5]
[material.ball]
color = [0.8, 0.6, 0.4]
ambient = 0.1
diffuse = 0.7
specular = 0.3
shininess = 30
[[spheres]]
file = "{name}.xyz"
material = "ball"
"""

# Both look along +z in a left-handed system: our scene with z turned round.
TACHYON = f"""BEGIN_SCENE
 RESOLUTION {SIDE} {SIDE}
CAMERA
 ZOOM 1.0
 ASPECTRATIO 1.0
 ANTIALIASING 0
 RAYDEPTH 1
 CENTER 0 0 0
 VIEWDIR 0 0 1
 UPDIR 0 1 0
END_CAMERA
LIGHT CENTER 5 5 -5 RAD 0.1 COLOR 1 1 1
BACKGROUND 0 0 0
TEXDEF ball AMBIENT 0.1 DIFFUSE 0.7 SPECULAR 0.0 OPACITY 1.0
 PHONG PLASTIC 0.3 PHONG_SIZE 30 COLOR 0.8 0.6 0.4 TEXFUNC 0
"""

POVRAY = """#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 1 }
camera { location <0,0,0> direction <0,0,1> up <0,1,0> right <1,0,0> }
light_source { <5,5,-5> rgb 1 shadowless }
#declare Ball = texture {
  pigment { rgb <0.8,0.6,0.4> } finish { ambient 0.1 diffuse 0.7 phong 0.3 phong_size 30 }
}
"""


def spheres(which, count):
    """Yields the spheres as x, y, z, radius, in a cube of side 2 around (0, 0, -3)."""
    if which == "flake":
        # Generations come one after the other, so that the first spheres of a deeper flake are a flake too.
        depth = next(d for d in range(8) if (9 ** (d + 1) - 1) // 8 >= count)
        rule = ["sphereflake", "--depth", str(depth)]
    else:
        rule = ["spheres", which, "--count", str(count)]
    with subprocess.Popen([FIGURES, "gen", *rule], stdout=subprocess.PIPE, text=True) as source:
        for number, line in enumerate(source.stdout):
            if number - 2 >= count:
                source.kill()
                return
            if number >= 2:
                x, y, z, radius = line.split()[:4]
                if which == "flake":
                    x, y, z, radius = (f"{float(v) / 2:.7f}" for v in (x, y, z, radius))
                    z = f"{float(z) - 3:.7f}"
                yield x, y, z, radius


def make(which, count):
    name = f"{which}-{count}"
    with open(f"{name}.toml", "w") as scene:
        scene.write(OURS.format(name=name))
    with open(f"{name}.xyz", "w") as ours, open(f"{name}.dat", "w") as dat, open(f"{name}.pov", "w") as pov:
        ours.write(f"{count}\nProperties=pos:R:3:radius:R:1\n")
        dat.write(TACHYON)
        pov.write(POVRAY)
        for x, y, z, radius in spheres(which, count):
            away = z[1:] if z.startswith("-") else f"-{z}"
            ours.write(f"{x} {y} {z} {radius}\n")
            dat.write(f"SPHERE CENTER {x} {y} {away} RAD {radius} ball\n")
            pov.write(f"sphere {{ <{x},{y},{away}>, {radius} texture {{ Ball }} }}\n")
        dat.write("END_SCENE\n")


def programs(name):
    side = f"{SIDE}x{SIDE}"
    return {
        "ours": [FIGURES, "render", f"{name}.toml", "--size", side, "--threads", "1", "--quiet", "-o", f"{name}.ppm"],
        "tachyon": ["tachyon", f"{name}.dat", "-numthreads", "1", "-mediumshade", "-shade_phong", "-format", "PPM"]
        + ["-o", f"{name}-tachyon.ppm"],
        "povray": ["povray", f"+I{name}.pov", f"+O{name}-povray.ppm", "+FP", f"+W{SIDE}", f"+H{SIDE}", "-D", "-A"]
        + ["+WT1"],
    }


def measure(command):
    """Runs a program; returns user and system seconds, and its largest memory in MB."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    if status != 0:
        sys.exit(f"{' '.join(command)} failed: {status}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e6


def run(which, count, wanted, rounds):
    best = {}
    for _ in range(rounds):
        # In turns, so that all meet the same disturbances.
        for program, command in programs(f"{which}-{count}").items():
            if program in wanted:
                seconds, memory = measure(command)
                least = best.get(program, (math.inf, 0))[0]
                best[program] = (min(least, seconds), memory)
    with open("results.jsonl", "a") as results:
        for program, (seconds, memory) in best.items():
            entry = {"set": which, "count": count, "program": program, "seconds": seconds, "memory": memory}
            print(json.dumps(entry))
            results.write(json.dumps(entry) + "\n")


def table():
    found = {}
    for line in open("results.jsonl"):
        entry = json.loads(line)
        found[entry["set"], entry["count"], entry["program"]] = entry["seconds"], entry["memory"]
    print("| spheres | ours | Tachyon | POV-Ray | faster peer / ours | memory: ours | Tachyon | POV-Ray |")
    print("| --- | --: | --: | --: | --: | --: | --: | --: |")
    ratios = []
    for count in sorted({count for _, count, _ in found}):
        for which in SETS:
            try:
                times, sizes = zip(*(found[which, count, program] for program in ["ours", "tachyon", "povray"]))
            except KeyError:
                continue
            ratios.append(min(times[1:]) / times[0])
            seconds = " | ".join(f"{value:.2f} s" for value in times)
            memory = " | ".join(f"{value:.0f} MB" for value in sizes)
            print(f"| {which}, {count:,} | {seconds} | {ratios[-1]:.2f} | {memory} |")
    print(f"\nGeometric mean {math.prod(ratios) ** (1 / len(ratios)):.2f}, least {min(ratios):.2f}.")


def main():
    match sys.argv[1:]:
        case ["make", folder, which, count] if which in SETS:
            os.makedirs(folder, exist_ok=True)
            os.chdir(folder)
            make(which, int(count))
        case ["run", folder, which, count, *wanted] if which in SETS:
            os.chdir(folder)
            rounds = int(os.environ.get("ROUNDS", "3"))
            run(which, int(count), wanted or ["ours", "tachyon", "povray"], rounds)
        case ["table", folder]:
            os.chdir(folder)
            table()
        case _:
            sys.exit(__doc__)


main()

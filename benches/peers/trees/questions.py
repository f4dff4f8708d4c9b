"""Asks trimesh (with Embree, through embreex) what the program `questions` asked, on the files that it wrote.

pip install trimesh embreex; taskset -c 1 python3 questions.py FOLDER
"""

import pathlib
import sys
import time

import numpy
import trimesh
from trimesh.ray.ray_pyembree import RayMeshIntersector


def least(ask):
    """The answer and the least of three CPU times."""
    seconds = []
    for _ in range(3):
        start = time.process_time()
        answer = ask()
        seconds.append(time.process_time() - start)
    return answer, min(seconds)


def near(folder):
    """Points 2^-24 from faces."""
    def read(name, kind, width):
        return numpy.fromfile(folder / f"near.{name}", dtype=kind).reshape(-1, width)

    mesh = trimesh.Trimesh(read("corners", "<f4", 3), read("triangles", "<u4", 3), process=False)
    inside = RayMeshIntersector(mesh).contains_points(read("points", "<f8", 3))
    exact = read("inside", "u1", 1)[:, 0]
    print(f"{len(exact)} points 2^-24 from faces: trimesh {trimesh.__version__} differs at {(inside != exact).sum()}")


def main(folder):
    near(folder)
    print("mesh\ttriangles\tquestion\tcontestant\tM/s\tours/theirs\tbatch/theirs\tsum\tdiffering")
    for file in sorted(folder.glob("[0-9]*.corners"), key=lambda file: int(file.stem)):
        def read(name, kind, width):
            return numpy.fromfile(file.with_suffix("." + name), dtype=kind).reshape(-1, width)

        mesh = trimesh.Trimesh(read("corners", "<f4", 3), read("triangles", "<u4", 3), process=False)
        caster = RayMeshIntersector(mesh)
        rays, points = read("rays", "<f4", 6), read("points", "<f4", 3)
        ours = [float(x) for x in file.with_suffix(".seconds").read_text().split()]
        caster.intersects_any(rays[:1, :3], rays[:1, 3:])  # Builds.

        (_, ray, _), hits = least(lambda: caster.intersects_location(rays[:, :3], rays[:, 3:], multiple_hits=True))
        counted = numpy.bincount(ray, minlength=len(rays))
        inside, contains = least(lambda: caster.contains_points(points))
        for question, answers, seconds, ours_seconds in [
            ("all hits", counted, hits, ours[:2]),
            ("contains", inside, contains, ours[2:]),
        ]:
            exact = read("hits" if question == "all hits" else "inside", "<u4", 1)[:, 0]
            rate, differing = len(answers) / seconds / 1e6, int((answers != exact).sum())
            name = f"trimesh {trimesh.__version__}"
            ratios = "\t".join(f"{seconds / ours:.2f}" for ours in ours_seconds)
            print(f"globe\t{file.stem}\t{question}\t{name}\t{rate:.3f}\t{ratios}\t{answers.sum()}\t{differing}")


main(pathlib.Path(sys.argv[1]))

"""What peers make of tests/corpus: wrong verdicts, as a Markdown table.

    pip install trimesh embreex numpy
    python3 corpus.py

Peers take doubles where they can; Embree rounds its input to floats, which alone changes some answers.
"""

import contextlib
import importlib.metadata
import io
import pathlib
import struct
import sys
import warnings

import numpy
import trimesh
from trimesh.ray import ray_triangle

CORPUS = pathlib.Path(__file__).parents[2] / "tests" / "corpus"


def double(bits):
    return struct.unpack(">d", bytes.fromhex(bits))[0]


def rows(kernel, count):
    """The inputs, as lists of numbers, and the verdicts."""
    for line in (CORPUS / f"{kernel}.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            words = line.split()
            yield [double(word) for word in words[1 : 1 + count]], words[1 + count]


def roots(numbers):
    """How many real roots numpy.roots finds."""
    found = numpy.roots(numbers)
    return {0: "none", 1: "one"}.get(len({x.real for x in found if x.imag == 0}), "two")


def quadratics():
    for numbers, verdict in rows("quadratic", 3):
        # Where every number is a root, there is no polynomial.
        if verdict != "all":
            yield "numpy.roots", verdict, lambda n=numbers: roots(n)


def triangles():
    for numbers, verdict in rows("ray_triangle", 15):
        origin, direction, corners = numpy.split(numpy.array(numbers), [3, 6])
        exact = "hit" if verdict.startswith(("interior", "edge", "vertex")) else "miss"
        mesh = trimesh.Trimesh(corners.reshape(3, 3), [[0, 1, 2]], process=False)
        for name, caster in casters(mesh):
            yield name, exact, lambda c=caster, o=origin, d=direction: "hit" if c().intersects_any([o], [d])[0] else "miss"


def casters(mesh):
    yield "trimesh, its own", lambda: ray_triangle.RayMeshIntersector(mesh)
    try:
        from trimesh.ray import ray_pyembree
    except ImportError:
        return
    yield "Embree 4, by trimesh", lambda: ray_pyembree.RayMeshIntersector(mesh)


def main():
    versions = [f"{name} {importlib.metadata.version(name)}" for name in ("trimesh", "embreex", "numpy")]
    print(f"{', '.join(versions)}, Python {sys.version.split()[0]}\n")
    print("| kernel | peer | wrong verdicts | errors raised |")
    print("| --- | --- | ---: | ---: |")
    for kernel, cases in (("quadratic", quadratics()), ("ray_triangle", triangles())):
        score = {}
        for name, exact, answer in cases:
            count, wrong, raised = score.get(name, (0, 0, 0))
            try:
                with warnings.catch_warnings(), numpy.errstate(all="ignore"), contextlib.redirect_stderr(io.StringIO()):
                    warnings.simplefilter("ignore")
                    wrong += answer() != exact
            except Exception:  # whatever a peer raises on finite input counts as its answer
                raised += 1
            score[name] = count + 1, wrong, raised
        for name, (count, wrong, raised) in score.items():
            print(f"| {kernel} | {name} | {wrong} of {count} | {raised} |")


main()

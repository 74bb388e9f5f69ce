#!/usr/bin/env python3
"""Solves, measures and draws the figures 4 to 11 of the ShapeOp paper."""

import argparse
import json
import sys
from pathlib import Path

from tqdm import tqdm

import meshes
import solve
from claims import number
from figures import ALL

EPILOG = """\
examples:
  python run.py out                  all figures: out/fig04.png ... out/fig11.png, out/measures.json
  python run.py out --figure 8       one figure (repeat the option for more)
  python run.py out --quick          measures only, no pictures
  python run.py --write-specs        makes fig04.json ... and meshes/*.obj anew from the rules in figures/
  python run.py out --docs           also renews docs/paper-examples.md and its pictures

The table shows what the paper's figure claims, and what was measured on the points alone. Exit status: 0 if every
claim is met, 1 if one is not. SHAPEOP_LIBRARY names the library to load, if it is not the package's own.
"""
PICTURES = solve.FOLDER.parents[1] / "docs" / "images" / "paper"
PAGE = solve.FOLDER.parents[1] / "docs" / "paper-examples.md"


def main(arguments=None):
    options = parser().parse_args(arguments)
    numbers = options.figure or sorted(ALL)
    if options.write_specs:
        write_specs(numbers)
    if options.out is None:
        return 0
    options.out.mkdir(parents=True, exist_ok=True)
    table = {}
    for figure in numbers:
        module, spec = ALL[figure], solve.read_spec(figure)
        with tqdm(total=solve.solve_count(spec), desc="figure %d" % figure, unit="solve", leave=False, mininterval=0.5) as bar:
            solved = {model["name"]: solve.solve(model, bar.update) for model in spec["models"]}
        measures = module.measures(solved)
        table["fig%02d" % figure] = {
            "title": module.TITLE,
            "claim": module.CLAIM,
            "measures": [measure.data() for measure in measures],
        }
        print_table(module, measures)
        if not options.quick:
            module.picture(solved, options.out / ("fig%02d.png" % figure))
    text = json.dumps(table, indent=1, ensure_ascii=False) + "\n"
    (options.out / "measures.json").write_text(text, encoding="utf-8")
    is_met = all(measure["is_met"] for figure in table.values() for measure in figure["measures"])
    return 0 if is_met else 1


def parser():
    made = argparse.ArgumentParser(description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("out", nargs="?", type=Path, help="the folder that results are written to; made if it is missing")
    made.add_argument("--figure", type=int, action="append", choices=sorted(ALL), help="only this figure; may be repeated")
    made.add_argument("--quick", action="store_true", help="solve and measure, draw nothing")
    made.add_argument("--write-specs", action="store_true", help="make the specs and meshes anew first")
    made.add_argument("--docs", action="store_true", help="renew the page in docs/ and its pictures; needs all figures")
    return made


def write_specs(numbers):
    for figure in numbers:
        spec, made = ALL[figure].build()
        for path, mesh in made.items():
            (solve.FOLDER / path).write_text(meshes.obj_text(mesh))
        (solve.FOLDER / ("fig%02d.json" % figure)).write_text(solve.spec_text(spec))


def print_table(module, measures):
    print("\nFigure %d: %s\n  %s" % (module.NUMBER, module.TITLE, module.CLAIM))
    for measure in measures:
        claim = measure.claim()
        verdict = "" if not claim else "met" if measure.is_met else "NOT MET"
        value = "%s %s" % (number(measure.value), measure.unit)
        print("  %-66s %-26s %-18s %s" % (measure.what, value, claim, verdict))


if __name__ == "__main__":
    sys.exit(main())

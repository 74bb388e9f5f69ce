#!/usr/bin/env python3
"""Solves, measures and draws the figures 4 to 11 of the ShapeOp paper."""

import argparse
import json
import shutil
import sys
from pathlib import Path

from tqdm import tqdm

import meshes
import page
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
DOCS = solve.FOLDER.parents[1] / "docs"
#: The measures that the page in docs/ was made from.
MEASURES = solve.FOLDER / "measures.json"


def main(arguments=None):
    made = parser()
    options = made.parse_args(arguments)
    if options.out is None and not options.write_specs:
        made.error("name a folder for the results, or give --write-specs")
    if options.docs and (options.figure or options.quick or options.out is None):
        made.error("--docs needs a folder, all figures and their pictures")
    numbers = options.figure or sorted(ALL)
    if options.write_specs:
        write_specs(numbers)
    if options.out is None:
        return 0
    options.out.mkdir(parents=True, exist_ok=True)
    table = {}
    for figure in numbers:
        module, spec = ALL[figure], solve.read_spec(figure)
        with tqdm(
            total=solve.solve_count(spec), desc="figure %d" % figure, unit="solve", leave=False, mininterval=0.5
        ) as bar:
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
    (options.out / "measures.json").write_text(measures_text(table), encoding="utf-8")
    if options.docs:
        write_docs(table, options.out)
    is_met = all(measure["is_met"] for figure in table.values() for measure in figure["measures"])
    return 0 if is_met else 1


def write_docs(table, pictures):
    MEASURES.write_text(measures_text(table), encoding="utf-8")
    (DOCS / "paper-examples.md").write_text(page.text(table, ALL), encoding="utf-8")
    (DOCS / "images" / "paper").mkdir(exist_ok=True)
    for name in table:
        shutil.copy(pictures / (name + ".png"), DOCS / "images" / "paper")


def measures_text(table):
    return json.dumps(table, indent=1, ensure_ascii=False) + "\n"


def parser():
    made = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    made.add_argument("out", nargs="?", type=Path, help="the folder that results are written to; made if it is missing")
    made.add_argument(
        "--figure", type=int, action="append", choices=sorted(ALL), help="only this figure; may be repeated"
    )
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
        print("  %-78s %-28s %-10s %s" % (measure.what, value, claim, verdict))


if __name__ == "__main__":
    sys.exit(main())

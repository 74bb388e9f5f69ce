"""Solves to the end in one call and keeps nothing: for Hops, the cloud and optimisers."""

# The same lines in every component: they find the package shapeop_gh.
import os
import re
import sys


def add_shapeop_to_path():
    packages = []
    for data in (os.environ.get("APPDATA"), os.path.expanduser("~/Library/Application Support")):
        for rhino in ("7.0", "8.0"):
            folder = os.path.join(data or "", "McNeel", "Rhinoceros", "packages", rhino, "ShapeOp")
            for version in os.listdir(folder) if data and os.path.isdir(folder) else []:
                numbers = [int(n) for n in re.findall("[0-9]+", version)]
                packages.append((numbers, "-" not in version, os.path.join(folder, version)))
    homes = [os.environ.get("SHAPEOP_HOME")] + [p[-1] for p in sorted(packages, reverse=True)]
    for home in homes:
        if home and os.path.isfile(os.path.join(home, "shapeop_gh", "__init__.py")):
            sys.path.insert(0, home)
            return


if "shapeop_gh" not in sys.modules:
    add_shapeop_to_path()
try:
    from shapeop_gh import components, host
except ImportError as error:
    raise ImportError(
        "ShapeOp is not installed (%s): install the package ShapeOp with Rhino's command PackageManager, or set the "
        "environment variable SHAPEOP_HOME to the folder that contains shapeop_gh, then restart Rhino" % error
    )

Points, Iterations, Energy, Violations, Outcome, Conflicts = host.run(
    ghenv, 6, components.one_shot_solver, ConstraintSigs, Points, Forces, Tolerance, MaxIterations, Precision, Seconds
)

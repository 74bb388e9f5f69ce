"""The page docs/paper-examples.md, from what was measured."""

from claims import Measure, number

HEAD = """\
# The examples of the ShapeOp paper

Made by `python examples/paper/run.py OUT --docs`, which solves the models, measures and draws them.

Figures 4 to 11 of M. Deuss, A. H. Deleuran, S. Bouaziz, B. Deng, D. Piker, M. Pauly: *ShapeOp, a robust and
extensible geometric modelling paradigm* (2015), with the constraints, iterations and lengths that their captions
name. The paper gives neither meshes nor weights; those here are chosen, and stand as plain data in
[examples/paper](../examples/paper), whose README states their form. What is measured is computed from points and
faces with numpy (`examples/paper/measure.py`): the library's own violations are not used. The paper's pictures show
colours where this page has numbers, so a bound in the column *claim* is what we take a figure to say; the tests hold
it. Rows without one are there for comparison. Iterations are plain ones.
"""


def text(table, figures):
    """`table` is that of measures.json, `figures` the modules by number."""
    parts = [HEAD]
    for module in figures.values():
        name = "fig%02d" % module.NUMBER
        parts.append("## Figure %d: %s\n" % (module.NUMBER, module.TITLE))
        parts.append(module.CLAIM + "\n")
        parts.append("![%s](images/paper/%s.png)\n" % (module.TITLE, name))
        parts.append(module.NOTES)
        parts.append(
            "| measured | value | claim | |\n|---|---|---|---|\n"
            + "".join(row(found) for found in table[name]["measures"])
        )
    return "\n".join(parts)


def row(found):
    measure = Measure(**{key: value for key, value in found.items() if key != "is_met"})
    verdict = "" if not measure.claim() else "met" if measure.is_met else "**not met**"
    return "| %s | %s %s | %s | %s |\n" % (measure.what, number(measure.value), measure.unit, measure.claim(), verdict)

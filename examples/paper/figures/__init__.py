"""One module for each figure of the paper. Each says:

- `NUMBER`, `TITLE`, `CLAIM` (what the paper shows or says, in our words), `NOTES` (what was chosen here, and why
  numbers are what they are)
- `build()`: the spec, as README.md states it, and its meshes by path
- `measures(solved)`: what was measured, as `claims.Measure`s
- `picture(solved, path)`: draws it

`solved` maps the names of the models to `solve.Solved`.
"""

from . import fig04, fig05, fig06, fig07, fig08, fig09, fig10, fig11

ALL = {module.NUMBER: module for module in (fig04, fig05, fig06, fig07, fig08, fig09, fig10, fig11)}

"""Reads numbers: each line of the text is a branch of the tree.

Lines that begin with # divide the text into sections, one for each stage, the first being stage 0. Between two whole
stages the numbers go evenly from one section's to the next one's."""
from Grasshopper import DataTree
from Grasshopper.Kernel.Data import GH_Path

sections = [[]]
for line in (Text or "").splitlines():
    if line.startswith("#"):
        sections.append([])
    elif line.strip():
        sections[-1].append([float(word) for word in line.split()])

stage = min(max(Stage or 0, 0), len(sections) - 1)
before = int(stage)
fraction = stage - before
rows = sections[before]
if fraction > 0:
    following = sections[before + 1]
    if [len(row) for row in rows] != [len(row) for row in following]:
        raise ValueError("sections %d and %d have not as many numbers in each line" % (before, before + 1))
    rows = [[a + (b - a) * fraction for a, b in zip(*pair)] for pair in zip(rows, following)]

Numbers = DataTree[float]()
for index, row in enumerate(rows):
    for value in row:
        Numbers.Add(value, GH_Path(index))

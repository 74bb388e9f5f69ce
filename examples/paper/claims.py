"""A measured number beside the bound that the figure claims for it."""

from dataclasses import asdict, dataclass


@dataclass
class Measure:
    """`value` in `unit`. `most` and `least` are the bounds that the claim sets, if it sets any."""

    what: str
    value: float
    unit: str = ""
    most: float | None = None
    least: float | None = None

    def __post_init__(self):
        self.value = float(self.value)

    @property
    def is_met(self):
        return (self.most is None or self.value <= self.most) and (self.least is None or self.value >= self.least)

    def claim(self):
        bounds = []
        if self.least is not None:
            bounds.append("≥ " + number(self.least))
        if self.most is not None:
            bounds.append("≤ " + number(self.most))
        return " and ".join(bounds)

    def data(self):
        return {key: value for key, value in asdict(self).items() if value is not None} | {"is_met": self.is_met}


def number(value):
    """Three significant digits; whole numbers and the whole part of large ones as they are; what is only round-off as
    such."""
    if 0 < abs(value) < 1e-9:
        return "< 1e-9"
    if float(value).is_integer() or abs(value) >= 1000:
        return "%.0f" % value
    return ("%.3g" % value).replace("e-0", "e-")

class Color(object):
    def __init__(self, red, green, blue):
        assert all(isinstance(c, int) and 0 <= c <= 255 for c in (red, green, blue))
        self.R, self.G, self.B = red, green, blue

    @staticmethod
    def FromArgb(red, green, blue):
        return Color(red, green, blue)

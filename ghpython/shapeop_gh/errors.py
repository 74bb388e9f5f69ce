"""What the user did wrong, or what the library refused: its text is for the component's balloon."""


class ShapeOpError(Exception):
    pass

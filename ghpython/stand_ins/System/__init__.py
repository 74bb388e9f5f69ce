import uuid


class Guid(object):
    def __init__(self, text):
        self._text = text

    @staticmethod
    def NewGuid():
        return Guid(str(uuid.uuid4()))

    def __str__(self):
        return self._text

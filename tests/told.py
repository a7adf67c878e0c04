"""Telling planners to stop by the number of their looks, which no load of the machine changes."""


class StopAt:
    """Says stop from a look on, and counts the looks."""

    def __init__(self, look):
        self.look, self.looks = look, 0

    def __call__(self):
        self.looks += 1
        return self.looks >= self.look

    @property
    def later(self):
        """How often it was asked again after it had said stop."""
        return self.looks - self.look

"""Random values of an effect's parameters, over the range that tests have."""

import numpy as np


class Draw:
    """Values from `random`. Where two effects must both be seen (`strong`), the weaker half of a range is left out."""

    def __init__(self, random, strong=False):
        self.random, self.strong = random, strong

    def rising(self, low, high):
        """Even in the logarithm; the effect grows with the value."""
        low = np.sqrt(low * high) if self.strong else low
        return float(np.exp(self.random.uniform(np.log(low), np.log(high))))

    def falling(self, low, high):
        """Even in the logarithm; the effect shrinks with the value."""
        high = np.sqrt(low * high) if self.strong else high
        return float(np.exp(self.random.uniform(np.log(low), np.log(high))))

    def even(self, low, high):
        """Even between the two; no end shows more."""
        return float(self.random.uniform(low, high))

    def sign(self):
        """-1 or 1."""
        return float(self.random.choice([-1.0, 1.0]))

    def along(self, bench):
        """A place on the piece, at least 2 % of the length from its ends, m."""
        return round(self.even(-0.48, 0.48) * bench.panel.length, 3)

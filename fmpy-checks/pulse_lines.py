"""The accelerance of an FMU of one force and one response, from its motion under a short pulse.

Force and acceleration go to the Laplace plane, s = sigma + j omega, where the transform of a motion that has not yet died away
is exact.
"""

import numpy as np
from masters import OUTPUTS, panel

STEP, COUNT = 1e-5, 20_000
SIGMA = 16.0 / (STEP * COUNT)
UP_TO = 3500.0  # Hz


def accelerance(fmu, parameters=(), up_to=UP_TO, by="acceleration"):
    """Lines s on the contour, and acceleration over force there, by the motion that is read.

    What lies above half the sampling rate is folded into an acceleration's samples, at a driving point by percents; not so into a
    displacement's.
    """
    times = STEP * np.arange(COUNT + 1)
    pulse = np.where(times < 4e-4, np.sin(np.pi * times / 4e-4) ** 2, 0.0)
    with panel(fmu) as instance:
        for name, value in parameters:
            instance.set(name, value)
        motion = instance.initialize(force_linear=True).run(pulse[1:], STEP)[OUTPUTS.index(by)]
    motion = np.concatenate([[0.0], motion])[:-1]
    lines = np.arange(1, int(up_to * STEP * COUNT))
    s = SIGMA + 2.0j * np.pi * lines / (STEP * COUNT)
    window = np.exp(-SIGMA * times[:-1])
    transform = lambda signal: STEP * np.fft.rfft(signal * window)[lines]  # noqa: E731
    # Straight lines between samples are triangles, one a sample.
    half = s * STEP / 2.0
    return s, s ** (2 - OUTPUTS.index(by)) * transform(motion) / (transform(pulse[:-1]) * (np.sinh(half) / half) ** 2)


def worst(found, expected):
    return np.max(np.abs(found - expected)) / np.sqrt(np.mean(np.abs(expected) ** 2))

"""What must become of the bound where noise and window change."""

import dataclasses

import numpy as np
import pytest

from . import bound, records

SETUP = records.Setup(hits=2, samples=4096, pulse_duration=1.2e-3, noise=0.003, noise_of="peak", seed=3)


@pytest.fixture(name="usual", scope="module")
def _usual():
    return bound.percent(SETUP)


def test_twice_the_noise_is_twice_the_bound(usual):
    twice = dataclasses.replace(SETUP, noise=2.0 * SETUP.noise)
    assert np.allclose(bound.percent(twice), 2.0 * usual, rtol=1e-6)


def test_a_wider_window_tells_less(usual):
    assert np.all(bound.percent(SETUP, half_width=400) > usual)

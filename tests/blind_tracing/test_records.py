"""Sampling, restoring forces and the measuring chain against closed forms and an ODE solver."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from . import nonlinear, records, sets, whole
from .bench import draw
from .contour import Sampling, half_sine
from .modes import Modes

SAMPLING = Sampling(samples=8192)
PEAK, DURATION, START = 80.0, 1.8e-4, 0.0127


def test_val_the_contour_gives_a_single_modes_exact_response():
    """A half-sine on one mode: the convolution in closed form after the contact, up to the last sample. What the low
    pass takes from a 900 Hz tone is below 1e-9."""
    frequency, s = SAMPLING.lines()
    omega, zeta = 2.0 * np.pi * 900.0, 0.003
    found = SAMPLING.samples_of(
        half_sine(s, PEAK, DURATION, START) / (s**2 + 2.0 * zeta * omega * s + omega**2), frequency
    )
    pole = -zeta * omega + 1.0j * omega * np.sqrt(1.0 - zeta**2)
    # The force's transform at the pole: what the contact leaves in the mode.
    left = half_sine(pole, PEAK, DURATION, 0.0)
    after = SAMPLING.time > START + DURATION + 2e-3  # clear of the low pass' ringing
    wanted = (left * np.exp(pole * (SAMPLING.time - START)) / pole.imag).imag
    assert np.max(np.abs(found - wanted)[after]) < 1e-6 * np.max(np.abs(wanted))


def test_val_nothing_comes_before_the_hit():
    """The record is causal but for the low pass, which rings for a few samples."""
    frequency, s = SAMPLING.lines()
    found = SAMPLING.samples_of(half_sine(s, PEAK, DURATION, START), frequency)
    before = SAMPLING.time < START - 3e-3
    assert np.max(np.abs(found[before])) < 1e-6 * PEAK


def test_transform_and_samples_are_inverse():
    """Samples to the contour and back."""
    frequency, s = SAMPLING.lines()
    given = half_sine(s, PEAK, DURATION, START) * SAMPLING.low_pass(frequency)
    found = SAMPLING.transform_of(SAMPLING.samples_of(given, frequency, filtered=False), len(frequency))
    # The line at half the rate has no phase in a real record.
    np.testing.assert_allclose(found[:-1], given[:-1], atol=1e-12 * np.abs(given).max())


@pytest.mark.parametrize("k1, k3", [(3e4, 0.0), (0.0, 4e10)])
def test_val_a_restoring_force_against_an_ode_solver(k1, k3):
    """Two modes and a free translation on a spring, straight or cubic, at one place."""
    modes = Modes(
        omega=2.0 * np.pi * np.array([0.0, 310.0, 1500.0]),
        zeta=np.array([0.0, 0.004, 0.01]),
        shape=np.array([[1.3], [1.7], [-0.8]]),
        rigid=1,
    )
    law = lambda y, v: k1 * y + k3 * y**3  # noqa: E731
    samples, rate = 4096, 40960.0
    time = np.arange(samples) / rate

    def blow(t):
        inside = (t >= START) & (t <= START + DURATION)
        return np.where(inside, PEAK * np.sin(np.pi * (t - START) / DURATION), 0.0)

    def slope(t, state, held):
        place, speed = state[:3], state[3:]
        force = blow(t) - (law(modes.shape[:, 0] @ place, 0.0) if held else 0.0)
        own = -(modes.omega**2) * place - 2.0 * modes.zeta * modes.omega * speed
        return np.concatenate([speed, own + modes.shape[:, 0] * force])

    def run(held):
        # The contact ends in a corner: the solver starts anew there.
        end, exact = START + DURATION, {"args": (held,), "rtol": 1e-10, "atol": 1e-14}
        before, after = time[time < end], time[time >= end]
        first = solve_ivp(slope, (0.0, end), np.zeros(6), t_eval=[*before, end], max_step=2e-5, **exact)
        rest = solve_ivp(slope, (end, time[-1]), first.y[:, -1], t_eval=after, **exact)
        whole = np.hstack([first.y[:, :-1], rest.y])
        return modes.shape[:, 0] @ whole[:3], modes.shape[:, 0] @ whole[3:]

    free, wanted = run(False), law(run(True)[0], 0.0)
    found = nonlinear.restoring_force(
        modes, [0], free[0][None, :, None], free[1][None, :, None], 1.0 / rate, law
    )[0, :, 0]
    # The force runs straight between samples: (omega h)^2 / 12 of its 1500 Hz part, and less below.
    assert np.max(np.abs(found - wanted)) < 5e-3 * np.max(np.abs(wanted))


def test_a_finer_grid_leaves_the_cubic_record_as_it_is(monkeypatch):
    """Twice the samples of the restoring force move the noiseless record by less than a tenth of the least noise."""
    played = []
    for finer in (records.FINER, 2 * records.FINER):
        monkeypatch.setattr(records, "FINER", finer)
        random = np.random.default_rng(5)
        bench, _, _ = sets.build(sets.Case("cubic", ("cubic-stiffness",)), random, SAMPLING)
        bench.noise = 0.0
        played.append(records.play(bench, random).acceleration)
    change = np.sqrt(np.mean((played[1] - played[0]) ** 2)) / np.sqrt(np.mean(played[0] ** 2))
    assert change < 1e-4


def test_the_noise_is_what_the_truth_says():
    """The same test with and without noise differs by the stated deviations, within 2 % (1e5 samples)."""
    clean = draw(np.random.default_rng(3), sampling=SAMPLING)
    noisy = draw(np.random.default_rng(3), sampling=SAMPLING)
    clean.noise, noisy.noise = 0.0, 0.004
    one, other = (records.play(bench, np.random.default_rng(4)) for bench in (clean, noisy))
    assert np.std(other.force - one.force) == pytest.approx(other.force_noise, rel=0.02)
    assert np.std(other.acceleration - one.acceleration) == pytest.approx(other.acceleration_noise, rel=0.02)


@pytest.mark.parametrize("name", [name for name in sets.SETS if name not in ("real", *whole.SETS)])
def test_every_kind_can_be_played(name):
    """Finite records, and different from those of the same bench with nothing in it by a tenth of the least noise."""
    small = Sampling(samples=4096)
    for number, case in enumerate(sets.cases(name, 1)):
        random = np.random.default_rng([2, number])
        bench, truth, _ = sets.build(case, random, small)
        bench.noise = 0.0
        with_it = records.play(bench, np.random.default_rng(1))
        assert np.all(np.isfinite(with_it.acceleration)), case.kind
        assert len(truth) == len(case.effects)
        plain = draw(np.random.default_rng([2, number]), case.places, small, case.cantilever)
        plain.noise = 0.0
        without = records.play(plain, np.random.default_rng(1)).acceleration
        difference = np.sqrt(np.mean((with_it.acceleration - without) ** 2) / np.mean(without**2))
        # A rough test differs from the smooth one even where nothing is missing.
        assert (difference > 1e-4) == (bool(case.effects) or case.rough), f"{case.kind}: {difference:.1e}"

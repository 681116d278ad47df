"""Acceleration, velocity and displacement against the modal sum computed apart.

A half-sine is not made of straight lines: a straight line between its samples misses it by (pi h/T)^2/8 of its peak.
With 50,000 steps in the pulse that is 5e-10, and half of it on the mean; so 1e-9 is asked of the linear routes.
"""

import numpy as np
import pytest
from conftest import BEAM, FORCES, RESPONSES, ZETAS
from fmpy import simulate_fmu
from masters import OUTPUTS, panel, worst
from modal_sum import half_sine, modes_at, staircase, straight_lines

DURATION = 1e-3
STEP = DURATION / 50_000
COUNT = 100_000
TOLERANCE = 1e-9


def pulse(t):
    return np.where((t >= 0.0) & (t <= DURATION), np.sin(np.pi * t / DURATION), 0.0)


def test_a_linear_force_gives_the_half_sine_response(fmu):
    ends = STEP * np.arange(1, COUNT + 1)
    with panel(fmu) as instance:
        motion = instance.initialize(force_linear=True).run(pulse(ends), STEP)
    expected = half_sine(modes_at(BEAM, ZETAS, FORCES[0], RESPONSES[0]), DURATION, ends)
    assert np.all(worst(motion, expected) < TOLERANCE), worst(motion, expected)


def test_input_derivatives_give_the_half_sine_response(fmu2):
    # FMPy takes, on a sample of the input, the slope of the line before it. Samples a hair (1e-5 of a step) before the
    # communication points make it take the line ahead; the hair runs the force past the pulse's end by 6e-10.
    times = STEP * (np.arange(COUNT + 2) - 1e-5)
    names = [f"force_{n + 1}" for n in range(len(FORCES))]
    signals = np.zeros(len(times), dtype=[("time", float)] + [(name, float) for name in names])
    signals["time"] = times
    signals["force_1"] = pulse(times)
    result = simulate_fmu(
        str(fmu2),
        stop_time=COUNT * STEP,
        output_interval=STEP,
        input=signals,
        output=[f"{output}_1" for output in OUTPUTS],
        set_input_derivatives=True,
    )
    motion = np.array([result[f"{output}_1"] for output in OUTPUTS])
    expected = half_sine(modes_at(BEAM, ZETAS, FORCES[0], RESPONSES[0]), DURATION, result["time"])
    assert np.all(worst(motion, expected) < TOLERANCE), worst(motion, expected)


@pytest.mark.parametrize("port", range(len(RESPONSES)))
@pytest.mark.parametrize("step", [2e-6, 1e-4, 7e-3])
def test_a_held_force_gives_the_staircase_response(fmu, port, step):
    """Exact at any step, coarse ones too; the driving point is port 2."""
    forces = np.sin(0.37 * np.arange(400)) + 0.3 * (np.arange(400) % 5 == 0)
    with panel(fmu) as instance:
        motion = instance.initialize().run(forces, step, port + 1)
    expected = staircase(modes_at(BEAM, ZETAS, FORCES[0], RESPONSES[port]), forces, step)
    # Rounding in both sums, and in the frequencies: 2e-16 of omega t, up to 7e4.
    assert np.all(worst(motion, expected) < 1e-10), worst(motion, expected)


@pytest.mark.parametrize("step", [3e-5, 1e-3, 7e-3])
def test_a_force_of_straight_lines_is_met_to_rounding(fmu, step):
    """To 1e-12 of the peak. 40 steps, for a phase of omega t has no more digits than its rounding leaves.

    At steps of a microsecond the closed form here has lost them by cancelling; the crates' own tests go on to those.
    """
    forces = np.sin(1.37 * np.arange(1, 41)) + 0.3 * (np.arange(40) % 5 == 0)
    with panel(fmu) as instance:
        motion = instance.initialize(force_linear=True).run(forces, step, 2)
    expected = straight_lines(modes_at(BEAM, ZETAS, FORCES[0], RESPONSES[1]), forces, step)
    assert np.all(worst(motion, expected) < 1e-12), worst(motion, expected)


def test_fmpy_simulates_with_its_own_defaults(fmu):
    result = simulate_fmu(str(fmu), start_values={"force_1": 1.0}, validate=True)
    assert len(result) > 100 and all(np.all(np.isfinite(result[name])) for name in result.dtype.names)


def test_an_acceleration_answers_at_once_to_a_force(fmu):
    """Direct feedthrough: at rest, the sum of the products of the shapes times the force."""
    with panel(fmu) as instance:
        instance.initialize().set("force_1", 3.0)
        at_once = instance.get("displacement_2", "velocity_2", "acceleration_2")
    expected = 3.0 * sum(weight for _, _, weight in modes_at(BEAM, ZETAS, FORCES[0], RESPONSES[1]))
    assert at_once[:2] == [0.0, 0.0]
    assert at_once[2] == pytest.approx(expected, rel=1e-12)

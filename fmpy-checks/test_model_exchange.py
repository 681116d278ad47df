"""Model exchange: FMPy's solver integrates the modes, against the exact steps of co-simulation on the same force."""

import ctypes

import numpy as np
import pytest
from conftest import BEAM, FORCES, RESPONSES, ZETAS
from fmpy import simulate_fmu
from fmpy.sundials import CVodeSolver
from masters import OUTPUTS, REFUSED, panel
from modal_sum import modes_at

STOP = 4e-3
INTERVAL = 2e-5
NAMES = [f"{output}_{port + 1}" for output in OUTPUTS for port in range(len(RESPONSES))]


CHANGE = STOP / 2


def two_levels():
    """1 N, then -0.5 N. FMPy holds inputs over a step of its solver and stops it at a jump: so both run this exactly."""
    points = [(0.0, 1.0), (CHANGE, 1.0), (CHANGE, -0.5), (STOP, -0.5)]
    return np.array(points, dtype=[("time", float), ("force_1", float)])


def co_simulated(fmu):
    """Outputs after each step, the force of the next one set."""
    rows = []
    with panel(fmu) as instance:
        instance.initialize()
        for n in range(round(STOP / INTERVAL) + 1):
            instance.set("force_1", 1.0 if n * INTERVAL < CHANGE else -0.5)
            rows.append(instance.get(*NAMES))
            instance.step(n * INTERVAL, INTERVAL)
    return np.array(rows)


def test_cvode_gives_what_the_exact_steps_give(fmu):
    result = simulate_fmu(
        str(fmu),
        fmi_type="ModelExchange",
        stop_time=STOP,
        output_interval=INTERVAL,
        relative_tolerance=1e-10,
        input=two_levels(),
        output=NAMES,
        record_events=False,
    )
    expected = co_simulated(fmu)
    found = np.array([result[name] for name in NAMES]).T
    error = np.max(np.abs(found - expected), axis=0) / np.max(np.abs(expected), axis=0)
    assert np.all(error < 1e-6), dict(zip(NAMES, error))


PULSE = 2e-3


def half_sine(interval):
    """A half sine of 1 N, sampled."""
    times = interval * np.arange(round(STOP / interval) + 1)
    forces = np.where(times < PULSE, np.sin(np.pi * times / PULSE), 0.0)
    return np.array(list(zip(times, forces)), dtype=[("time", float), ("force_1", float)])


def exact_pulse(fmu, interval):
    """Outputs at multiples of an interval, by exact steps of a microsecond on the chords of the pulse."""
    fine = half_sine(1e-6)
    rows = []
    with panel(fmu) as instance:
        instance.initialize(force_linear=True)
        for n, force in enumerate(fine["force_1"][1:]):
            if n % round(interval / 1e-6) == 0:
                rows.append(instance.get(*NAMES))
            instance.set("force_1", force)
            instance.step(n * 1e-6, 1e-6)
        rows.append(instance.get(*NAMES))
    return np.array(rows)


def test_cvode_follows_a_sampled_pulse_where_the_master_interpolates_it(export, monkeypatch):
    """With residual modes, at the tolerance of DefaultExperiment. FMPy's CVode asks for derivatives at a force of the step before, and errs by a third."""
    fmu = export("pulse.fmu", "--residual", "attachment", forces=FORCES[:1])
    steps = CVodeSolver.f

    def interpolated(solver, time, states, derivatives, data):
        solver.input.apply(time)
        return steps(solver, time, states, derivatives, data)

    expected = exact_pulse(fmu, INTERVAL)
    errors = []
    for follows in (steps, interpolated):
        monkeypatch.setattr(CVodeSolver, "f", follows)
        result = simulate_fmu(
            str(fmu), fmi_type="ModelExchange", stop_time=STOP, output_interval=INTERVAL, relative_tolerance=1e-6,
            input=half_sine(INTERVAL), output=NAMES, record_events=False,
        )
        found = np.array([result[name] for name in NAMES]).T
        errors.append(np.max(np.abs(found - expected), axis=0) / np.max(np.abs(expected), axis=0))
    assert np.all(errors[1] < 0.02) and np.max(errors[0]) > 0.1, dict(zip(NAMES, zip(*errors)))


def test_fmpy_integrates_with_its_own_defaults(fmu):
    result = simulate_fmu(str(fmu), fmi_type="ModelExchange", start_values={"force_1": 1.0}, validate=True)
    assert len(result) > 100 and all(np.all(np.isfinite(result[name])) for name in result.dtype.names)


@pytest.fixture
def continuous(fmu):
    with panel(fmu, model_exchange=True) as instance:
        instance.initialize()
        instance.fmu.enterContinuousTimeMode()
        yield instance


def numbers(values):
    return (ctypes.c_double * len(values))(*values)


def read(instance, names, count):
    values = numbers([0.0] * count)
    assert instance.call(names, values, ctypes.c_size_t(count)) == 0
    return np.array(values)


GET = ("fmi2GetContinuousStates", "fmi3GetContinuousStates")
SET = ("fmi2SetContinuousStates", "fmi3SetContinuousStates")
DERIVATIVES = ("fmi2GetDerivatives", "fmi3GetContinuousStateDerivatives")


def test_derivatives_are_those_of_the_equation_of_motion(continuous):
    """d/dt (a, a') = (a', p - 2 zeta omega a' - omega^2 a), with the modes of the beam computed apart."""
    modes = modes_at(BEAM, ZETAS, FORCES[0], FORCES[0])
    count = 2 * len(modes)
    given = np.random.default_rng(7).normal(size=count) * 1e-6
    assert continuous.call(SET, numbers(given), ctypes.c_size_t(count)) == 0
    continuous.set("force_1", 2.5)
    found = read(continuous, DERIVATIVES, count)
    np.testing.assert_array_equal(read(continuous, GET, count), given)
    np.testing.assert_array_equal(found[0::2], given[1::2])
    for mode, (omega, zeta, weight) in enumerate(modes):
        position, velocity = given[2 * mode : 2 * mode + 2]
        force = found[2 * mode + 1] + 2.0 * zeta * omega * velocity + omega**2 * position
        # The sign of a shape is free, its product with itself is not.
        assert force**2 == pytest.approx(2.5**2 * weight, rel=1e-6)


def test_states_of_another_number_or_none_are_refused(continuous):
    count = 2 * (2 + len(ZETAS))
    before = read(continuous, GET, count)
    assert continuous.call(SET, numbers(before[:-1]), ctypes.c_size_t(count - 1)) == 3
    assert f"the FMU has {count}" in continuous.messages[-1]
    assert continuous.call(SET, numbers([float("nan")] * count), ctypes.c_size_t(count)) == 3
    assert "must be a finite number" in continuous.messages[-1]
    assert continuous.call(SET, None, ctypes.c_size_t(count)) == 3
    assert "null pointer" in continuous.messages[-1]
    np.testing.assert_array_equal(read(continuous, GET, count), before)


def test_modes_and_interfaces_are_kept_apart(fmu, continuous):
    answers = [ctypes.byref(ctypes.c_bool()) for _ in range(3)] + [ctypes.byref(ctypes.c_double())]
    step = [ctypes.c_double(0.0), ctypes.c_double(1e-4), 1] + (answers if continuous.version == 3 else [])
    assert continuous.call(("fmi2DoStep", "fmi3DoStep"), *step) == 3
    assert "allowed in step mode (co-simulation" in continuous.messages[-1]
    continuous.fmu.enterEventMode()
    with pytest.raises(REFUSED):
        continuous.fmu.enterEventMode()
    assert "not allowed in the state event mode" in continuous.messages[-1]
    continuous.fmu.newDiscreteStates() if continuous.version == 2 else continuous.fmu.updateDiscreteStates()
    with panel(fmu) as co_simulation:
        co_simulation.initialize()
        assert co_simulation.call(("fmi2EnterContinuousTimeMode", "fmi3EnterContinuousTimeMode")) == 3
        assert "this instance is co-simulation" in co_simulation.messages[-1]

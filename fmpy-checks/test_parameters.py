"""Parameters set at initialization, against an FMU exported with these numbers in the first place."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import BEAM, FORCES, ZETAS
from masters import OUTPUTS, REFUSED, panel

STEP = 1e-4
RUN = np.cos(0.2 * np.arange(60))
CHANGES = {"length": 0.9, "width": 0.12, "thickness": 0.028, "mass_per_area": 6.5, "e_x": 1.3e10, "g_zx": 4.1e8}
NAMES = [f"{output}_{port}" for output in OUTPUTS for port in (1, 2)]


@pytest.fixture(params=["2", "3"], ids=["fmi2", "fmi3"])
def version(request):
    return ("--fmi", request.param)


def outputs(instance):
    instance.run(RUN, STEP)
    return instance.get(*NAMES)


def changed(instance, changes):
    for name, value in changes.items():
        instance.set(name, value)
    return instance


def test_sizes_mass_and_constants(export, version):
    with panel(export(f"p{version[1]}.fmu", *version)) as instance:
        found = outputs(changed(instance, CHANGES).initialize())
    with panel(export(f"q{version[1]}.fmu", *version, beam=replace(BEAM, **CHANGES))) as instance:
        expected = outputs(instance.initialize())
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_places_of_the_ports(export, version):
    places = [FORCES[0] + 0.07, *FORCES[1:]]
    with panel(export(f"r{version[1]}.fmu", *version)) as instance:
        found = outputs(changed(instance, {"force_1_x": places[0]}).initialize())
    with panel(export(f"s{version[1]}.fmu", *version, forces=places)) as instance:
        np.testing.assert_allclose(found, outputs(instance.initialize()), rtol=1e-9)


def test_damping_and_what_was_set_is_read_back(fmu):
    changes = {f"damping_ratio_{n + 1}": 0.0 for n in range(len(ZETAS))}
    with panel(fmu) as instance:
        changed(instance, changes).initialize()
        assert instance.get(*changes) == [0.0] * len(ZETAS)
        # Without damping the energy of the modes stays as it is once the force is gone.
        instance.run(RUN, STEP)
        instance.set("force_1", 0.0)
        energies = []
        for n in range(2):
            time = (len(RUN) + 1000 * n) * STEP
            names = [f"modal_{word}_{m}" for m in range(3, 9) for word in ("position", "velocity")]
            rates = [f"der(modal_velocity_{m})" for m in range(3, 9)]
            state, rate = np.array(instance.get(*names)).reshape(-1, 2), np.array(instance.get(*rates))
            energies.append(np.sum(state[:, 1] ** 2 - rate * state[:, 0]))
            instance.step(time, 1000 * STEP)
        assert energies[1] == pytest.approx(energies[0], rel=1e-9)


@pytest.mark.parametrize(
    "name, value, message",
    [("length", 0.0, "must be finite and greater than zero"), ("thickness", -0.03, "greater than zero"),
     ("damping_ratio_2", 0.8, "0 <= zeta"), ("e_x", float("nan"), "must be a finite number")],
)
def test_values_without_a_meaning_are_refused_at_once(fmu, name, value, message):
    with panel(fmu) as instance:
        with pytest.raises(REFUSED):
            instance.set(name, value)
        assert message in instance.messages[-1]
        assert np.all(np.isfinite(outputs(instance.initialize())))


def test_values_that_do_not_fit_each_other_are_refused_before_the_start(fmu):
    """Each size may be right by itself: only when all are set can the place of a port be judged."""
    with panel(fmu) as instance:
        instance.set("length", 0.5)
        with pytest.raises(REFUSED):
            instance.initialize()
        assert "lies off the piece" in instance.messages[-1]
        instance.set("length", 0.8)
        instance.fmu.exitInitializationMode()
        assert np.all(np.isfinite(outputs(instance)))


def test_parameters_stay_once_started_and_reset_brings_the_first_ones_back(fmu):
    with panel(fmu) as instance:
        first = outputs(instance.initialize())
        with pytest.raises(REFUSED):
            instance.set("e_x", 1e10)
        assert "fixed parameter" in instance.messages[-1]
        instance.fmu.reset()
        second = outputs(changed(instance, CHANGES).initialize())
        assert second != first
        state = instance.fmu.getFMUState()
        instance.fmu.reset()
        assert outputs(instance.initialize()) == first
        instance.fmu.setFMUState(state)
        assert instance.get(*NAMES) == second and instance.get("e_x") == [CHANGES["e_x"]]

"""The plate's FMU: the beam's checks of calls and interfaces on it, and its numbers against scikit-fem's modes.

Imported tests run here with this file's `fmu`: a plate with ports off the centre line.
"""

from test_calls import *  # noqa: F403  (first: its forces are not the plate's)

import numpy as np
import pytest
from fmpy.validation import validate_fmu
from masters import OUTPUTS, REFUSED, panel
from modal_sum import half_sine, staircase
from plate_panel import CONSTANTS, FORCES, PIECE, RESPONSES, ZETAS, export, fmu, fmu2, modes_at  # noqa: F401
from test_description import (  # noqa: F401
    test_each_state_has_its_derivative_and_a_nominal,
    test_fmi_2_is_the_default,
    test_fmpy_finds_no_problem,
    test_the_archive_has_documentation_and_an_executable_library,
    test_accelerations_alone_depend_on_forces,
)
from test_importers import test_ecospy_agrees_with_fmpy, test_libcosimpy_agrees_with_fmpy  # noqa: F401
from test_model_exchange import (  # noqa: F401
    continuous,
    test_cvode_gives_what_the_exact_steps_give,
    test_fmpy_integrates_with_its_own_defaults,
    test_modes_and_interfaces_are_kept_apart,
    test_states_of_another_number_or_none_are_refused,
)
from test_motion import test_fmpy_simulates_with_its_own_defaults  # noqa: F401

DURATION = 2e-3
STEP = 1e-6
COUNT = 6000
# Frequencies are held to 1e-4, which turns mode 5 by 4e-3 over this run, and shapes less well than those.
TOLERANCE = 5e-3

RUN = np.cos(0.2 * np.arange(60))
CHANGES = {"length": 0.9, "width": 0.33, "thickness": 0.028, "mass_per_area": 6.5, "e_x": 1.3e10, "e_y": 8e9,
           "nu_xy": 0.25, "g_xy": 3.3e9, "g_yz": 3.5e8, "g_zx": 4.1e8}
NAMES = [f"{output}_{port}" for output in OUTPUTS for port in (1, 2)]


def in_phase(modes):
    """The same modes, all with a share of one sign: what the motion is made of before it cancels."""
    return [(omega, zeta, abs(product)) for omega, zeta, product in modes]


def error(motion, expected, whole):
    """Largest error of displacement, velocity and acceleration as a share of the peak of what they are made of."""
    return np.max(np.abs(motion - expected), axis=1) / np.max(np.abs(whole), axis=1)


def outputs(instance):
    instance.run(RUN, 1e-4)
    return instance.get(*NAMES)


def changed(instance, changes):
    for name, value in changes.items():
        instance.set(name, value)
    return instance


@pytest.mark.parametrize("port", range(len(RESPONSES)))
def test_a_linear_force_gives_the_half_sine_response(fmu, port):
    """Between two places off the centre line, and at the driving point."""
    ends = STEP * np.arange(1, COUNT + 1)
    force = np.where(ends <= DURATION, np.sin(np.pi * ends / DURATION), 0.0)
    with panel(fmu) as instance:
        motion = instance.initialize(force_linear=True).run(force, STEP, port + 1)
    modes = modes_at(FORCES[0], RESPONSES[port])
    expected = half_sine(modes, DURATION, ends)
    assert np.all(error(motion, expected, half_sine(in_phase(modes), DURATION, ends)) < TOLERANCE)


@pytest.mark.parametrize("step", [2e-6, 1e-4])
def test_a_held_force_gives_the_staircase_response(fmu, step):
    """Steps of any size are exact, so the coarse ones miss by no more than the modes do."""
    forces = np.sin(0.37 * np.arange(60)) + 0.3 * (np.arange(60) % 5 == 0)
    with panel(fmu) as instance:
        motion = instance.initialize().run(forces, step)
    modes = modes_at(FORCES[0], RESPONSES[0])
    expected = staircase(modes, forces, step)
    assert np.all(error(motion, expected, staircase(in_phase(modes), forces, step)) < TOLERANCE)


def test_an_acceleration_answers_at_once_to_a_force(fmu):
    """Direct feedthrough: at rest, the sum of the products of the shapes times the force, for every pair of ports."""
    with panel(fmu) as instance:
        instance.initialize()
        for row, response in enumerate(RESPONSES):
            unknown = [instance.references[f"acceleration_{row + 1}"]]
            for column, force in enumerate(FORCES):
                known = [instance.references[f"force_{column + 1}"]]
                found = instance.fmu.getDirectionalDerivative(unknown, known, [1.0])[0]
                products = [product for _, _, product in modes_at(force, response)]
                assert found == pytest.approx(sum(products), abs=1e-3 * np.abs(products).sum())


def test_all_six_constants_and_the_places_are_parameters(fmu):
    names = [*PIECE, *CONSTANTS]
    places = {f"{kind}_{n + 1}": place for kind, list_ in (("force", FORCES), ("response", RESPONSES)) for n, place in enumerate(list_)}
    with panel(fmu) as instance:
        instance.initialize()
        assert instance.get(*names) == [*PIECE.values(), *CONSTANTS.values()]
        for name, place in places.items():
            assert tuple(instance.get(f"{name}_x", f"{name}_y")) == place
        assert instance.get(*(f"damping_ratio_{n + 1}" for n in range(len(ZETAS)))) == ZETAS
    assert validate_fmu(str(fmu)) == []


@pytest.mark.parametrize("version", ["2", "3"])
def test_sizes_mass_constants_and_places(export, version):
    places = [(-0.31, 0.09), *FORCES[1:]]
    moved = {"force_1_x": places[0][0], "force_1_y": places[0][1]}
    with panel(export(f"p{version}.fmu", "--fmi", version)) as instance:
        found = outputs(changed(instance, CHANGES | moved).initialize())
    with panel(export(f"q{version}.fmu", "--fmi", version, forces=places, **CHANGES)) as instance:
        expected = outputs(instance.initialize())
    # An FMU solves on the basis chosen at its own values: alike to what a basis holds.
    np.testing.assert_allclose(found, expected, rtol=1e-9)


@pytest.mark.parametrize("changes, message", [
    ({"nu_xy": 0.94, "e_y": 2e10}, "no definite law"), ({"force_3_y": 0.2}, "lies off the piece"),
])
def test_values_that_do_not_fit_each_other_are_refused_before_the_start(fmu, changes, message):
    with panel(fmu) as instance:
        changed(instance, changes)
        with pytest.raises(REFUSED):
            instance.initialize()
        assert message in instance.messages[-1]


def test_reset_brings_the_first_parameters_back_and_a_state_the_others(fmu):
    with panel(fmu) as instance:
        first = outputs(instance.initialize())
        instance.fmu.reset()
        second = outputs(changed(instance, CHANGES).initialize())
        assert second != first
        state = instance.fmu.getFMUState()
        instance.fmu.reset()
        # The modes are solved again, by another build than that of the command that exported: alike but for rounding.
        np.testing.assert_allclose(outputs(instance.initialize()), first, rtol=1e-9)
        instance.fmu.setFMUState(state)
        assert instance.get(*NAMES) == second and instance.get("g_xy") == [CHANGES["g_xy"]]

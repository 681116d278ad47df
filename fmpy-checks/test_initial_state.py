"""A panel that starts bent and moving: its free decay in closed form, with states as the page inside the FMU tells to set them."""

import zipfile

import numpy as np
import pytest
from conftest import BEAM, RESPONSES, ZETAS
from fmpy import simulate_fmu
from masters import OUTPUTS, REFUSED, panel
from modal_sum import free_motion

STEP, COUNT = 2e-5, 200
NAMES = [f"{output}_{port + 1}" for port in range(len(RESPONSES)) for output in OUTPUTS]
MODES = [(omega, 0.0, shape) for omega, shape in BEAM.rigid_modes()]
MODES += [(omega, zeta, shape) for (omega, shape), zeta in zip(BEAM.flexible_modes(len(ZETAS)), ZETAS)]
# Each mode starts with a displacement and a velocity of its own [m.kg^(1/2), m.kg^(1/2)/s].
POSITIONS = 1e-3 * np.array([3.0, -2.0, 1.0, 0.5, -0.7, 0.3, 0.2, -0.4])
VELOCITIES = 1e-2 * np.array([2.0, 1.0, 90.0, -300.0, 70.0, 500.0, -30.0, 800.0])
STATES = {f"modal_position_{n + 1}": value for n, value in enumerate(POSITIONS)}
STATES |= {f"modal_velocity_{n + 1}": value for n, value in enumerate(VELOCITIES)}
TOLERANCES = {"CoSimulation": 1e-9, "ModelExchange": 1e-6}


def shapes_told(fmu):
    """Each mode's shape at the responses, by directional derivatives: of ours but for the sign, which is the FMU's to choose."""
    with panel(fmu) as instance:
        instance.fmu.setupExperiment() if instance.version == 2 else None
        instance.fmu.enterInitializationMode()
        unknowns = [instance.references[f"displacement_{port + 1}"] for port in range(len(RESPONSES))]
        knowns = [instance.references[f"modal_position_{n + 1}"] for n in range(len(MODES))]
        told = np.array([instance.fmu.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns])
    ours = np.array([[shape(x) for x in RESPONSES] for _, _, shape in MODES])
    signs = np.sign(np.sum(told * ours, axis=1))[:, None]
    np.testing.assert_allclose(told, signs * ours, rtol=1e-7, atol=1e-9)
    return signs * ours


def decay(fmu, times):
    """Rows are displacement, velocity and acceleration of each port."""
    shapes = shapes_told(fmu)
    starts = list(zip(POSITIONS, VELOCITIES))
    of_port = lambda port: [(omega, zeta, shape[port]) for (omega, zeta, _), shape in zip(MODES, shapes)]
    return np.vstack([free_motion(of_port(port), starts, times) for port in range(len(RESPONSES))])


def far(found, expected):
    return np.max(np.abs(found - expected), axis=1) / np.max(np.abs(expected), axis=1)


@pytest.mark.parametrize("interface", TOLERANCES)
def test_start_values_of_the_states_give_the_free_decay(fmu, interface):
    """As an importer sets them: by name, with its other start values."""
    result = simulate_fmu(
        str(fmu), fmi_type=interface, start_values=STATES, output=NAMES, stop_time=STEP * COUNT, output_interval=STEP,
        relative_tolerance=1e-10,
    )
    found = np.array([result[name] for name in NAMES])
    error = far(found, decay(fmu, result["time"]))
    assert len(result) >= COUNT and np.all(error < TOLERANCES[interface]), error


def test_reset_forgets_the_initial_state_and_takes_a_new_one(fmu):
    still = np.zeros(COUNT)
    with panel(fmu) as instance:
        set_states(instance)
        first = instance.initialize().run(still, STEP)
        assert np.any(first)
        instance.fmu.reset()
        assert not np.any(instance.initialize().run(still, STEP))
        instance.fmu.reset()
        set_states(instance)
        assert np.array_equal(instance.initialize().run(still, STEP), first)


def test_states_set_in_co_simulation_after_the_start_are_refused(fmu):
    with panel(fmu) as instance:
        set_states(instance)
        instance.initialize()
        before = instance.get(*STATES)
        assert before == list(STATES.values())
        with pytest.raises(REFUSED):
            instance.set("modal_position_1", 1.0)
        assert "the initial state is set before or in initialization mode" in instance.messages[-1]
        assert instance.get(*STATES) == before


def test_the_page_inside_the_fmu_tells_how(fmu):
    with zipfile.ZipFile(fmu) as archive:
        page = archive.read("documentation/index.html").decode()
    assert "starts bent or moving" in page and all(name in page for name in STATES)


def test_parameters_may_be_set_before_the_states_or_after(fmu):
    """Both stay as set: modal coordinates of the panel that is solved anew."""
    runs = []
    for calls in ((set_states, set_size), (set_size, set_states)):
        with panel(fmu) as instance:
            for call in calls:
                call(instance)
            instance.initialize()
            assert instance.get(*STATES, "length") == [*STATES.values(), 0.9]
            runs.append(instance.run(np.zeros(COUNT), STEP))
    assert np.array_equal(*runs)


def set_states(instance):
    for name, value in STATES.items():
        instance.set(name, value)


def set_size(instance):
    instance.set("length", 0.9)

"""Each capability flag of the XML against what the FMU does."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from conftest import BEAM, FORCES, RESPONSES, ZETAS
from masters import REFUSED, panel
from modal_sum import modes_at

STEP = 1e-4
RUN = np.cos(0.2 * np.arange(40))
OUTPUTS = ["acceleration_1", "velocity_1", "displacement_1", "acceleration_2", "velocity_2", "displacement_2"]


@pytest.fixture(params=[False, True], ids=["co-simulation", "model exchange"])
def running(request, fmu):
    """Under way, with states that are not zero: by steps, or set at the start."""
    with panel(fmu, model_exchange=request.param) as instance:
        if request.param:
            states = {f"modal_{word}_{n + 1}": 1e-6 * (n + 1) for word in ("position", "velocity") for n in range(8)}
            for name, value in states.items():
                instance.set(name, value)
            instance.initialize()
            instance.set("force_1", 2.0)
        else:
            instance.initialize().run(RUN, STEP)
        yield instance


def flag(instance, name):
    """What the XML says of the interface in use; the versions differ in a plural and in one capital."""
    interface = "CoSimulation" if hasattr(instance.fmu, "doStep") else "ModelExchange"
    attributes = ElementTree.parse(Path(instance.folder) / "modelDescription.xml").find(interface).attrib
    if instance.version == 3:
        name = name.replace("FMUstate", "FMUState").replace("Derivative", "Derivatives", 1)
        name = name.replace("DerivativesOrder", "DerivativeOrder")
    return attributes[name]


def continued(instance, start):
    """What comes next: the outputs after some steps or, where there are none, now."""
    if hasattr(instance.fmu, "doStep"):
        for n, force in enumerate((3.0, -1.0, 0.5)):
            instance.set("force_2", force)
            instance.step(start + n * STEP, STEP)
    return instance.get(*OUTPUTS, "force_1", "force_2")


def test_fmu_states_bring_an_instance_back(running):
    assert flag(running, "canGetAndSetFMUstate") == "true"
    time = running.get("time")[0]
    state = running.fmu.getFMUState()
    first = continued(running, time)
    running.set("force_1", 9.0)
    for _ in range(2):
        running.fmu.setFMUState(state)
        assert running.get("time")[0] == time
        assert continued(running, time) == first
    running.fmu.freeFMUState(state)


def test_fmu_states_of_others_are_refused(running, fmu):
    state = running.fmu.getFMUState()
    with panel(fmu) as other:
        other.initialize()
        with pytest.raises(REFUSED):
            other.fmu.setFMUState(state)
        assert "serializing" in other.messages[-1]
    kept = type(state)(state.value)
    running.fmu.freeFMUState(state)
    with pytest.raises(REFUSED):
        running.fmu.setFMUState(kept)
    assert "it was freed" in running.messages[-1]


def test_serialized_states_move_to_another_instance(running, fmu):
    assert flag(running, "canSerializeFMUstate") == "true"
    time = running.get("time")[0]
    content = running.fmu.serializeFMUState(running.fmu.getFMUState())
    expected = continued(running, time)
    with panel(fmu, model_exchange=not hasattr(running.fmu, "doStep")) as other:
        other.fmu.setFMUState(other.fmu.deserializeFMUState(content))
        assert continued(other, time) == expected


def test_damaged_or_foreign_bytes_are_refused(running, export):
    content = running.fmu.serializeFMUState(running.fmu.getFMUState())
    before = running.get(*OUTPUTS)
    damaged = [b"", content[:-1], content + b"\0", b"x" * len(content)]
    for at in range(0, len(content), 7):
        damaged.append(content[:at] + bytes([content[at] ^ 0x10]) + content[at + 1 :])
    for wrong in damaged:
        with pytest.raises(REFUSED):
            running.fmu.deserializeFMUState(wrong)
        assert "FMU state: the bytes are" in running.messages[-1]
    assert running.get(*OUTPUTS) == before
    with panel(export("other.fmu", "--fmi", str(running.version), modes=2)) as other:
        with pytest.raises(REFUSED):
            other.fmu.deserializeFMUState(content)
        assert "another panel" in other.messages[-1]


def partial_derivatives(instance, unknowns, knowns):
    references = [[instance.references[name] for name in names] for names in (unknowns, knowns)]
    unit = np.eye(len(knowns))
    return np.array([instance.fmu.getDirectionalDerivative(*references, list(seed)) for seed in unit]).T


def test_directional_derivatives_by_forces_are_sums_over_shapes(running):
    assert flag(running, "providesDirectionalDerivative") == "true"
    forces = [f"force_{n + 1}" for n in range(len(FORCES))]
    found = partial_derivatives(running, OUTPUTS, forces)
    for row, name in enumerate(OUTPUTS):
        port = int(name[-1]) - 1
        for column, force in enumerate(FORCES):
            direct = name.startswith("acceleration")
            expected = sum(w for _, _, w in modes_at(BEAM, ZETAS, force, RESPONSES[port])) if direct else 0.0
            assert found[row, column] == pytest.approx(expected, rel=1e-7, abs=1e-9)


def test_directional_derivatives_by_states_are_differences(fmu):
    """The panel is linear: a difference of any size is exact."""
    count = 2 + len(ZETAS)
    knowns = [f"modal_{word}_{n + 1}" for n in range(count) for word in ("position", "velocity")]
    unknowns = OUTPUTS + [f"der({name})" for name in knowns]
    with panel(fmu) as instance:
        instance.fmu.setupExperiment() if instance.version == 2 else None
        instance.fmu.enterInitializationMode()
        found = partial_derivatives(instance, unknowns, knowns)
        for column, known in enumerate(knowns):
            instance.set(known, 1.0)
            np.testing.assert_allclose(found[:, column], instance.get(*unknowns), rtol=1e-14)
            instance.set(known, 0.0)


def test_adjoint_derivatives_are_the_transpose(export):
    with panel(export("v3.fmu", "--fmi", "3")) as instance:
        assert flag(instance, "providesAdjointDerivative") == "true"
        instance.initialize().run(RUN, STEP)
        knowns = ["force_1", "force_4", "modal_position_3", "modal_velocity_5"]
        matrix = partial_derivatives(instance, OUTPUTS, knowns)
        seed = [0.5, -1.0, 2.0, 0.25, 3.0, -0.75]
        references = [[instance.references[name] for name in names] for names in (OUTPUTS, knowns)]
        found = instance.fmu.getAdjointDerivative(*references, seed, len(knowns))
        np.testing.assert_allclose(found, matrix.T @ seed, rtol=1e-12)


@pytest.mark.parametrize(
    "unknown, known", [("force_1", "force_2"), ("acceleration_1", "velocity_1"), ("time", "force_1")]
)
def test_derivatives_that_are_none_are_refused(running, unknown, known):
    with pytest.raises(REFUSED):
        running.fmu.getDirectionalDerivative([running.references[unknown]], [running.references[known]], [1.0])
    assert "has no such derivative" in running.messages[-1]


def output_derivatives(instance, names):
    get = instance.fmu.getRealOutputDerivatives if instance.version == 2 else instance.fmu.getOutputDerivatives
    return get([instance.references[name] for name in names], [1] * len(names))


def test_output_derivatives_are_slopes_of_the_outputs(fmu):
    """Along the force of the last step: differences over a short step behind and ahead, the same slope on both."""
    short = 1e-9
    with panel(fmu) as instance:
        assert flag(instance, "maxOutputDerivativeOrder") == "1"
        instance.initialize(force_linear=True).run(RUN, STEP)
        time = len(RUN) * STEP
        slope = 5e3
        motions = []
        for n in range(3):
            instance.set("force_1", RUN[-1] + slope * short * n)
            instance.step(time + short * n, short)
            motions.append(instance.get(*OUTPUTS))
            if n == 1:
                found = output_derivatives(instance, OUTPUTS)
        expected = (np.array(motions[2]) - motions[0]) / (2.0 * short)
        # Rounding in the outputs, 1e-16 of them over the step, sets the limit.
        scale = np.abs(motions[1]) * 1e-15 / short
        np.testing.assert_array_less(np.abs(np.array(found) - expected), 1e-5 * np.abs(expected) + 10.0 * scale)


def test_output_derivatives_of_another_order_are_refused(fmu):
    with panel(fmu) as instance:
        instance.initialize()
        get = instance.fmu.getRealOutputDerivatives if instance.version == 2 else instance.fmu.getOutputDerivatives
        with pytest.raises(REFUSED):
            get([instance.references["velocity_1"]], [2])
        assert "maxOutputDerivativeOrder = 1" in instance.messages[-1]


def test_steps_of_any_size_follow_each_other(fmu):
    with panel(fmu) as instance:
        assert flag(instance, "canHandleVariableCommunicationStepSize") == "true"
        instance.initialize().set("force_1", 1.0)
        time = 0.0
        for size in (1e-5, 3e-4, 2e-6, 1e-3):
            instance.step(time, size)
            time += size
        found = instance.get(*OUTPUTS)
    with panel(fmu) as instance:
        instance.initialize().set("force_1", 1.0)
        instance.step(0.0, time)
        np.testing.assert_allclose(found, instance.get(*OUTPUTS), rtol=1e-11)


def test_what_the_flags_deny_is_refused(fmu):
    denied = {
        2: {"canRunAsynchronuously": "fmi2CancelStep"},
        3: {"hasEventMode": "fmi3EnterStepMode", "providesEvaluateDiscreteStates": "fmi3EvaluateDiscreteStates"},
    }
    with panel(fmu) as instance:
        instance.initialize()
        for name, function in denied[instance.version].items():
            assert flag(instance, name) == "false"
            assert instance.call((function, function)) == 3
            assert f"not offered: modelDescription.xml says {name} = false" in instance.messages[-1]

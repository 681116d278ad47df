"""Calls that a careless importer makes: an error, a message, the host alive, the state as before."""

import ctypes
import json

import numpy as np
import pytest
from fmpy import extract
from masters import REFUSED, Panel, panel

FORCES = np.cos(0.2 * np.arange(50))
STEP = 1e-4


def refused(instance, call, message):
    """The call fails, says why, and changes nothing."""
    names = ["acceleration_1", "velocity_1", "displacement_1", "force_1"]
    before = instance.get(*names)
    instance.messages.clear()
    with pytest.raises(REFUSED):
        call()
    assert any(message in text for text in instance.messages), instance.messages
    assert instance.get(*names) == before


@pytest.fixture
def running(fmu):
    with panel(fmu) as instance:
        instance.initialize(stop_time=1.0).run(FORCES, STEP)
        yield instance


def real(instance):
    kind = "Real" if instance.version == 2 else "Float64"
    return getattr(instance.fmu, f"get{kind}"), getattr(instance.fmu, f"set{kind}")


def test_unknown_references(running):
    get, set_ = real(running)
    refused(running, lambda: get([9999]), "no such variable")
    refused(running, lambda: set_([running.references["force_1"], 9999], [5.0, 5.0]), "no such variable")


def test_variables_of_another_type_or_not_settable(running):
    get, set_ = real(running)
    refused(running, lambda: get([running.references["force_linear"]]), "is a Boolean")
    refused(running, lambda: running.fmu.getBoolean([running.references["force_1"]]), "is a Real")
    refused(running, lambda: running.set("acceleration_1", 1.0), "it is an output")
    refused(running, lambda: running.set("time", 1.0), "time follows the steps")
    refused(running, lambda: running.fmu.setBoolean([running.references["force_linear"]], [True]), "fixed parameter")


@pytest.mark.parametrize("force", [float("nan"), float("inf"), float("-inf")])
def test_forces_that_are_no_numbers(running, force):
    refused(running, lambda: running.set("force_1", force), "must be a finite number")


@pytest.mark.parametrize("step", [0.0, -1e-3, float("nan"), float("inf")])
def test_steps_that_are_none(running, step):
    refused(running, lambda: running.step(len(FORCES) * STEP, step), "step =")


def test_steps_from_elsewhere_or_past_the_stop_time(running):
    now = len(FORCES) * STEP
    refused(running, lambda: running.step(now + 1e-3, STEP), "communication point")
    refused(running, lambda: running.step(float("nan"), STEP), "communication point")
    refused(running, lambda: running.step(now, 2.0), "stop time")


def test_calls_in_the_wrong_order(fmu):
    with panel(fmu) as instance:
        for call in (lambda: instance.step(0.0, STEP), lambda: instance.get("time"), instance.fmu.terminate):
            with pytest.raises(REFUSED):
                call()
            assert "not allowed in the state instantiated" in instance.messages[-1]
        instance.initialize()
        refused(instance, instance.fmu.enterInitializationMode, "not allowed in the state step mode")
        instance.fmu.terminate()
        with pytest.raises(REFUSED):
            instance.step(0.0, STEP)
        assert "not allowed in the state terminated" in instance.messages[-1]


def test_null_pointers(running):
    library, component = running.fmu.dll, ctypes.c_void_p(running.fmu.component)
    two = running.version == 2
    name = "fmi2GetReal" if two else "fmi3GetFloat64"
    last = () if two else (ctypes.c_size_t(1),)
    get = getattr(library, name)
    reference = (ctypes.c_uint32 * 1)(running.references["force_1"])
    value = (ctypes.c_double * 1)()
    error = 3
    assert get(None, reference, ctypes.c_size_t(1), value, *last) == error
    assert get(component, None, ctypes.c_size_t(1), value, *last) == error
    assert get(component, reference, ctypes.c_size_t(1), None, *last) == error
    assert get(component, reference, ctypes.c_size_t(1), value, *last) == 0
    assert value[0] == FORCES[-1]


def test_what_is_not_offered_says_so(running):
    assert running.call(("fmi2CancelStep", "fmi3EnterConfigurationMode")) == 3
    assert "not offered: modelDescription.xml says" in running.messages[-1]


def test_input_derivatives_of_another_order(fmu2):
    with panel(fmu2) as instance:
        instance.initialize()
        reference = instance.references["force_1"]
        refused(instance, lambda: instance.fmu.setRealInputDerivatives([reference], [2], [1.0]), "order 1 only")
        refused(
            instance, lambda: instance.fmu.setRealInputDerivatives([reference], [1], [float("nan")]), "finite number"
        )


def shift_a_frequency(resource):
    content = json.loads(resource.read_text())
    content["model"]["modes"][3]["angular_frequency"] += 1.0
    resource.write_text(json.dumps(content))


@pytest.mark.parametrize(
    "guid, damage, message",
    [
        ("{00000000-0000-0000-0000-000000000000}", lambda resource: None, "the importer's token"),
        (None, shift_a_frequency, "the file is damaged"),
        (None, lambda resource: resource.write_bytes(b"\xff\x00{"), "the file is damaged"),
        (None, lambda resource: resource.unlink(), "unpack the FMU with its resources/ folder"),
    ],
    ids=["foreign token", "another number", "no JSON", "missing"],
)
def test_a_foreign_token_and_damaged_or_missing_resources(fmu, tmp_path, guid, damage, message):
    extract(str(fmu), unzipdir=str(tmp_path))
    damage(tmp_path / "resources" / "panel.json")
    messages = []
    with pytest.raises(Exception, match="Failed to instantiate"):
        Panel(tmp_path, guid=guid, messages=messages)
    assert len(messages) == 1 and message in messages[0], messages


def test_reset_gives_the_same_run_again(fmu):
    with panel(fmu) as instance:
        first = instance.initialize().run(FORCES, STEP)
        instance.fmu.reset()
        assert np.array_equal(instance.initialize().run(FORCES, STEP), first)
        instance.fmu.terminate()
        instance.fmu.reset()
        assert np.array_equal(instance.initialize().run(FORCES, STEP), first)


def test_instances_do_not_know_each_other(fmu):
    with panel(fmu) as alone:
        expected = alone.initialize().run(FORCES, STEP)
    with panel(fmu) as one, panel(fmu) as other:
        one.initialize()
        other.initialize()
        for n, force in enumerate(FORCES):
            one.set("force_1", force)
            other.set("force_1", -3.0 * force)
            one.step(n * STEP, STEP)
            other.step(n * STEP, STEP)
            assert one.get("displacement_1")[0] == expected[0, n]
        assert other.get("displacement_1")[0] == pytest.approx(-3.0 * expected[0, -1], rel=1e-12)


def test_an_instance_may_be_freed_at_any_time(fmu):
    panel_ = Panel(fmu)
    panel_.close()
    panel_ = Panel(fmu)
    panel_.initialize().run(FORCES[:3], STEP)
    panel_.close()


@pytest.mark.parametrize("name", ["plain", "with blank", "50% of it", "ünï-板", "a%20b", "hash#and?mark"])
def test_any_folder_will_do(fmu, tmp_path, name):
    folder = tmp_path / name
    extract(str(fmu), unzipdir=str(folder))
    with panel(folder) as instance:
        motion = instance.initialize().run(FORCES, STEP)
    assert np.all(np.isfinite(motion)) and np.any(motion != 0.0)


def test_events_are_logged_when_asked_for(fmu):
    with panel(fmu, logging=True) as instance:
        instance.initialize()
        assert instance.messages == ["instantiated", "initialization begins", "initialized"]
    with panel(fmu) as instance:
        instance.initialize()
        assert instance.messages == []

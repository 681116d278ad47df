"""FMI 3.0 with `--arrays`: one variable for all forces, one for each kind of output; the same motion as with scalars."""

import numpy as np
import pytest
from conftest import FORCES, RESPONSES
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from masters import OUTPUTS, REFUSED, panel

STEP = 1e-4
PUSHES = np.cos(0.3 * np.arange(40)[:, None] + np.arange(len(FORCES)))


@pytest.fixture(scope="module")
def scalars(export):
    return export("scalars.fmu", "--fmi", "3")


@pytest.fixture(scope="module")
def arrays(export):
    return export("arrays.fmu", "--fmi", "3", "--arrays")


def get(instance, name, count):
    return np.array(instance.fmu.getFloat64([instance.references[name]], nValues=count))


def test_fmpy_finds_no_problem_and_the_sizes(arrays):
    assert validate_fmu(str(arrays)) == []
    variables = {v.name: v for v in read_model_description(str(arrays)).modelVariables}
    sizes = {"force": len(FORCES)} | {name: len(RESPONSES) for name in OUTPUTS}
    for name, size in sizes.items():
        assert [int(dimension.start) for dimension in variables[name].dimensions] == [size]
        assert f"{name}_1" not in variables


def test_dependencies_are_those_of_all_elements(arrays):
    outputs = {u.variable.name: u for u in read_model_description(str(arrays)).outputs}
    assert set(outputs) == set(OUTPUTS)
    for name, direct in (("acceleration", True), ("velocity", False), ("displacement", False)):
        assert ("force" in {v.name for v in outputs[name].dependencies}) == direct


def test_arrays_move_as_scalars_do(arrays, scalars):
    with panel(arrays) as whole, panel(scalars) as single:
        whole.initialize(), single.initialize()
        for n, push in enumerate(PUSHES):
            whole.fmu.setFloat64([whole.references["force"]], list(push))
            for port, force in enumerate(push):
                single.set(f"force_{port + 1}", force)
            whole.step(n * STEP, STEP), single.step(n * STEP, STEP)
            for name in OUTPUTS:
                expected = single.get(*(f"{name}_{port + 1}" for port in range(len(RESPONSES))))
                assert list(get(whole, name, len(RESPONSES))) == expected
        assert list(get(whole, "force", len(FORCES))) == list(PUSHES[-1])


def test_derivatives_hold_an_entry_for_each_element(arrays, scalars):
    with panel(arrays) as whole, panel(scalars) as single:
        whole.initialize(), single.initialize()
        unknown, known = whole.references["acceleration"], whole.references["force"]
        seed = list(PUSHES[1])
        found = whole.fmu.getDirectionalDerivative([unknown], [known], seed, nSensitivity=len(RESPONSES))
        expected = single.fmu.getDirectionalDerivative(
            [single.references[f"acceleration_{n + 1}"] for n in range(len(RESPONSES))],
            [single.references[f"force_{n + 1}"] for n in range(len(FORCES))],
            seed,
        )
        assert list(found) == list(expected)


def test_wrong_numbers_of_values_and_single_elements_are_refused(arrays):
    with panel(arrays) as whole:
        whole.initialize()
        reference = whole.references["force"]
        for values in ([1.0], [1.0] * (len(FORCES) + 1)):
            with pytest.raises(REFUSED):
                whole.fmu.setFloat64([reference], values)
        # References count on over the arrays: the next is that of the outputs, and none is left for an element.
        with pytest.raises(REFUSED):
            whole.fmu.setFloat64([reference + 1], [1.0] * len(RESPONSES))
        assert "acceleration_1" in whole.messages[-1] and "output" in whole.messages[-1]
        last = max(whole.references.values())
        with pytest.raises(REFUSED):
            whole.fmu.getFloat64([last + 1], nValues=1)
        assert f"no such variable; references run from 1 to {last}" in whole.messages[-1]
        assert not np.any(get(whole, "force", len(FORCES)))

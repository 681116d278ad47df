"""Each capability flag of the standard, tried out: a probe answers as the flag ought to read.

A probe takes the FMU and the element of the XML, and looks only at what the FMU does. Where something works, its numbers
are held against the closed form; where it is refused, the message must quote the flag.
"""

import ctypes
import os

import numpy as np
from conftest import BEAM, FORCES, RESPONSES, ZETAS
from fmpy.fmi2 import fmi2CallbackAllocateMemoryTYPE, fmi2CallbackFreeMemoryTYPE, fmi2StepFinishedTYPE
from masters import OUTPUTS, REFUSED, panel
from modal_sum import modes_at, ramp, staircase

STEP = 1e-5
FORCE = np.cos(0.2 * np.arange(30))
MODES = modes_at(BEAM, ZETAS, FORCES[0], RESPONSES[0])
MOTION = [f"{output}_1" for output in OUTPUTS]
TRUE, FALSE = "true", "false"
ERROR, PENDING = 3, 5
# Velocity and acceleration.
EXPECTED = staircase(MODES, FORCE, STEP)[1:]


def started(fmu, interface, **options):
    return panel(fmu, model_exchange=interface == "ModelExchange", **options)


def close(found, expected, share):
    return np.max(np.abs(np.array(found) - expected)) <= share * np.max(np.abs(expected))


class Run:
    """The forces of `FORCE`, each held for a step, by the interface in use; what an instance has done so far."""

    def __init__(self, instance, completed=False):
        self.instance, self.completed, self.motion = instance, completed, []
        instance.initialize()
        if not hasattr(instance.fmu, "doStep"):
            events = instance.fmu.newDiscreteStates if instance.version == 2 else instance.fmu.updateDiscreteStates
            events(), instance.fmu.enterContinuousTimeMode()

    def go(self, count):
        for n in range(len(self.motion), len(self.motion) + count):
            self.instance.set("force_1", FORCE[n])
            advance = self.instance.step if hasattr(self.instance.fmu, "doStep") else self.integrate
            advance(n * STEP, STEP)
            self.motion.append(self.instance.get(*MOTION[1:]))
        return self

    def integrate(self, start, step, parts=8):
        """Runge-Kutta of fourth order, over the states of model exchange."""
        h = step / parts
        for n in range(parts):
            x = self.states("GetContinuousStates")
            k1 = self.rate(x, start + n * h)
            k2 = self.rate(x + k1 * h / 2, start + n * h + h / 2)
            k3 = self.rate(x + k2 * h / 2, start + n * h + h / 2)
            k4 = self.rate(x + k3 * h, start + n * h + h)
            self.rate(x + (k1 + 2 * k2 + 2 * k3 + k4) * h / 6, start + n * h + h)
            if self.completed:
                assert self.instance.fmu.completedIntegratorStep() == (False, False)

    def states(self, call, values=None):
        count = 2 * len(MODES)
        array = (ctypes.c_double * count)(*([0.0] * count if values is None else values))
        assert self.instance.call(("fmi2" + call, "fmi3" + call), array, ctypes.c_size_t(count)) == 0
        return np.array(array)

    def rate(self, x, time):
        self.instance.fmu.setTime(time)
        self.states("SetContinuousStates", x)
        return self.states("GetDerivatives" if self.instance.version == 2 else "GetContinuousStateDerivatives")

    def right(self):
        share = 1e-9 if hasattr(self.instance.fmu, "doStep") else 1e-5
        return len(self.motion) == len(FORCE) and all(
            close(row, expected, share) for row, expected in zip(np.array(self.motion).T, EXPECTED))


def works(instance, **options):
    return Run(instance, **options).go(len(FORCE)).right()


def denied(instance, flag, function, *arguments):
    """`false` where the call is refused and the flag quoted; `true` where it passes."""
    status = instance.call((function, function), *arguments)
    quoted = f"not offered: modelDescription.xml says {flag} = false"
    assert status == 0 or (status == ERROR and quoted in instance.messages[-1]), (status, instance.messages)
    return TRUE if status == 0 else FALSE


def tells(right):
    """A capability that is there, but wrong, is neither."""
    return TRUE if right else "wrong numbers"


def needs_execution_tool(fmu, interface):
    """`false`: it works without a process beside this one, and with no program to be found."""
    children = lambda: sorted(open(f"/proc/self/task/{task}/children").read() for task in os.listdir("/proc/self/task"))
    before, path = children(), os.environ.pop("PATH", "")
    try:
        with started(fmu, interface) as instance:
            return FALSE if works(instance) and children() == before else TRUE
    finally:
        os.environ["PATH"] = path


def completed_step_needed(fmu, interface):
    with started(fmu, interface) as silent, started(fmu, interface) as told:
        assert works(told, completed=True)
        return FALSE if works(silent) else TRUE


def completed_step_not_needed(fmu, interface):
    return TRUE if completed_step_needed(fmu, interface) == FALSE else FALSE


def only_once(fmu, interface):
    """`false`: two by turns, and a third of the other interface beside them, are all right."""
    other = "CoSimulation" if interface == "ModelExchange" else "ModelExchange"
    with started(fmu, interface) as one, started(fmu, interface) as two, started(fmu, other) as three:
        runs = [Run(instance) for instance in (one, two, three)]
        for _ in FORCE:
            for run in runs:
                run.go(1)
        return FALSE if all(run.right() for run in runs) else TRUE


def no_memory_functions(fmu, interface):
    """`true`: the importer's memory functions are never called, and may be missing."""
    calls = []
    options = {
        "allocateMemory": fmi2CallbackAllocateMemoryTYPE(lambda *_: calls.append("allocate")),
        "freeMemory": fmi2CallbackFreeMemoryTYPE(lambda *_: calls.append("free")),
    }
    for given in ({}, options):
        with started(fmu, interface, **given) as instance:
            assert works(instance)
            instance.fmu.freeFMUState(instance.fmu.getFMUState())
    return FALSE if calls else TRUE


def get_and_set_state(fmu, interface):
    with started(fmu, interface) as instance:
        run = Run(instance).go(10)
        try:
            state = instance.fmu.getFMUState()
        except REFUSED:
            return FALSE
        run.go(15)
        instance.fmu.setFMUState(state)
        del run.motion[10:]
        return tells(run.go(20).right())


def serialize_state(fmu, interface):
    with started(fmu, interface) as instance, started(fmu, interface) as other:
        run = Run(instance).go(10)
        try:
            content = instance.fmu.serializeFMUState(instance.fmu.getFMUState())
        except REFUSED:
            return FALSE
        run.instance = other
        other.fmu.setFMUState(other.fmu.deserializeFMUState(content))
        return tells(run.go(20).right())


def sensitivity(instance, unknowns, knowns):
    references = [[instance.references[name] for name in names] for names in (unknowns, knowns)]
    unit = np.eye(len(knowns))
    return np.array([instance.fmu.getDirectionalDerivative(*references, list(seed)) for seed in unit]).T


def directional_derivatives(fmu, interface):
    """By all forces while it runs, and by all states in initialization mode, against differences, exact for a linear panel."""
    rates = [f"der(modal_{word}_{n + 1})" for n in range(len(MODES)) for word in ("position", "velocity")]
    states = [name[4:-1] for name in rates]
    forces = [f"force_{n + 1}" for n in range(len(FORCES))]
    with started(fmu, interface) as instance:
        try:
            instance.fmu.setupExperiment() if instance.version == 2 else None
            instance.fmu.enterInitializationMode()
            right = [by_differences(instance, MOTION + rates, states)]
            instance.fmu.exitInitializationMode()
            right.append(by_differences(instance, MOTION + rates, forces))
        except REFUSED:
            return FALSE
    return tells(all(right))


def by_differences(instance, unknowns, knowns):
    found = sensitivity(instance, unknowns, knowns)
    start, differences = np.array(instance.get(*unknowns)), []
    for known in knowns:
        before = instance.get(known)[0]
        instance.set(known, before + 1.0)
        differences.append(np.array(instance.get(*unknowns)) - start)
        instance.set(known, before)
    differences = np.array(differences).T
    return np.any(differences) and np.allclose(found, differences, rtol=1e-9, atol=1e-12 * np.max(np.abs(differences)))


def adjoint_derivatives(fmu, interface):
    knowns = ["force_1", "force_4", "modal_position_3", "modal_velocity_5"]
    seed = [0.5, -1.0, 2.0]
    with started(fmu, interface) as instance:
        instance.initialize()
        references = [[instance.references[name] for name in names] for names in (MOTION, knowns)]
        try:
            found = instance.fmu.getAdjointDerivative(*references, seed, len(knowns))
        except REFUSED:
            return FALSE
        return tells(np.allclose(found, sensitivity(instance, MOTION, knowns).T @ seed, rtol=1e-12))


def per_element_dependencies(fmu, interface):
    with started(fmu, interface) as instance:
        instance.initialize()
        acceleration, count = ctypes.c_uint32(instance.references["acceleration_1"]), ctypes.c_size_t()
        function = "fmi3GetNumberOfVariableDependencies"
        return denied(instance, "providesPerElementDependencies", function, acceleration, ctypes.byref(count))


def evaluate_discrete_states(fmu, interface):
    """Asked for where the standard has it: in event mode, which co-simulation without events never enters."""
    with started(fmu, interface) as instance:
        instance.initialize()
        return denied(instance, "providesEvaluateDiscreteStates", "fmi3EvaluateDiscreteStates")


def variable_step(fmu, interface):
    """Steps of 1, 3, 2, 7 ... base steps; the force changes with the step."""
    sizes = [1, 3, 2, 7, 1, 5, 11]
    levels = [1.0, -0.5, 2.0, 0.25, 3.0, -1.0, 0.7]
    expected = staircase(MODES, np.repeat(levels, sizes), STEP)[1:, np.cumsum(sizes) - 1]
    found, start = [], 0
    with started(fmu, interface) as instance:
        instance.initialize()
        for size, level in zip(sizes, levels):
            instance.set("force_1", level)
            try:
                instance.step(start * STEP, size * STEP)
            except REFUSED:
                return FALSE
            start += size
            found.append(instance.get(*MOTION[1:]))
    return tells(all(close(row, known, 1e-9) for row, known in zip(np.array(found).T, expected)))


def fixed_internal_step(fmu, interface):
    """None: one step of any size is exact, sizes without a common measure too."""
    for size in (1e-6, np.e * 1e-5, np.pi * 1e-4):
        with started(fmu, interface) as instance:
            instance.initialize().set("force_1", 1.0)
            instance.step(0.0, size)
            if not close(instance.get(*MOTION[1:]), staircase(MODES, [1.0], size)[1:, 0], 1e-9):
                return "some step"
    return None


def interpolate_inputs(fmu, interface):
    """A force that grows over a step by its derivative, and then stays."""
    duration, rate, later = 2e-4, 5e3, 3e-4
    found = []
    with started(fmu, interface) as instance:
        instance.initialize()
        try:
            instance.fmu.setRealInputDerivatives([instance.references["force_1"]], [1], [rate])
        except REFUSED:
            return FALSE
        for start, size in ((0.0, duration), (duration, later)):
            instance.step(start, size)
            found.append(instance.get(*MOTION[1:]))
    expected = ramp(MODES, rate, duration, np.array([duration, duration + later]))[1:]
    return tells(all(close(row, known, 1e-9) for row, known in zip(np.array(found).T, expected)))


def output_derivative_order(fmu, interface):
    """The highest order answered: under a held force a displacement's first is the velocity, a velocity's the acceleration."""
    with started(fmu, interface) as instance:
        Run(instance).go(len(FORCE))
        get = instance.fmu.getRealOutputDerivatives if instance.version == 2 else instance.fmu.getOutputDerivatives
        order = 0
        while order < 9:
            try:
                found = get([instance.references[name] for name in MOTION[:2]], [order + 1] * 2)
            except REFUSED:
                assert f"maxOutputDerivativeOrder = {order}" in instance.messages[-1]
                return str(order)
            order += 1
            if order == 1 and not close(found, EXPECTED[:, -1], 1e-9):
                return "wrong numbers"
        return str(order)


def run_asynchronously(fmu, interface):
    finished = []
    callback = fmi2StepFinishedTYPE(lambda *_: finished.append(True))
    with started(fmu, interface, stepFinished=callback) as instance:
        instance.initialize()
        status = instance.call(("fmi2DoStep", ""), ctypes.c_double(0.0), ctypes.c_double(STEP), 1)
        if status == PENDING or finished:
            return TRUE
        return denied(instance, "canRunAsynchronuously", "fmi2CancelStep")


def early(fmu, interface, **options):
    """What steps tell of how far they went, and the calls of an intermediate update that asks to return early."""
    updates, steps = [], []

    def update(environment, time, *arguments):
        updates.append(time)
        arguments[-2][0], arguments[-1][0] = True, time

    with started(fmu, interface, intermediateUpdate=update, earlyReturnAllowed=True) as instance:
        instance.initialize()
        for n, force in enumerate(FORCE):
            instance.set("force_1", force)
            event, end, returned, reached = instance.fmu.doStep(n * STEP, STEP)
            assert not end and (returned or reached == n * STEP + STEP)
            steps.append((event, returned))
    return updates, steps


def intermediate_update(fmu, interface):
    updates, _ = early(fmu, interface)
    messages, wanted = [], [0]
    try:
        with started(fmu, interface, messages=messages, requiredIntermediateVariables=wanted):
            return TRUE
    except Exception:
        assert "modelDescription.xml says providesIntermediateUpdate = false" in messages[-1]
    return TRUE if updates else FALSE


def intermediate_smoothness(fmu, interface):
    """Of inputs that are set in an intermediate update: the standard's usual value, as there is none."""
    updates, _ = early(fmu, interface)
    return "some" if updates else "0"


def might_return_early(fmu, interface):
    _, steps = early(fmu, interface)
    return TRUE if any(returned for _, returned in steps) else FALSE


def return_after_update(fmu, interface):
    updates, steps = early(fmu, interface)
    return TRUE if updates and any(returned for _, returned in steps) else FALSE


def event_mode(fmu, interface):
    _, steps = early(fmu, interface)
    assert not any(event for event, _ in steps)
    messages = []
    try:
        with started(fmu, interface, messages=messages, eventModeUsed=True):
            return TRUE
    except Exception:
        assert "modelDescription.xml says hasEventMode = false" in messages[-1]
    with started(fmu, interface) as instance:
        instance.initialize()
        assert instance.call(("", "fmi3EnterEventMode")) == ERROR
        return denied(instance, "hasEventMode", "fmi3EnterStepMode")


PROBES = {
    "needsExecutionTool": needs_execution_tool,
    "completedIntegratorStepNotNeeded": completed_step_not_needed,
    "needsCompletedIntegratorStep": completed_step_needed,
    "canBeInstantiatedOnlyOncePerProcess": only_once,
    "canNotUseMemoryManagementFunctions": no_memory_functions,
    "canGetAndSetFMUstate": get_and_set_state,
    "canGetAndSetFMUState": get_and_set_state,
    "canSerializeFMUstate": serialize_state,
    "canSerializeFMUState": serialize_state,
    "providesDirectionalDerivative": directional_derivatives,
    "providesDirectionalDerivatives": directional_derivatives,
    "providesAdjointDerivatives": adjoint_derivatives,
    "providesPerElementDependencies": per_element_dependencies,
    "providesEvaluateDiscreteStates": evaluate_discrete_states,
    "canHandleVariableCommunicationStepSize": variable_step,
    "fixedInternalStepSize": fixed_internal_step,
    "canInterpolateInputs": interpolate_inputs,
    "maxOutputDerivativeOrder": output_derivative_order,
    "canRunAsynchronuously": run_asynchronously,
    "providesIntermediateUpdate": intermediate_update,
    "recommendedIntermediateInputSmoothness": intermediate_smoothness,
    "mightReturnEarlyFromDoStep": might_return_early,
    "canReturnEarlyAfterIntermediateUpdate": return_after_update,
    "hasEventMode": event_mode,
}

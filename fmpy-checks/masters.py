"""A master of a few lines for both versions and both interfaces, over FMPy's bindings."""

import contextlib
import ctypes
import shutil

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Model, FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Model, FMU3Slave

REFUSED = FMICallException
OUTPUTS = ("displacement", "velocity", "acceleration")


class Panel:
    """One instance, driven by names.

    `fmu` is the file, or the folder where it was unpacked; `model_exchange` chooses that interface in place of
    co-simulation; `messages` keeps what the logger was told. `options` are further callbacks of FMI 2.0, or further
    arguments of an instantiation of FMI 3.0.
    """

    def __init__(self, fmu, guid=None, logging=False, messages=None, model_exchange=False, **options):
        self.description = read_model_description(str(fmu))
        self.version = int(self.description.fmiVersion[0])
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.temporary = not fmu.is_dir()
        self.folder = extract(str(fmu)) if self.temporary else str(fmu)
        self.messages = [] if messages is None else messages
        kinds = {2: FMU2Model, 3: FMU3Model} if model_exchange else {2: FMU2Slave, 3: FMU3Slave}
        kind = kinds[self.version]
        self.fmu = kind(
            guid=self.description.guid if guid is None else guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="panel",
        )
        if self.version == 2:
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = fmi2CallbackLoggerTYPE(
                lambda environment, name, status, category, message: self.messages.append(message.decode())
            )
            for name, callback in options.items():
                setattr(callbacks, name, callback)
            self.fmu.instantiate(callbacks=callbacks, loggingOn=logging)
        else:
            self.fmu.instantiate(
                loggingOn=logging,
                logMessage=lambda environment, status, category, message: self.messages.append(message.decode()),
                **options,
            )

    def initialize(self, force_linear=False, stop_time=None):
        self.fmu.setBoolean([self.references["force_linear"]], [force_linear])
        if self.version == 2:
            self.fmu.setupExperiment(startTime=0.0, stopTime=stop_time)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=0.0, stopTime=stop_time)
        self.fmu.exitInitializationMode()
        return self

    def set(self, name, value):
        setter = self.fmu.setReal if self.version == 2 else self.fmu.setFloat64
        setter([self.references[name]], [value])

    def get(self, *names):
        getter = self.fmu.getReal if self.version == 2 else self.fmu.getFloat64
        return list(getter([self.references[name] for name in names]))

    def shapes(self, kind, port, first, last):
        """Shape values of modes, counted from 1, at a force or a response port: directional derivatives."""
        unknowns, knowns = {
            "force": (lambda n: f"der(modal_velocity_{n})", lambda n: f"force_{port}"),
            "response": (lambda n: f"displacement_{port}", lambda n: f"modal_position_{n}"),
        }[kind]
        pairs = [(self.references[unknowns(n)], self.references[knowns(n)]) for n in range(first, last + 1)]
        return np.array([self.fmu.getDirectionalDerivative([one], [other], [1.0])[0] for one, other in pairs])

    def call(self, names, *arguments):
        """Status of a C function, called past FMPy's checks; `names` are those of FMI 2.0 and 3.0."""
        name = names[self.version - 2]
        return getattr(self.fmu.dll, name)(ctypes.c_void_p(self.fmu.component), *arguments)

    def step(self, start, size):
        self.fmu.doStep(currentCommunicationPoint=start, communicationStepSize=size)

    def run(self, forces, step, port=1):
        """One step for each force, set before it; the motion at `port` after each step."""
        names = [f"{output}_{port}" for output in OUTPUTS]
        motion = np.empty((3, len(forces)))
        for n, force in enumerate(forces):
            self.set("force_1", force)
            self.step(n * step, step)
            motion[:, n] = self.get(*names)
        return motion

    def close(self):
        self.fmu.freeInstance()
        if self.temporary:
            shutil.rmtree(self.folder, ignore_errors=True)


@contextlib.contextmanager
def panel(fmu, **options):
    instance = Panel(fmu, **options)
    try:
        yield instance
    finally:
        instance.close()


def worst(motion, expected):
    """Largest error of each row as a share of that row's peak."""
    return np.max(np.abs(motion - expected), axis=1) / np.max(np.abs(expected), axis=1)

"""The same force in ecospy and libcosimpy as in FMPy: the same motion, to 1e-9 of its peak."""

import shutil

import numpy as np
import pytest
from masters import OUTPUTS, panel, worst

STEP, COUNT = 1e-4, 200
FORCES = np.sin(0.37 * np.arange(COUNT)) + 0.3 * (np.arange(COUNT) % 5 == 0)
TOLERANCE = 1e-9


def loaded(name):
    try:
        return __import__(name)
    except (ImportError, OSError) as reason:
        pytest.skip(f"{name} does not load: {reason}")


# How the folder is called that the FMU lies in, and, where the importer unpacks below it, is unpacked in.
FOLDERS = pytest.mark.parametrize("folder", ["plain", "50% of ü a%20b"])


def laid_in(folder, fmu):
    folder.mkdir()
    return shutil.copy(fmu, folder)


def in_fmpy(fmu):
    with panel(fmu) as instance:
        return instance.initialize().run(FORCES, STEP)


@FOLDERS
def test_ecospy_agrees_with_fmpy(fmu, folder, tmp_path, monkeypatch):
    # Wants libtbb.so.12 (Debian: libtbb12).
    ecospy = loaded("ecospy")
    motion = np.empty((len(OUTPUTS), COUNT))
    structure = ecospy.EcosSimulationStructure()
    structure.add_model("panel", str(laid_in(tmp_path / folder, fmu)))
    # Where it unpacks.
    monkeypatch.setenv("TMPDIR", str(tmp_path / folder))
    with ecospy.EcosSimulation(STEP, structure=structure) as simulation:
        simulation.init()
        for n, force in enumerate(FORCES):
            simulation.set_real("panel::force_1", force)
            simulation.step()
            motion[:, n] = [simulation.get_real(f"panel::{output}_1") for output in OUTPUTS]
        simulation.terminate()
    assert np.all(worst(motion, in_fmpy(fmu)) < TOLERANCE), worst(motion, in_fmpy(fmu))


@FOLDERS
def test_libcosimpy_agrees_with_fmpy(fmu2, folder, tmp_path, monkeypatch):
    loaded("libcosimpy")
    monkeypatch.setenv("TMPDIR", str(tmp_path / folder))
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    with panel(fmu2) as instance:
        references = instance.references
    execution = CosimExecution.from_step_size(round(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(str(laid_in(tmp_path / folder, fmu2)), "panel"))
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    execution.add_observer(observer)
    execution.add_manipulator(manipulator)
    motion = np.empty((len(OUTPUTS), COUNT))
    for n, force in enumerate(FORCES):
        manipulator.slave_real_values(slave, [references["force_1"]], [float(force)])
        execution.step()
        motion[:, n] = observer.last_real_values(slave, [references[f"{output}_1"] for output in OUTPUTS])
    assert np.all(worst(motion, in_fmpy(fmu2)) < TOLERANCE), worst(motion, in_fmpy(fmu2))

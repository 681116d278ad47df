"""Runs the vehicle: the SSP in FMPy, and the same wiring in ecospy."""

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssv
from vehicle import OUTPUT, connections, parameters


def in_fmpy(ssp, step, count):
    """Acceleration [m/s2] under the passenger's foot at step, 2 step, ..., count step [s]."""
    result = simulate_ssp(
        str(ssp),
        # Half a step less: FMPy adds up its time, and rounding must not make one step more.
        stop_time=(count - 0.5) * step,
        step_size=step,
        parameter_set=read_ssv(str(ssp), "resources/parameters.ssv"),
    )
    # FMPy writes what comes after a step beside the time before it.
    return np.array([result[name] for name in result.dtype.names if name.endswith(f"floor.{OUTPUT}")][0])


def in_ecos(folder, bracket, step, count):
    """The same in ecospy 0.7.2, from the FMUs in `folder` and the SSP's wiring; OSError without `libtbb.so.12`.

    The SSP itself does not serve: ecospy runs it, but with the parameters of its file left unset.
    """
    from ecospy import EcosSimulation, EcosSimulationStructure

    structure = EcosSimulationStructure()
    for name in ["car", "floor"] + ["bracket"] * (bracket is not None):
        structure.add_model(name, str(folder / f"{name}.fmu"))
    for source, output, sink, taken in connections(bracket is not None):
        structure.make_real_connection(f"{source}::{output}", f"{sink}::{taken}")
    values = {name.replace(".", "::"): value for name, value in parameters(bracket, predict=True).items()}
    structure.add_parameter_set("vehicle", values)
    motion = np.empty(count)
    with EcosSimulation(step, structure=structure) as simulation:
        simulation.init(parameter_set="vehicle")
        for n in range(count):
            simulation.step()
            motion[n] = simulation.get_real(f"floor::{OUTPUT}")
        simulation.terminate()
    return motion

"""How comfortable is the rail car on a floor that is known only as well as its hammer test tells?

    python examples/campaigns/rail_car_comfort.py OUT [--draws 500]

Identifies the floor of examples/rail-car from twelve natural frequencies, draws models by the covariance of what was found, runs each as an FMU in
the car (FMPy), and prints the weighted rms acceleration under a passenger's foot (ISO 2631-1, W_k) with its 95 % interval.
"""

import argparse
import json
import sys
from functools import lru_cache, partial
from pathlib import Path

import numpy as np

import orthopanel as op

RAIL_CAR = Path(__file__).resolve().parents[1] / "rail-car"
sys.path.insert(0, str(RAIL_CAR))

import car_body  # noqa: E402
from comfort import lines_of, weighted_rms  # noqa: E402
from suspended_system import SuspendedSystem  # noqa: E402
from track import Track  # noqa: E402

STEP, SETTLE = 1e-3, 6.0  # s
MODES_UP_TO = 150.0  # Hz, three times the track's highest line
SCATTER = 3e-3  # by which a real panel's frequencies miss a plate's, of themselves
DAMPING, DAMPING_STD = 0.01, 0.002  # as half-power widths of a dozen hits tell it
SIZES = ("length", "width", "thickness", "mass_per_area")


def truth():
    """The floor as it is, without the loose bracket."""
    floor = json.loads((RAIL_CAR / "floor.json").read_text())
    return op.Model.from_json(json.dumps({**floor, "effects": []}))


def identified(seed=1997):
    """The floor as a laboratory knows it: constants from a list of frequencies, damping ratios beside them."""
    floor = truth()
    modes = floor.modes(12)
    read = modes["frequency_hz"].to_numpy() * (1.0 + SCATTER * np.random.default_rng(seed).standard_normal(12))
    order = np.argsort(read)
    test = op.Test(op.Piece(**{name: floor.to_dict()["piece"][name] for name in SIZES}), structure="mindlin-plate")
    shape = modes[["nodes_x", "nodes_y"]].to_numpy()[order].tolist()
    test.add_frequencies(read[order], scatter=SCATTER * read[order], shape=shape)
    model = op.identify(test).model.to_dict()
    model["damping"] = {"ratios": 12 * [DAMPING], "std": 12 * [DAMPING_STD], "beyond": DAMPING}
    model["ports"] = floor.to_dict()["ports"]
    return op.Model.from_json(json.dumps(model))


@lru_cache(maxsize=1)
def car_on_track(ports):
    """The car with mounts at these places: what answers the panel's motion with forces."""
    count = len(ports)
    mounts = (car_body.mount_rows(ports), count * [car_body.MOUNT_STIFFNESS], count * [car_body.MOUNT_DAMPER])
    return SuspendedSystem(*car_body.matrices(), *mounts, Track().omegas, car_body.track_forces(Track()))


def ride(model, step=STEP, settle=SETTLE):
    """The weighted rms [m/s2] under the foot, over one period of the track."""
    from copy import copy

    import fmpy
    from fmpy.fmi2 import FMU2Slave

    mounts = tuple(map(tuple, model.to_dict()["ports"]["forces"][:4]))
    foot = model.to_dict()["ports"]["responses"][-1]
    car = copy(car_on_track(mounts))
    car.free, car.last_velocity = car.free.copy(), car.last_velocity.copy()
    track = Track()
    count = round(settle / step) + round(track.period / step)
    # Residual modes at a mount want shorter steps, and add 0.3 % (README of examples/rail-car).
    with op.campaign.fmu(model, up_to=MODES_UP_TO, residual=False, forces=mounts, responses=[*mounts, foot]) as path:
        folder = path.parent / "fmu"
        fmpy.extract(path, folder)
        description = fmpy.read_model_description(path)
        known = {variable.name: variable.valueReference for variable in description.modelVariables}
        of = {name: [known[f"{name}_{port}"] for port in range(1, 5)] for name in ("force", "displacement", "velocity")}
        motion = of["displacement"] + of["velocity"]
        slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="floor",
        )
        slave.instantiate()
        try:
            slave.setupExperiment(startTime=0.0)
            slave.enterInitializationMode()
            slave.setBoolean([known["force_linear"]], [True])
            slave.exitInitializationMode()
            forces, felt = np.zeros(4), np.empty(count)
            for n in range(count):
                seen = np.array(slave.getReal(motion))
                onward = car.step(n * step, step, seen[:4], seen[4:])
                slave.setReal(of["force"], forces.tolist())
                slave.doStep(n * step, step)
                (felt[n],) = slave.getReal([known["acceleration_5"]])
                forces = onward
            slave.terminate()
        finally:
            slave.freeInstance()
    lines = lines_of(felt[-round(track.period / step) :], len(track.omegas))
    return {"comfort": float(weighted_rms(track.omegas, lines))}


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="OUT")
    parser.add_argument("--draws", type=int, default=500)
    parser.add_argument("--settle", type=float, default=SETTLE, help="time before the comfort record [s]")
    given = parser.parse_args(arguments)
    floor = identified()
    simulate = partial(ride, settle=given.settle)
    runs = op.campaign.runs(floor.sample(given.draws, seed=1), simulate, given.folder).compute()
    comfort = runs["comfort"].dropna().to_numpy()
    low, high = np.quantile(comfort, [0.025, 0.975])
    print(f"{len(comfort)} of {len(runs)} draws: weighted rms {comfort.mean():.5f} m/s2, 95 % interval {low:.5f} to {high:.5f}")
    print(f"the floor as it is: {simulate(truth())['comfort']:.5f} m/s2")
    for name in floor.constants:
        print(f"correlation with {name}: {np.corrcoef(runs[name], runs['comfort'])[0, 1]:+.2f}")


if __name__ == "__main__":
    main()

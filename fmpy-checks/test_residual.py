"""Residual modes: what the modes left out do, at a driving point and where a stiff mount holds the panel.

The authority for the beam are the finite elements of `tests/blind_tracing`, with all their modes; for mounts it is one linear system of the panel's
modes and the springs, solved whole (`scipy.linalg.expm`).
"""

import json
import re
import sys
import zipfile

import numpy as np
import pytest
from conftest import BEAM
from exported import ROOT, run_export
from fmpy import read_model_description
from masters import panel
from pulse_lines import accelerance, worst
from scipy.linalg import expm

sys.path.insert(0, str(ROOT / "tests"))
from blind_tracing import beam as elements  # noqa: E402

BARE = elements.Panel(BEAM.length, BEAM.width, BEAM.thickness, BEAM.mass_per_area, BEAM.e_x, BEAM.g_zx)
FLOOR = json.loads((ROOT / "examples/rail-car/floor.json").read_text())
PLACES = [tuple(place) for place in FLOOR["ports"]["forces"]]


def exported(path, content, *options, forces, responses):
    done = run_export(content, path, *options, forces=forces, responses=responses)
    assert done.returncode == 0, done.stderr
    return path


def beam(**changes):
    return {
        "schema": "orthopanel.model/1",
        "piece": {name: getattr(BEAM, name) for name in ("length", "width", "thickness", "mass_per_area")},
        "structure": "timoshenko-beam",
        "constants": {"e_x": BEAM.e_x, "g_zx": BEAM.g_zx},
        "damping": {"beyond": 0.003},
    } | changes


def seen(fmu):
    """omega, zeta, shapes at forces and at responses, of all modes in the FMU's resources."""
    with zipfile.ZipFile(fmu) as archive:
        modes = json.loads(archive.read("resources/panel.json"))["model"]["modes"]
    keys = ("angular_frequency", "damping_ratio", "at_forces", "at_responses")
    return [np.array([mode[key] for mode in modes]) for key in keys]


def test_they_are_told_and_can_be_left_out(tmp_path):
    ports = {"forces": [-0.3, 0.1], "responses": [0.3]}
    with_them = exported(tmp_path / "with.fmu", beam(), "--modes", "6", **ports)
    without = exported(tmp_path / "without.fmu", beam(), "--modes", "6", "--residual", "none", **ports)
    states = [read_model_description(str(fmu)).numberOfContinuousStates for fmu in (with_them, without)]
    assert states == [2 * (8 + 4), 2 * 8]
    names = [{v.name for v in read_model_description(str(fmu)).modelVariables} for fmu in (with_them, without)]
    assert "residual_damping_ratio" in names[0] and "residual_damping_ratio" not in names[1]
    done = run_export(beam(), tmp_path / "x.fmu", "--modes", "6", "--json", **ports)
    told = json.loads(done.stdout)["residual_hz"]
    np.testing.assert_allclose(np.array(told) * 2.0 * np.pi, seen(with_them)[0][-4:])
    assert f"4 residual modes from {told[0]:.0f} to {told[-1]:.0f} Hz" in done.stderr
    refused = run_export(beam(), tmp_path / "y.fmu", "--residual", "all", **ports)
    assert refused.returncode == 2 and "must be attachment or none" in refused.stderr


@pytest.mark.parametrize("version, by", [("2", "displacement"), ("3", "velocity")])
def test_a_driving_point_is_that_of_many_modes(tmp_path, version, by):
    """Six modes to 3986 Hz, lines to 0.8 of that, as a share of the rms over all lines."""
    ports = {"forces": [-0.3], "responses": [-0.3]}
    export = lambda name, *options: exported(tmp_path / name, beam(), "--fmi", version, "--modes", "6", *options, **ports)
    few, bare = export("few.fmu"), export("bare.fmu", "--residual", "none")
    top = BEAM.flexible_modes(6)[-1][0] / (2.0 * np.pi)
    s, found = accelerance(few, up_to=0.8 * top, by=by)
    whole = s**2 * elements.solve(BARE, [-0.3], np.full(60, 0.003)).receptance(s, [0], [0])[:, 0, 0]
    assert worst(found, whole) < 0.01 < 0.1 < worst(accelerance(bare, up_to=0.8 * top, by=by)[1], whole)


def test_a_set_place_before_the_start_takes_its_residual_modes_along_and_later_keeps_them(tmp_path):
    """Displacement under a standing force, by the shapes: whole at the place set before the start; tuned later, only what they hold."""
    here = exported(tmp_path / "here.fmu", beam(), "--modes", "6", forces=[-0.3], responses=[0.2])
    there = exported(tmp_path / "there.fmu", beam(), "--modes", "6", forces=[0.25], responses=[0.2])
    omega = seen(there)[0][2:]

    def static(instance):
        shapes = [instance.shapes(kind, 1, 3, 10) for kind in ("force", "response")]
        return np.sum(shapes[0] * shapes[1] / omega**2)

    with panel(there) as instance:
        expected = static(instance.initialize())
    with panel(here) as instance:
        instance.set("force_1_x", 0.25)
        assert static(instance.initialize()) == pytest.approx(expected, rel=1e-9)
    with panel(here) as instance:
        instance.initialize()
        before = [instance.get(f"modal_position_{n}")[0] for n in (9, 10)]
        instance.set("force_1_x", 0.25)
        assert [instance.get(f"modal_position_{n}")[0] for n in (9, 10)] == before
        omega = seen(here)[0][2:]
        assert static(instance) != pytest.approx(expected, rel=1e-6)


def whole_system(modes, stiffness, dashpots):
    """x' = A x + b f_last: the modes on springs and dashpots from the ground at their first ports."""
    omega, zeta, at_forces, _ = modes
    held = at_forces[:, : len(stiffness)]
    count = len(omega)
    matrix = np.zeros((2 * count, 2 * count))
    matrix[:count, count:] = np.eye(count)
    matrix[count:, :count] = -np.diag(omega**2) - held @ np.diag(stiffness) @ held.T
    matrix[count:, count:] = -np.diag(2.0 * zeta * omega) - held @ np.diag(dashpots) @ held.T
    return matrix, np.concatenate([np.zeros(count), at_forces[:, -1]])


def moved_whole(modes, stiffness, dashpots, force, times, response):
    """Displacement at a response under a force that is held from zero on: in closed form."""
    matrix, push = whole_system(modes, stiffness, dashpots)
    rest = np.linalg.solve(matrix, -push * force)
    step = expm(matrix * (times[1] - times[0]))
    state, rows = -rest, []
    shape = modes[3][:, response]
    for _ in times:
        rows.append(shape @ (state + rest)[: len(shape)])
        state = step @ state
    return np.array(rows)


def coupled(fmu, stiffness, dashpots, force, step, count):
    """Explicit: forces of the mounts from the motion at the end of the step before. Displacement at the last response."""
    ports = range(1, len(stiffness) + 1)
    motion = np.zeros(count + 1)
    names = [f"displacement_{port}" for port in ports] + [f"velocity_{port}" for port in ports]
    last = len(stiffness) + 1
    with panel(fmu) as instance:
        instance.initialize().set(f"force_{last}", force)
        now = np.zeros(2 * len(ports))
        for n in range(count):
            for port, value in zip(ports, -stiffness * now[: len(ports)] - dashpots * now[len(ports) :]):
                instance.set(f"force_{port}", value)
            instance.step(n * step, step)
            now = np.array(instance.get(*names))
            motion[n + 1] = instance.get(f"displacement_{last}")[0]
            if not abs(motion[n + 1]) < 1.0:
                return motion * np.inf
    return motion


@pytest.mark.parametrize("options", [(), ("--residual", "none")])
def test_mounts_are_stable_where_the_page_says(tmp_path, options):
    """By the eigenvalues of a whole step: the modes under forces that are held, these set by the motion before it."""
    fmu = exported(tmp_path / "floor.fmu", FLOOR | {"effects": []}, "--modes", "20", *options, forces=PLACES, responses=PLACES)
    with zipfile.ZipFile(fmu) as archive:
        page = archive.read("documentation/index.html").decode()
    masses = [float(mass) for mass in re.findall(r"<tr><td>force_\d</td><td>([0-9.e+-]+)</td>", page)]
    modes = seen(fmu)
    np.testing.assert_allclose(masses, 1.0 / np.sum(modes[2] ** 2, axis=0), rtol=1e-3)
    held, none = modes[2][:, :4], np.zeros(4)
    count, mass = len(held), min(masses[:4])
    half_period = np.pi / np.max(modes[0])
    free, push = whole_system(modes, none, none)[0], np.vstack([np.zeros((count, 4)), held])
    for stiffness in (1e5, 1e6, 1e7, 1e8, 1e9):
        for ratio in (0.02, 0.05, 0.2):
            damper = 2.0 * ratio * np.sqrt(stiffness * 3.7)
            step = min(0.5 * min(np.sqrt(mass / stiffness), mass / damper, damper / stiffness), half_period)
            both = expm(step * np.block([[free, push], [np.zeros((4, 2 * count + 4))]]))
            answer = np.hstack([-stiffness * held.T, -damper * held.T])
            grown = np.abs(np.linalg.eigvals(both[: 2 * count, : 2 * count] + both[: 2 * count, 2 * count :] @ answer))
            assert np.max(grown) < 1.0 + 1e-12, (stiffness, ratio, step)


@pytest.mark.parametrize("stiffness, steps", [(1e6, (2e-5, 1e-5)), (1e8, (1e-5, 5e-6)), (1e9, (1e-5, 5e-6))])
def test_a_stiff_mount_is_stable_at_a_step_small_enough(tmp_path, stiffness, steps):
    """The rail car's floor on four mounts, explicitly coupled, against the whole in closed form: the error falls with the step."""
    content = FLOOR | {"effects": []}
    fmu = exported(tmp_path / "floor.fmu", content, "--modes", "20", forces=PLACES, responses=PLACES)
    modes = seen(fmu)
    springs, dashpots = np.full(4, stiffness), np.full(4, 2.0 * 0.05 * np.sqrt(stiffness * 3.7))
    errors = []
    for step in steps:
        count = round(steps[0] * 400 / step)
        times = step * np.arange(count + 1)
        expected = moved_whole(modes, springs, dashpots, 10.0, times, 4)
        found = coupled(fmu, springs, dashpots, 10.0, step, count)
        errors.append(np.max(np.abs(found - expected)) / np.max(np.abs(expected)))
    # The README's table; where the step is small beside the mount's own period, the error is halved with it.
    assert errors[0] < 1e-3 and errors[0] / errors[1] > 1.7, errors

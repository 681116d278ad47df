"""Mounts inside, weight, pressure, a moving frame and couples, against closed forms and one linear system of the whole.

The FMU is read through its directional derivatives, x' = A x + B u, y = C x + D u, or stepped. The whole is put together here, from the free
panel's modes as they lie in the FMU, springs by numpy; from Navier's solution of a plate; from the sines of a pinned beam.
"""

import json
import zipfile

import numpy as np
import pytest
from conftest import BEAM
from exported import run_export
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from masters import REFUSED, panel
from scipy.linalg import expm
from test_residual import FLOOR, PLACES, beam, exported

PLATE = {
    "schema": "orthopanel.model/1",
    "piece": {"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88},
    "structure": "mindlin-plate",
    "constants": {"e_x": 1.067e10, "e_y": 0.9e10, "nu_xy": 0.3, "g_xy": 3e9, "g_yz": 4e8, "g_zx": 5.304e8},
    "damping": {"beyond": 0.003},
    "boundary": {edge: "pinned" for edge in ("left", "right", "front", "back")},
}
MOUNTS = [f"m{n}" for n in range(4)]


def mounts(stiffness, dashpot, places=PLACES[:4]):
    return [f"--mount={name}={x},{y},{stiffness},{dashpot}" for name, (x, y) in zip(MOUNTS, places)]


def free(fmu):
    """omega, zeta, shapes at inputs and responses of the free panel, as they lie in the FMU."""
    with zipfile.ZipFile(fmu) as archive:
        modes = json.loads(archive.read("resources/panel.json"))["model"]["modes"]
    return [np.array([m[k] for m in modes]) for k in ("angular_frequency", "damping_ratio", "at_forces", "at_responses")]


def held(modes, stiffness, dashpot):
    """A of the free panel's modes on springs; base displacement and velocity of mount n are inputs 1 + 2 n and 2 + 2 n."""
    omega, zeta, inputs, _ = modes
    at, count = inputs[:, 1::2], len(omega)
    matrix = np.zeros((2 * count, 2 * count))
    matrix[:count, count:] = np.eye(count)
    matrix[count:, :count] = -np.diag(omega**2) - stiffness * at @ at.T
    matrix[count:, count:] = -np.diag(2.0 * zeta * omega) - dashpot * at @ at.T
    return matrix, np.vstack([np.zeros_like(inputs), inputs * np.array([1.0] + [stiffness, dashpot] * at.shape[1])])


def state_space(instance, inputs, outputs, skip=0):
    """A, B, C, D by directional derivatives, without the states of the first `skip` modes."""
    count = sum(name.startswith("modal_position_") for name in instance.references)
    states = [f"modal_{word}_{n}" for word in ("position", "velocity") for n in range(skip + 1, count + 1)]
    references = instance.references

    def matrix(unknowns, knowns):
        get = instance.fmu.getDirectionalDerivative
        columns = [get([references[u] for u in unknowns], [references[k]], [1.0]) for k in knowns]
        return np.array(columns).T

    rates = [f"der({name})" for name in states]
    return matrix(rates, states), matrix(rates, inputs), matrix(outputs, states), matrix(outputs, inputs)


def at_rest(instance, inputs, outputs, skip=0):
    a, b, c, d = state_space(instance, inputs, outputs, skip)
    return d - c @ np.linalg.solve(a, b)


@pytest.mark.parametrize("version", ["2", "3"])
@pytest.mark.parametrize("stiffness", [1e6, 1e7, 1e8, 1e9])
def test_mounts_inside_are_the_whole_at_any_step(tmp_path, version, stiffness):
    """A force held over a step, bases that go on at their velocities: exact, from 10 us to 2 ms, where explicit coupling is stable below 20 us."""
    dashpot = 2.0 * 0.05 * np.sqrt(stiffness * 3.7)
    content = FLOOR | {"effects": []}
    fmu = exported(
        tmp_path / "floor.fmu", content, "--fmi", version, "--modes", "20", *mounts(stiffness, dashpot),
        forces=PLACES[4:], responses=PLACES[4:],
    )
    assert validate_fmu(str(fmu)) == []
    modes = free(fmu)
    matrix, push = held(modes, stiffness, dashpot)
    count = len(modes[0])
    names = ["force_1"] + [f"base_{word}_{name}" for name in MOUNTS for word in ("displacement", "velocity")]
    goes_on = np.zeros((len(names), len(names)))
    goes_on[range(1, len(names), 2), range(2, len(names), 2)] = 1.0
    random = np.random.default_rng(5)
    for step in (1e-5, 1e-4, 2e-3):
        both = expm(step * np.block([[matrix, push], [np.zeros((len(names), 2 * count)), goes_on]]))
        state, motion, expected = np.zeros(2 * count), [], []
        with panel(fmu) as instance:
            instance.initialize()
            for n in range(40):
                inputs = random.normal(size=len(names)) * np.array([10.0] + [1e-4, 1e-2] * 4)
                for name, value in zip(names, inputs):
                    instance.set(name, value)
                instance.step(n * step, step)
                state = (both @ np.concatenate([state, inputs]))[: 2 * count]
                moved, speed = modes[3].T @ state[:count], modes[3].T @ state[count:]
                inputs = inputs + step * goes_on @ inputs
                base = stiffness * (moved[1:] - inputs[1::2]) + dashpot * (speed[1:] - inputs[2::2])
                motion.append(instance.get("displacement_1", "velocity_1", *[f"base_force_{name}" for name in MOUNTS]))
                expected.append([moved[0], speed[0], *base])
        motion, expected = np.array(motion), np.array(expected)
        errors = np.max(np.abs(motion - expected), axis=0) / np.max(np.abs(expected), axis=0)
        assert np.max(errors) < 1e-8, (step, errors)


@pytest.mark.parametrize("linear", [False, True])
def test_a_base_that_swings_errs_the_less_the_shorter_the_step(tmp_path, linear):
    """All four bases by 1 mm at 50 Hz under the floor, against the whole with the swing among its states."""
    stiffness, size, omega = 1e6, 1e-3, 2.0 * np.pi * 50.0
    dashpot = 2.0 * 0.05 * np.sqrt(stiffness * 3.7)
    content = FLOOR | {"effects": []}
    ports = {"forces": PLACES[4:], "responses": PLACES[4:]}
    fmu = exported(tmp_path / "floor.fmu", content, "--modes", "20", *mounts(stiffness, dashpot), **ports)
    modes = free(fmu)
    matrix, push = held(modes, stiffness, dashpot)
    count = len(modes[0])
    # u = size (1 - cos), v = size omega sin: states behind the modes are 1, cos and sin.
    whole = np.zeros((2 * count + 3, 2 * count + 3))
    whole[: 2 * count, : 2 * count] = matrix
    moved, sped = size * push[:, 1::2].sum(axis=1), size * omega * push[:, 2::2].sum(axis=1)
    whole[: 2 * count, 2 * count :] = np.array([moved, -moved, sped]).T
    whole[2 * count + 1, 2 * count + 2], whole[2 * count + 2, 2 * count + 1] = -omega, omega
    errors = []
    for step in (2e-4, 1e-4, 5e-5):
        state, once = np.concatenate([np.zeros(2 * count), [1.0, 1.0, 0.0]]), expm(whole * step)
        expected, found = [], []
        with panel(fmu) as instance:
            instance.initialize(force_linear=linear)
            for n in range(round(0.04 / step)):
                time = (n + linear) * step
                for name in MOUNTS:
                    instance.set(f"base_displacement_{name}", size * (1.0 - np.cos(omega * time)))
                    instance.set(f"base_velocity_{name}", size * omega * np.sin(omega * time))
                instance.step(n * step, step)
                state = once @ state
                base = [size * (1.0 - state[-2]), size * omega * state[-1]]
                follows = [modes[3][:, 1] @ state[:count], modes[3][:, 1] @ state[count : 2 * count]]
                force = stiffness * (follows[0] - base[0]) + dashpot * (follows[1] - base[1])
                expected.append([modes[3][:, 0] @ state[:count], force])
                found.append(instance.get("displacement_1", "base_force_m0"))
        expected, found = np.array(expected), np.array(found)
        errors.append(np.max(np.abs(found - expected), axis=0) / np.max(np.abs(expected), axis=0))
    errors = np.array(errors)
    # Going on, the velocity of the dampers is that at the start of the step.
    assert np.all(errors[1] < (1e-3 if linear else 2e-2)), errors
    assert np.all(errors[:-1] / errors[1:] > (3.5 if linear else 1.9)), errors


def test_a_mount_is_a_mount_outside_at_small_steps(tmp_path):
    """Against the same springs coupled from outside, each step: the difference falls with the step, as that coupling errs."""
    stiffness, dashpot = 1e6, 2.0 * 0.05 * np.sqrt(1e6 * 3.7)
    content = FLOOR | {"effects": []}
    inside = exported(
        tmp_path / "in.fmu", content, "--modes", "20", *mounts(stiffness, dashpot), forces=PLACES[4:], responses=PLACES[4:]
    )
    outside = exported(tmp_path / "out.fmu", content, "--modes", "20", forces=PLACES, responses=PLACES)
    from test_residual import coupled

    errors = []
    for step in (2e-5, 1e-5):
        steps = round(4e-3 / step)
        with panel(inside) as instance:
            instance.initialize().set("force_1", 10.0)
            exact = [0.0]
            for n in range(steps):
                instance.step(n * step, step)
                exact += instance.get("displacement_1")
        found = coupled(outside, np.full(4, stiffness), np.full(4, dashpot), 10.0, step, steps)
        errors.append(np.max(np.abs(found - exact)) / np.max(np.abs(exact)))
    assert errors[0] < 2e-3 and 1.7 < errors[0] / errors[1] < 2.3, errors


def test_weight_on_mounts_is_shared_by_levers(tmp_path):
    """Beam on two mounts, statically determinate: their forces from the balance alone, whatever bends."""
    options = ["--modes", "6", "--gravity", "--pressure", "--mount=a=-0.3,0,2e4,10", "--mount=b=0.2,0,3e4,10"]
    mass = {"effects": [{"id": "local-mass", "owner": "panel", "mass": 0.05, "x": 0.1},
                        {"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 400, "zeta": 0.05, "x": -0.2}]}
    fmu = exported(tmp_path / "beam.fmu", beam(**mass), *options, forces=[0.0], responses=[0.0, -0.3])
    own = BEAM.length * BEAM.width * BEAM.mass_per_area
    total, moment = own + 0.07, 0.05 * 0.1 - 0.02 * 0.2
    outputs = ["base_force_a", "base_force_b", "displacement_2"]
    with panel(fmu) as instance:
        found = at_rest(instance.initialize(), ["gravity", "pressure"], outputs)
    for column, (weight, lever) in enumerate([(total, moment), (BEAM.length * BEAM.width, 0.0)]):
        b = (lever + 0.3 * weight) / 0.5
        np.testing.assert_allclose(found[:2, column], [weight - b, b], rtol=1e-6)
        assert found[2, column] == pytest.approx((weight - b) / 2e4, rel=1e-6)


def navier(pressure, terms=199):
    """Deflection of the middle of a pinned orthotropic Mindlin plate: three equations for each sine."""
    piece, c = PLATE["piece"], PLATE["constants"]
    a, b, t = piece["length"], piece["width"], piece["thickness"]
    nu_yx = c["nu_xy"] * c["e_y"] / c["e_x"]
    bend = t**3 / 12.0 / (1.0 - c["nu_xy"] * nu_yx)
    d11, d22, d12, d66 = bend * c["e_x"], bend * c["e_y"], bend * c["nu_xy"] * c["e_y"], c["g_xy"] * t**3 / 12.0
    a55, a44 = 2.0 / 3.0 * c["g_zx"] * t, 2.0 / 3.0 * c["g_yz"] * t
    middle = 0.0
    for m in range(1, terms, 2):
        for n in range(1, terms, 2):
            p, q = m * np.pi / a, n * np.pi / b
            matrix = np.array([
                [a55 * p * p + a44 * q * q, a55 * p, a44 * q],
                [a55 * p, d11 * p * p + d66 * q * q + a55, (d12 + d66) * p * q],
                [a44 * q, (d12 + d66) * p * q, d22 * q * q + d66 * p * p + a44],
            ])
            load = 16.0 * pressure / (np.pi**2 * m * n)
            middle += np.linalg.solve(matrix, [load, 0.0, 0.0])[0] * np.sin(m * np.pi / 2) * np.sin(n * np.pi / 2)
    return middle


def test_weight_and_pressure_bend_a_plate_as_navier_says(tmp_path):
    options = ["--modes", "60", "--gravity", "--pressure", "--base-acceleration"]
    fmu = exported(tmp_path / "plate.fmu", PLATE, *options, forces=[(0.1, 0.1)], responses=[(0.0, 0.0)])
    inputs = ["pressure", "gravity", "base_acceleration", "force_1"]
    with panel(fmu) as instance:
        found = at_rest(instance.initialize(), inputs, ["displacement_1", "frame_force", "frame_moment_x", "frame_moment_y"], skip=3)
    density, area = PLATE["piece"]["mass_per_area"], 0.8 * 0.5
    middle = navier(1.0)
    np.testing.assert_allclose(found[0, :3], [middle, density * middle, -density * middle], rtol=2e-3)
    np.testing.assert_allclose(found[1], [area, density * area, -density * area, 1.0], rtol=1e-9)
    np.testing.assert_allclose(found[2:], [[0.0, 0.0, 0.0, 0.1], [0.0, 0.0, 0.0, -0.1]], atol=1e-7)


def test_a_frame_moves_a_pinned_beam_as_its_sines_say(tmp_path):
    """Absolute acceleration and reaction over frequency: sines are the modes, and their mean is known."""
    held_ends = {"boundary": {"left": "pinned", "right": "pinned"}}
    fmu = exported(
        tmp_path / "beam.fmu", beam(**held_ends), "--modes", "20", "--residual", "none", "--base-acceleration",
        forces=[0.0], responses=[0.13],
    )
    outputs = ["acceleration_1", "frame_force"]
    with panel(fmu) as instance:
        a, b, c, d = state_space(instance.initialize(), ["base_acceleration"], outputs, skip=2)
    omega = free(fmu)[0][2:]
    length, thickness = BEAM.length, BEAM.thickness
    mass = length * BEAM.width * BEAM.mass_per_area
    shapes, means = [], []
    for m, own in zip(range(1, 21), omega):
        wave = m * np.pi / length
        # psi over w from the balance of moments: k'GA (w' + psi) = (rho I omega^2 - E I wave^2) psi.
        shear, bending = 2.0 / 3.0 * BEAM.g_zx * thickness, BEAM.e_x * thickness**3 / 12.0
        rotary = BEAM.mass_per_area * thickness**2 / 12.0
        ratio = shear * wave / (rotary * own**2 - bending * wave**2 - shear)
        size = np.sqrt(2.0 / (mass * (1.0 + thickness**2 / 12.0 * ratio**2)))
        shapes.append(size * np.sin(wave * (0.13 + 0.5 * length)))
        means.append(size * mass * (1.0 - np.cos(m * np.pi)) / (m * np.pi))
    shapes, means = np.array(shapes), np.array(means)
    for frequency in (20.0, 150.0, 500.0, 1200.0):
        s = 2j * np.pi * frequency
        found = d[:, 0] + c @ np.linalg.solve(s * np.eye(len(a)) - a, b[:, 0])
        answer = -(s**2) * means / (s**2 + 2.0 * 0.003 * omega * s + omega**2)
        expected = np.array([1.0 + shapes @ answer, -mass - means @ answer])
        np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_a_frame_takes_mounts_and_motions_along(tmp_path):
    """A cantilever whose frame is accelerated for a while goes on at its speed, and is bent and turned as the frame turns."""
    held_end = {"boundary": {"left": "clamped", "right": "free"}}
    fmu = exported(
        tmp_path / "beam.fmu", beam(**held_end), "--modes", "6", "--base-acceleration", "--mount=tip=0.4,0,1e4,200",
        forces=[0.0], responses=[0.4, -0.4],
    )
    with panel(fmu) as instance:
        instance.initialize(force_linear=True)
        step = 1e-3
        for n in range(4000):
            # The base of the mount goes along with the frame, all by their values at the end of the step: then nothing is strained for long.
            time = (n + 1) * step
            instance.set("base_acceleration", 2.0 if n < 500 else 0.0)
            instance.set("base_velocity_tip", 2.0 * min(time, 0.5))
            instance.set("base_displacement_tip", time * time if time < 0.5 else 0.25 + 1.0 * (time - 0.5))
            instance.step(n * step, step)
        moved, ends = instance.get("displacement_1", "displacement_2"), 0.25 + 3.5
        np.testing.assert_allclose(moved, [ends, ends], rtol=1e-3)
        np.testing.assert_allclose(instance.get("velocity_1", "velocity_2"), [1.0, 1.0], rtol=1e-3)
    with panel(fmu) as instance:
        found = at_rest(instance.initialize(), ["base_angular_acceleration_y"], ["frame_moment_y", "base_force_tip"], skip=2)[:, 0]
    mass = BEAM.length * BEAM.width * BEAM.mass_per_area
    inertia = mass * (BEAM.length**2 + BEAM.thickness**2) / 12.0
    # Of the cantilever the mount bears a part at x = 0.4.
    assert found[0] + inertia == pytest.approx(0.4 * found[1], rel=1e-9)


def test_couples_and_rotations_are_reciprocal_and_turn_a_cantilever(tmp_path):
    held_end = {"boundary": {"left": "clamped", "right": "free"}}
    fmu = exported(tmp_path / "beam.fmu", beam(**held_end), "--modes", "30", "--rotations", forces=[0.2], responses=[0.2, 0.4])
    with panel(fmu) as instance:
        found = at_rest(
            instance.initialize(), ["force_1", "moment_y_1"], ["displacement_1", "rotation_y_1", "displacement_2", "rotation_y_2"]
        )
    bending = BEAM.e_x * BEAM.width * BEAM.thickness**3 / 12.0
    arm = 0.2 + 0.5 * BEAM.length
    assert found[0, 1] == pytest.approx(found[1, 0], rel=1e-6)
    # A couple about +y turns the beam by M l / E I, and takes what is beyond down by its arm.
    np.testing.assert_allclose(found[3, 1], arm / bending, rtol=0.02)
    assert found[2, 1] == pytest.approx(-arm * (0.2 + 0.5 * arm) / bending, rel=0.02)


def test_mounts_are_tuned_under_way_and_states_go_on(tmp_path):
    fmus = [
        exported(tmp_path / f"{name}.fmu", beam(), "--fmi", "3", "--modes", "6", f"--mount=a=-0.3,0,{law}", "--mount=b=0.3,0,1e5,5",
                 forces=[0.0], responses=[0.1])
        for name, law in (("soft", "1e5,5"), ("stiff", "1e7,50"))
    ]
    with panel(fmus[0]) as instance:
        instance.initialize().run(np.full(30, 3.0), 1e-4)
        state = instance.get(*[f"modal_position_{n}" for n in range(1, 9)])
        content = instance.fmu.serializeFMUState(instance.fmu.getFMUState())
        instance.set("mount_a_stiffness", 1e7)
        instance.set("mount_a_damping", 50.0)
        assert instance.get(*[f"modal_position_{n}" for n in range(1, 9)]) == state
        a, *_ = state_space(instance, ["force_1"], ["displacement_1"])
        instance.fmu.setFMUState(instance.fmu.deserializeFMUState(content))
        assert instance.get("mount_a_stiffness", "mount_a_damping") == [1e5, 5.0]
        for wrong in (-1.0, np.inf, 1e16):
            with pytest.raises(REFUSED):
                instance.set("mount_a_stiffness", wrong)
        assert "mount a: stiffness" in instance.messages[-1]
    with panel(fmus[1]) as instance:
        b, *_ = state_space(instance.initialize(), ["force_1"], ["displacement_1"])
    np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-6 * np.max(np.abs(b)))


@pytest.mark.parametrize(
    "words, said",
    [
        (["--mount=1e6"], "has no name: give a mount as NAME=X,Y,STIFFNESS,DAMPING"),
        (["--mount=a b=0,0,1e6,1"], "is no name of letters"),
        (["--mount=a=0,0,1e6"], "3 numbers behind a=, not 4"),
        (["--mount=a=0,0,-1e6,1"], 'stiffness "-1e6" is no finite number that is not below zero'),
        (["--mount=a=0,0,1e6,nan"], 'damping "nan" is no finite number'),
        (["--mount=a=0.5,0,1e6,1"], "--mount 0.5,0: place (0.5, 0) m lies off the piece"),
        (["--mount=a=0,0,1e6,1", "--mount=a=0.1,0,1e6,1"], 'two variables are called "base_displacement_a"'),
        (["--mount=a=0,0,1e17,1"], "mount a: stiffness = 100000000000000000 N/m: must lie between 0 and 1e15"),
        (["--base-acceleration"], "all edges of the panel are free"),
    ],
)
def test_bad_connections_are_refused_with_the_way_out(tmp_path, words, said):
    refused = run_export(beam(), tmp_path / "x.fmu", *words, forces=[0.0], responses=[0.0])
    assert refused.returncode in (1, 2) and said in refused.stderr, refused.stderr
    assert not (tmp_path / "x.fmu").exists()


def test_model_exchange_holds_mounts_too(tmp_path):
    """The derivatives of all states are those of the whole."""
    fmu = exported(tmp_path / "beam.fmu", beam(), "--modes", "4", "--mount=a=-0.3,0,1e7,20", forces=[0.0], responses=[0.1])
    modes = free(fmu)
    matrix, push = held(modes, 1e7, 20.0)
    count = len(modes[0])
    assert read_model_description(str(fmu)).numberOfContinuousStates == 2 * count
    random = np.random.default_rng(1)
    state = random.normal(size=2 * count) * 1e-4
    with panel(fmu, model_exchange=True) as instance:
        for n in range(count):
            instance.set(f"modal_position_{n + 1}", state[n])
            instance.set(f"modal_velocity_{n + 1}", state[count + n])
        instance.initialize()
        inputs = {"force_1": 3.0, "base_displacement_a": 1e-5, "base_velocity_a": 0.02}
        for name, value in inputs.items():
            instance.set(name, value)
        rates = instance.get(*[f"der(modal_velocity_{n + 1})" for n in range(count)])
    expected = (matrix @ state + push @ np.array(list(inputs.values())))[count:]
    np.testing.assert_allclose(rates, expected, rtol=1e-9, atol=1e-9 * np.max(np.abs(expected)))

"""Damping ratios and places set while a simulation runs, against closed form in pieces worked out here."""

import numpy as np
import pytest
from conftest import BEAM, FORCES, RESPONSES, ZETAS
from exported import run_export
from fmpy import simulate_fmu
from masters import OUTPUTS, REFUSED, panel
from modal_sum import free_motion, held_step

STEP, HALF = 2e-5, 150
NAMES = [f"{output}_1" for output in OUTPUTS]
FLEXIBLE = BEAM.flexible_modes(len(ZETAS))
# The damping ratios set half way, and the flexible modes whose they are, counted from 1.
TUNED = {1: 0.04, 4: 0.0, 5: 0.02}
INTERFACES = {"CoSimulation": 1e-9, "ModelExchange": 1e-6}


def damped(tuned):
    return [(tuned or {}).get(number + 1, zeta) for number, zeta in enumerate(ZETAS)]


def modes_seen(response, tuned=None):
    """(omega, zeta, shape at the response) of rigid and flexible modes."""
    modes = [(omega, 0.0, shape(response)) for omega, shape in BEAM.rigid_modes()]
    return modes + [(omega, zeta, shape(response)) for (omega, shape), zeta in zip(FLEXIBLE, damped(tuned))]


def senses(fmu):
    """+1 or -1 for each mode: whose sense the FMU may choose, and tells by directional derivatives."""
    with panel(fmu) as instance:
        instance.initialize()
        unknown = [instance.references["displacement_1"]]
        knowns = [instance.references[f"modal_position_{n + 1}"] for n in range(len(ZETAS) + 2)]
        told = [instance.fmu.getDirectionalDerivative(unknown, [known], [1.0])[0] for known in knowns]
    return np.sign(np.array(told) * [shape for *_, shape in modes_seen(RESPONSES[0])])


@pytest.mark.parametrize("interface", INTERFACES)
def test_a_free_decay_goes_on_at_its_new_rates(fmu, interface):
    """As an importer does it: the parameters are columns of the signals beside the inputs."""
    velocities = np.array([0.0, 0.0, 1.0, -2.0, 0.7, 3.0, -1.5, 2.0])
    starts = {f"modal_velocity_{n + 1}": value for n, value in enumerate(velocities)}
    times, turn = STEP * np.arange(2 * HALF + 1), STEP * HALF
    columns = [f"damping_ratio_{number}" for number in TUNED]
    signals = np.zeros(3, dtype=[("time", float)] + [(name, float) for name in columns])
    signals["time"] = 0.0, turn, times[-1]
    for name, (number, zeta) in zip(columns, TUNED.items()):
        signals[name] = ZETAS[number - 1], zeta, zeta
    result = simulate_fmu(
        str(fmu), fmi_type=interface, start_values=starts, input=signals, output=NAMES, stop_time=times[-1],
        output_interval=STEP, relative_tolerance=1e-10,
    )
    signed = senses(fmu) * velocities
    before = free_motion(modes_seen(RESPONSES[0]), [(0.0, v) for v in signed], times[: HALF + 1])
    one = [free_motion([(omega, zeta, 1.0)], [(0.0, v)], np.array([turn]))[:2, 0]
           for (omega, zeta, _), v in zip(modes_seen(RESPONSES[0]), signed)]
    after = free_motion(modes_seen(RESPONSES[0], TUNED), one, times[1 : HALF + 1])
    expected = np.hstack([before, after])
    # At the turn itself the acceleration is recorded before it, after it or both.
    _, first = np.unique(np.round(result["time"] / STEP), return_index=True)
    found = np.array([result[name][first] for name in NAMES])
    rows = [np.arange(times.size)] * 2 + [np.delete(np.arange(times.size), HALF)]
    for row, of_row, known in zip(rows, found, expected):
        error = np.max(np.abs(of_row - known)[row]) / np.max(np.abs(known))
        assert error < INTERFACES[interface], error
    # It is no small matter: with the old rates the end is another.
    held = free_motion(modes_seen(RESPONSES[0]), one, times[1 : HALF + 1])
    assert np.max(np.abs(held - after)[1]) > 0.1 * np.max(np.abs(after[1]))


def test_a_force_and_a_response_move_under_way(fmu):
    """Modal coordinates under a force held over each step; the second half with other places and one other damping ratio."""
    places = [(FORCES[0], RESPONSES[0]), (-0.13, 0.05)]
    loads = 2.0 * np.cos(0.2 * np.arange(2 * HALF))
    states = [(0.0, 0.0)] * (len(ZETAS) + 2)
    expected = []
    for n, load in enumerate(loads):
        force, response = places[n >= HALF]
        tuned = TUNED if n >= HALF else None
        at_force = [shape for *_, shape in modes_seen(force)]
        modes = modes_seen(response, tuned)
        states = [held_step(omega, zeta, state, load * w, STEP) for (omega, zeta, _), state, w in zip(modes, states, at_force)]
        accelerations = [load * w - 2.0 * zeta * omega * v - omega**2 * q
                         for (omega, zeta, _), (q, v), w in zip(modes, states, at_force)]
        expected.append([sum(s * q for (*_, s), (q, _) in zip(modes, states)),
                         sum(s * v for (*_, s), (_, v) in zip(modes, states)),
                         sum(s * a for (*_, s), a in zip(modes, accelerations))])
    found = []
    with panel(fmu) as instance:
        instance.initialize()
        for n, load in enumerate(loads):
            if n == HALF:
                state = instance.fmu.getFMUState()
                tune(instance, places[1])
            instance.set("force_1", load)
            instance.step(n * STEP, STEP)
            found.append(instance.get(*NAMES))
        # The state from before brings all of it back, and the same again gives the same.
        again = []
        instance.fmu.setFMUState(state)
        assert instance.get("damping_ratio_1", "force_1_x", "response_1_x") == [ZETAS[0], *places[0]]
        tune(instance, places[1])
        for n, load in enumerate(loads[HALF:]):
            instance.set("force_1", load)
            instance.step((HALF + n) * STEP, STEP)
            again.append(instance.get(*NAMES))
        assert again == found[HALF:]
    found, expected = np.array(found).T, np.array(expected).T
    error = np.max(np.abs(found - expected), axis=1) / np.max(np.abs(expected), axis=1)
    assert np.all(error < 1e-9), error


def tune(instance, places):
    for name, value in {"force_1_x": places[0], "response_1_x": places[1]}.items():
        instance.set(name, value)
    for number, zeta in TUNED.items():
        instance.set(f"damping_ratio_{number}", zeta)


def test_in_model_exchange_only_at_an_event(fmu):
    with panel(fmu, model_exchange=True) as instance:
        instance.initialize()
        instance.set("damping_ratio_1", 0.01)
        instance.fmu.enterContinuousTimeMode()
        with pytest.raises(REFUSED):
            instance.set("damping_ratio_1", 0.02)
        assert "a tunable parameter is set in event mode (model exchange)" in instance.messages[-1]
        assert instance.get("damping_ratio_1") == [0.01]
        instance.fmu.enterEventMode()
        instance.set("damping_ratio_1", 0.02)
        with pytest.raises(REFUSED):
            instance.set("thickness", 0.02)
        assert "a fixed parameter is set before or in initialization mode" in instance.messages[-1]
        instance.set("force_9_x", 0.1)
        update = instance.fmu.newDiscreteStates if instance.version == 2 else instance.fmu.updateDiscreteStates
        # Sizes of states to be expected follow the force that stood at the end, where all modes move most.
        assert list(update()[:4]) == [False, False, True, False]
        assert list(update()[:4]) == [False] * 4


def test_values_without_a_meaning_are_refused_under_way(fmu):
    bad = {"damping_ratio_2": (0.8, "0 <= zeta"), "force_1_x": (0.5, "lies off the piece"), "response_1_y": (-0.06, "off the piece"),
           "response_2_x": (float("nan"), "must be a finite number")}
    with panel(fmu) as instance, panel(fmu) as beside:
        instance.initialize().run(np.ones(5), STEP)
        beside.initialize().run(np.ones(5), STEP)
        for name, (value, message) in bad.items():
            with pytest.raises(REFUSED):
                instance.set(name, value)
            assert message in instance.messages[-1]
        for one in (instance, beside):
            one.step(5 * STEP, STEP)
        assert instance.get(*NAMES) == beside.get(*NAMES)


def test_the_xml_says_which_are_tunable_and_what_follows_them(fmu):
    with panel(fmu) as instance:
        kinds = {v.name: v.variability for v in instance.description.modelVariables if v.causality == "parameter"}
        tunable = {name for name, kind in kinds.items() if kind == "tunable"}
        assert {name for name, kind in kinds.items() if kind == "fixed"} == kinds.keys() - tunable
        ports = [f"{kind}_{n + 1}" for kind, places in (("force", FORCES), ("response", RESPONSES)) for n in range(len(places))]
        ratios = {f"damping_ratio_{n + 1}" for n in range(len(ZETAS))}
        assert tunable == ratios | {f"{port}_{axis}" for port in ports for axis in "xy"}
        on = {unknown.variable.name: dict(zip((v.name for v in unknown.dependencies), unknown.dependenciesKind))
              for unknown in [*instance.description.outputs, *instance.description.derivatives]}
        assert on["acceleration_1"]["force_1"] == "tunable" == on["der(modal_velocity_3)"]["modal_velocity_3"]
        assert on["der(modal_velocity_3)"]["modal_position_3"] == "fixed"
        listed = {name for name in on["acceleration_1"] if name in kinds}
        # A parameter is no known of an output in FMI 2.0; in FMI 3.0 it is. Across a beam nothing moves.
        expected = ratios | {f"{port}_x" for port in ports if port != "response_2"} if instance.version == 3 else set()
        assert listed == expected


PLATE = {"structure": "mindlin-plate",
         "piece": {"length": 0.5, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88},
         "constants": {"e_x": 1e10, "e_y": 1e10, "nu_xy": 0.3, "g_xy": 3e9, "g_yz": 4e8, "g_zx": 4e8}}
WIDER = {**PLATE, "piece": {**PLATE["piece"], "length": 0.8}}
STRIP = {"structure": "timoshenko-beam",
         "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
         "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}}
RESONATOR = {"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 900.0, "zeta": 0.02, "x": 0.21}
LOSS = {"id": "stiffness-loss", "owner": "panel", "loss": 0.5, "span": 0.1, "x": 0.1}
CORE = {"id": "viscoelastic-core", "owner": "panel", "strength": 0.3, "tau": 1e-4, "alpha": 0.6}
# A square plate has pairs of modes at one frequency, whose order nothing but a solver's rounding would tell.
KINDS = {"plate": (WIDER, []), "square plate": (PLATE, []), "resonator": (STRIP, [RESONATOR]), "loss": (STRIP, [LOSS]),
         "core": (STRIP, [CORE]), "plate with a resonator": (WIDER, [RESONATOR]), "square with a resonator": (PLATE, [RESONATOR])}


@pytest.mark.parametrize("kind", KINDS)
def test_modes_found_inside_are_those_of_the_export(kind, tmp_path):
    """The command solves for them by other loops than the FMU: sense and order are theirs to choose, and must be the same."""
    content, effects = KINDS[kind]
    source = {"schema": "orthopanel.model/1", **content, "effects": effects, "damping": {"beyond": 0.003}}
    places = {"forces": [(-0.21, 0.03)], "responses": [(0.17, 0.021), (-0.11, 0.013)]}
    done = run_export(source, tmp_path / "one.fmu", "--modes", "8", **places)
    assert done.returncode == 0, done.stderr
    loads, names = np.cos(0.2 * np.arange(40)), [f"{output}_{n}" for output in OUTPUTS for n in (1, 2)]
    with panel(tmp_path / "one.fmu") as instance, panel(tmp_path / "one.fmu") as other:
        instance.initialize().run(loads, 1e-4)
        first, shapes = instance.get(*names), told(instance)
        # As it was, but for what a millionth of damping does, and a nanometre.
        instance.set("damping_ratio_3", 0.003 + 1e-9)
        instance.set("force_1_x", -0.21 + 1e-9)
        assert np.max(np.abs(told(instance) - shapes)) < 1e-8 * np.max(np.abs(shapes))
        assert np.max(np.abs(np.array(instance.get(*names)) - first)) < 1e-7 * np.max(np.abs(first))
        # The motion goes on as that of a panel which was never changed.
        other.initialize().run(loads, 1e-4)
        runs = np.empty((2, 40, len(names)))
        for run, one in zip(runs, (instance, other)):
            for n in range(40):
                one.step((40 + n) * 1e-4, 1e-4)
                run[n] = one.get(*names)
        assert np.all(np.max(np.abs(runs[0] - runs[1]), axis=0) < 1e-7 * np.max(np.abs(runs[1]), axis=0))


def told(instance):
    """Each mode's shape at both responses."""
    unknowns = [instance.references[f"displacement_{n}"] for n in (1, 2)]
    modes = [reference for name, reference in instance.references.items() if name.startswith("modal_position")]
    return np.array([instance.fmu.getDirectionalDerivative(unknowns, [mode], [1.0]) for mode in modes])

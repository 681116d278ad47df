"""Panels with effects: the FMU's accelerance against finite elements of their own (`tests/blind_tracing`).

The FMU runs under a short pulse; force and acceleration go to the Laplace plane, s = sigma + j omega, where the beam of
`blind_tracing` is evaluated line by line, with no modal sum over the dressed panel.
"""

import re
import sys
import zipfile
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import BEAM, model
from exported import ROOT, run_export
from pulse_lines import SIGMA, UP_TO, accelerance, worst

sys.path.insert(0, str(ROOT / "tests"))
from blind_tracing import attachments, beam, core  # noqa: E402

ZETA = 0.004
FORCE, RESPONSE = -0.31, 0.27
# So many that those left out add less than 2e-5 of the rms at the highest line; what a mass or a resonator does to them, and
# only the residual shapes hold, is five times that at a resonance.
MODES = ("--modes", "80", "--residual", "none")
TOLERANCE = 2e-4  # of the rms over all lines
BARE = beam.Panel(BEAM.length, BEAM.width, BEAM.thickness, BEAM.mass_per_area, BEAM.e_x, BEAM.g_zx)


def losing(loss, span, x):
    ends = (x - span / 2.0, x + span / 2.0)
    along = lambda at: np.where((at > ends[0]) & (at < ends[1]), 1.0 - loss, 1.0)  # noqa: E731
    return replace(BARE, shear_along=along, steps=ends)


# Effects as in a model file, and the same as the panel and the attachments (x, Z(s)) of blind_tracing.
CASES = {
    "none": ([], BARE, []),
    "local-mass": ([{"id": "local-mass", "mass": 0.03, "x": 0.11}], BARE, [(0.11, attachments.mass(0.03))]),
    "a mass that is missing": ([{"id": "local-mass", "mass": -0.02, "x": -0.2}], BARE, [(-0.2, attachments.mass(-0.02))]),
    "edge-mass": (
        [{"id": "edge-mass", "mass": 0.012}], BARE, [(x, attachments.mass(0.012)) for x in (-0.4, 0.4)],
    ),
    "stiffness-loss": ([{"id": "stiffness-loss", "loss": 0.4, "span": 0.1, "x": 0.2}], losing(0.4, 0.1, 0.2), []),
    "rotary-inertia": ([{"id": "rotary-inertia", "factor": 2.2}], replace(BARE, rotary=2.2), []),
    "resonator": (
        [{"id": "resonator", "mass": 0.02, "frequency": 1200.0, "zeta": 0.02, "x": -0.33}],
        BARE,
        [(-0.33, attachments.resonator(0.02, 1200.0, 0.02))],
    ),
}


def truth(body, hung, s):
    """Accelerance on the lines `s`."""
    points = [FORCE, RESPONSE, *(x for x, _ in hung)]
    modes = beam.solve(body, points, np.full(60, ZETA))
    at = list(range(2, len(points)))
    receptance = lambda rows, columns: modes.receptance(s, rows, columns)  # noqa: E731
    return s**2 * attachments.coupled(receptance, s, [1], [0], at, [z for _, z in hung])[:, 0, 0]


def export(path, effects, *options, zeta=ZETA):
    content = model()
    content["damping"] = {"beyond": zeta}
    content["effects"] = [{"owner": "panel", **effect} for effect in effects]
    return run_export(content, path, *options, forces=[FORCE], responses=[RESPONSE])


@pytest.mark.parametrize("name", CASES)
def test_an_effect_of_the_panel_is_in_the_fmu(tmp_path, name):
    effects, body, hung = CASES[name]
    done = export(tmp_path / "x.fmu", effects, *MODES)
    assert done.returncode == 0, done.stderr
    s, found = accelerance(tmp_path / "x.fmu")
    expected = truth(body, hung, s)
    if effects:
        assert worst(truth(BARE, [], s), expected) > 0.05, "the effect must be seen"
    assert worst(found, expected) < TOLERANCE


def test_effects_stay_where_parameters_are_set(tmp_path):
    effects, _, hung = CASES["resonator"]
    export(tmp_path / "x.fmu", effects, *MODES)
    changes = {"e_x": 1.2e10, "mass_per_area": 6.4, "thickness": 0.028}
    s, found = accelerance(tmp_path / "x.fmu", changes.items())
    expected = truth(replace(BARE, **changes), hung, s)
    assert worst(truth(BARE, hung, s), expected) > 0.5, "the parameters must be seen"
    assert worst(found, expected) < TOLERANCE


def test_effects_of_rig_and_channel_are_left_out_and_said(tmp_path):
    own = CASES["local-mass"][0]
    others = [{"id": "sensor-mass", "owner": "rig", "mass": 0.01}, {"id": "gain", "owner": "channel", "gain": 0.9}]
    said = export(tmp_path / "all.fmu", [others[0], *own, others[1]])
    assert said.returncode == 0 and "left out, as no part of the panel: sensor-mass, gain" in said.stderr, said.stderr
    assert "left out" not in export(tmp_path / "own.fmu", own).stderr
    texts = []
    for name in ("all.fmu", "own.fmu"):
        with zipfile.ZipFile(tmp_path / name) as archive:
            texts.append(archive.read("resources/panel.json"))
            page = archive.read("documentation/index.html").decode()
            assert ("<td>effect gain</td><td>left out: no part of the panel</td>" in page) == (name == "all.fmu")
            assert "<td>effect local-mass</td><td>in the modes</td>" in page
    assert texts[0] == texts[1]


def modulus(strength, tau, alpha, factor=1.0):
    """Shear modulus over that at low frequency (Bagley and Torvik 1983), times a factor."""
    return lambda s: factor * (1.0 + strength * (s * tau) ** alpha / (1.0 + (s * tau) ** alpha))


@pytest.mark.parametrize("numbers", [(0.1, 1e-4, 0.6), (0.6, 2e-4, 0.45)])
def test_a_viscoelastic_core_is_in_the_fmu(tmp_path, numbers):
    effect = dict(zip(("strength", "tau", "alpha"), numbers), id="viscoelastic-core")
    done = export(tmp_path / "x.fmu", [effect], "--modes", "16", zeta=0.0)
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(tmp_path / "x.fmu") as archive:
        page = archive.read("documentation/index.html").decode()
    stated = re.search(r"errs by ([0-9.]+) % of it at most, from ([0-9]+) to ([0-9]+) Hz", page)
    assert stated and float(stated[2]) < 40.0 and float(stated[3]) > UP_TO, page
    error = (float(stated[1]) + 0.005) / 100.0  # as printed
    s, found = accelerance(tmp_path / "x.fmu")
    sampling = SimpleNamespace(sigma=SIGMA, lines=lambda: (np.array([UP_TO]),))

    def expected(law):
        return s**2 * core.solve(BARE, [FORCE, RESPONSE], np.zeros(60), law, sampling).receptance(s, [1], [0])[:, 0, 0]

    whole = expected(modulus(*numbers))
    # A modulus that errs by so much everywhere; and what the modes left out add.
    allowed = worst(expected(modulus(*numbers, factor=1.0 + error)), whole) + 2e-3
    assert worst(found, whole) < allowed
    assert worst(expected(lambda s: 1.0 + 0.0 * s), whole) > 10.0 * allowed, "the core must be seen"


def test_a_core_stands_beside_a_mass_a_missing_one_and_a_resonator(tmp_path):
    numbers = (0.4, 2e-4, 0.5)
    hung = [CASES[name][2][0] for name in ("local-mass", "a mass that is missing", "resonator")]
    effects = [CASES[name][0][0] for name in ("local-mass", "a mass that is missing", "resonator")]
    effects.insert(1, dict(zip(("strength", "tau", "alpha"), numbers), id="viscoelastic-core"))
    done = export(tmp_path / "x.fmu", effects, "--modes", "14", zeta=0.0)
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(tmp_path / "x.fmu") as archive:
        page = archive.read("documentation/index.html").decode()
    error = (float(re.search(r"errs by ([0-9.]+) % of it at most", page)[1]) + 0.005) / 100.0
    s, found = accelerance(tmp_path / "x.fmu")
    sampling = SimpleNamespace(sigma=SIGMA, lines=lambda: (np.array([UP_TO]),))
    points = [FORCE, RESPONSE, *(x for x, _ in hung)]

    def expected(law):
        modes = core.solve(BARE, points, np.zeros(60), law, sampling)
        receptance = lambda rows, columns: modes.receptance(s, rows, columns)  # noqa: E731
        z = [stiffness for _, stiffness in hung]
        return s**2 * attachments.coupled(receptance, s, [1], [0], list(range(2, len(points))), z)[:, 0, 0]

    whole = expected(modulus(*numbers))
    allowed = worst(expected(modulus(*numbers, factor=1.0 + error)), whole) + 2e-3
    assert worst(found, whole) < allowed
    assert worst(expected(lambda s: 1.0 + 0.0 * s), whole) > 10.0 * allowed, "the core must be seen"

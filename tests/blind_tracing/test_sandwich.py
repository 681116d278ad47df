"""Converged solid elements of a sandwich, faces and core apart: a second source of data for whole panels, and what the command finds in it."""

import json
import os
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from . import files, records, sandwich, whole
from .contour import Sampling
from .sandwich import Sandwich

ORTHOPANEL = os.environ.get("ORTHOPANEL")
PANEL = Sandwich()
HIGHEST = 3150.0  # Hz
NODES = 0.01  # m apart
# What a trace of the sound panel gives, Pa; k' = 2/3.
SOUND = {"e_x": 1.4432e10, "e_y": 1.4429e10, "nu_xy": 0.33, "g_xy": 5.4247e9, "g_yz": 1.3556e8, "g_zx": 2.258e8}


def frequencies(panel, element=sandwich.ELEMENT, flexible=80):
    """Of the flexible modes, Hz: as many as records are made of, so that one solution serves both."""
    return np.sqrt(sandwich.lowest(panel, element, flexible)[0][sandwich.RIGID :]) / 2.0 / np.pi


def test_the_elements_have_converged():
    """Frequencies err by the fourth power of the length of these elements: what they differ by from those of elements twice as long is
    fifteen times what they are off, which is no more than 5e-4 in the band, a sixth of what a real panel's are."""
    fine = frequencies(PANEL)
    in_band = np.flatnonzero(fine < HIGHEST)
    assert 15 < len(in_band) < 40
    coarse = frequencies(PANEL, 2.0 * sandwich.ELEMENT, len(in_band) + 5)
    np.testing.assert_allclose(coarse[in_band], fine[in_band], rtol=15.0 * 5e-4)


def test_val_a_long_bending_wave_is_that_of_the_theory():
    """The first bending mode of a slender strip, held between the beam of the same bending stiffness and 3 % less: shear yields a little."""
    strip = replace(PANEL, length=1.0, width=0.04, g_zx=1e9, g_yz=1e9)
    first = frequencies(strip, flexible=3)[0]
    bending = strip.e_face * (0.5 * strip.face * (strip.core + strip.face) ** 2 + strip.face**3 / 6.0)
    beam = 4.7300407**2 / strip.length**2 * np.sqrt(bending / strip.mass_per_area) / 2.0 / np.pi
    assert 0.97 * beam < first < 1.005 * beam, (first, beam)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_a_sandwich_has_the_constants_of_its_faces_and_core(tmp_path, monkeypatch):
    """What a plate of its thickness would need: from records of nine places up to 2.6 kHz the moduli to 1 %, and the rotary inertia of mass that sits in
    the faces, named by itself, to 8 %. k' = 2/3."""
    _write_case(tmp_path / "case", PANEL, monkeypatch, (9, 2600.0))
    identified, traced = (_told(action, tmp_path / "case" / "test.toml") for action in ("identify", "trace"))
    for name, value in _constants().items():
        assert identified["constants"][name]["value"] == pytest.approx(value, rel=0.01), name
    assert [effect["id"] for effect in traced["effects"]] == ["rotary-inertia"], traced["effects"]
    turning = PANEL.face_density * _second_moment() + PANEL.core_density * PANEL.core**3 / 12.0
    factor = 12.0 * turning / PANEL.mass_per_area / PANEL.thickness**2
    assert traced["effects"][0]["parameters"]["factor"]["value"] == pytest.approx(factor, rel=0.08)


@pytest.mark.skipif(ORTHOPANEL is None, reason="ORTHOPANEL names no binary")
def test_val_a_patch_without_core_is_found(tmp_path, monkeypatch):
    """A square of 60 mm inside which the core bears no shear: with the constants held that a trace of the sound panel gives, the disbond is named,
    within 5 mm of its middle and of its side. With those of the closed form, 1 % off, another place was found."""
    x, y = 0.09, -0.05
    _write_case(tmp_path / "case", replace(PANEL, patch=(x, y, 0.06)), monkeypatch)
    with (tmp_path / "case" / "test.toml").open("a", encoding="utf-8") as test:
        test.write("\n[constants]\n" + "".join(f"{name} = {value}\n" for name, value in SOUND.items()))
    traced = _told("trace", tmp_path / "case" / "test.toml")
    assert traced["verdict"] == "explained", traced["candidates"][:3]
    found = {effect["id"]: effect["parameters"] for effect in traced["effects"]}
    place = {name: value["value"] for name, value in found["stiffness-loss"].items()}
    assert np.hypot(place["x"] - x, place["y"] - y) < 0.005, place
    assert abs(place["span"] - 0.06) < 0.005, place


def _second_moment():
    """Of the faces about the middle plane, m3."""
    return 0.5 * PANEL.face * (PANEL.core + PANEL.face) ** 2 + PANEL.face**3 / 6.0


def _constants():
    """Of a plate of its thickness, Pa; k' = 2/3."""
    bending = 12.0 * PANEL.e_face * _second_moment() / PANEL.thickness**3
    shear = 1.5 * (PANEL.core + PANEL.face) ** 2 / PANEL.core / PANEL.thickness
    wanted = {"e_x": bending, "e_y": bending, "nu_xy": PANEL.nu_face, "g_xy": bending / 2.0 / (1.0 + PANEL.nu_face)}
    return wanted | {"g_zx": shear * PANEL.g_zx, "g_yz": shear * PANEL.g_yz}


def _write_case(folder, panel, monkeypatch, size=(12, HIGHEST)):
    """Hits of a sandwich at so many places, up to a frequency."""
    count, highest = size
    random = np.random.default_rng(5)
    monkeypatch.setattr(whole, "solve", sandwich.solve)
    on_node = lambda at: np.round(np.asarray(at) / NODES) * NODES  # noqa: E731
    half = np.array([panel.length, panel.width]) / 2.0
    response = half - 0.05
    draws = (on_node(random.uniform(-0.44, 0.44, 2) * 2.0 * half) for _ in range(10000))
    places = {tuple(at) for at, _ in zip((at for at in draws if np.hypot(*(at - response)) > whole.APART), range(count))}
    zeta = np.exp(random.uniform(*np.log(whole.DAMPING), 80))
    sampling, contact = Sampling(2.56 * highest, 8192), tuple(part / highest for part in whole.CONTACT)
    bench = whole.WholeBench(panel, zeta, np.array(sorted(places)), response, (), 2, 1e-3, sampling, contact)
    files.write_case(folder, bench, records.play(bench, random))


def _told(action, test):
    """What the command says of a test."""
    return json.loads(subprocess.run([ORTHOPANEL, action, test, "--json"], capture_output=True, text=True, check=True).stdout)

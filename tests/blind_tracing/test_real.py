"""Real panels against the exact beam, and what they are off by against what was asked."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from . import attachments, beam, catalogue, exact, files, make, real, records, sets
from .contour import Sampling
from .draw import Draw

PIECE = beam.Panel(0.8, 0.1, 0.03, 6.88, 1.067e10, 5.304e8)
SMALL = Sampling(samples=4096)
STEPS = (-0.21, 0.0, 0.13)


def stepped(*values):
    """Constant between STEPS."""
    return lambda x: np.array(values)[np.searchsorted(STEPS, x)]


UNEVEN = replace(
    PIECE,
    bending_along=stepped(1.1, 0.9, 1.05, 0.95),
    shear_along=stepped(0.8, 1.2, 1.0, 1.1),
    mass_along=stepped(1.05, 0.9, 1.1, 1.0),
    steps=STEPS,
)


@pytest.mark.parametrize("panel", [UNEVEN, replace(UNEVEN, left="clamped")])
def test_val_an_uneven_panel_is_the_exact_one(panel):
    """Bending, shear and mass in four different parts: the receptance by transfer matrices up to 8 kHz, rigid part and all."""
    s = 10.0 + 2.0j * np.pi * np.arange(5.0, 8000.0, 173.0)
    modes = beam.solve(panel, (-0.31, 0.22), np.zeros(200))
    found = replace(modes, zeta=np.zeros(len(modes))).receptance(s, [1], [0])[:, 0, 0]
    wanted = np.array([exact.receptance(panel, line, -0.31, 0.22) for line in s])
    around = np.maximum(np.abs(wanted), np.median(np.abs(wanted * s**2)) / np.abs(s**2))
    assert np.max(np.abs(found - wanted) / around) < 1e-4


def test_val_without_wandering_frequencies_are_the_exact_beams():
    """A field of no size: the zeros of the exact beam's determinant, within 1e-8."""
    even = {name: real.wandering(0.8, 0.0, 0.1, np.random.default_rng(1)) for name in real.FIELDS}
    modes = beam.solve(replace(PIECE, **even), (0.4,), ())
    for omega in modes.omega[2:8]:
        determinant = lambda at: exact.determinant(PIECE, 1.0j * at).real  # noqa: E731
        wanted = brentq(determinant, omega * (1.0 - 1e-4), omega * (1.0 + 1e-4), rtol=1e-12)
        assert wanted == pytest.approx(omega, rel=1e-8)


def test_val_cords_in_the_panel_are_springs_at_their_places():
    """The receptance with cords as part of the modes and by exact springs."""
    cords = ((-0.22, 900.0), (0.22, 900.0))
    s = 3.0 + 2.0j * np.pi * np.array([1.0, 7.0, 12.0, 40.0, 400.0, 2100.0])
    modes = beam.solve(replace(PIECE, cords=cords), (-0.3, 0.35), np.zeros(200))
    found = replace(modes, zeta=np.zeros(len(modes))).receptance(s, [1], [0])[:, 0, 0]
    springs = [(x, attachments.spring(stiffness)) for x, stiffness in cords]
    wanted = [exact.receptance(PIECE, line, -0.3, 0.35, springs) for line in s]
    np.testing.assert_allclose(found, wanted, rtol=1e-5)


def test_a_wandering_field_has_its_size_mean_and_reach():
    """Of 300 fields: mean 0 and rms 2 % along each, and the correlation of a Gauss curve at its reach."""
    random, x = np.random.default_rng(5), np.linspace(-0.4, 0.4, 801)
    drawn = np.array([real.wandering(0.8, 0.02, 0.05, random)(x) - 1.0 for _ in range(300)])
    np.testing.assert_allclose(np.mean(drawn, axis=1), 0.0, atol=1e-4)
    np.testing.assert_allclose(np.std(drawn, axis=1), 0.02, rtol=2e-2)
    apart = np.mean(drawn[:, 200:600] * drawn[:, 250:650]) / 0.02**2
    # The mean along the piece, which is taken out, holds reach sqrt(2 pi) / 0.8 m of the variance.
    taken = 0.05 * np.sqrt(2.0 * np.pi) / 0.8
    assert apart == pytest.approx((np.exp(-0.5) - taken) / (1.0 - taken), abs=0.08)


@pytest.fixture(scope="module")
def smooth():
    """The same test twice without noise: with its modes off, and as they are."""
    case, pair = real.Case("none", "none"), []
    for _ in range(2):
        bench, _, told = sets.build(case, np.random.default_rng(10))
        bench.noise = 0.0
        pair.append(bench)
    pair[1].own = None
    return *pair, told


def test_val_records_have_the_residues_that_were_asked(smooth):
    """Residues read off the records by least squares at the true poles, over those of the modes as they are: the factors told."""
    off, plain, told = smooth
    shares = np.array(told["shares"])
    read = [_residues(bench, share) for bench, share in ((off, shares), (plain, 0.0 * shares))]
    strong = np.abs(read[1]) > 0.1 * np.max(np.abs(read[1]), axis=1, keepdims=True)
    ratio = (read[0] / read[1]).real - 1.0
    asked = np.array(told["residues"])[: ratio.shape[1]].T
    assert np.sum(strong) >= 10
    np.testing.assert_allclose(ratio[strong], asked[strong], atol=5e-4)


def _residues(bench, shares):
    """Of each record, those of the first six flexible modes."""
    sampling = bench.sampling
    frequency, s = sampling.lines()
    played = records.play(bench, np.random.default_rng(9))
    force, acceleration = (sampling.transform_of(part[:, 0], len(s)) for part in (played.force, played.acceleration))
    modes = bench.modes([bench.sensed()])
    omega, zeta = modes.omega[2:12] * (1.0 + shares[:10]), modes.zeta[2:12]
    band = (frequency > 80.0) & (frequency < 0.8 * omega[7] / 2.0 / np.pi)
    s = s[band]
    basis = s[:, None] ** 2 / (s[:, None] ** 2 + 2.0 * zeta * omega * s[:, None] + omega**2)
    basis = np.hstack([basis, np.ones((len(s), 1)), s[:, None] ** 2 / omega[-1] ** 2])
    split = lambda part: np.concatenate([part.real, part.imag])  # noqa: E731
    answers = (acceleration / force)[:, band]
    return np.array([np.linalg.lstsq(split(basis), split(one), rcond=None)[0][:6] for one in answers])

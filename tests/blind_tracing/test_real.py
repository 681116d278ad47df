"""Real panels against the exact beam, and what they are off by against what was asked."""

from dataclasses import replace

import numpy as np
import pytest
import pyuff
from scipy.optimize import brentq

from . import attachments, beam, exact, files, lists, make, real, records, sets, visible
from .contour import Sampling

PIECE = beam.Panel(0.8, 0.1, 0.03, 6.88, 1.067e10, 5.304e8)
SMALL = Sampling(samples=2048)
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
    """Residues read off the records by least squares at the true poles, over those of the modes as they are: the factors
    told, and a thousandth in quadrature."""
    off, plain, told = smooth
    shares = np.array(told["shares"])
    read = [_residues(bench, share) for bench, share in ((off, shares), (plain, 0.0 * shares))]
    along, across = [one[:, :6] for one in read], [one[:, 6:] for one in read]
    strong = np.abs(along[1]) > 0.1 * np.max(np.abs(along[1]), axis=1, keepdims=True)
    asked = np.array(told["residues"])[:6].T
    assert np.sum(strong) >= 10
    np.testing.assert_allclose((along[0] / along[1] - 1.0)[strong], asked[strong], atol=5e-4)
    quadrature = ((across[0] - across[1]) / along[1])[strong]
    assert 0.5e-3 < np.std(quadrature) < 1.6e-3


def _residues(bench, shares):
    """Of each record, those of the first six flexible modes, and what is in quadrature of these."""
    sampling = bench.sampling
    frequency, s = sampling.lines()
    played = records.play(bench, np.random.default_rng(9))
    force, acceleration = (sampling.transform_of(part[:, 0], len(s)) for part in (played.force, played.acceleration))
    modes = bench.modes([bench.sensed()])
    omega, zeta = modes.omega[2:12] * (1.0 + shares[:10]), modes.zeta[2:12]
    band = (frequency > 80.0) & (frequency < 0.8 * omega[7] / 2.0 / np.pi)
    s = s[band]
    basis = s[:, None] ** 2 / (s[:, None] ** 2 + 2.0 * zeta * omega * s[:, None] + omega**2)
    basis = np.hstack([basis, basis * s[:, None] / omega, np.ones((len(s), 1)), s[:, None] ** 2 / omega[-1] ** 2])
    split = lambda part: np.concatenate([part.real, part.imag])  # noqa: E731
    answers = (acceleration / force)[:, band]
    return np.array([np.linalg.lstsq(split(basis), split(one), rcond=None)[0] for one in answers])[:, [*range(6), *range(10, 16)]]


def test_modes_are_off_by_their_shares(smooth):
    """Frequencies of the flexible modes by the shares told, whose spread is what was drawn; motions on the cords not at all."""
    off, _, told = smooth
    points = [*off.forces, off.sensed()]
    plain = off.modes(points)
    moved = off.off_by_itself(plain, np.arange(len(off.forces)), len(off.forces))
    np.testing.assert_allclose((moved.omega / plain.omega - 1.0)[2:12], told["shares"][:10], atol=1e-12)
    np.testing.assert_array_equal(moved.omega[:2], plain.omega[:2])
    np.testing.assert_array_equal(moved.shape[:, -1], plain.shape[:, -1])
    assert np.std(told["shares"]) == pytest.approx(told["share"], rel=0.35)
    assert np.std(told["residues"]) == pytest.approx(3e-3, rel=0.15)
    assert off.hanging and all(0.02 <= zeta <= 0.08 for zeta in plain.zeta[:2])


def test_hits_fall_a_millimetre_beside_their_marks_and_gains_differ():
    """Over 200 benches of a random test."""
    random, hits, gains = np.random.default_rng(3), [], []
    bench = real._draw(real.Case("none", "none"), random, None)
    for _ in range(200):
        real._beside(bench, random)
        hits.append(bench.off.ravel())
        gains.append(bench.record_gain - 1.0)
    assert np.std(np.concatenate(hits)) == pytest.approx(1e-3, rel=0.1)
    assert np.std(np.concatenate(gains)) == pytest.approx(3e-3, rel=0.1)


def test_an_effect_shows_by_what_constants_do_not_undo():
    """A stiffer panel is none; a wrong gain shows twice as much at twice the size; a gain of 1 % beside 0.5 % of two places, some 2."""
    bench = real._draw(real.Case("none", "none"), np.random.default_rng(7), None)
    stiffer, gains = visible.copy(bench), []
    stiffer.change_panel(e_x=1.001 * bench.panel.e_x, g_zx=0.999 * bench.panel.g_zx)
    assert visible.amplitude(stiffer, bench, bench, 1e-3) < 0.05
    for gain in (1.0, 1.01, 1.02):
        other = visible.copy(bench)
        other.gain = gain
        gains.append(visible.amplitude(other, bench, bench, 1e-3))
    assert gains[0] == 0.0
    assert gains[2] == pytest.approx(2.0 * gains[1], rel=1e-6)
    residues = visible._seen(bench)[1]
    strong = np.sqrt(residues.size + len(bench.forces))  # rms 1 of the residues, and some of the motion as a whole
    assert 0.5 * strong < gains[1] / 2.0 < 2.0 * strong


def test_val_the_hung_strip_hangs_as_a_rigid_body_would():
    """Two cords, a mass of 4 g at 0.27 m: the two motions of a rigid bar in closed form within 1e-3, damped by 5 %."""
    bench, effects, _ = sets.build(real.Case("hung strip", "hung", ("sensor-mass", "suspension")), np.random.default_rng(1))
    own, load, x = 0.6 * 0.08 * 5.1, 4e-3, 0.27
    turning = own * (0.6**2 + 0.02**2) / 12.0
    mass = np.array([[own + load, load * x], [load * x, turning + load * x**2]])
    wanted = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, np.diag([300.0, 300.0 * 0.165**2])))))
    found = lists.poles(lists.coupled(bench)[0])[0][[0, 2]]
    np.testing.assert_allclose(np.abs(found), wanted, rtol=1e-3)
    np.testing.assert_allclose(-found.real / np.abs(found), 0.05, rtol=3e-2)
    assert [effect["parameters"] for effect in effects] == [{"mass": 4e-3}, {"stiffness": 150.0}]


SPECIAL = ("viscoelastic-core", "width-coupling", "cubic-stiffness", "softening-core", "tension", "temperature-drift")


@pytest.mark.parametrize("name", SPECIAL)
def test_every_way_of_playing_can_be_real(name):
    """What has modes or forces of its own: finite, and moved by the modes' shares."""
    case, played = real.Case(name, "one", (name,)), []
    for seed in range(100):
        if len(real._draw(case, np.random.default_rng(seed), SMALL).forces) == 1:
            break
    for own in (True, False):
        # The first number drawn says whether the effect is hard to see, the outside group has no such number.
        bench, _, _ = sets.build(replace(case, group="outside"), np.random.default_rng(seed), SMALL)
        bench.own = bench.own if own else None
        played.append(records.play(bench, np.random.default_rng(1)).acceleration)
    assert np.all(np.isfinite(played))
    difference = np.sqrt(np.mean((played[0] - played[1]) ** 2) / np.mean(played[1] ** 2))
    assert 1e-4 < difference < 1.0


def test_a_seed_makes_the_same_files_and_a_whole_truth(tmp_path):
    """Two sets of three cases; the truth tells all that was drawn, and no case folder more than a tester knows."""
    made = []
    for name in ("one", "other"):
        make.make(tmp_path / name, "real", 3, 5, SMALL)
        made.append({p.relative_to(tmp_path / name): p.read_bytes() for p in (tmp_path / name).rglob("*") if p.is_file()})
    assert made[0] == made[1] and len(made[0]) > 6
    truth = files.read_truth(tmp_path / "one")
    assert sorted(case["kind"] == "none" for case in truth["cases"]) == [False, False, True]
    told = {"wander", "alike_over_m", "share", "shares", "residues", "hard", "amplitudes", "group", "record_gains", "hits_off_m", "zeta"}
    assert all(told <= set(case) for case in truth["cases"])


def test_groups_have_their_shares_and_every_effect_its_turn():
    """Of 60 tests 12 lack nothing and 12 lack two effects; every effect of the catalogue comes once or twice alone."""
    drawn = real.cases(60, 902)
    counts = {group: sum(case.group == group for case in drawn) for group in real.GROUPS}
    assert counts == {"none": 12, "one": 27, "two": 12, "hung": 3, "outside": 6}
    alone = [case.kind for case in drawn if case.group == "one"]
    assert {alone.count(name) for name in real.EFFECTS} == {1, 2}
    assert real.cases(60, 902) == drawn != real.cases(60, 903)


def test_accelerations_in_g_are_told_as_such(tmp_path):
    """The hung strip's file is in g, and the test file says so."""
    bench, _, _ = sets.build(real.Case("hung strip, cords told", "hung", ("sensor-mass",)), np.random.default_rng(1), SMALL)
    played = records.play(bench, np.random.default_rng(2))
    files.write_case(tmp_path / "case", bench, played)
    read = pyuff.UFF(str(tmp_path / "case" / "point-0.uff")).read_sets(1)
    np.testing.assert_allclose(read["data"], played.acceleration[0, 0] / 9.80665, rtol=1e-6)
    text = (tmp_path / "case" / "test.toml").read_text()
    assert text.count('response_unit = "g"') == 7 and 'id = "suspension"' in text and "sensor-mass" not in text

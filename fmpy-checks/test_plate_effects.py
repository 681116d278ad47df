"""A plate with effects: the FMU's accelerance against finite elements of its own (scikit-fem), line by line.

The FMU runs under a short pulse; force and acceleration go to the Laplace plane, s = sigma + j omega. There the plate is one
sparse system a line, s^2 M + K_b + g(s) K_s + sum_p Z_p(s) r_p r_p^T, with no mode anywhere: bending and shear stiffness
K_b, K_s, core modulus g, and rows r_p of the elements, which stand on feet of 10 mm, with their dynamic stiffnesses Z_p: each foot is a
cell of its own, over which the row is the mean deflection. The panel's own damping is zero, and sigma keeps the peaks finite.
"""

import re
import sys
import zipfile

import numpy as np
import pytest
from exported import ROOT, run_export
from plate_by_scikit_fem import stiffnesses
from plate_panel import CONSTANTS, PIECE, model
from pulse_lines import accelerance, worst
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementComposite, ElementQuadP, FacetBasis, MeshQuad

sys.path.insert(0, str(ROOT / "tests"))
from blind_tracing import attachments  # noqa: E402

FORCE, RESPONSE = (-0.31, 0.08), (0.27, -0.11)
UP_TO = 1500.0  # Hz
MODES = ("--modes", "80")
SPAN = (0.15, 0.25)
FOOT = 0.01
TOLERANCE = 3e-3  # of the rms over all lines


def lines_of(side, cells, more, feet):
    """Lines of a mesh over a side: even ones and `more` outside the feet, and the edges of these."""
    lines = np.concatenate([np.linspace(-side / 2, side / 2, cells + 1), more])
    lines = [line for line in lines if all(abs(line - foot) > 0.5 * FOOT for foot in feet)]
    lines = np.unique([*lines, *(foot + end * FOOT for foot in feet for end in (-0.5, 0.5))])
    return lines[np.concatenate([[True], np.diff(lines) > 1e-9])]


class Plate:
    """Matrices of the plate; `loss` of both shear stiffnesses over SPAN, `rotary` a factor on its inertia. `feet` are cells."""

    def __init__(self, loss=0.0, rotary=1.0, cells=(12, 5), order=4, constants=CONSTANTS, feet=()):
        d11, d22, d12, d66, a44, a55 = stiffnesses(PIECE, constants)
        a, b = PIECE["length"], PIECE["width"]
        x, y = ([place[axis] for place in feet] for axis in (0, 1))
        mesh = MeshQuad.init_tensor(lines_of(a, cells[0], SPAN, x), lines_of(b, cells[1], (), y))
        element = ElementComposite(*(ElementQuadP(order) for _ in range(3)))
        self.basis = basis = Basis(mesh, element, intorder=2 * order)
        at = lambda axis, end: mesh.facets_satisfying(lambda x: np.isclose(x[axis], end))  # noqa: E731
        self.edges = [[FacetBasis(mesh, element, facets=at(axis, end)) for end in (-side / 2, side / 2)] for axis, side in enumerate((a, b))]

        @BilinearForm
        def bending(w, p, q, w2, p2, q2, _):
            (px, py), (qx, qy) = p.grad, q.grad
            (p2x, p2y), (q2x, q2y) = p2.grad, q2.grad
            return d11 * px * p2x + d22 * qy * q2y + d12 * (px * q2y + qy * p2x) + d66 * (py + qx) * (p2y + q2x)

        @BilinearForm
        def shear(w, p, q, w2, p2, q2, at):
            left = np.where((at.x[0] > SPAN[0]) & (at.x[0] < SPAN[1]), 1.0 - loss, 1.0)
            return left * (a55 * (w.grad[0] + p) * (w2.grad[0] + p2) + a44 * (w.grad[1] + q) * (w2.grad[1] + q2))

        @BilinearForm
        def mass(w, p, q, w2, p2, q2, _):
            inertia = rotary * PIECE["mass_per_area"] * PIECE["thickness"] ** 2 / 12.0
            return PIECE["mass_per_area"] * w * w2 + inertia * (p * p2 + q * q2)

        self.bending, self.shear, self.mass = (form.assemble(basis) for form in (bending, shear, mass))

    def row(self, place):
        """The deflection at a place."""
        row = np.zeros(self.basis.N)
        row[self.basis.split_indices()[0]] = self.basis.split_bases()[0].probes(np.array([place]).T).toarray()[0]
        return row

    def foot(self, place):
        """The mean deflection over a foot."""
        points, weights = np.polynomial.legendre.leggauss(3)
        at = lambda x, y: self.row((place[0] + FOOT / 2 * x, place[1] + FOOT / 2 * y))  # noqa: E731
        return sum(u * v / 4.0 * at(x, y) for x, u in zip(points, weights) for y, v in zip(points, weights))

    def along_edges(self, kilograms):
        """The mass matrix of so many kilograms spread evenly along each of left and right, and of front and back."""

        @BilinearForm
        def edge(w, p, q, w2, p2, q2, at):
            return at.per_metre * w * w2

        sides = zip(kilograms, self.edges, (PIECE["width"], PIECE["length"]))
        return sum(edge.assemble(basis, per_metre=mass / length) for mass, pair, length in sides for basis in pair)

    def accelerance(self, s, hung=(), core=lambda s: 1.0, edge_mass=None):
        """s^2 w / F on the lines; `hung` lists (place, Z(s))."""
        mass = self.mass + self.along_edges(edge_mass) if edge_mass else self.mass
        force, response = self.row(FORCE), self.row(RESPONSE)
        rows = [self.foot(place) for place, _ in hung]
        loads = np.array([force, *rows]).T.astype(complex)
        found = []
        for line in s:
            whole = csc_matrix(line**2 * mass + self.bending + core(line) * self.shear)
            moved = splu(whole).solve(loads)
            seen = np.array([response, force, *rows]) @ moved
            direct = seen[0, 0]
            if rows:
                z = np.array([stiffness(line) for _, stiffness in hung])
                inner = np.eye(len(rows)) + seen[2:, 1:] * z[None, :]
                direct -= (seen[0, 1:] * z) @ np.linalg.solve(inner, seen[2:, 0])
            found.append(line**2 * direct)
        return np.array(found)


RESONATOR = {"id": "resonator", "mass": 0.05, "frequency": 500.0, "zeta": 0.02, "x": -0.33}
MASS = {"id": "local-mass", "mass": 0.04, "x": 0.12}
CORE = {"id": "viscoelastic-core", "strength": 0.4, "tau": 2e-4, "alpha": 0.5}
HANGS = {"local-mass": lambda e: attachments.mass(e["mass"]),
         "resonator": lambda e: attachments.resonator(e["mass"], e["frequency"], e["zeta"])}


def law(s):
    """The core's modulus over that at low frequency (Bagley and Torvik 1983)."""
    return 1.0 + CORE["strength"] * (s * CORE["tau"]) ** CORE["alpha"] / (1.0 + (s * CORE["tau"]) ** CORE["alpha"])


# Effects, the plate they leave behind, and what more acts.
CASES = {
    "none": ([], {}, {}),
    "local-mass": ([MASS], {}, {}),
    "a mass that is missing": ([{"id": "local-mass", "mass": -0.03, "x": -0.2}], {}, {}),
    "edge-mass": ([{"id": "edge-mass", "mass": 0.05, "mass_y": 0.08}], {}, {"edge_mass": (0.05, 0.08)}),
    "stiffness-loss": ([{"id": "stiffness-loss", "loss": 0.6, "span": 0.1, "x": 0.2}], {"loss": 0.6}, {}),
    "rotary-inertia": ([{"id": "rotary-inertia", "factor": 2.2}], {"rotary": 2.2}, {}),
    "resonator": ([RESONATOR], {}, {}),
}


def export(path, effects, *options, **changes):
    content = model(**changes)
    content["damping"] = {"beyond": 0.0}
    content["effects"] = [{"owner": "panel", **effect} for effect in effects]
    return run_export(content, path, *options, forces=[FORCE], responses=[RESPONSE])


def hung(effects):
    return [((e["x"], e.get("y", 0.0)), HANGS[e["id"]](e)) for e in effects if e["id"] in HANGS]


def lines(fmu, parameters=()):
    """Some lines of the contour, and the FMU's accelerance there."""
    s, found = accelerance(fmu, parameters, UP_TO)
    return s[::20], found[::20]


@pytest.fixture(scope="module")
def bare():
    """The accelerance of the plate without effects, on the same lines."""
    known = {}

    def of(s):
        if "lines" not in known:
            known["lines"] = Plate().accelerance(s)
        return known["lines"]

    return of


@pytest.mark.parametrize("name", CASES)
def test_an_effect_of_a_plate_is_in_the_fmu(tmp_path, name, bare):
    effects, body, more = CASES[name]
    done = export(tmp_path / "x.fmu", effects, *MODES)
    assert done.returncode == 0, done.stderr
    s, found = lines(tmp_path / "x.fmu")
    feet = [place for place, _ in hung(effects)]
    expected = Plate(feet=feet, **body).accelerance(s, hung(effects), **more) if effects else bare(s)
    assert worst(found, expected) < TOLERANCE
    if effects:
        assert worst(bare(s), expected) > 10 * TOLERANCE, "the effect must be seen"


def test_all_effects_stand_together_in_the_fmu(tmp_path, bare):
    effects = [MASS, RESONATOR, CORE, {"id": "edge-mass", "mass": 0.05}, {"id": "rotary-inertia", "factor": 2.2}]
    done = export(tmp_path / "x.fmu", effects, "--modes", "20")
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(tmp_path / "x.fmu") as archive:
        page = archive.read("documentation/index.html").decode()
    error = (float(re.search(r"errs by ([0-9.]+) % of it at most", page)[1]) + 0.005) / 100.0
    s, found = lines(tmp_path / "x.fmu")
    # What the modes left out add grows with the square of frequency: with twenty 1e-3 of the rms here (with twelve 1.3e-2).
    near = s.imag < 2.0 * np.pi * 700.0
    s, found = s[near], found[near]
    plate = Plate(rotary=2.2, feet=[place for place, _ in hung(effects)])
    of = lambda core: plate.accelerance(s, hung(effects), core, edge_mass=(0.05, 0.0))  # noqa: E731
    expected = of(law)
    # What a modulus that errs by as much everywhere changes, and what the modes left out add.
    allowed = worst(of(lambda s: (1.0 + error) * law(s)), expected) + 2 * TOLERANCE
    assert worst(found, expected) < allowed
    assert worst(of(lambda s: 1.0), expected) > 5 * allowed, "the core must be seen"


def test_effects_of_a_plate_stay_where_parameters_are_set(tmp_path):
    assert export(tmp_path / "x.fmu", [MASS, RESONATOR], *MODES).returncode == 0
    changes = {"g_zx": 4.1e8, "e_y": 8e9}
    s, found = lines(tmp_path / "x.fmu", changes.items())
    standing = hung([MASS, RESONATOR])
    plate = Plate(constants={**CONSTANTS, **changes}, feet=[place for place, _ in standing])
    expected = plate.accelerance(s, standing)
    assert worst(found, expected) < TOLERANCE


def test_what_a_plate_cannot_have_is_refused(tmp_path):
    ratios = {"e_y_ratio": 0.9, "nu_xy": 0.3, "g_xy_ratio": 0.3, "g_yz_ratio": 0.6}
    done = export(tmp_path / "x.fmu", [{"id": "width-coupling", **ratios}])
    assert done.returncode == 1 and "width-coupling in a model file" in done.stderr, done.stderr
    assert not (tmp_path / "x.fmu").exists()

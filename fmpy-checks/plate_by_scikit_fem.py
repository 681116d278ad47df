"""Natural frequencies of an orthotropic Mindlin plate by scikit-fem: a witness that shares nothing with ours.

    python plate_by_scikit_fem.py MODEL.json --count 20 [--repeat 5]

reads a model file (`orthopanel.model/1`, structure "mindlin-plate", all edges free unless its boundary says clamped) and
prints one JSON line: {"frequencies": [...], "built_s", "cold_s"}. `built_s` is the median time of the eigenproblem once the matrices
stand, `cold_s` that of everything.

Energies: 2U = ∫ D11 a_x^2 + 2 D12 a_x b_y + D22 b_y^2 + D66 (a_y + b_x)^2 + A55 (w_x + a)^2 + A44 (w_y + b)^2 over the area,
2T = ∫ rho t w'^2 + rho t^3/12 (a'^2 + b'^2); a and b turn the section about y and x. The shear coefficient is 2/3 in both
directions (section 2.3 of the paper). Fourth-order quadrilaterals do not lock at the thicknesses met here.
"""

import argparse
import functools
import json
import statistics
import time

import numpy as np
from scipy.sparse.linalg import eigsh
from skfem import Basis, BilinearForm, ElementComposite, ElementQuadP, MeshQuad, condense

SHEAR_COEFFICIENT = 2.0 / 3.0
ORDER = 4


def stiffnesses(piece, constants):
    """D11, D22, D12, D66, A44, A55 of the standard law."""
    value = {name: c["value"] if isinstance(c, dict) else c for name, c in constants.items()}
    t = piece["thickness"]
    nu_yx = value["nu_xy"] * value["e_y"] / value["e_x"]
    bending = t**3 / 12.0 / (1.0 - value["nu_xy"] * nu_yx)
    return (
        value["e_x"] * bending,
        value["e_y"] * bending,
        value["nu_xy"] * value["e_y"] * bending,
        value["g_xy"] * t**3 / 12.0,
        SHEAR_COEFFICIENT * value["g_yz"] * t,
        SHEAR_COEFFICIENT * value["g_zx"] * t,
    )


def corners(half, count, graded):
    """Corners of the cells along one direction; graded ones crowd at the edges, where thin plates have layers."""
    even = np.linspace(-1.0, 1.0, count + 1)
    return half * (np.sin(0.5 * np.pi * even) if graded else even)


def matrices(model, cells, graded=False):
    """K, M and the degrees of freedom that are free."""
    piece = model["piece"]
    d11, d22, d12, d66, a44, a55 = stiffnesses(piece, model["constants"])
    half = 0.5 * piece["length"], 0.5 * piece["width"]
    mesh = MeshQuad.init_tensor(*(corners(side, count, graded) for side, count in zip(half, cells)))
    element = ElementComposite(*(ElementQuadP(ORDER) for _ in range(3)))
    basis = Basis(mesh, element, intorder=2 * ORDER)

    @BilinearForm
    def stiffness(w, a, b, w2, a2, b2, _):
        (ax, ay), (bx, by) = a.grad, b.grad
        (a2x, a2y), (b2x, b2y) = a2.grad, b2.grad
        bending = d11 * ax * a2x + d22 * by * b2y + d12 * (ax * b2y + by * a2x) + d66 * (ay + bx) * (a2y + b2x)
        return bending + a55 * (w.grad[0] + a) * (w2.grad[0] + a2) + a44 * (w.grad[1] + b) * (w2.grad[1] + b2)

    @BilinearForm
    def mass(w, a, b, w2, a2, b2, _):
        rotary = piece["mass_per_area"] * piece["thickness"] ** 2 / 12.0
        return piece["mass_per_area"] * w * w2 + rotary * (a * a2 + b * b2)

    edges = {
        "left": lambda x: np.isclose(x[0], -half[0]),
        "right": lambda x: np.isclose(x[0], half[0]),
        "front": lambda x: np.isclose(x[1], -half[1]),
        "back": lambda x: np.isclose(x[1], half[1]),
    }
    held = [np.empty(0, dtype=int)]
    for name, end in model.get("boundary", {}).items():
        if end == "free":
            continue
        if end != "clamped":
            raise SystemExit(f"boundary.{name} = {end!r}: this witness knows free and clamped edges")
        held.append(basis.get_dofs(mesh.facets_satisfying(edges[name])).all())
    free = np.setdiff1d(np.arange(basis.N), np.concatenate(held))
    return stiffness.assemble(basis), mass.assemble(basis), free


def frequencies(stiffness, mass, free, count):
    """The lowest flexible natural frequencies [Hz]."""
    k, m = stiffness[free][:, free].tocsc(), mass[free][:, free].tocsc()
    # A small negative shift keeps the factor of a free plate regular.
    values = eigsh(k, count + 3, m, sigma=-1e4, which="LM", return_eigenvectors=False)
    found = np.sqrt(np.clip(np.sort(values), 0.0, None)) / (2.0 * np.pi)
    return found[found > 1e-2 * found[-1] / count][:count]


def solve(model, cells, count):
    """Frequencies [Hz] and mass-normalised vectors of the lowest modes of a free plate, three rigid ones first; the basis."""
    stiffness, mass, free = matrices(model, cells)
    k, m = stiffness[free][:, free].tocsc(), mass[free][:, free].tocsc()
    values, vectors = eigsh(k, count + 3, m, sigma=-1e4, which="LM")
    order = np.argsort(values)
    found = np.sqrt(np.clip(values[order], 0.0, None)) / (2.0 * np.pi)
    found[:3] = 0.0
    half = 0.5 * model["piece"]["length"], 0.5 * model["piece"]["width"]
    mesh = MeshQuad.init_tensor(np.linspace(-half[0], half[0], cells[0] + 1), np.linspace(-half[1], half[1], cells[1] + 1))
    return found, vectors[:, order], Basis(mesh, ElementComposite(*(ElementQuadP(ORDER) for _ in range(3))))


@functools.cache
def solved(model, cells, count):
    """The same of a model file's text, once for all places asked about."""
    return solve(json.loads(model), cells, count)


def shapes_at(model, cells, count, places):
    """Frequencies [Hz] and deflections at places (x, y) of a free plate's modes, three rigid ones first."""
    found, vectors, basis = solved(json.dumps(model), cells, count)
    rows = basis.split_indices()[0]
    return found, basis.split_bases()[0].probes(np.array(places).T) @ vectors[rows]


def nodal_lines(model, cells, count):
    """Frequencies [Hz] and nodal lines [across x, across y] of the lowest flexible modes of a free plate.

    Lines are counted as changes of sign of the deflection along the line of cells' corners where it is greatest, in both
    directions: no projection, so it shares nothing with how orthopanel names a mode.
    """
    half = 0.5 * model["piece"]["length"], 0.5 * model["piece"]["width"]
    x, y = np.linspace(-half[0], half[0], 61), np.linspace(-half[1], half[1], 25)
    grid = np.array(np.meshgrid(x, y, indexing="ij")).reshape(2, -1)
    frequencies, shapes = shapes_at(model, cells, count, grid.T)
    found = []
    for frequency, shape in list(zip(frequencies, shapes.T))[3:]:
        deflection = shape.reshape(len(x), len(y))
        changes = [0, 0]
        for axis in (0, 1):
            amplitude = np.abs(deflection).max(axis=axis)
            line = deflection.take(int(np.argmax(amplitude)), axis=1 - axis)
            # Values near zero have no sure sign.
            line = line[np.abs(line) > 1e-3 * np.abs(line).max()]
            changes[axis] = int(np.sum(np.sign(line[1:]) != np.sign(line[:-1])))
        found.append((float(frequency), changes))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--cells", type=int, nargs=2, default=[12, 3])
    parser.add_argument("--repeat", type=int, default=1)
    arguments = parser.parse_args()
    with open(arguments.model, encoding="utf-8") as file:
        model = json.load(file)
    built, cold = [], []
    for _ in range(arguments.repeat):
        start = time.perf_counter()
        parts = matrices(model, arguments.cells)
        middle = time.perf_counter()
        found = frequencies(*parts, arguments.count)
        end = time.perf_counter()
        built.append(end - middle)
        cold.append(end - start)
    print(json.dumps({"frequencies": list(found), "built_s": statistics.median(built), "cold_s": statistics.median(cold)}))


if __name__ == "__main__":
    main()

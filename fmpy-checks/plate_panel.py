"""The plate under test, with ports off its centre line; its fixtures take the place of the beam's where they are imported."""

from functools import cache

import pytest
from exported import exporter
from plate_by_scikit_fem import shapes_at

PIECE = {"length": 0.8, "width": 0.3, "thickness": 0.03, "mass_per_area": 6.880}
# Table 4's E_x and G_zx of piece 1; the others such as a honeycomb has them, all apart.
CONSTANTS = {"e_x": 1.07e10, "e_y": 9.6e9, "nu_xy": 0.31, "g_xy": 3.7e9, "g_yz": 2.9e8, "g_zx": 5.363e8}
# With its three rigid modes the plate has as many as the beam of the other checks.
ZETAS = [2.4e-3, 1.3e-3, 1.1e-3, 2.3e-3, 5.5e-3]
# As many as the beam's; the second response stands at the first force.
FORCES = [(-0.3, 0.1), (-0.25, -0.12), (-0.15, 0.15), (-0.05, -0.03), (0.0, 0.0), (0.05, 0.07), (0.15, -0.15), (0.25, 0.02),
          (0.4, 0.15)]
RESPONSES = [(0.3, -0.11), (-0.3, 0.1)]


def model(**changes):
    """The model file's content, sizes and constants changed."""
    changed = lambda values: {name: changes.get(name, value) for name, value in values.items()}
    return {
        "schema": "orthopanel.model/1",
        "piece": changed(PIECE),
        "structure": "mindlin-plate",
        "constants": changed(CONSTANTS),
        "damping": {"ratios": ZETAS, "beyond": 0.003},
    }


@cache
def shapes_at_ports():
    """Frequencies and deflections at all forces, then all responses, by scikit-fem: solved once, not for each pair of ports."""
    return shapes_at(model(), (16, 6), len(ZETAS), [*FORCES, *RESPONSES])


def modes_at(force, response):
    """(omega, zeta, product of shapes) by scikit-fem, rigid modes first, as `modal_sum` takes them."""
    frequencies, shapes = shapes_at_ports()
    a, b = shapes[FORCES.index(force)], shapes[len(FORCES) + RESPONSES.index(response)]
    return list(zip(6.283185307179586 * frequencies, [0.0, 0.0, 0.0, *ZETAS], a * b))


@pytest.fixture(scope="session")
def export(tmp_path_factory):
    return exporter(tmp_path_factory.mktemp("plate-fmu"), model, FORCES, RESPONSES, len(ZETAS))


@pytest.fixture(scope="session", params=[2, 3], ids=["fmi2", "fmi3"])
def fmu(request, export):
    return export(f"v{request.param}.fmu", "--fmi", str(request.param))


@pytest.fixture(scope="session")
def fmu2(export):
    return export("default.fmu")

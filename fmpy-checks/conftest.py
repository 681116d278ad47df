"""The panel under test, exported once for each version of the standard."""

import pytest

from exported import ROOT, exporter  # noqa: F401  (ROOT is taken from here)
from timoshenko import Beam

# Test piece 1 of the paper: table 3, mass per area of section 3.1, constants and damping of table 9.
BEAM = Beam(length=0.8, width=0.1, thickness=0.03, mass_per_area=6.880, e_x=1.067e10, g_zx=5.304e8)
ZETAS = [2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3]

# Nine forces: FMPy 0.3.32 passes input derivatives of exactly nine inputs.
FORCES = [-0.3, -0.25, -0.15, -0.05, 0.0, 0.05, 0.15, 0.25, 0.4]
RESPONSES = [0.3, -0.3]


def model(beam=BEAM):
    """The model file's content."""
    sizes = ("length", "width", "thickness", "mass_per_area")
    return {
        "schema": "orthopanel.model/1",
        "piece": {name: getattr(beam, name) for name in sizes},
        "structure": "timoshenko-beam",
        "constants": {"e_x": beam.e_x, "g_zx": beam.g_zx},
        "damping": {"ratios": ZETAS, "beyond": 0.003},
    }


@pytest.fixture(scope="session")
def export(tmp_path_factory):
    return exporter(tmp_path_factory.mktemp("fmu"), model, FORCES, RESPONSES, len(ZETAS))


@pytest.fixture(scope="session", params=[2, 3], ids=["fmi2", "fmi3"])
def fmu(request, export):
    return export(f"v{request.param}.fmu", "--fmi", str(request.param))


@pytest.fixture(scope="session")
def fmu2(export):
    return export("default.fmu")

"""The coupled vehicle against the closed form, and W_k against the standard's table."""

import json
import zipfile
from pathlib import Path

import fmpy
import pytest
from compare import coupling_error, spectra_and_comfort
from comfort import w_k
from coupled_runs import in_ecos, in_fmpy
from lxml import etree
from monolith import Monolith
from vehicle import MODEL, build_fmus, resonator, write_ssp


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rail-car")
    build_fmus(folder)
    return folder


def test_val_the_ssp_is_valid_by_the_standards_schemas(folder, bracket):
    schemas = Path(fmpy.__file__).parent / "ssp/schema"
    with zipfile.ZipFile(write_ssp(folder / "valid.ssp", folder, bracket)) as archive:
        for name, schema in (("SystemStructure.ssd", "Description"), ("resources/parameters.ssv", "ParameterValues")):
            document = etree.fromstring(archive.read(name))
            etree.XMLSchema(file=str(schemas / f"SystemStructure{schema}.xsd")).assertValid(document.getroottree())
            # OMSimulator knows prefixes, not namespaces.
            assert {"ssd": "ssd", "ssv": "ssv"}.get(document.prefix) and None not in document.nsmap


@pytest.fixture(scope="module")
def bracket():
    return resonator(json.loads(MODEL.read_text()))


def test_val_coupling_error_falls_with_the_square_of_the_step(folder, bracket):
    ssp, monolith = write_ssp(folder / "predicted.ssp", folder, bracket), Monolith(folder / "floor.fmu", bracket)
    coarse, fine = (
        coupling_error(in_fmpy(ssp, step, round(2.0 / step)), monolith, step, 1.0) for step in (1e-3, 5e-4)
    )
    assert coarse < 0.01
    # Second order: 4, and a little more where the third order still shows.
    assert 3.5 < coarse / fine < 5.5


def test_val_ecospy_couples_to_second_order_too(folder):
    try:
        import ecospy  # noqa: F401
    except (ImportError, OSError) as reason:
        pytest.skip(f"ecospy does not load: {reason}")
    monolith = Monolith(folder / "floor.fmu")
    coarse, fine = (
        coupling_error(in_ecos(folder, None, step, round(2.0 / step)), monolith, step, 1.0) for step in (1e-3, 5e-4)
    )
    assert coarse < 0.01 and 3.5 < coarse / fine < 5.5


@pytest.mark.parametrize("with_bracket, coupled, exact", [(False, "0.1542", "0.1543"), (True, "0.1428", "0.1429")])
def test_comfort_is_what_the_readme_says(folder, bracket, with_bracket, coupled, exact):
    *_, found, closed = spectra_and_comfort(folder, bracket if with_bracket else None, 6.0, 1e-3)
    assert (f"{found:.4f}", f"{closed:.4f}") == (coupled, exact)


@pytest.mark.parametrize("hertz, factor", [(1.0, 0.482), (4.0, 0.967), (6.3, 1.054), (16.0, 0.768), (31.5, 0.405)])
def test_val_w_k_is_that_of_table_3(hertz, factor):
    # Three digits, at the nominal frequencies of third octaves.
    assert abs(w_k(hertz)) == pytest.approx(factor, rel=2e-3)

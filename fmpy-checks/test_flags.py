"""Each capability flag that the standard knows, written in the XML or not, reads as the FMU behaves."""

from pathlib import Path
from xml.etree import ElementTree

import fmpy
import pytest
from flag_probes import PROBES
from fmpy import extract

SCHEMAS = Path(fmpy.__file__).parent / "schema"
XS = "{http://www.w3.org/2001/XMLSchema}"
INTERFACES = ("ModelExchange", "CoSimulation")


def of_the_standard(version, interface):
    """Flags of an interface with the value that one has where it is not written, from the standard's schema."""
    if version == 2:
        schema = ElementTree.parse(SCHEMAS / "fmi2/fmi2ModelDescription.xsd")
        parts = [e for e in schema.iter(f"{XS}element") if e.get("name") == interface]
    else:
        schema = ElementTree.parse(SCHEMAS / "fmi3/fmi3InterfaceType.xsd")
        parts = [e for e in schema.iter(f"{XS}complexType") if e.get("name") in ("fmi3InterfaceType", f"fmi3{interface}")]
    attributes = [a for part in parts for a in part.iter(f"{XS}attribute") if a.get("type") != "xs:normalizedString"]
    return {a.get("name"): a.get("default") for a in attributes if a.get("name") != "modelIdentifier"}


FLAGS = [(v, i, flag) for v in (2, 3) for i in INTERFACES for flag in of_the_standard(v, i)]


@pytest.fixture(scope="module")
def fmus(export, tmp_path_factory):
    folder = tmp_path_factory.mktemp("flags")
    return {v: Path(extract(str(export(f"v{v}.fmu", "--fmi", str(v))), unzipdir=str(folder / str(v)))) for v in (2, 3)}


def written(fmu, interface):
    attributes = dict(ElementTree.parse(fmu / "modelDescription.xml").find(interface).attrib)
    assert attributes.pop("modelIdentifier") == "panel"
    return attributes


@pytest.mark.parametrize("version, interface, flag", FLAGS)
def test_a_flag_reads_as_the_fmu_behaves(fmus, version, interface, flag):
    reads = written(fmus[version], interface).get(flag, of_the_standard(version, interface)[flag])
    assert PROBES[flag](fmus[version], interface) == reads


@pytest.mark.parametrize("version", [2, 3])
def test_no_flag_and_no_interface_goes_without_a_probe(fmus, version):
    """A flag that is new here or in the standard wants a probe of its own."""
    found = {e.tag for e in ElementTree.parse(fmus[version] / "modelDescription.xml").getroot()}
    assert found & {*INTERFACES, "ScheduledExecution"} == set(INTERFACES)
    for interface in INTERFACES:
        known = set(of_the_standard(version, interface))
        assert set(written(fmus[version], interface)) <= known <= set(PROBES)
    assert len(FLAGS) > 40

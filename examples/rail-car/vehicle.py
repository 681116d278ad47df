"""The vehicle as an SSP: car, floor panel and, where the panel's model names a `resonator`, the bracket on it."""

import json
import os
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

from pythonfmu.builder import FmuBuilder
from rail_car import MOUNTS

HERE = Path(__file__).resolve().parent
MODEL = HERE / "floor.json"
MODES_UP_TO = 150.0  # Hz, three times the track's highest line
FOOT = len(MOUNTS) + 2  # the response port where a passenger's foot stands; the one before is the bracket's place
OUTPUT = f"acceleration_{FOOT}"
SHARED = ["port_slave.py", "suspended_system.py"]
NAMESPACES = {
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
}
STEP = 5e-4  # s, of OMSimulator's master, which takes it from an annotation; FMPy and ecospy are told theirs


def resonator(model):
    """The bracket that the model file names as an effect, or None."""
    return next((effect for effect in model.get("effects", []) if effect["id"] == "resonator"), None)


def build_fmus(folder, model=MODEL):
    """Writes car.fmu, bracket.fmu and floor.fmu.

    The panel goes without the bracket, which is a component of its own, so that the coupling of three is shown.
    """
    folder.mkdir(parents=True, exist_ok=True)
    bare = json.loads(Path(model).read_text())
    bare["effects"] = []
    (folder / "bare-floor.json").write_text(json.dumps(bare))
    command = os.environ.get("ORTHOPANEL", str(HERE.parent.parent / "target/release/orthopanel"))
    words = [command, "export", str(folder / "bare-floor.json"), "-o", str(folder / "floor.fmu"), "--name", "floor", "--up-to", str(MODES_UP_TO)]
    # Residual modes weigh some hundred grams at a mount, which its dashpot, a step of 1 ms late, would drive: soft mounts want none.
    words += ["--residual", "none"]
    subprocess.run(words, check=True, capture_output=True)
    for script, name, more in (("rail_car.py", "car", ["car_body.py", "track.py"]), ("loose_bracket.py", "bracket", [])):
        FmuBuilder.build_FMU(HERE / script, folder / f"{name}.fmu", [HERE / file for file in SHARED + more])


def ports(with_bracket):
    """(component, its port, the panel's port) of each place where force is handed over."""
    joined = [("car", port, port) for port in range(1, len(MOUNTS) + 1)]
    return joined + [("bracket", 1, len(MOUNTS) + 1)] * with_bracket


def connections(with_bracket):
    """(component, output, component, input) of each wire."""
    wires = []
    for component, port, at in ports(with_bracket):
        wires.append((component, f"force_{port}", "floor", f"force_{at}"))
        for motion in ("displacement", "velocity"):
            wires.append(("floor", f"{motion}_{at}", component, f"{motion}_{port}"))
    return wires


def parameters(bracket, predict):
    """Start values by component and name; FMPy 0.3.32 sets a Boolean `false` of an SSV to true, so none is listed."""
    values = {}
    if predict:
        values |= {"car.predict": True, "floor.force_linear": True}
    if bracket:
        values |= {f"bracket.{name}": bracket[name] for name in ("mass", "frequency", "zeta")}
        if predict:
            values["bracket.predict"] = True
    return values


def write_ssp(path, folder, bracket=None, predict=True):
    """Packs the FMUs of `folder` with their wiring and parameters into the SSP `path`."""
    wires = connections(bracket is not None)
    components = ["car", "floor"] + ["bracket"] * (bracket is not None)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", _structure(components, wires))
        archive.writestr("resources/parameters.ssv", _values(parameters(bracket, predict)))
        for component in components:
            archive.write(folder / f"{component}.fmu", f"resources/{component}.fmu")
    return path


def _text(root):
    for prefix, address in NAMESPACES.items():
        ElementTree.register_namespace(prefix, address)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True)


def _structure(components, wires):
    ssd = lambda name: f"{{{NAMESPACES['ssd']}}}{name}"  # noqa: E731
    ssc = lambda name: f"{{{NAMESPACES['ssc']}}}{name}"  # noqa: E731
    oms = lambda name: f"{{{NAMESPACES['oms']}}}{name}"  # noqa: E731
    root = ElementTree.Element(ssd("SystemStructureDescription"), version="1.0", name="rail_car")
    system = ElementTree.SubElement(root, ssd("System"), name="vehicle")
    bindings = ElementTree.SubElement(system, ssd("ParameterBindings"))
    ElementTree.SubElement(bindings, ssd("ParameterBinding"), source="resources/parameters.ssv")
    elements = ElementTree.SubElement(system, ssd("Elements"))
    for name in components:
        fmu = {"type": "application/x-fmu-sharedlibrary", "source": f"resources/{name}.fmu"}
        component = ElementTree.SubElement(elements, ssd("Component"), name=name, **fmu)
        connectors = ElementTree.SubElement(component, ssd("Connectors"))
        outputs = [wire[1] for wire in wires if wire[0] == name] + [OUTPUT] * (name == "floor")
        inputs = [wire[3] for wire in wires if wire[2] == name]
        for kind, variables in (("output", outputs), ("input", inputs)):
            for variable in variables:
                connector = ElementTree.SubElement(connectors, ssd("Connector"), name=variable, kind=kind)
                ElementTree.SubElement(connector, ssc("Real"))
    joined = ElementTree.SubElement(system, ssd("Connections"))
    for wire in wires:
        names = ("startElement", "startConnector", "endElement", "endConnector")
        ElementTree.SubElement(joined, ssd("Connection"), dict(zip(names, wire)))
    noted = ElementTree.SubElement(ElementTree.SubElement(system, ssd("Annotations")), ssc("Annotation"), type="org.openmodelica")
    information = ElementTree.SubElement(ElementTree.SubElement(noted, oms("Annotations")), oms("SimulationInformation"))
    step = {"description": "oms-ma", "stepSize": str(STEP), "absoluteTolerance": "1e-6", "relativeTolerance": "1e-6"}
    ElementTree.SubElement(information, oms("FixedStepMaster"), step)
    return _text(root)


def _values(values):
    ssv = lambda name: f"{{{NAMESPACES['ssv']}}}{name}"  # noqa: E731
    root = ElementTree.Element(ssv("ParameterSet"), version="1.0", name="vehicle")
    listed = ElementTree.SubElement(root, ssv("Parameters"))
    for name, value in values.items():
        parameter = ElementTree.SubElement(listed, ssv("Parameter"), name=name)
        kind = "Boolean" if isinstance(value, bool) else "Real"
        ElementTree.SubElement(parameter, ssv(kind), value=str(value).lower())
    return _text(root)

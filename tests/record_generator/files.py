"""A test as a folder: `test.toml`, the records as CSV or UFF 58, and `truth.json`, which only a scorer reads.

CSV holds one hit a file with the columns `time_s,force_n,acceleration_m_s2`, so every hit is a measurement of its own.
UFF holds all hits of a place in one file, force then acceleration, as dataset 58 or 58b in double precision (pyuff
writes it).
"""

import importlib.util
import json
from pathlib import Path

import numpy as np

from . import beam

FORMATS = ("csv", "uff", "uff-binary")
TIME_RESPONSE, ACCELERATION, FORCE, TIME = 1, 12, 13, 17  # codes of dataset 58
Z_TRANSLATION = 3


def write(setup, modes, places, folder, kind="csv"):
    """Write the test into `folder` (made if absent, refused unless empty) and return its `test.toml`."""
    if kind not in FORMATS:
        raise ValueError(f'format "{kind}": one of {", ".join(FORMATS)}')
    if kind == "csv" and setup.unit != "m/s2":
        raise ValueError('unit "g" with CSV: its column is called acceleration_m_s2; write UFF for a record in g')
    if kind != "csv" and importlib.util.find_spec("pyuff") is None:
        raise ValueError(f'format "{kind}" is written by pyuff: pip install pyuff, or write csv')
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise ValueError(f"{folder} is not empty: name a new folder")
    plan = folder / "test.toml"
    blocks = [_piece(setup)]
    for place, (pair, hits) in enumerate(zip(setup.pairs, places)):
        if kind == "csv":
            names = [f"point-{place}-hit-{number}.csv" for number in range(1, len(hits) + 1)]
            for name, hit in zip(names, hits):
                _write_csv(folder / name, setup, hit)
        else:
            names = [f"point-{place}.uff"]
            _write_uff(folder / names[0], setup, pair, hits, binary=kind == "uff-binary")
        blocks += [_measurement(setup, name, pair) for name in names]
    plan.write_text("\n".join(blocks), encoding="utf-8")
    (folder / "truth.json").write_text(json.dumps(truth(setup, modes, places), indent=1) + "\n", encoding="utf-8")
    return plan


def truth(setup, modes, places):
    """What was put in: constants, damping, natural frequencies, noise and every hit. SI units."""
    zeta = beam.damping(modes, setup.zeta, setup.zeta_beyond)
    seen = modes.frequency <= 0.5 * setup.sampling_rate
    return {
        "schema": "orthopanel.record-truth/1",
        "constants": {"e_x": setup.panel.e_x, "g_zx": setup.panel.g_zx, "shear_coefficient": beam.SHEAR_COEFFICIENT},
        "modes": [
            {"mode": m, "frequency_hz": float(f), "zeta": float(z)}
            for m, (f, z) in enumerate(zip(modes.frequency[seen], zeta[seen]), start=1)
        ],
        "dynamic_modes": len(modes.frequency),
        "noise": {"level": setup.noise, "of": setup.noise_of},
        "pulse": setup.pulse,
        "anti_alias": setup.anti_alias,
        "double_hits": list(setup.double_hits),
        "overloads": list(setup.overloads),
        "sensor": {"sign": setup.sensor_sign, "unit": setup.unit},
        "seed": setup.seed,
        "points": [
            {"force_at": pair[0], "response_at": pair[1], "hits": [hit.facts for hit in hits]}
            for pair, hits in zip(setup.pairs, places)
        ],
    }


def _piece(setup):
    """The [piece] table."""
    panel = setup.panel
    return (
        f"[piece]\nlength = {panel.length}\nwidth = {panel.width}\n"
        f"thickness = {panel.thickness}\nmass_per_area = {panel.mass_per_area}\n"
    )


def _measurement(setup, name, pair):
    """One [[measurement]]; unit and direction are declared only where they are not the plain ones."""
    lines = ["[[measurement]]", 'kind = "time-history"', f'file = "{name}"']
    lines += [f"force_at = [{pair[0]}, 0.0]", f"response_at = [{pair[1]}, 0.0]"]
    if setup.unit != "m/s2":
        lines.append(f'unit = "{setup.unit}"')
    if setup.sensor_sign != 1:
        lines.append(f"direction = {setup.sensor_sign}")
    return "\n".join(lines) + "\n"


def _write_csv(path, setup, hit):
    """One hit; ten digits keep the rounding under the smallest noise asked for."""
    time = np.arange(setup.samples) / setup.sampling_rate
    table = np.column_stack([time, hit.force, hit.acceleration])
    header = "time_s,force_n,acceleration_m_s2"
    np.savetxt(path, table, fmt=["%.12g", "%.10g", "%.10g"], delimiter=",", header=header, comments="")


def _write_uff(path, setup, pair, hits, binary):
    """All hits of a place. Nodes are numbered along the places of the test. The header calls every direction +z, as an
    analyser does whose user turned the sensor round and did not tell it: test.toml alone declares the sign, once."""
    import pyuff  # only this option needs it

    nodes = sorted({x for p in setup.pairs for x in p})
    force_node, response_node = (nodes.index(x) + 1 for x in pair)
    time = np.arange(setup.samples) / setup.sampling_rate
    sets = []
    for number, hit in enumerate(hits, start=1):
        channels = [
            ("Force", hit.force, force_node, FORCE, "N"),
            ("Acceleration", hit.acceleration, response_node, ACCELERATION, setup.unit),
        ]
        for name, data, node, code, unit in channels:
            sets.append(
                pyuff.prepare_58(
                    binary=int(binary),
                    id1=f"{name} hit {number}",
                    func_type=TIME_RESPONSE,
                    ver_num=number,
                    rsp_node=node,
                    rsp_dir=Z_TRANSLATION,
                    ref_node=force_node,
                    ref_dir=Z_TRANSLATION,
                    abscissa_spacing=1,
                    abscissa_spec_data_type=TIME,
                    abscissa_axis_units_lab="s",
                    ordinate_spec_data_type=code,
                    ordinate_axis_units_lab=unit,
                    orddenom_spec_data_type=0,
                    x=time,
                    data=data,
                )
            )
    pyuff.UFF(str(path)).write_sets(sets, mode="add")

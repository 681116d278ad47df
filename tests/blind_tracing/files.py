"""A case as a folder that a tester would hand over (test.toml and a UFF 58b file a place), and the truth of all cases.

The truth lies in one file beside the case folders, and in none of them.
"""

import json

import numpy as np
import pyuff

TRUTH = "truth.json"
SCHEMA = "orthopanel.blind-truth/1"
TIME_RESPONSE, ACCELERATION, FORCE, TIME = 1, 12, 13, 17  # codes of dataset 58
Z_TRANSLATION = 3
SI = "m/s2"
UNITS = {SI: 1.0, "g": 9.80665}  # of an acceleration, m/s2


def write_case(folder, bench, played):
    """The folder of one case."""
    folder.mkdir(parents=True)
    plan = [piece_text(bench)]
    unit = f'response_unit = "{bench.unit}"\n' if bench.unit != SI else ""
    for place, x in enumerate(bench.forces):
        name = f"point-{place}.uff"
        _write_records(folder / name, place, bench, played)
        plan.append(measurement_text("time-history", name, x, bench.response) + unit)
    (folder / "test.toml").write_text("\n".join(plan), encoding="utf-8")


def truth_of(name, case, bench, truth, played):
    """What was put into one case."""
    return {
        "case": name,
        "kind": case.kind,
        "effects": truth,
        "rough": case.rough,
        "constants": bench.constants(),
        "across": vars(bench.across) if bench.across else None,
        "zeta": list(bench.zeta),
        "noise": {"part": bench.noise, "force_n": played.force_noise, "acceleration_m_s2": played.acceleration_noise},
        "record_gains": list(bench.gain * bench.record_gain),
        "hits_off_m": bench.struck().tolist(),
    }


def write_truth(out, name, seed, cases):
    """The one file that the scorer reads."""
    whole = {"schema": SCHEMA, "set": name, "seed": seed, "cases": cases}
    (out / TRUTH).write_text(json.dumps(whole, indent=1, default=float) + "\n", encoding="utf-8")


def read_truth(out):
    """The truth of a made set; ValueError where the file is something else."""
    whole = json.loads((out / TRUTH).read_text(encoding="utf-8"))
    if whole.get("schema") != SCHEMA:
        raise ValueError(f"{out / TRUTH}: schema {whole.get('schema')!r}, wanted {SCHEMA!r}")
    return whole


def piece_text(bench):
    """Everything of test.toml but the measurements."""
    panel = bench.panel
    text = f'structure = "{bench.structure}"\n\n' if bench.structure else ""
    text += (
        f"[piece]\nlength = {panel.length}\nwidth = {panel.width}\n"
        f"thickness = {panel.thickness}\nmass_per_area = {panel.mass_per_area}\n"
    )
    if panel.left != "free":
        text += '\n[boundary]\nleft = "clamped"\nright = "free"\n'
    if bench.suspension:
        text += f"\n[suspension]\nat = [{', '.join(_number(at) if np.isscalar(at) else _place(at) for at in bench.suspension)}]\n"
    return text + "".join(f'\n[[effect]]\nid = "{name}"\n' for name in bench.declared)


def measurement_text(kind, name, force, response):
    """One place."""
    return (
        f'[[measurement]]\nkind = "{kind}"\nfile = "{name}"\n'
        f"force_at = {_place(force)}\nresponse_at = {_place(response)}\n"
    )


def _place(at):
    """A place (x, y), or one on the centre line by its x."""
    x, y = (at, None) if np.isscalar(at) else at
    return f"[{_number(x)}, {'0.0' if y is None else _number(y)}]"


def _number(value):
    """To a tenth of a millimetre and better, no zero with a sign."""
    return f"{value + 0.0:.4g}"


def _write_records(path, place, bench, played):
    """All hits of a place, force then acceleration."""
    sets = []
    for hit in range(bench.hits):
        channels = (
            ("Force", played.force, place + 1, FORCE, "N"),
            ("Acceleration", played.acceleration / UNITS[bench.unit], len(bench.forces) + 1, ACCELERATION, bench.unit),
        )
        for name, data, node, code, unit in channels:
            sets.append(
                pyuff.prepare_58(
                    binary=1,
                    id1=f"{name} hit {hit + 1}",
                    func_type=TIME_RESPONSE,
                    ver_num=hit + 1,
                    rsp_node=node,
                    rsp_dir=Z_TRANSLATION,
                    ref_node=place + 1,
                    ref_dir=Z_TRANSLATION,
                    abscissa_spacing=1,
                    abscissa_spec_data_type=TIME,
                    abscissa_axis_units_lab="s",
                    ordinate_spec_data_type=code,
                    ordinate_axis_units_lab=unit,
                    orddenom_spec_data_type=0,
                    x=bench.sampling.time,
                    data=data[place, hit],
                )
            )
    pyuff.UFF(str(path)).write_sets(sets, mode="add")

"""Writes one hammer test in each dialect that labs leave it in, and the accelerance that each must become.

Physics, units and files are of this script, numpy and pyuff alone: it shares no code with what reads them. Under the folder given
each dialect is a folder with `test.toml`, its records and `expected.csv` (frequency, real, imaginary part, greatest relative
error allowed); their names are printed.
"""

import pathlib
import sys

import numpy as np
import pyuff

GRAVITY, INCH, POUND = 9.80665, 0.0254, 4.4482216152605
RATE, SAMPLES = 12800.0, 16384
MODES = [(0.5, 120.0, 0.02), (-0.4, 431.0, 0.015)]  # 1/kg, Hz, damping ratio
MOTION = {"displacement": 0, "velocity": 1, "acceleration": 2}
DATA_TYPE = {"displacement": 8, "velocity": 11, "acceleration": 12}
folder = pathlib.Path(sys.argv[1])
rng = np.random.default_rng(40)


def receptance(s):
    """Displacement over force at s [m/N]."""
    total = 0.0
    for part, hertz, zeta in MODES:
        omega = 2 * np.pi * hertz
        total = total + part / (s * s + 2 * zeta * omega * s + omega * omega)
    return total


def hit(peak):
    """Force and displacement, velocity and acceleration of one blow, by exact steps on a grid 16 times as fine."""
    fine, width, start = 16, 1.5e-3, 0.02
    t = np.arange(SAMPLES * fine) / (RATE * fine)
    force = np.where(abs(t - start) < width / 2, 0.5 * peak * (1 + np.cos(2 * np.pi * (t - start) / width)), 0.0)
    motion = np.zeros((3, len(t)))
    for part, hertz, zeta in MODES:
        omega = 2 * np.pi * hertz
        damped = omega * np.sqrt(1 - zeta**2)
        pole, dt = -zeta * omega + 1j * damped, 1 / (RATE * fine)
        # q' = pole q + f: exact for a force that runs straight between samples.
        e = np.exp(pole * dt)
        first, slope = (e - 1) / pole, (e - 1 - pole * dt) / (pole**2 * dt)
        drive = first * force[:-1] + slope * (force[1:] - force[:-1])
        q = _recursion(e, drive)
        x = part * q.imag / damped
        v = part * (pole * q).imag / damped
        motion += [x, v, part * force - 2 * zeta * omega * v - omega**2 * x]
    return force[::fine], motion[:, ::fine]


def _recursion(e, drive):
    """q[n+1] = e q[n] + drive[n] from rest, in blocks, without overflow."""
    q, block = np.zeros(len(drive) + 1, complex), 4096
    for start in range(0, len(drive), block):
        part = drive[start : start + block]
        powers = e ** np.arange(1, len(part) + 1)
        q[start + 1 : start + 1 + len(part)] = powers * (q[start] + np.cumsum(part / powers))
    return q


HITS = [hit(peak) for peak in (180.0, 230.0, 260.0)]
FREQUENCY = np.arange(0, 1601) * 0.78125
S = 2j * np.pi * FREQUENCY


PLACES = "force_at = [-0.2, 0]\nresponse_at = [0.3, 0]"


def dialect(name, kind, keys, files, frequency, value, error, named=None, places=PLACES):
    """Writes a folder; `files` maps a name to what writes it. A measurement a file, or one alone with `file` as `named` has it."""
    home = folder / name
    home.mkdir(parents=True)
    text = "[piece]\nlength = 1\nwidth = 0.1\nthickness = 0.02\nmass_per_area = 5\n"
    for file, write in files.items():
        write(home / file)
    for file in [named] if named else [f'"{file}"' for file in files]:
        text += f'[[measurement]]\nkind = "{kind}"\nfile = {file}\n{places}\n{keys}\n'
    (home / "test.toml").write_text(text)
    rows = np.column_stack([frequency, value.real, value.imag, np.full(len(frequency), error)])
    np.savetxt(home / "expected.csv", rows, delimiter=",", fmt="%.12g")
    print(name)


def dataset(x, data, *, kind, axis, over=(0, ""), abscissa="", ends="s", nodes=(2, 1), names=("NONE", "NONE"), even=1, binary=1):
    """A dataset 58 for pyuff."""
    label = lambda text: text or "NONE"
    return {
        "type": 58, "binary": binary, "func_type": kind, "rsp_node": nodes[0], "rsp_dir": 3, "ref_node": nodes[1], "ref_dir": 3,
        "rsp_ent_name": names[0], "ref_ent_name": names[1], "abscissa_spacing": even, "x": x, "data": data,
        "abscissa_spec_data_type": 17 if kind == 1 else 18, "abscissa_axis_units_lab": label(abscissa),
        "ordinate_spec_data_type": axis[0], "ordinate_axis_units_lab": label(axis[1]),
        "orddenom_spec_data_type": over[0], "orddenom_axis_units_lab": label(over[1]), "z_axis_spec_data_type": 0,
    }


def universal(*sets):
    """What writes a universal file of these datasets."""
    def write(path):
        for each in sets:
            pyuff.UFF(str(path)).write_sets(dict(each), mode="add")
    return write


def units(code, description, length, force):
    return {"type": 164, "units_code": code, "units_description": description, "temp_mode": 1, "length": length, "force": force,
            "temp": 1.0, "temp_offset": 273.15}


def frf(quantity="acceleration", scale=1.0, axis=None, over=(13, "N"), **more):
    """A frequency response whose numbers are `scale` times those in SI."""
    data = S ** MOTION[quantity] * receptance(S) * scale
    return dataset(more.pop("x", FREQUENCY), data, kind=4, axis=axis or (DATA_TYPE[quantity], "m/s2"), over=over, **more)


def response(name, sets, keys="", error=1e-5):
    """A dialect of an accelerance file."""
    used = slice(1, None)
    dialect(name, "accelerance", keys, {"a.uff": universal(*sets)}, FREQUENCY[used], (S**2 * receptance(S))[used], error)


response("accelerance: (1/N)*(m/s^2)", [frf(axis=(12, "(1/N)*(m/s^2)"), over=(13, ""))])
response("accelerance: 1/kg, no types", [frf(axis=(0, "1/kg"), over=(0, ""))])
response("accelerance: g over N", [frf(scale=1 / GRAVITY, axis=(12, "g"))])
response("accelerance: g over lbf", [frf(scale=POUND / GRAVITY, axis=(12, "Gs"), over=(13, "lbf"))])
response("accelerance: in/s^2 over lbf", [frf(scale=POUND / INCH, axis=(12, "in/s^2"), over=(13, "LBF"))])
response("accelerance: mm/s2 over kN", [frf(scale=1e6, axis=(12, "mm/s2"), over=(13, "kN"))])
response("accelerance: m/s2 over kgf", [frf(scale=GRAVITY, axis=(12, "M/SEC^2"), over=(13, "kgf"))])
response("accelerance: Newtons", [frf(axis=(12, "m/s/s"), over=(13, "Newtons"))])
response("accelerance: units declared", [frf(scale=POUND / GRAVITY, axis=(12, ""), over=(13, ""))],
         'response_unit = "g"\nforce_unit = "lbf"')
response("accelerance: wrong label, quantity declared", [frf(scale=1 / GRAVITY, axis=(12, "m/s^2"))],
         'quantity = "acceleration"\nresponse_unit = "g"')
response("accelerance: wrong label of the quotient", [frf(scale=POUND / INCH, axis=(12, "m/s^2/N"), over=(13, "N"))],
         'quantity = "acceleration"\nresponse_unit = "in/s2"\nforce_unit = "lbf"')
response("accelerance: volts over volts", [frf(scale=0.0102 / 0.00224, axis=(12, "V"), over=(13, "V"))],
         "response_sensitivity = 0.0102\nforce_sensitivity = 0.00224")
response("mobility: labelled m/s2, quantity declared", [frf("velocity", axis=(12, "m/s2"))],
         'quantity = "velocity"\nresponse_unit = "m/s"')
response("mobility: m/s over N", [frf("velocity", axis=(11, "m/s"))])
response("mobility: mm/s over N, no types", [frf("velocity", 1e3, axis=(0, "mm/s"), over=(0, "N"))])
response("mobility: quantity declared", [frf("velocity", axis=(0, ""), over=(0, ""))], 'quantity = "velocity"')
response("mobility: in/s over lbf, no label", [frf("velocity", POUND / INCH, axis=(11, ""), over=(13, ""))],
         'response_unit = "in/s"\nforce_unit = "lbf"')
response("receptance: m/N", [frf("displacement", axis=(8, "m/N"))])
response("receptance: um over N", [frf("displacement", 1e6, axis=(8, "um"))])
response("receptance: quantity declared", [frf("displacement", axis=(0, ""), over=(13, "N"))], 'quantity = "displacement"')
response("dataset 164: inch and pound",
         [units(7, "IN: Inch (pound f)", 1 / INCH, 1 / POUND), frf(scale=POUND / INCH, axis=(12, ""), over=(13, ""))])
response("dataset 164: millimetre and newton", [units(10, "MM: mm (newton)", 1e3, 1.0), frf(scale=1e3, axis=(12, ""), over=(13, ""))])
response("dataset 164: mobility in mm",
         [units(10, "MM: mm (newton)", 1e3, 1.0), frf("velocity", 1e3, axis=(11, ""), over=(13, ""))])
response("dataset 164: SI, label g", [units(1, "SI: Meter (newton)", 1.0, 1.0), frf(scale=1 / GRAVITY, axis=(12, "g"), over=(13, "N"))])
response("abscissa: kHz", [frf(abscissa="kHz", x=FREQUENCY / 1e3)])
response("names: longer than ten characters", [frf(names=("Accelerometer12", "Impact hammer 3x"))])

GOOD, POOR = np.full(len(FREQUENCY), 0.99), np.full(len(FREQUENCY), 0.5)
coherence = lambda values, **more: dataset(FREQUENCY, values.copy(), kind=6, axis=(0, ""), **more)
none = {"nodes": (0, 0)}
response("coherence: behind each response, no nodes",
         [frf(scale=2.0, **none), coherence(POOR, **none), frf(**none), coherence(GOOD, **none)], "record = 3")
response("coherence: two runs of one pair of places", [frf(scale=2.0), coherence(POOR), frf(), coherence(GOOD)], "record = 3")
response("coherence: all behind all responses", [frf(scale=2.0), frf(), coherence(POOR), coherence(GOOD)], "record = 2")
response("coherence: before each response", [coherence(POOR), frf(scale=2.0), coherence(GOOD), frf()], "record = 4")
response("coherence: of other nodes first", [frf(scale=2.0, nodes=(3, 1)), frf(), coherence(GOOD), coherence(POOR, nodes=(3, 1))],
         "record = 2")
response("coherence: one response without", [frf(), coherence(GOOD), frf(scale=2.0), frf(scale=3.0), coherence(POOR)], "record = 1")


def noisy(values):
    return values + 3e-6 * abs(values).max() * rng.standard_normal(len(values))


def history(name, quantity="acceleration", scale=(1.0, 1.0), axes=None, keys="", error=0.01, table=None, x=None, window=None, **more):
    """A dialect of hits: three, in one universal file, or each in a CSV that `table` writes."""
    time = np.arange(SAMPLES) / RATE
    fade = np.exp(-time / window) if window else 1.0
    records = [(fade * noisy(force) * scale[0], fade * noisy(motion[MOTION[quantity]]) * scale[1]) for force, motion in HITS]
    used = (FREQUENCY > 20) & (FREQUENCY < 700)
    if table is None:
        (of_force, of_motion) = axes
        x = time if x is None else x
        sets = [
            dataset(x, data, kind=1, axis=axis, nodes=(node, 1), **more)
            for force, motion in records for data, axis, node in ((force, of_force, 1), (motion, of_motion, 2))
        ]
        files = {"hits.uff": universal(*sets)}
    else:
        files = {f"hit-{n}.csv": table(time, *each) for n, each in enumerate(records)}
    dialect(name, "time-history", keys, files, FREQUENCY[used], (S**2 * receptance(S))[used], error)


def csv(header, number="%.9g"):
    """A CSV whose times are printed as `number` says."""
    def of(time, force, motion):
        def write(path):
            rows = zip(time, force, motion)
            text = "".join(f"{number % t},{f:.9g},{m:.9g}\n" for t, f, m in rows)
            path.write_text(f"{header}\n{text}")
        return write
    return of


def several(name, keys, sets_of, nodes=()):
    """A dialect of several channels in one file: what is not wanted is three times too large."""
    time = np.arange(SAMPLES) / RATE
    make = lambda data, axis, node, direction=3, title="NONE": dict(
        dataset(time, noisy(data), kind=1, axis=axis, nodes=(node, 1)), rsp_dir=direction, id1=title)
    sets = [each for force, motion in HITS for each in sets_of(make, force, motion[2])]
    used = (FREQUENCY > 20) & (FREQUENCY < 700)
    text = "    -1\n    15\n" + "".join(f"{n:10}{0:10}{0:10}{8:10}{x:13.5e}{y:13.5e}{0:13.5e}\n" for n, x, y in nodes) + "    -1\n"
    def write(path):
        path.write_text(text if nodes else "")
        universal(*sets)(path)
    dialect(name, "time-history", keys, {"all.uff": write}, FREQUENCY[used], (S**2 * receptance(S))[used], 0.01)


def continuous(name, keys, error):
    """Five blows in one record, with pauses of different lengths, the last one cut short by the record's end."""
    blows = [HITS[n % 3] for n in range(5)]
    pauses = [3000, 500, 4000, 900, 0]
    join = lambda parts: noisy(np.concatenate([np.concatenate([part, np.zeros(pause)]) for part, pause in zip(parts, pauses)])[:-9000])
    force, motion = join([blow[0] for blow in blows]), join([blow[1][2] for blow in blows])
    x = np.arange(len(force)) / RATE
    sets = [dataset(x, force, kind=1, axis=(13, "N"), nodes=(1, 1)), dataset(x, motion, kind=1, axis=(12, "m/s2"))]
    used = (FREQUENCY > 20) & (FREQUENCY < 700)
    dialect(name, "time-history", keys, {"all.uff": universal(*sets)}, FREQUENCY[used], (S**2 * receptance(S))[used], error)


continuous("continuous: cut by what is found", "", 0.05)
continuous("continuous: cut as declared", "trigger = {level = 30, before = 0.015, length = 1.28}", 0.01)

F, A = (13, "N"), (12, "m/s2")
several("channels: one response by its node", 'response_channel = "5:+z"',
        lambda make, f, a: [make(f, F, 1), make(3 * a, A, 4), make(a, A, 5), make(3 * a, A, 6)])
several("channels: one response by its number", "response_channel = 3",
        lambda make, f, a: [make(f, F, 1), make(3 * a, A, 4), make(a, A, 5), make(3 * a, A, 6)])
several("channels: one response by its name", 'response_channel = "Point 5"',
        lambda make, f, a: [make(f, F, 1), make(3 * a, A, 4, title="Point 4"), make(a, A, 4, title="Point 5")])
several("channels: the force behind its responses", 'response_channel = "5"',
        lambda make, f, a: [make(3 * a, A, 4), make(a, A, 5), make(f, F, 1)])
several("channels: a triaxial sensor", "",
        lambda make, f, a: [make(f, F, 1), make(3 * a, A, 5, 1), make(3 * a, A, 5, 2), make(a, A, 5, 3)])
several("channels: a roving test by its nodes' places", "",
        lambda make, f, a: [make(f, F, 1), make(a, A, 5), make(f, F, 2), make(3 * a, A, 5)],
        nodes=[(1, -0.2, 0.0), (2, 0.1, 0.0), (5, 0.3, 0.0)])
several("channels: a roving test by force_channel", 'force_channel = "2:+z"',
        lambda make, f, a: [make(f, F, 1), make(3 * a, A, 5), make(f, F, 2), make(a, A, 5)])
several("channels: neither type nor unit", "force_channel = \"Hammer\"\nresponse_channel = \"Sensor\"",
        lambda make, f, a: [make(3 * a, (0, ""), 0, title="Temperature"), make(a, (0, ""), 0, title="Sensor"),
                            make(f, (0, ""), 0, title="Hammer")])
response("channels: one of several responses by its nodes", [frf(scale=2.0, nodes=(3, 1)), frf(nodes=(2, 1)), frf(scale=3.0, nodes=(2, 4))],
         'response_channel = "2"\nforce_channel = "1"')

SI = "time_s,force_n,acceleration_m_s2"
NEWTON, ACCELERATION = (13, "N"), (12, "m/s2")
history("hits: m/s2 and N", axes=(NEWTON, ACCELERATION))
history("hits: g and lbf", scale=(1 / POUND, 1 / GRAVITY), axes=((13, "lbf"), (12, "g's")))
history("hits: units declared", scale=(1 / POUND, 1 / GRAVITY), axes=((13, ""), (12, "")), keys='response_unit = "g"\nforce_unit = "lbf"')
history("hits: g declared and told", scale=(1.0, 1 / GRAVITY), axes=(NEWTON, (12, "g")), keys='response_unit = "g"')
history("hits: volts", scale=(2.24, 10.2), axes=((0, "mV"), (0, "mV")),
        keys='response_sensitivity = 0.0102\nforce_sensitivity = 0.00224\n')
history("hits: velocity in mm/s", "velocity", (1.0, 1e3), axes=(NEWTON, (11, "mm/s")))
history("hits: velocity, quantity declared", "velocity", axes=(NEWTON, (12, "")), keys='quantity = "velocity"')
history("hits: displacement in um", "displacement", (1.0, 1e6), axes=(NEWTON, (8, "um")), error=0.02)
history("hits: times in ms", axes=(NEWTON, ACCELERATION), abscissa="ms", x=1e3 * np.arange(SAMPLES) / RATE)
history("hits: uneven layout, six digits", axes=(NEWTON, ACCELERATION), even=0, binary=0)
history("hits: exponential window declared", window=0.4, axes=(NEWTON, ACCELERATION), keys="window_decay = 0.4")
history("CSV: times of 3 decimals", table=csv(SI, "%.3f"))
history("CSV: times of 4 decimals", table=csv(SI, "%.4f"))
history("CSV: times of 5 decimals", table=csv(SI, "%.5f"))
history("CSV: times of 4 digits", table=csv(SI, "%.4g"))
history("CSV: times of 5 digits (dlmwrite)", table=csv(SI, "%.5g"))
history("CSV: times of single precision", table=lambda t, f, a: csv(SI)(t.astype(np.float32), f, a))
history("CSV: times in ms, rate declared", table=lambda t, f, a: csv(SI)(1e3 * t, f, a), keys="sampling_rate = 12800")


def text(of, encoding="utf-8"):
    """A table of hits as a text of its own: `of` makes it from rows of time, force and motion."""
    return lambda time, force, motion: lambda path: path.write_text(of(list(zip(time, force, motion))), encoding=encoding)


def rows(format, comma=False):
    """Rows of numbers in a format, their decimals behind a comma where wanted."""
    line = lambda row: format % row
    return lambda table: "".join((line(row).replace(".", ",") if comma else line(row)) + "\n" for row in table)


history("text: semicolons, decimal commas, units in a row", scale=(1.0, 1 / GRAVITY),
        table=text(lambda t: "Messung 3\n\nZeit;Hammer;Beschl. 1\n[s];[N];[g]\n" + rows("%.9g;%.9g;%.9g", True)(t)))
history("text: tabs, units in the names", scale=(1 / POUND, 1.0),
        table=text(lambda t: "Time (s)\tImpact hammer (lbf)\tAccelerometer [m/s^2]\n" + rows("%.9g\t%.9g\t%.9g")(t)))
history("text: blanks, names in a comment",
        table=text(lambda t: "# time_s force_n acceleration_m_s2\n" + rows("%.9e %.9e %.9e")(t)))
history("text: UTF-16", table=text(lambda t: SI + "\n" + rows("%.9g,%.9g,%.9g")(t), "utf-16"))
history("text: quoted names and numbers",
        table=text(lambda t: '"Time, s","Force","Acceleration"\n"s","N","m/s²"\n' + rows('"%.9g"/"%.9g"/"%.9g"', True)(t).replace("/", ",")))
history("text: columns by name", keys='columns = {time = "A", force = "C", response = "D"}',
        table=text(lambda t: "A,B,C,D\n" + rows("%.9g,%.9g,%.9g,%.9g")([(a, 3 * c, b, c) for a, b, c in t])))
history("text: columns by number, none named", keys="columns = {time = 1, force = 3, response = 2}",
        table=text(lambda t: rows("%.9g %.9g %.9g")([(a, c, b) for a, b, c in t])))
history("text: no times, rate declared", keys="columns = {force = 1, response = 2}\nsampling_rate = 12800",
        table=text(lambda t: "Hammer;Sensor\n" + rows("%.9g;%.9g")([row[1:] for row in t])))
history("text: one of several channels by its name", keys='response_channel = "Acc 2"',
        table=text(lambda t: "Time (ms),Force (N),Acc 1 (m/s2),Acc 2 (m/s2)\n" + rows("%.9g,%.9g,%.9g,%.9g")([(1e3 * a, b, 3 * c, c) for a, b, c in t])))


def lvm(columns):
    """A LabVIEW measurement file with two blows, each a stretch of its own."""
    head = ("LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\nMulti_Headings\tYes\n"
            f"X_Columns\t{columns}\nTime_Pref\tRelative\n***End_of_Header***\t\n\n")
    def write(path):
        parts = []
        for force, motion in HITS:
            a = noisy(motion[2]) / GRAVITY
            f = noisy(force)
            head_of = (f"Channels\t2\t\t\nSamples\t{len(f)}\t{len(f)}\t\nDate\t2026/11/27\t2026/11/27\t\nY_Unit_Label\tNewtons\tg\t\n"
                       f"X_Dimension\tTime\tTime\t\nX0\t0\t0\t\nDelta_X\t{1 / RATE:.9g}\t{1 / RATE:.9g}\t\n***End_of_Header***\t\t\t\n"
                       "X_Value\tHammer\tSensor\tComment\n")
            x = (f"{n / RATE:.9g}" if columns == "One" else "" for n in range(len(f)))
            parts.append(head_of + "".join(f"{t}\t{p:.9g}\t{q:.9g}\n" for t, p, q in zip(x, f, a)) + "\n")
        path.write_text(head + "".join(parts))
    return write


BAND = (FREQUENCY > 20) & (FREQUENCY < 700)
for columns, name in (("One", "LVM: a column of times"), ("No", "LVM: times in the header")):
    dialect(name, "time-history", "", {"hits.lvm": lvm(columns)}, FREQUENCY[BAND], (S**2 * receptance(S))[BAND], 0.01)


def channel_files():
    """Hits whose channels have a file each."""
    time = np.arange(SAMPLES) / RATE
    def write(of):
        def to(path):
            sets = [dataset(time, noisy(force if of == 0 else motion[2]), kind=1, axis=(F, A)[of], nodes=(1, 1)) for force, motion in HITS]
            universal(*sets)(path)
        return to
    return {"force.uff": write(0), "motion.uff": write(1)}


dialect("channels: each in a file of its own", "time-history", "", channel_files(), FREQUENCY[BAND],
        (S**2 * receptance(S))[BAND], 0.01, named='{force = "force.uff", response = "motion.uff"}')


def roving(name, places, extra):
    """All points of a roving test in one file, placed by a file of nodes; the one that is asked for is chosen by its node."""
    time = np.arange(SAMPLES) / RATE
    sets = []
    for force, motion in HITS:
        for data, axis, node in ((force, F, 1), (3 * motion[2], A, 4), (motion[2], A, 5)):
            sets.append(dataset(time, noisy(data), kind=1, axis=axis, nodes=(node, 1)))
    dialect(name, "time-history", 'response_channel = "5:+z"', {"all.uff": universal(*sets), **extra}, FREQUENCY[BAND],
            (S**2 * receptance(S))[BAND], 0.01, named='"all.uff"', places=places)


roving("places: rows node,x,y", 'places = "places.csv"',
       {"places.csv": lambda path: path.write_text("node,x,y\n1,-0.2,0\n4,0,0\n5,0.3,0\n")})
nodes15 = "".join(f"{n:10}{0:10}{0:10}{8:10}{x:13.5e}{0:13.5e}{0:13.5e}\n" for n, x in ((1, 0.3), (4, 0.5), (5, 0.8)))
roving("places: dataset 15, counted from a corner", 'places = "nodes.uff"\norigin = [0.5, 0.0]',
       {"nodes.uff": lambda path: path.write_text(f"    -1\n    15\n{nodes15}    -1\n")})


def table(name, head, of, keys="", quantity="acceleration"):
    """A frequency response as a text."""
    used = slice(1, None)
    value = (S ** MOTION[quantity] * receptance(S))[used]
    lines = "".join(of(f, h) + "\n" for f, h in zip(FREQUENCY[used], value))
    dialect(name, "accelerance", keys, {"frf.txt": lambda path: path.write_text(head + "\n" + lines)}, FREQUENCY[used],
            (S**2 * receptance(S))[used], 1e-5)


degrees = lambda h: np.degrees(np.angle(h))
table("text: real and imaginary part", "Frequency (Hz)\tReal ((m/s^2)/N)\tImaginary ((m/s^2)/N)",
      lambda f, h: f"{f:.9g}\t{h.real:.9g}\t{h.imag:.9g}")
table("text: kHz", "f (kHz);Re;Im", lambda f, h: f"{f / 1e3:.9g};{h.real:.9g};{h.imag:.9g}", 'quantity = "acceleration"')
table("text: magnitude and phase in degrees", "Freq,Magnitude,Phase (deg)\nHz,g/N,deg".replace(" (deg)", ""),
      lambda f, h: f"{f:.9g},{abs(h) / GRAVITY:.9g},{degrees(h):.9g}")
table("text: dB and radians", "Frequency [Hz],H [dB re 1 (m/s^2)/N],Phase [rad]",
      lambda f, h: f"{f:.9g},{20 * np.log10(abs(h)):.12g},{np.angle(h):.9g}")
table("text: mobility by its unit", "frequency_hz,Real (mm/s/N),Imag (mm/s/N)",
      lambda f, h: f"{f:.9g},{1e3 * h.real:.9g},{1e3 * h.imag:.9g}", quantity="velocity")
table("text: magnitude between bars", "f / Hz;|Y| / (mm/s)/N;phase / rad",
      lambda f, h: f"{f:.9g};{1e3 * abs(h):.9g};{np.angle(h):.9g}", quantity="velocity")
table("text: columns of a frequency response by number", "no names here",
      lambda f, h: f"{h.imag:.9g} {h.real:.9g} {f:.9g}", "columns = {frequency = 3, real = 2, imag = 1}\nquantity = \"acceleration\"")

"""The effects that a tracer knows by name: each puts itself into a test and returns the parameters it drew.

Names of effects and parameters are those of the trace's result. README.md gives each range and its reason. Every
function takes a bench and a Draw.
"""

import numpy as np

from . import attachments, plate


def sensor_mass(bench, draw):
    """An accelerometer's mass where it sits."""
    mass = draw.rising(1e-3, 20e-3)
    bench.attachments.append((bench.sensed(), attachments.mass(mass)))
    return {"mass": mass}


def turning_sensor_mass(bench, draw):
    """An accelerometer that resists turning, too: 10 to 20 mm between its mass and the middle plane."""
    mass, arm = draw.rising(5e-3, 20e-3), draw.rising(10e-3, 20e-3)
    bench.attachments.append((bench.sensed(), attachments.mass(mass)))
    bench.change_panel(turning=((bench.sensed(), mass * arm**2),))
    return {"mass": mass, "inertia": mass * arm**2}


def suspension(bench, draw, most=2e4):
    """Springs, of up to `most` N/m, and dashpots at the suspension points."""
    stiffness, damping = draw.rising(500.0, most), draw.rising(0.5, 20.0)
    for x in bench.suspension:
        bench.attachments.append((x, attachments.spring(stiffness, damping)))
    return {"stiffness": stiffness, "damping": damping}


def local_mass(bench, draw):
    """A mass somewhere, or one that is missing."""
    mass, x = draw.rising(4e-3, 40e-3), draw.along(bench)
    if draw.sign() < 0.0:
        mass = -0.75 * mass
    bench.attachments.append((x, attachments.mass(mass)))
    return {"mass": mass, "x": x}


def edge_mass(bench, draw, most=20e-3):
    """Edge closings: the same mass, up to `most` kg, at each end."""
    mass = draw.rising(2e-3, most)
    for x in (-bench.panel.length / 2.0, bench.panel.length / 2.0):
        bench.attachments.append((x, attachments.mass(mass)))
    return {"mass": mass}


def stiffness_loss(bench, draw):
    """A disbond: the core carries less shear over a span."""
    loss, span = draw.rising(0.15, 0.8), draw.rising(0.03, 0.12)
    half = bench.panel.length / 2.0 - span / 2.0
    x = float(np.clip(draw.along(bench), -half, half))
    along = bench.panel.shear_along or (lambda at: np.ones_like(at))
    ends = (x - span / 2.0, x + span / 2.0)

    def weakened(at):
        return along(at) * np.where((at > ends[0]) & (at < ends[1]), 1.0 - loss, 1.0)

    bench.change_panel(shear_along=weakened, steps=(*bench.panel.steps, *ends))
    return {"loss": loss, "span": span, "x": x}


def resonator(bench, draw):
    """A loose bracket or a cable: a mass on a spring of its own."""
    mass, zeta, x = draw.rising(4e-3, 40e-3), draw.even(0.005, 0.05), draw.along(bench)
    frequency = float(np.exp(draw.even(np.log(150.0), np.log(3500.0))))
    bench.attachments.append((x, attachments.resonator(mass, frequency, zeta)))
    return {"mass": mass, "frequency": frequency, "zeta": zeta, "x": x}


def rotary_inertia(bench, draw):
    """More rotary inertia than that of an even section: mass sits in the faces."""
    factor = draw.rising(1.3, 3.0)
    bench.change_panel(rotary=factor)
    return {"factor": factor}


def viscoelastic_core(bench, draw):
    """A core whose shear modulus rises and damps with frequency (fractional Zener)."""
    strength, alpha = draw.rising(0.03, 0.4), draw.even(0.4, 0.9)
    tau = 1.0 / (2.0 * np.pi * float(np.exp(draw.even(np.log(200.0), np.log(4000.0)))))

    def modulus(s):
        power = (s * tau) ** alpha
        return 1.0 + strength * power / (1.0 + power)

    bench.core = modulus
    return {"strength": strength, "tau": tau, "alpha": alpha}


def width_coupling(bench, draw):
    """A panel so wide that it bends across, too: a plate in place of the beam."""
    panel = bench.panel
    bench.change_panel(width=round(max(panel.width, draw.rising(0.25, 0.4) * panel.length), 3))
    bench.across = plate.Across(
        e_y=panel.e_x * draw.even(0.6, 1.1),
        nu_xy=draw.even(0.25, 0.45),
        g_xy=panel.e_x * draw.even(0.3, 0.45),
        g_yz=panel.g_zx * draw.even(0.45, 0.8),
    )
    # A point force on a plate has no finite answer under itself.
    near = np.abs(bench.forces - bench.response) < plate.NEAREST
    bench.forces[near] = np.round(bench.response - plate.NEAREST * np.sign(bench.response), 3)
    return {}


def cubic_stiffness(bench, draw):
    """Suspension that stiffens with the cube of the motion: springs of foam or rubber."""
    k3 = draw.rising(1e9, 1e11)
    bench.restoring, bench.restoring_at = (lambda y, v: k3 * y**3), bench.suspension
    return {"k3": k3}


def channel_delay(bench, draw):
    """The acceleration's channel comes late."""
    delay = draw.rising(2e-6, 1e-4)
    bench.chain.append(lambda s: np.exp(-s * delay))
    return {"delay": delay}


def sensor_resonance(bench, draw):
    """The accelerometer on its mounting: wax or a magnet lowers its resonance."""
    frequency, zeta = draw.falling(5e3, 25e3), draw.even(0.02, 0.1)
    omega = 2.0 * np.pi * frequency
    bench.chain.append(lambda s: omega**2 / (s**2 + 2.0 * zeta * omega * s + omega**2))
    return {"frequency": frequency, "zeta": zeta}


def high_pass(bench, draw):
    """A coupling capacitor in the acceleration's channel: first order."""
    corner = draw.rising(0.5, 15.0)
    bench.chain.append(lambda s: s / (s + 2.0 * np.pi * corner))
    return {"corner": corner}


def exponential_window(bench, draw):
    """An analyser's exponential window on both channels, from the record's start."""
    bench.window = draw.falling(0.15, 2.0)
    return {"tau": bench.window}


def gain(bench, draw):
    """A wrong calibration, the same in all records."""
    bench.gain = (1.0 + draw.rising(0.02, 0.2)) ** draw.sign()
    return {"gain": bench.gain}


def record_gain(bench, draw):
    """One record's gain: an oblique hit, a range switched."""
    record = int(draw.random.integers(len(bench.forces)))
    bench.record_gain[record] = (1.0 + draw.rising(0.03, 0.2)) ** draw.sign()
    # Records count from 1, as "the fourth place" does.
    return {"gain": float(bench.record_gain[record]), "record": record + 1}


def hammer_offset(bench, draw):
    """The hammer misses each record's place by a few millimetres, the same in all hits of a record."""
    offset = [round(draw.sign() * draw.rising(2e-3, 8e-3) * 4e3) / 4e3 for _ in bench.forces]
    bench.off += np.array(offset)[:, None]
    return {"offset": [float(x) for x in bench.struck().mean(axis=1) - bench.forces]}


def support_compliance(bench, draw):
    """A clamped edge that turns and gives: it takes some 0.3 to 10 % off the first frequency."""
    panel = bench.panel
    rotation = panel.bending / panel.length * draw.falling(8.0, 300.0)
    translation = panel.bending / panel.length**3 * draw.falling(300.0, 3e4)
    bench.change_panel(left=(translation, rotation))
    return {"rotation": rotation, "translation": translation}


def position_error(bench, draw):
    """The sensor sits beside the place that was noted."""
    before = bench.response
    bench.response_off = draw.sign() * round(draw.rising(3e-3, 15e-3), 5)
    return {"offset": bench.sensed() - before}


STRUCTURAL = {
    "sensor-mass": sensor_mass,
    "suspension": suspension,
    "local-mass": local_mass,
    "edge-mass": edge_mass,
    "stiffness-loss": stiffness_loss,
    "resonator": resonator,
    "rotary-inertia": rotary_inertia,
    "viscoelastic-core": viscoelastic_core,
    "width-coupling": width_coupling,
    "cubic-stiffness": cubic_stiffness,
    "support-compliance": support_compliance,
}
CHANNEL = {
    "channel-delay": channel_delay,
    "sensor-resonance": sensor_resonance,
    "high-pass": high_pass,
    "exponential-window": exponential_window,
    "gain": gain,
    "record-gain": record_gain,
    "hammer-offset": hammer_offset,
    "position-error": position_error,
}
EFFECTS = STRUCTURAL | CHANNEL
# Kinds of a set of their own, each an effect of the catalogue with what it keeps unless it pays.
FURTHER = {"sensor-mass": turning_sensor_mass}
CANTILEVER = ("support-compliance",)  # effects that want a clamped piece
# With one record, one record's gain is the gain: there is nothing to tell apart.
NOT_SINGLE = ("record-gain",)
# What files of accelerances do not tell: the strength of a hit, how the file was calibrated, a window that an analyser takes
# out or damping hides; and what is not looked for in them yet.
NOT_ANALYSED = ("cubic-stiffness", "gain", "exponential-window", "width-coupling", "viscoelastic-core")
# What moves natural frequencies, and not as other constants do.
LISTED = (
    "sensor-mass",
    "suspension",
    "local-mass",
    "edge-mass",
    "stiffness-loss",
    "resonator",
    "rotary-inertia",
    "support-compliance",
)
# One of the structure with one of the rig or the channel.
PAIRS = (
    ("local-mass", "sensor-mass"),
    ("local-mass", "record-gain"),
    ("stiffness-loss", "gain"),
    ("stiffness-loss", "hammer-offset"),
    ("resonator", "suspension"),
    ("resonator", "position-error"),
    ("rotary-inertia", "sensor-resonance"),
    ("viscoelastic-core", "channel-delay"),
    ("edge-mass", "high-pass"),
    ("width-coupling", "gain"),
)

"""What no tracer of the catalogue can name: each puts itself into a test and returns what it drew."""

import numpy as np

from . import attachments

MIDDLE = 0.137  # of the length, from the centre: no node of the first modes, and far from the suspension points


def saturating_amplifier(bench, draw):
    """An amplifier that bends towards its limit (a hyperbolic tangent): no flat top, so no overload is seen."""
    bench.saturation = draw.falling(0.8, 2.5)
    return {"limit_over_median_peak": bench.saturation}


def dry_friction(bench, draw):
    """A cable that rubs: friction of a few tenths of a newton, rounded below some mm/s."""
    force, speed, x = draw.rising(0.05, 1.0), draw.even(3e-3, 1e-2), _aside(bench, draw)
    bench.restoring, bench.restoring_at = (lambda y, v: force * np.tanh(v / speed)), (x,)
    return {"force": force, "speed": speed, "x": x}


def spring_to_ground(bench, draw):
    """Something stiff touches the panel away from its suspension."""
    stiffness, x = draw.rising(5e3, 3e5), _aside(bench, draw)
    bench.attachments.append((x, attachments.spring(stiffness)))
    return {"stiffness": stiffness, "x": x}


def dashpot_to_ground(bench, draw):
    """A damper away from the suspension."""
    damping, x = draw.rising(2.0, 60.0), _aside(bench, draw)
    bench.attachments.append((x, attachments.spring(0.0, damping)))
    return {"damping": damping, "x": x}


def temperature_drift(bench, draw):
    """The panel warms under lamps: all stiffness falls evenly from the first hit to the last."""
    fall = draw.rising(3e-3, 2e-2)
    bench.drift = (1.0 - fall * np.linspace(0.0, 1.0, bench.drift.size)).reshape(bench.drift.shape)
    return {"fall": fall}


def mains_hum(bench, draw):
    """50 Hz and 150 Hz in the acceleration."""
    bench.hum = draw.rising(0.03, 0.5)
    return {"rms_over_response": bench.hum}


def tension(bench, draw):
    """The fixture pulls along the panel, as a string is pulled: 1 to 15 % of its buckling load."""
    force = draw.rising(0.01, 0.15) * bench.panel.bending / bench.panel.length**2 * np.pi**2
    bench.change_panel(tension=force)
    return {"tension": force}


def softening_core(bench, draw):
    """A core that softens where it is sheared: up to 30 % less shear force, over eight parts of the length."""
    panel = bench.panel
    ends = np.linspace(-panel.length / 2.0, panel.length / 2.0, 9)
    strain = draw.falling(5e-7, 5e-6)
    stiffness = 0.3 * panel.shear * panel.length / 8.0

    def law(y, v):
        # The linear core is in the panel already; this is what softening takes away. y is a part's mean shear strain.
        square = (y / strain) ** 2
        return -stiffness * y * square / (1.0 + square)

    bench.restoring, bench.restoring_spans = law, tuple(zip(ends[:-1], ends[1:]))
    return {"strain": strain}


def _aside(bench, draw):
    """A place at MIDDLE of the length, left or right."""
    return round(draw.sign() * MIDDLE * bench.panel.length, 3)


OUTSIDE = {
    "saturating-amplifier": saturating_amplifier,
    "dry-friction": dry_friction,
    "spring-to-ground": spring_to_ground,
    "dashpot-to-ground": dashpot_to_ground,
    "temperature-drift": temperature_drift,
    "mains-hum": mains_hum,
    "tension": tension,
    "softening-core": softening_core,
}

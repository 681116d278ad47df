"""Motion of a sum of modes in closed form: rows are displacement, velocity, acceleration."""

import numpy as np


def modes_at(beam, zetas, force_x, response_x):
    """(omega, zeta, product of shapes) of the rigid modes and as many flexible ones as there are damping ratios."""
    modes = [(omega, 0.0, shape) for omega, shape in beam.rigid_modes()]
    modes += [(omega, zeta, shape) for (omega, shape), zeta in zip(beam.flexible_modes(len(zetas)), zetas)]
    return [(omega, zeta, shape(force_x) * shape(response_x)) for omega, zeta, shape in modes]


def half_sine(modes, duration, t):
    """A pulse sin(pi t / duration) N from 0 to duration: a sine switched on, and again half a period later."""
    return _sum(modes, lambda omega, zeta: _sine(omega, zeta, duration, t) + _sine(omega, zeta, duration, t - duration))


def staircase(modes, forces, step):
    """A force held at forces[n] from n step to (n + 1) step; the motion just before each end of a step."""
    jumps = np.diff(forces, prepend=0.0)
    ends = step * np.arange(1, len(forces) + 1)

    def mode(omega, zeta):
        since = ends[:, None] - step * np.arange(len(forces))[None, :]
        return np.einsum("ktn,n->kt", _unit_step(omega, zeta, since), jumps)

    return _sum(modes, mode)


def ramp(modes, rate, duration, t):
    """A force that grows from 0 at `rate` [N/s] for a while and then stays."""
    shape = lambda omega, zeta: _unit_ramp(omega, zeta, t) - _unit_ramp(omega, zeta, t - duration)
    return rate * _sum(modes, shape)


def straight_lines(modes, forces, step):
    """A force that runs in straight lines from 0 through forces[n] at (n + 1) step; the motion at the end of each step."""
    slopes = np.diff(forces, prepend=0.0) / step
    bends = np.diff(slopes, prepend=0.0)
    ends = step * np.arange(1, len(forces) + 1)

    def mode(omega, zeta):
        since = ends[:, None] - step * np.arange(len(forces))[None, :]
        return np.einsum("ktn,n->kt", _unit_ramp(omega, zeta, since), bends)

    return _sum(modes, mode)


def free_motion(modes, starts, t):
    """No force: each mode from its own position and velocity; the third of each of `modes` is its shape."""
    parts = zip(modes, starts)
    return sum(shape * _free_or_rigid(omega, zeta, *start, t) for (omega, zeta, shape), start in parts)


def held_step(omega, zeta, state, force, step):
    """Position and velocity of one mode after a step under a modal force that is held over it."""
    if omega == 0.0:
        position, velocity = state
        return position + velocity * step + force * step**2 / 2.0, velocity + force * step
    rest = force / omega**2
    position, velocity, _ = _free(omega, zeta, state[0] - rest, state[1], step)
    return position + rest, velocity


def _sum(modes, motion):
    return sum(weight * motion(omega, zeta) for omega, zeta, weight in modes)


def _free(omega, zeta, position, velocity, t):
    """Free motion from a position and a velocity, as the real part of one complex exponential."""
    root = complex(-zeta * omega, omega * np.sqrt(1.0 - zeta**2))
    amplitude = complex(position, (position * root.real - velocity) / root.imag)
    wave = amplitude * np.exp(root * t)
    return np.array([wave.real, (root * wave).real, (root**2 * wave).real])


def _free_or_rigid(omega, zeta, position, velocity, t):
    if omega > 0.0:
        return _free(omega, zeta, position, velocity, t)
    return np.array([position + velocity * t, np.full_like(t, velocity), np.zeros_like(t)])


def _sine(omega, zeta, duration, t):
    """Unit modal force sin(pi t / duration) from t = 0 on, at rest before."""
    rate = np.pi / duration
    on = t >= 0.0
    t = np.where(on, t, 0.0)
    if omega == 0.0:
        motion = np.array([(t - np.sin(rate * t) / rate) / rate, (1.0 - np.cos(rate * t)) / rate, np.sin(rate * t)])
        return np.where(on, motion, 0.0)
    gain = 1.0 / complex(omega**2 - rate**2, 2.0 * zeta * omega * rate)
    wave = gain * np.exp(1j * rate * t)
    forced = np.array([wave.imag, (1j * rate * wave).imag, (-(rate**2) * wave).imag])
    free = _free(omega, zeta, -gain.imag, -rate * gain.real, t)
    return np.where(on, forced + free, 0.0)


def _unit_step(omega, zeta, t):
    """Unit modal force from t = 0 on; its value at t = 0 itself is that before the jump."""
    on = t > 0.0
    t = np.where(on, t, 0.0)
    if omega == 0.0:
        motion = np.array([t**2 / 2.0, t, np.ones_like(t)])
    else:
        rest = 1.0 / omega**2
        motion = _free(omega, zeta, -rest, 0.0, t)
        motion[0] += rest
    return np.where(on, motion, 0.0)


def _unit_ramp(omega, zeta, t):
    """Unit rate of the modal force from t = 0 on."""
    on = t > 0.0
    t = np.where(on, t, 0.0)
    if omega == 0.0:
        motion = np.array([t**3 / 6.0, t**2 / 2.0, t])
    else:
        # Behind the ramp by 2 zeta / omega, and at rest at its start.
        behind, slope = 2.0 * zeta / omega**3, 1.0 / omega**2
        motion = _free(omega, zeta, behind, -slope, t)
        motion[0] += slope * t - behind
        motion[1] += slope
    return np.where(on, motion, 0.0)

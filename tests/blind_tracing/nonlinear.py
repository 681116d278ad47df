r"""Restoring forces that are not linear, at a few places of a panel whose linear response is known.

What a place does is $y(t) = y_{lin}(t) - \int h(t - \tau) f(\tau) d\tau$ with f = law(y, dy/dt). The integral runs
over the panel's modes exactly for a force that is linear between samples; inside a block of samples f is found by
iteration, which always converges for a short enough block, as the equation is Volterra's. SI units.
"""

import numpy as np
from scipy.linalg import expm

BLOCK = 64
ROUNDS = 60


def restoring_force(modes, at, motion, speed, step, law):
    """f (places, samples, hits) from the linear `motion` [m] and `speed` [m/s] (places, samples, hits) at the points
    `at`, `step` [s] apart; samples in a multiple of BLOCK. Raises ArithmeticError where the
    iteration does not settle."""
    places, samples, hits = motion.shape
    shape = modes.shape[:, at]
    carry, before, after = _steps(modes, step)
    own, push = _block_response(shape, carry, before, after)
    powers = [carry]
    for _ in range(BLOCK - 1):
        powers.append(carry @ powers[-1])
    # From the state at the sample before the block to motion and speed at each of its samples.
    read = np.einsum("kmcs,mp->ckpms", np.stack(powers), shape).reshape(2 * BLOCK * places, -1)
    given = np.stack([motion, speed]).transpose(0, 2, 1, 3)
    state = np.zeros((len(carry), 2, hits))
    force = np.zeros((samples, places, hits))
    last = np.zeros((places, hits))  # a record starts before the hit, at rest
    for start in range(0, samples, BLOCK):
        linear = given[:, start : start + BLOCK].reshape(-1, hits) + read @ state.reshape(-1, hits)
        inside = np.repeat(last[None], BLOCK + 1, axis=0)
        inside = _settle(inside, linear, own, law, places, hits)
        force[start : start + BLOCK] = inside[1:]
        state = powers[-1] @ state - (push @ inside.reshape(-1, hits)).reshape(state.shape)
        last = inside[-1]
    return force.transpose(1, 0, 2)


def _settle(inside, linear, own, law, places, hits):
    """The block's forces (samples + 1, places, hits), the first known, by fixed-point rounds."""
    for _ in range(ROUNDS):
        reached = (linear - own @ inside.reshape(-1, hits)).reshape(2, BLOCK, places, hits)
        new = np.stack([law(y, v) for y, v in zip(reached[0], reached[1])])
        change = np.max(np.abs(new - inside[1:]))
        inside[1:] = new
        if change <= 1e-11 * (1.0 + np.max(np.abs(new))):
            return inside
    raise ArithmeticError(f"the restoring force still changes by {change:g} N after {ROUNDS} rounds")


def _steps(modes, step):
    """Each mode over one step, exactly, for a load that is linear in it: state matrix (n, 2, 2) and the parts of the
    load at the step's start and end (n, 2)."""
    carry, before, after = [], [], []
    for omega, zeta in zip(modes.omega, modes.zeta):
        # The load and its slope ride along as two more states.
        whole = np.zeros((4, 4))
        whole[0, 1], whole[1, :3], whole[2, 3] = 1.0, [-(omega**2), -2.0 * zeta * omega, 1.0], 1.0 / step
        whole = expm(whole * step)
        carry.append(whole[:2, :2])
        after.append(whole[:2, 3])
        before.append(whole[:2, 2] - whole[:2, 3])
    return np.array(carry), np.array(before), np.array(after)


def _block_response(shape, carry, before, after):
    """What the forces at a block's samples and the one before ((BLOCK + 1) places) do: motion and speed at its samples
    (2 BLOCK places), and the state left at its end (2 modes)."""
    places = shape.shape[1]
    own = np.zeros((2, BLOCK, places, BLOCK + 1, places))
    push = np.zeros((len(carry), 2, BLOCK + 1, places))
    start, end = before, after
    for lag in range(BLOCK):
        begun = np.einsum("mc,mp,mq->cpq", start, shape, shape)
        ended = np.einsum("mc,mp,mq->cpq", end, shape, shape)
        for j in range(BLOCK - lag):
            # The force j begins the step to sample j, and the force j + 1 ends it.
            own[:, j + lag, :, j, :] += begun
            own[:, j + lag, :, j + 1, :] += ended
        push[:, :, BLOCK - 1 - lag] += start[:, :, None] * shape[:, None]
        push[:, :, BLOCK - lag] += end[:, :, None] * shape[:, None]
        start, end = ((carry @ part[:, :, None])[:, :, 0] for part in (start, end))
    return own.reshape(2 * BLOCK * places, -1), push.reshape(2 * len(carry), -1)

"""Masses that hold a panel through springs and dashpots: moved by the panel and the track, they answer with forces.

    M z'' + C z' + K z = e(t) - rows' F,    F_p = k_p (rows_p z - u_p) + c_p (rows_p z' - v_p)

F_p is the force on the panel at port p, u_p and v_p the panel's motion there, e(t) = Re(sum e_k exp(j omega_k t)). The
answer to the track is a closed form; that to the panel is exact for a motion that runs as `predicts` says:
held over a step, or, with prediction, with the acceleration of the last step.
"""

import numpy as np
from scipy.linalg import expm


class SuspendedSystem:
    def __init__(self, mass, damping, stiffness, rows, springs, dashpots, omegas=(), forces=None, predicts=True):
        size, ports = len(mass), len(rows)
        inverse = np.linalg.inv(mass)
        springs, dashpots = np.diag(springs), np.diag(dashpots)
        total_stiffness = stiffness + rows.T @ springs @ rows
        total_damping = damping + rows.T @ dashpots @ rows
        zero = np.zeros((size, size))
        self.state_matrix = np.block([[zero, np.eye(size)], [-inverse @ total_stiffness, -inverse @ total_damping]])
        by_motion = np.block([[np.zeros((size, 2 * ports))], [inverse @ rows.T @ springs, inverse @ rows.T @ dashpots]])
        # State, then the panel's displacement, velocity and acceleration: the last three go on as `predicts` says.
        zeros, ones = np.zeros((ports, ports)), float(predicts) * np.eye(ports)
        motion = np.block([[zeros, ones, zeros], [zeros, zeros, ones], [zeros, zeros, zeros]])
        self.generator = np.block([
            [self.state_matrix, by_motion, np.zeros((2 * size, ports))],
            [np.zeros((3 * ports, 2 * size)), motion],
        ])
        self.to_force = np.hstack([springs @ rows, dashpots @ rows, -springs, -dashpots, zeros])
        self.predicts, self.size, self.ports = predicts, size, ports
        self.omegas = np.asarray(omegas, dtype=float)
        self.lines = self._lines(inverse, forces)
        # At rest at t = 0: the free part starts with the opposite of the track's.
        self.free = -self._driven(0.0)
        self.last_velocity = np.zeros(ports)
        self.steps = {}

    def _lines(self, inverse, forces):
        if not len(self.omegas):
            return np.zeros((0, 2 * self.size), dtype=complex)
        pushed = np.concatenate([np.zeros_like(forces), forces @ inverse.T], axis=1)
        unit = np.eye(2 * self.size)
        return np.array([
            np.linalg.solve(1j * omega * unit - self.state_matrix, push) for omega, push in zip(self.omegas, pushed)
        ])

    def _driven(self, t):
        return (np.exp(1j * self.omegas * t) @ self.lines).real

    def step(self, t, h, displacement, velocity):
        """From t to t + h with the panel's motion at t; the forces to hand over at t + h.

        With prediction these are the forces at t + 2 h, to which the panel runs in its next step; else those at t + h.
        """
        if h not in self.steps:
            self.steps[h] = expm(self.generator * h)
        onward = self.steps[h]
        acceleration = (velocity - self.last_velocity) / h
        self.last_velocity = np.array(velocity)
        moved = onward @ np.concatenate([self.free, displacement, velocity, acceleration])
        self.free = moved[: 2 * self.size]
        ahead, seen = t + h, moved
        if self.predicts:
            ahead, seen = t + 2.0 * h, onward @ moved
        whole = seen.copy()
        whole[: 2 * self.size] += self._driven(ahead)
        return self.to_force @ whole

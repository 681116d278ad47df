"""The whole vehicle as one linear system, solved in closed form: no step, no master.

    x' = A x + Re(sum_k e_k exp(j omega_k t)),   x(0) = 0

x holds displacements and velocities of the car, of the bracket and of the panel's modes, residual ones too. The panel's
frequencies, damping and shapes are read from its FMU's resources; nothing of the FMU runs.
The forces at the ports are F = k (rows z - shapes q) + c (rows z' - shapes q').
"""

import json
import zipfile

import car_body
import numpy as np
from rail_car import MOUNTS
from track import Track


class PanelModes:
    """The panel's modes at the ports, mass-normalised."""

    def __init__(self, fmu):
        with zipfile.ZipFile(fmu) as archive:
            content = json.loads(archive.read("resources/panel.json"))
        modes = content["model"]["modes"]
        self.omega = np.array([mode["angular_frequency"] for mode in modes])
        self.zeta = np.array([mode["damping_ratio"] for mode in modes])
        self.at_forces = np.array([mode["at_forces"] for mode in modes]).T
        self.at_responses = np.array([mode["at_responses"] for mode in modes]).T


class Monolith:
    def __init__(self, fmu, bracket=None, track=None):
        panel, track = PanelModes(fmu), track or Track()
        mass, damping, stiffness = car_body.matrices()
        car, modes, more = len(mass), len(panel.omega), int(bracket is not None)
        ports = len(MOUNTS) + more
        size = car + more + modes
        rows = np.zeros((ports, car + more))
        rows[: len(MOUNTS), :car] = car_body.mount_rows(MOUNTS)
        springs = len(MOUNTS) * [car_body.MOUNT_STIFFNESS]
        dashpots = len(MOUNTS) * [car_body.MOUNT_DAMPER]
        masses = np.zeros((size, size))
        masses[:car, :car] = mass
        if bracket:
            omega = 2.0 * np.pi * bracket["frequency"]
            rows[-1, -1] = 1.0
            springs.append(bracket["mass"] * omega**2)
            dashpots.append(2.0 * bracket["zeta"] * bracket["mass"] * omega)
            masses[car, car] = bracket["mass"]
        masses[car + more :, car + more :] = np.eye(modes)

        joint = np.hstack([rows, -panel.at_forces[:ports]])
        free_stiffness, free_damping = np.zeros((2, size, size))
        free_stiffness[:car, :car], free_damping[:car, :car] = stiffness, damping
        free_stiffness[car + more :, car + more :] = np.diag(panel.omega**2)
        free_damping[car + more :, car + more :] = np.diag(2.0 * panel.zeta * panel.omega)
        springs, dashpots = np.diag(springs), np.diag(dashpots)
        inverse = np.linalg.inv(masses)
        lower = [
            -inverse @ (free_stiffness + joint.T @ springs @ joint),
            -inverse @ (free_damping + joint.T @ dashpots @ joint),
        ]
        self.matrix = np.block([[np.zeros((size, size)), np.eye(size)], lower])
        self.track = track
        forces = car_body.track_forces(track) @ inverse[:car, :car].T
        unit = np.eye(2 * size)
        pushed = np.zeros((len(track.omegas), 2 * size), dtype=complex)
        pushed[:, size : size + car] = forces
        self.lines = np.array([
            np.linalg.solve(1j * omega * unit - self.matrix, push) for omega, push in zip(track.omegas, pushed)
        ])
        # No force of the track stands on the panel's own rows, so its acceleration is a row over x.
        self.to_acceleration = panel.at_responses @ self.matrix[size + car + more :]

    def line_amplitudes(self, response):
        """Complex amplitudes of the stationary acceleration [m/s2] at a response port counted from 1."""
        return self.lines @ self.to_acceleration[response - 1]

    def acceleration(self, response, times):
        """Acceleration [m/s2] from rest at t = 0, at any times [s]."""
        roots, vectors = np.linalg.eig(self.matrix)
        start = np.linalg.solve(vectors, -self.lines.sum(axis=0).real)
        weights = (self.to_acceleration[response - 1] @ vectors) * start
        stationary = self.line_amplitudes(response)
        motion = np.empty(len(times))
        for part in np.array_split(np.arange(len(times)), 1 + len(times) // 4000):
            t = times[part][:, None]
            motion[part] = (np.exp(1j * self.track.omegas * t) @ stationary).real + (np.exp(roots * t) @ weights).real
        return motion

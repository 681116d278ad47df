"""The same panel as a pythonfmu slave: modes from MODES_TEXT beside it, exact steps by NumPy."""

from pathlib import Path

import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class NumpyPanel(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.force_1 = 0.0
        self.acceleration_1 = 0.0
        self.register_variable(Real("force_1", causality=Fmi2Causality.input))
        self.register_variable(Real("acceleration_1", causality=Fmi2Causality.output))
        table = np.loadtxt(Path(__file__).with_name("modes.txt"), ndmin=2)
        self.omega, self.zeta, self.at_force, self.at_response = table.T
        self.stiffness, self.damping = self.omega**2, 2.0 * self.zeta * self.omega
        self.state = np.zeros((2, len(self.omega)))
        self.step = None

    def coefficients(self, step):
        """Exact step of each mode for a held force, by the root s of its equation of motion."""
        rigid = self.omega == 0.0
        omega = np.where(rigid, 1.0, self.omega)
        s = omega * (-self.zeta + 1j * np.sqrt(1.0 - self.zeta**2))
        e = np.exp(s * step)
        a12 = np.where(rigid, step, e.imag / s.imag)
        a11 = np.where(rigid, 1.0, e.real - s.real * e.imag / s.imag)
        a22 = np.where(rigid, 1.0, e.real + s.real * e.imag / s.imag)
        b1 = np.where(rigid, step**2 / 2.0, (1.0 - a11) / omega**2)
        self.matrix = np.array([[a11, a12], [-self.stiffness * a12, a22]])
        self.input = np.array([b1, a12])
        self.step = step

    def do_step(self, current_time, step_size):
        if step_size != self.step:
            self.coefficients(step_size)
        modal_force = self.at_force * self.force_1
        self.state = (self.matrix * self.state).sum(axis=1) + self.input * modal_force
        position, velocity = self.state
        acceleration = modal_force - self.damping * velocity - self.stiffness * position
        self.acceleration_1 = float(self.at_response @ acceleration)
        return True

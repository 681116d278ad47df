"""The effect `resonator` of the model file as an FMU that pythonfmu builds: a mass that hangs on one point of the panel."""

import numpy as np
from port_slave import PortSlave
from pythonfmu import Real
from suspended_system import SuspendedSystem


class LooseBracket(PortSlave):
    """Parameters `mass` [kg], `frequency` [Hz] on a panel at rest, damping ratio `zeta`."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.description = "A mass on a spring and a dashpot at one point of a panel"
        self.mass, self.frequency, self.zeta = 1.0, 10.0, 0.05
        for name in ("mass", "frequency", "zeta"):
            self.register_parameter(name, Real)
        self.open_ports(1)

    def exit_initialization_mode(self):
        omega = 2.0 * np.pi * self.frequency
        springs, dashpots = [self.mass * omega**2], [2.0 * self.zeta * self.mass * omega]
        none = np.zeros((1, 1))
        self.system = SuspendedSystem(
            np.array([[self.mass]]), none, none, np.ones((1, 1)), springs, dashpots, predicts=self.predict
        )

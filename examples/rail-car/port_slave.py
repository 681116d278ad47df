"""What the car and the bracket have in common as FMUs: motion of the panel in, forces on the panel out."""

import numpy as np
from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class PortSlave(Fmi2Slave):
    """`displacement_1`, `velocity_1`, ... [m, m/s] in; `force_1`, ... [N] on the panel out, all positive upwards.

    `predict` makes each force the one expected at the end of the step to come; without it, the one at this step's end.
    """

    def open_ports(self, count):
        self.ports = range(1, count + 1)
        self.predict = False
        self.register_parameter("predict", Boolean)
        for port in self.ports:
            for name in ("displacement", "velocity"):
                setattr(self, f"{name}_{port}", 0.0)
                self.register_variable(Real(f"{name}_{port}", causality=Fmi2Causality.input))
            setattr(self, f"force_{port}", 0.0)
            self.register_variable(Real(f"force_{port}", causality=Fmi2Causality.output))

    def register_parameter(self, name, kind):
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(kind(name, **fixed))

    def do_step(self, current_time, step_size):
        displacement = np.array([getattr(self, f"displacement_{port}") for port in self.ports])
        velocity = np.array([getattr(self, f"velocity_{port}") for port in self.ports])
        forces = self.system.step(current_time, step_size, displacement, velocity)
        for port, force in zip(self.ports, forces):
            setattr(self, f"force_{port}", float(force))
        return True

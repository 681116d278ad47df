"""The car body on its suspension and the track, as an FMU that pythonfmu builds."""

import car_body
from port_slave import PortSlave
from suspended_system import SuspendedSystem
from track import Track

# From the panel's centre [m]; `floor.json` has the same in its first four ports.
MOUNTS = [(-1.0, -0.35), (1.0, -0.35), (1.0, 0.35), (-1.0, 0.35)]


class RailCar(PortSlave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.description = "Rail car body on two bogies over a rough track, with four mounts for a floor panel"
        self.open_ports(len(MOUNTS))

    def exit_initialization_mode(self):
        track, count = Track(), len(MOUNTS)
        self.system = SuspendedSystem(
            *car_body.matrices(),
            car_body.mount_rows(MOUNTS),
            count * [car_body.MOUNT_STIFFNESS],
            count * [car_body.MOUNT_DAMPER],
            track.omegas,
            car_body.track_forces(track),
            predicts=self.predict,
        )

"""A passenger car's body on two bogies, for vertical motion: M z'' + C z' + K z = what the track and the floor push.

z = [bounce, pitch, roll, bending of the body; bounce and roll of each bogie], SI units, up positive, x ahead and y to
the left of the body's centre. The body bends in the first mode of a free uniform beam. Bogies do not pitch: with two
wheelsets each and the secondary springs at their centres, their pitch does not reach the body.
"""

import numpy as np

BODY_LENGTH, BODY_MASS, PITCH_INERTIA, ROLL_INERTIA = 24.0, 32e3, 1.44e6, 5.7e4
BENDING_HZ, BENDING_ZETA = 9.5, 0.015
BOGIE_MASS, BOGIE_ROLL_INERTIA, BOGIE_AT, HALF_WHEELBASE = 2.6e3, 1.5e3, 9.5, 1.25
SECONDARY, SECONDARY_DAMPER, SECONDARY_Y = 4.3e5, 3.0e4, 1.0  # of one side of one bogie [N/m, N s/m, m]
PRIMARY, PRIMARY_DAMPER, PRIMARY_Y = 2.4e6, 2.4e4, 1.0

FLOOR_AT = (2.0, 0.7)  # the panel's centre in the body [m]
MOUNT_STIFFNESS, MOUNT_DAMPER = 4.0e4, 150.0  # of one of the four mounts [N/m, N s/m]
SIZE = 8


def bending_shape(x):
    """First bending mode of a free uniform beam, of root mean square 1, so that its modal mass is the body's."""
    root = 4.730040744862704
    ratio = (np.cosh(root) - np.cos(root)) / (np.sinh(root) - np.sin(root))
    at = root * (x / BODY_LENGTH + 0.5)
    return np.cosh(at) + np.cos(at) - ratio * (np.sinh(at) + np.sin(at))


def body_row(x, y):
    """The body's height at (x, y) as a row over z."""
    row = np.zeros(SIZE)
    row[:4] = 1.0, x, y, bending_shape(x)
    return row


def bogie_row(bogie, y):
    """Height of bogie 0 (ahead) or 1 at y from its centre."""
    row = np.zeros(SIZE)
    row[4 + 2 * bogie : 6 + 2 * bogie] = 1.0, y
    return row


def matrices():
    """Mass, damping and stiffness, without the floor."""
    mass = np.diag(
        [BODY_MASS, PITCH_INERTIA, ROLL_INERTIA, BODY_MASS] + 2 * [BOGIE_MASS, BOGIE_ROLL_INERTIA]
    )
    bending = 2.0 * np.pi * BENDING_HZ
    stiffness = np.diag([0.0, 0.0, 0.0, BODY_MASS * bending**2, 0.0, 0.0, 0.0, 0.0])
    damping = np.diag([0.0, 0.0, 0.0, 2.0 * BENDING_ZETA * BODY_MASS * bending, 0.0, 0.0, 0.0, 0.0])
    for bogie, x in enumerate((BOGIE_AT, -BOGIE_AT)):
        for side in (-1.0, 1.0):
            stretch = body_row(x, side * SECONDARY_Y) - bogie_row(bogie, side * SECONDARY_Y)
            stiffness += SECONDARY * np.outer(stretch, stretch)
            damping += SECONDARY_DAMPER * np.outer(stretch, stretch)
            stretch = bogie_row(bogie, side * PRIMARY_Y)
            stiffness += PRIMARY * np.outer(stretch, stretch)
            damping += PRIMARY_DAMPER * np.outer(stretch, stretch)
    return mass, damping, stiffness


def track_forces(track):
    """Complex amplitudes of the generalised forces of the primary springs on z, one row a line of the track."""
    forces = np.zeros((len(track.omegas), SIZE), dtype=complex)
    through = PRIMARY + 1j * track.omegas * PRIMARY_DAMPER
    for bogie, x in enumerate((BOGIE_AT, -BOGIE_AT)):
        level, cant = 0.5 * (track.under(x + HALF_WHEELBASE) + track.under(x - HALF_WHEELBASE))
        for side in (-1.0, 1.0):
            height = level + side * PRIMARY_Y * cant
            forces += (through * height)[:, None] * bogie_row(bogie, side * PRIMARY_Y)[None, :]
    return forces


def mount_rows(places):
    """The body's height at the mounts, whose places [m] are counted from the panel's centre."""
    return np.array([body_row(FLOOR_AT[0] + x, FLOOR_AT[1] + y) for x, y in places])

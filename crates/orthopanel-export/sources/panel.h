/* One panel in a simulation: the modes, stepped exactly, and the life cycle that both versions of FMI share.
 *
 * C99, no library but libm. All memory of an instance is one block, taken when it is instantiated. */
#ifndef PANEL_H
#define PANEL_H

#include "model.h"

#include <stddef.h>

enum status { STATUS_OK = 0, STATUS_ERROR = 3 };

enum phase { INSTANTIATED = 1, INITIALIZATION = 2, STEPPING = 4, TERMINATED = 8 };

/* States, and columns of the step of coupled modes: position, velocity, force, change of force. */
#define SIZE (2 * MODES)
#define COLUMNS (4 * MODES)

typedef struct {
    enum phase phase;
    double time, stop_time;
    int stops, force_linear;
    /* As set, and at the end of the last step. */
    double inputs[INPUTS], inputs_before[INPUTS], inputs_after[INPUTS];
    double position[MODES], velocity[MODES], force[MODES], force_after[MODES];
    /* Of the last size of step. */
    double step;
    double impulse[MODES], held[MODES], ramp[MODES], ramp_rate[MODES];
#if COUPLED
    double rows[SIZE][COLUMNS];
    /* Room for the exponential of a matrix, row by row. */
    double generator[SIZE * SIZE], first[SIZE * SIZE], second[SIZE * SIZE], free_part[SIZE * SIZE];
    double held_part[SIZE * MODES], ramp_part[SIZE * MODES];
#endif
    double after[SIZE];
    /* What the importer gave. */
    void *environment;
    void *logger;
    const char *name;
    char name_text[128];
} Panel;

#endif

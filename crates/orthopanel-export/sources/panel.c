/* Included by the one file of entry points, so that two panels in one program share no name but theirs.
 * Functions that may refuse return a text that says why, or NULL where all is well. */
#include "panel.h"

#include <math.h>
#include <string.h>

/* Value references: time, force_linear, then inputs and outputs as the tables of model.h have them. */
#define TIME 1u
#define FORCE_LINEAR 2u

static const double LARGEST = 1e100, LARGEST_STATE = 1e150, TOO_LONG = 1e30;

static const char *const WRONG_ORDER = "not allowed in this state of the life cycle";
static const char *const UNKNOWN = "no such variable of this type";

static int panel_is_token(const char *token) { return token != NULL && strcmp(token, TOKEN) == 0; }

static void panel_reset(Panel *panel) {
    size_t i;
    panel->phase = INSTANTIATED;
    panel->time = 0.0;
    panel->stop_time = 0.0;
    panel->stops = 0;
    panel->force_linear = 0;
    panel->step = 0.0;
    for (i = 0; i < INPUTS; i++) panel->inputs[i] = panel->inputs_before[i] = 0.0;
    for (i = 0; i < MODES; i++) panel->position[i] = panel->velocity[i] = 0.0;
}

static const char *panel_enter(Panel *panel, double start, int stops, double stop) {
    if (panel->phase != INSTANTIATED) return WRONG_ORDER;
    if (!(fabs(start) < TOO_LONG) || (stops && !(stop >= start))) return "start and stop time are no times";
    panel->time = start;
    panel->stops = stops;
    panel->stop_time = stop;
    panel->phase = INITIALIZATION;
    return NULL;
}

static const char *panel_exit(Panel *panel) {
    if (panel->phase != INITIALIZATION) return WRONG_ORDER;
    memcpy(panel->inputs_before, panel->inputs, sizeof panel->inputs);
    panel->phase = STEPPING;
    return NULL;
}

static const char *panel_terminate(Panel *panel) {
    if (panel->phase != STEPPING) return WRONG_ORDER;
    panel->phase = TERMINATED;
    return NULL;
}

/* The modal forces p = sum over inputs. */
static void project(const double *inputs, double *forces) {
    size_t i, m;
    for (m = 0; m < MODES; m++) {
        forces[m] = 0.0;
        for (i = 0; i < INPUTS; i++) forces[m] += AT_INPUTS[m][i] * inputs[i];
    }
}

/* The inputs that act now: with force_linear, between steps, those at the end of the last step. */
static const double *in_effect(const Panel *panel) {
    int waits = panel->force_linear && (panel->phase & (STEPPING | TERMINATED));
    return waits ? panel->inputs_before : panel->inputs;
}

static double acceleration_of(const Panel *panel, size_t m) {
    double sum = panel->force[m] - 2.0 * ZETA[m] * OMEGA[m] * panel->velocity[m] - OMEGA[m] * OMEGA[m] * panel->position[m];
#if COUPLED
    size_t n;
    for (n = 0; n < MODES; n++) sum -= DAMPING[m][n] * panel->velocity[n] + STIFFNESS[m][n] * panel->position[n];
#endif
    return sum;
}

/* Of a response: kind 0 is acceleration, 1 velocity, 2 displacement; 3 is an input. */
static double signal_of(const Panel *panel, const double *inputs, int kind, size_t index) {
    double sum = 0.0;
    size_t m;
    if (kind == 3) return inputs[index];
    for (m = 0; m < MODES; m++) {
        double value = kind == 0 ? acceleration_of(panel, m) : kind == 1 ? panel->velocity[m] : panel->position[m];
        sum += AT_RESPONSES[m][index] * value;
    }
    return sum;
}

static const char *panel_get(Panel *panel, const unsigned *references, size_t count, double *values) {
    const double *inputs = in_effect(panel);
    size_t i, t;
    if (panel->phase == INSTANTIATED) return WRONG_ORDER;
    project(inputs, panel->force);
    for (i = 0; i < count; i++) {
        unsigned reference = references[i];
        const Variable *variable;
        if (reference == TIME) {
            values[i] = panel->time;
            continue;
        }
        if (reference <= FORCE_LINEAR || reference > FORCE_LINEAR + VARIABLES) return UNKNOWN;
        variable = &TABLE[reference - FORCE_LINEAR - 1u];
        if (variable->is_input) {
            values[i] = panel->inputs[variable->first];
            continue;
        }
        values[i] = 0.0;
        for (t = variable->first; t < variable->first + variable->count; t++) {
            values[i] += TERMS[t].weight * signal_of(panel, inputs, TERMS[t].kind, TERMS[t].index);
        }
        if (!(fabs(values[i]) <= 1.7976931348623157e308)) return "inputs and states are too large together";
    }
    return NULL;
}

static const char *panel_set(Panel *panel, const unsigned *references, size_t count, const double *values) {
    size_t i;
    if (panel->phase == TERMINATED) return WRONG_ORDER;
    for (i = 0; i < count; i++) {
        unsigned reference = references[i];
        if (reference <= FORCE_LINEAR || reference > FORCE_LINEAR + VARIABLES) return UNKNOWN;
        if (!TABLE[reference - FORCE_LINEAR - 1u].is_input) return "it is an output: only inputs can be set";
        if (!(fabs(values[i]) <= LARGEST)) return "an input must be a finite number up to 1e100";
    }
    for (i = 0; i < count; i++) panel->inputs[TABLE[references[i] - FORCE_LINEAR - 1u].first] = values[i];
    return NULL;
}

static const char *panel_is_boolean(const unsigned *references, size_t count) {
    size_t i;
    for (i = 0; i < count; i++) {
        if (references[i] != FORCE_LINEAR) return UNKNOWN;
    }
    return NULL;
}

static const char *panel_set_linear(Panel *panel, const unsigned *references, size_t count, int value) {
    const char *refused = panel_is_boolean(references, count);
    if (refused) return refused;
    if (count == 0) return NULL;
    if (!(panel->phase & (INSTANTIATED | INITIALIZATION))) return "a fixed parameter is set before or in initialization mode";
    panel->force_linear = value;
    return NULL;
}

#if COUPLED
enum { SERIES = 15 };

static double factorial(int n) {
    double product = 1.0;
    for (; n > 1; n--) product *= n;
    return product;
}

/* C = A B, row by row, of so many columns of B and C. */
static void multiply(const double *a, const double *b, double *c, size_t columns) {
    size_t i, j, k;
    for (i = 0; i < SIZE * columns; i++) c[i] = 0.0;
    for (i = 0; i < SIZE; i++) {
        for (k = 0; k < SIZE; k++) {
            double value = a[i * SIZE + k];
            if (value == 0.0) continue;
            for (j = 0; j < columns; j++) c[i * columns + j] += value * b[k * columns + j];
        }
    }
}

/* The step of all modes together (orthopanel_model: response/coupled.rs): the series of a fraction of the step, which is then doubled;
 * increments are doubled, not states. */
static const char *couple(Panel *panel, double h) {
    double *generator = panel->generator, *first = panel->first, *second = panel->second, *part_of = panel->free_part;
    double *held = panel->held_part, *ramp = panel->ramp_part;
    double size = 0.0, part, share, scale[MODES];
    size_t i, j, m, n;
    int doublings, k;
    for (n = 0; n < MODES; n++) {
        scale[n] = OMEGA[n];
        for (m = 0; m < MODES; m++) scale[n] = fmax(scale[n], sqrt(fabs(STIFFNESS[m][n])));
        if (!(scale[n] > 0.0)) scale[n] = 1.0;
    }
    for (i = 0; i < SIZE * SIZE; i++) generator[i] = 0.0;
    for (m = 0; m < MODES; m++) {
        double *row = generator + (MODES + m) * SIZE;
        generator[m * SIZE + MODES + m] = scale[m];
        for (n = 0; n < MODES; n++) {
            row[n] = -STIFFNESS[m][n] / scale[n];
            row[MODES + n] = -DAMPING[m][n];
        }
        row[m] -= OMEGA[m] * OMEGA[m] / scale[m];
        row[MODES + m] -= 2.0 * ZETA[m] * OMEGA[m];
    }
    for (j = 0; j < SIZE; j++) {
        double column = 0.0;
        for (i = 0; i < SIZE; i++) column += fabs(generator[i * SIZE + j]);
        size = fmax(size, column);
    }
    size *= h;
    if (!(size <= 1e300)) return "the step is too long";
    doublings = size > 0.5 ? (int)ceil(log2(size / 0.5)) : 0;
    part = ldexp(h, -doublings);
    for (i = 0; i < SIZE * SIZE; i++) {
        generator[i] *= part;
        second[i] = i / SIZE == i % SIZE ? 1.0 / factorial(SERIES + 1) : 0.0;
    }
    for (k = SERIES - 2; k >= 0; k--) {
        multiply(generator, second, first, SIZE);
        memcpy(second, first, sizeof panel->second);
        for (i = 0; i < SIZE; i++) second[i * SIZE + i] += 1.0 / factorial(k + 2);
    }
    multiply(generator, second, first, SIZE);
    for (i = 0; i < SIZE; i++) first[i * SIZE + i] += 1.0;
    multiply(generator, first, part_of, SIZE);
    share = part / h;
    for (i = 0; i < SIZE; i++) {
        for (j = 0; j < MODES; j++) {
            held[i * MODES + j] = part * first[i * SIZE + MODES + j];
            ramp[i * MODES + j] = share * part * second[i * SIZE + MODES + j];
        }
    }
    for (k = 0; k < doublings; k++) {
        multiply(part_of, ramp, first, MODES);
        for (i = 0; i < SIZE * MODES; i++) ramp[i] = 2.0 * ramp[i] + first[i] + share * held[i];
        multiply(part_of, held, first, MODES);
        for (i = 0; i < SIZE * MODES; i++) held[i] = 2.0 * held[i] + first[i];
        multiply(part_of, part_of, first, SIZE);
        for (i = 0; i < SIZE * SIZE; i++) part_of[i] = 2.0 * part_of[i] + first[i];
        share *= 2.0;
    }
    for (i = 0; i < SIZE; i++) {
        double unscaled = i < MODES ? 1.0 / scale[i] : 1.0;
        for (j = 0; j < MODES; j++) {
            panel->rows[i][j] = unscaled * part_of[i * SIZE + j] * scale[j];
            panel->rows[i][MODES + j] = unscaled * part_of[i * SIZE + MODES + j];
            panel->rows[i][2 * MODES + j] = unscaled * held[i * MODES + j];
            panel->rows[i][3 * MODES + j] = unscaled * ramp[i * MODES + j];
        }
    }
    return NULL;
}
#else
/* The exact step of one mode over h (orthopanel_model: response/propagator.rs): with the impulse response
 * g(t) = exp(-zeta omega t) sin(omega_d t) / omega_d, its integral G1 and that one's integral G2:
 * g, G1, G2 / h and G1 / h. */
static void propagator(Panel *panel, size_t m, double h) {
    double omega = OMEGA[m], zeta = ZETA[m], z = omega * h;
    if (z <= 1.0) {
        /* The power series, where the closed form would subtract nearly equal numbers. */
        double before = 0.0, term = 1.0, impulse = 0.0, held = 0.0, ramp = 0.0, next;
        int n;
        for (n = 1; n <= 24; n++) {
            impulse += term;
            held += term / (n + 1.0);
            ramp += term / ((n + 1.0) * (n + 2.0));
            next = -(2.0 * zeta * z * n * term + z * z * before) / (n * (n + 1.0));
            before = term;
            term = next;
        }
        panel->impulse[m] = h * impulse;
        panel->held[m] = h * h * held;
        panel->ramp[m] = h * h * ramp;
        panel->ramp_rate[m] = h * held;
    } else {
        /* The phase is carried with its rounding error, which would else return at every step. */
        double square = zeta * zeta, square_low = fma(zeta, zeta, -square);
        double rest = 1.0 - square, rest_low = (1.0 - rest - square) - square_low;
        double ratio = sqrt(rest), ratio_low = (fma(-ratio, ratio, rest) + rest_low) / (2.0 * ratio);
        double damped = omega * ratio, damped_low = fma(omega, ratio, -damped) + omega * ratio_low;
        double phase = damped * h, phase_low = fma(damped, h, -phase) + damped_low * h;
        double sine = sin(phase), cosine = cos(phase), decay = exp(-zeta * z);
        double s = decay * (sine + phase_low * cosine) / ratio, c = decay * (cosine - phase_low * sine);
        double held = 1.0 - c - zeta * s, ramp = z - s - 2.0 * zeta * held;
        panel->impulse[m] = s / omega;
        panel->held[m] = held / (omega * omega);
        panel->ramp[m] = ramp / (omega * omega * z);
        panel->ramp_rate[m] = held / omega / z;
    }
}
#endif

/* From the forces `force` to `force_after`; the states after it wait in `after`. */
static const char *advance(Panel *panel, double h) {
    size_t m;
    if (h != panel->step) {
#if COUPLED
        const char *refused;
        panel->step = 0.0;
        refused = couple(panel, h);
        if (refused) return refused;
#else
        for (m = 0; m < MODES; m++) propagator(panel, m, h);
#endif
        panel->step = h;
    }
    for (m = 0; m < MODES; m++) {
#if COUPLED
        size_t n;
        double moved[2] = {0.0, 0.0};
        for (n = 0; n < MODES; n++) {
            const double values[4] = {panel->position[n], panel->velocity[n], panel->force[n], panel->force_after[n] - panel->force[n]};
            int kind;
            for (kind = 0; kind < 4; kind++) {
                moved[0] += panel->rows[m][kind * MODES + n] * values[kind];
                moved[1] += panel->rows[MODES + m][kind * MODES + n] * values[kind];
            }
        }
        panel->after[m] = panel->position[m] + moved[0];
        panel->after[MODES + m] = panel->velocity[m] + moved[1];
#else
        double a = panel->position[m], v = panel->velocity[m], change = panel->force_after[m] - panel->force[m];
        double stiffness = OMEGA[m] * OMEGA[m];
        double elastic = panel->force[m] - stiffness * a, acceleration = elastic - 2.0 * ZETA[m] * OMEGA[m] * v;
        panel->after[m] = a + panel->impulse[m] * v + panel->held[m] * elastic + panel->ramp[m] * change;
        panel->after[MODES + m] = v + panel->impulse[m] * acceleration - stiffness * panel->held[m] * v + panel->ramp_rate[m] * change;
#endif
    }
    for (m = 0; m < SIZE; m++) {
        if (!(fabs(panel->after[m]) <= LARGEST_STATE)) return "the motion grows beyond all numbers";
    }
    memcpy(panel->position, panel->after, sizeof panel->position);
    memcpy(panel->velocity, panel->after + MODES, sizeof panel->velocity);
    return NULL;
}

static const char *panel_step(Panel *panel, double start, double step) {
    double slack, end = start + step;
    const char *refused;
    if (panel->phase != STEPPING) return WRONG_ORDER;
    if (!(step > 0.0 && step < TOO_LONG && fabs(start) < TOO_LONG && end < TOO_LONG)) return "a step is a time above zero";
    slack = 1e-3 * step + 1e-12 * fabs(start);
    if (!(fabs(start - panel->time) <= slack)) return "the communication point is not where the last step ended";
    if (panel->stops && end > panel->stop_time + slack) return "the step ends behind the stop time";
    memcpy(panel->inputs_after, panel->inputs, sizeof panel->inputs);
#if BASES > 0
    if (!panel->force_linear) {
        /* The base under a mount goes on at its velocity. */
        size_t base;
        for (base = 0; base < BASES; base++) panel->inputs_after[BASE[base][0]] += panel->inputs[BASE[base][1]] * step;
    }
#endif
    project(panel->force_linear ? panel->inputs_before : panel->inputs, panel->force);
    project(panel->inputs_after, panel->force_after);
    refused = advance(panel, step);
    if (refused) return refused;
    memcpy(panel->inputs, panel->inputs_after, sizeof panel->inputs);
    memcpy(panel->inputs_before, panel->inputs, sizeof panel->inputs);
    panel->time = end;
    return NULL;
}

/* Time of one communication step (set a force, step, get an acceleration): an FMU, and the same modes by hand in C.
 *
 *     bench c MODES-TEXT STEPS                              the C propagator and RK4
 *     bench LIBRARY GUID RESOURCES-URI STEPS INPUT,OUTPUT   an FMI 2.0 co-simulation FMU, by value references
 *     bench start LIBRARY GUID RESOURCES-URI REFERENCE VALUE   one from its making to its first step, modes solved anew
 *                                                              for a parameter of this value
 */
#define _POSIX_C_SOURCE 199309L
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fmi2Functions.h"
#include "propagator.h"

enum { MOST_MODES = 4096, ROUNDS = 100, STARTS = 7 };

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec * 1e-3;
}

static const double STEP = 1e-6;

/* A force that changes at every step, without the cost of a sine. */
static double force_at(long n) { return (double)(n % 7) - 2.5; }

/* The best of several rounds: what disturbs a round only ever lengthens it. */
static void report(const char *name, const double *rounds, int count, double last) {
    double best = rounds[0];
    for (int i = 1; i < count; i++)
        if (rounds[i] < best) best = rounds[i];
    printf("%s %.5f %.17g\n", name, best, last);
}

static void logger(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String message, ...) {
    (void)e, (void)n, (void)s, (void)c;
    fprintf(stderr, "%s\n", message);
}

static void *symbol(void *library, const char *name) {
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "%s: %s\n", name, dlerror());
        exit(1);
    }
    return found;
}

typedef struct {
    fmi2InstantiateTYPE *instantiate;
    fmi2SetupExperimentTYPE *setup;
    fmi2EnterInitializationModeTYPE *enter;
    fmi2ExitInitializationModeTYPE *leave;
    fmi2SetRealTYPE *set;
    fmi2DoStepTYPE *step;
    fmi2GetRealTYPE *get;
    fmi2FreeInstanceTYPE *release;
} functions;

static int load(functions *f, const char *path) {
    void *library = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    f->instantiate = (fmi2InstantiateTYPE *)symbol(library, "fmi2Instantiate");
    f->setup = (fmi2SetupExperimentTYPE *)symbol(library, "fmi2SetupExperiment");
    f->enter = (fmi2EnterInitializationModeTYPE *)symbol(library, "fmi2EnterInitializationMode");
    f->leave = (fmi2ExitInitializationModeTYPE *)symbol(library, "fmi2ExitInitializationMode");
    f->set = (fmi2SetRealTYPE *)symbol(library, "fmi2SetReal");
    f->step = (fmi2DoStepTYPE *)symbol(library, "fmi2DoStep");
    f->get = (fmi2GetRealTYPE *)symbol(library, "fmi2GetReal");
    f->release = (fmi2FreeInstanceTYPE *)symbol(library, "fmi2FreeInstance");
    return 0;
}

static const fmi2CallbackFunctions CALLBACKS = {logger, calloc, free, NULL, NULL};

static int bench_fmu(const char *path, const char *guid, const char *resources, long steps, const char *references) {
    functions f;
    if (load(&f, path)) return 1;
    fmi2ValueReference input, output;
    if (sscanf(references, "%u,%u", &input, &output) != 2) return 2;
    fmi2Component c = f.instantiate("bench", fmi2CoSimulation, guid, resources, &CALLBACKS, fmi2False, fmi2False);
    if (!c) return 1;
    int failed = f.setup(c, fmi2False, 0.0, 0.0, fmi2False, 0.0) | f.enter(c) | f.leave(c);
    double rounds[ROUNDS], acceleration = 0.0;
    long n = 0;
    for (int round = 0; round < ROUNDS; round++) {
        double start = now();
        for (long i = 0; i < steps; i++, n++) {
            double force = force_at(n);
            failed |= f.set(c, &input, 1, &force);
            failed |= f.step(c, (double)n * STEP, STEP, fmi2True);
            failed |= f.get(c, &output, 1, &acceleration);
        }
        rounds[round] = (now() - start) / (double)steps;
    }
    f.release(c);
    if (failed) return 1;
    report("fmu", rounds, ROUNDS, acceleration);
    return 0;
}

static int bench_start(const char *path, const char *guid, const char *resources, fmi2ValueReference parameter,
                       double value) {
    functions f;
    if (load(&f, path)) return 1;
    double rounds[STARTS];
    for (int round = 0; round < STARTS; round++) {
        double start = now(), set = value * (1.0 + 1e-4 * round);
        fmi2Component c = f.instantiate("bench", fmi2CoSimulation, guid, resources, &CALLBACKS, fmi2False, fmi2False);
        if (!c) return 1;
        if (f.set(c, &parameter, 1, &set) | f.enter(c) | f.leave(c)) return 1;
        rounds[round] = now() - start;
        f.release(c);
    }
    report("start", rounds, STARTS, 0.0);
    return 0;
}

static int bench_c(const char *path, long steps) {
    static double omega[MOST_MODES], zeta[MOST_MODES], at_force[MOST_MODES], at_response[MOST_MODES];
    FILE *file = fopen(path, "r");
    if (!file) return 1;
    int count = 0;
    while (count < MOST_MODES && fscanf(file, "%lf %lf %lf %lf", &omega[count], &zeta[count], &at_force[count],
                                        &at_response[count]) == 4)
        count++;
    fclose(file);
    const char *names[] = {"exact", "rk4"};
    void (*const methods[])(panel *, double) = {panel_step_exact, panel_step_rk4};
    for (int method = 0; method < 2; method++) {
        panel *p = panel_new(count, omega, zeta, at_force, at_response);
        double rounds[ROUNDS], acceleration = 0.0;
        long n = 0;
        for (int round = 0; round < ROUNDS; round++) {
            double start = now();
            for (long i = 0; i < steps; i++, n++) {
                panel_set_force(p, force_at(n));
                methods[method](p, STEP);
                acceleration = panel_acceleration(p);
            }
            rounds[round] = (now() - start) / (double)steps;
        }
        report(names[method], rounds, ROUNDS, acceleration);
        panel_free(p);
    }
    return 0;
}

int main(int argc, char **argv) {
    if (argc == 4 && strcmp(argv[1], "c") == 0) return bench_c(argv[2], atol(argv[3]));
    if (argc == 7 && strcmp(argv[1], "start") == 0)
        return bench_start(argv[2], argv[3], argv[4], (fmi2ValueReference)atoi(argv[5]), atof(argv[6]));
    if (argc == 6) return bench_fmu(argv[1], argv[2], argv[3], atol(argv[4]), argv[5]);
    fprintf(stderr, "usage: bench c MODES-TEXT STEPS | bench LIBRARY GUID RESOURCES-URI STEPS INPUT,OUTPUT\n"
                    "     | bench start LIBRARY GUID RESOURCES-URI REFERENCE VALUE\n");
    return 2;
}

/* What the checks of both versions share. */
#ifndef COMMON_H
#define COMMON_H

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "propagator.h"

#define LOAD(name) name##TYPE *name##_ = (name##TYPE *)symbol(library, #name)
#define CHECK(condition) ((condition) ? 0 : (failed++, printf("failed: %s (line %d)\n", #condition, __LINE__)))

enum { STEPS = 50, MOST = 64 };
static const double STEP = 1e-4;
static int failed = 0;

static inline double force_at(int n) { return cos(0.3 * n); }

static inline void *symbol(void *library, const char *name) {
    void *found = dlsym(library, name);
    if (!found) {
        printf("%s\n", dlerror());
        exit(100);
    }
    return found;
}

/* Memory of this process that no file backs, in kB. Counted page by page: `statm` is off by some dozen pages. */
static inline long resident(void) {
    long kilobytes = 0;
    char line[256];
    FILE *file = fopen("/proc/self/smaps_rollup", "r");
    if (!file) return 0;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "Anonymous: %ld kB", &kilobytes) == 1) break;
    fclose(file);
    return kilobytes;
}

/* A panel of modes that are not the FMU's, lines of omega, zeta and the shape at force and response. */
static inline panel *panel_of(const char *path) {
    double omega[MOST], zeta[MOST], at_force[MOST], at_response[MOST];
    int count = 0;
    FILE *file = fopen(path, "r");
    if (!file) exit(103);
    while (count < MOST && fscanf(file, "%lf %lf %lf %lf", &omega[count], &zeta[count], &at_force[count],
                                  &at_response[count]) == 4)
        count++;
    fclose(file);
    return panel_new(count, omega, zeta, at_force, at_response);
}

/* The acceleration after each step under the forces of `force_at`, held: in closed form, the first half of the steps by the modes
 * of `path`, the second, which goes on from there, by those of `then`. */
static inline void expect_in_halves(const char *path, const char *then, double *accelerations) {
    panel *p = panel_of(path);
    for (int n = 0; n < STEPS; n++) {
        if (n == STEPS / 2) {
            panel *other = panel_of(then);
            panel_go_on_from(other, p);
            panel_free(p);
            p = other;
        }
        panel_set_force(p, force_at(n));
        panel_step_exact(p, STEP);
        accelerations[n] = panel_acceleration(p);
    }
    panel_free(p);
}

/* The same by one panel. */
static inline void expect(const char *path, double *accelerations) { expect_in_halves(path, path, accelerations); }

/* Whether the first of each pair is what was expected, to 1e-9 of its peak. */
static inline int as_expected(double runs[STEPS][2], const double *expected) {
    double peak = 0.0, worst = 0.0;
    for (int n = 0; n < STEPS; n++) {
        peak = fmax(peak, fabs(expected[n]));
        /* Not a number is no match. */
        double error = fabs(runs[n][0] - expected[n]);
        worst = error <= worst ? worst : error;
    }
    return peak > 0.0 && worst <= 1e-9 * peak;
}

#endif

/* Hosts with floating-point environments of their own, which no call may trap in or leave as another. */
#ifndef HOSTS_H
#define HOSTS_H

#define _GNU_SOURCE
#include <fenv.h>
#include <signal.h>
#include <stdint.h>
#include <unistd.h>

#include "common.h"

enum { FORBIDDEN = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW, HOSTS = 4, VALUES = 1 << 18, MOST_VARIABLES = 1024 };
/* As a debugger or a real-time host sets them: traps that kill, rounding upwards, small numbers flushed to zero. */
static const char *const HOST_NAMES[HOSTS] = {"default", "traps", "upwards", "flushing"};
static int host;
static const char *running = "";
static void *library;

static void die(int signal) {
    (void)signal;
    ssize_t written = write(1, "trapped in ", 11) + write(1, running, strlen(running)) + write(1, "\n", 1);
    _exit(written ? 98 : 99);
}

static uint32_t control(void) {
    uint32_t word;
    __asm__ volatile("stmxcsr %0" : "=m"(word));
    return word;
}

static void become_host(void) {
    fesetenv(FE_DFL_ENV);
    if (host == 1) feenableexcept(FORBIDDEN);
    if (host == 2) fesetround(FE_UPWARD);
    if (host == 3) {
        const uint32_t word = 0x1f80 | 0x8040;
        __asm__ volatile("ldmxcsr %0" : : "m"(word));
    }
}

static uint32_t before;

/* From here to `end` the environment is the host's; what this program works out for a call, it does before. */
static void begin(const char *name) {
    running = name;
    become_host();
    before = control();
}

static int end(int status) {
    const uint32_t after = control();
    fesetenv(FE_DFL_ENV);
    const uint32_t raised = after & ~before & 0x0d;
    if (raised) {
        failed++;
        printf("%s raised%s%s%s\n", running, raised & 1 ? " INVALID" : "", raised & 4 ? " DIVBYZERO" : "",
               raised & 8 ? " OVERFLOW" : "");
    }
    if ((after & ~0x3fu) != (before & ~0x3fu)) {
        failed++;
        printf("%s left a host (%s) with another environment\n", running, HOST_NAMES[host]);
    }
    return status;
}

#define FUNCTION(name) ((name##TYPE *)symbol(library, #name))
#define STATUS(name, ...) (begin(#name), end((int)FUNCTION(name)(__VA_ARGS__)))
#define DONE(name, ...) CHECK(STATUS(name, __VA_ARGS__) == 0)
/* Whatever it answers. */
#define ASKED(name, ...) ((void)STATUS(name, __VA_ARGS__))

/* All that was read under the first host. Where another traps it must read the same bits, where it rounds or flushes the same but for
 * what rounding does to a step. */
static double seen[VALUES];
static long place;

static void record(const double *values, size_t count) {
    double largest = 0.0;
    if (place + (long)count > VALUES) exit(104);
    for (size_t i = 0; i < count; i++) {
        if (host == 0) seen[place + (long)i] = values[i];
        largest = fmax(largest, fabs(seen[place + (long)i]));
    }
    for (size_t i = 0; i < count; i++, place++) {
        if (!(fabs(values[i] - seen[place]) <= (host < 2 ? 0.0 : 1e-7 * largest))) {
            failed++;
            printf("after %s a host (%s) reads %.17g, not %.17g\n", running, HOST_NAMES[host], values[i], seen[place]);
        }
    }
}

/* The variables of one kind: i input, o output, p fixed parameter, t tunable one, s state, d derivative of a state, b Boolean;
 * for parameters other values. `size` counts numbers, of arrays their elements. */
typedef struct {
    uint32_t references[MOST_VARIABLES];
    double values[MOST_VARIABLES];
    size_t count, size;
} variables;

/* Lines of kind, reference, size and value. */
static variables of_kind(const char *path, char kind) {
    static const variables none;
    variables found = none;
    char letter;
    unsigned reference;
    size_t size;
    double value;
    FILE *file = fopen(path, "r");
    if (!file) exit(103);
    while (found.count < MOST_VARIABLES && fscanf(file, " %c %u %zu %lf", &letter, &reference, &size, &value) == 4)
        if (letter == kind) {
            found.references[found.count] = reference;
            found.values[found.count++] = value;
            found.size += size;
        }
    fclose(file);
    return found;
}

#endif

/* A Windows host: loads the library of an FMU (FMI 2.0 or 3.0), steps it under a force, prints accelerations as they are, bit for bit.

   host VERSION LIBRARY TOKEN PLACE FORCE ACCELERATION    PLACE: the resources' URI (2) or path (3); value references */
#include <stdio.h>
#include <stdlib.h>
#include <stdarg.h>
#include <windows.h>
#include "fmi2FunctionTypes.h"
#include "fmi3FunctionTypes.h"

static const double STEP = 1e-5;
enum { STEPS = 400 };

static double force_at(int step) { return step % 7 - 2.5; }

static void told2(fmi2ComponentEnvironment host, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...) {
    (void)host, (void)name, (void)status, (void)category;
    fprintf(stderr, "%s\n", message);
}

static void told3(fmi3InstanceEnvironment host, fmi3Status status, fmi3String category, fmi3String message) {
    (void)host, (void)status, (void)category;
    fprintf(stderr, "%s\n", message);
}

static void *function(HMODULE library, const char *name) {
    FARPROC found = GetProcAddress(library, name);
    if (!found) fprintf(stderr, "no %s\n", name), exit(3);
    return (void *)found;
}

#define OF(name) ((name##TYPE *)function(library, #name))
#define CHECK(call) do { if ((call) > 1) fprintf(stderr, "failed: %s\n", #call), exit(4); } while (0)

static char *utf8(const wchar_t *wide) {
    int size = WideCharToMultiByte(CP_UTF8, 0, wide, -1, NULL, 0, NULL, NULL);
    char *text = malloc(size);
    WideCharToMultiByte(CP_UTF8, 0, wide, -1, text, size, NULL, NULL);
    return text;
}

static void run2(HMODULE library, const char *token, const char *place, fmi2ValueReference force, fmi2ValueReference acceleration) {
    fmi2CallbackFunctions callbacks = {told2, calloc, free, NULL, NULL};
    fmi2Component panel = OF(fmi2Instantiate)("panel", fmi2CoSimulation, token, place, &callbacks, fmi2False, fmi2False);
    if (!panel) exit(5);
    CHECK(OF(fmi2SetupExperiment)(panel, fmi2False, 0.0, 0.0, fmi2False, 0.0));
    CHECK(OF(fmi2EnterInitializationMode)(panel));
    CHECK(OF(fmi2ExitInitializationMode)(panel));
    for (int n = 0; n < STEPS; n++) {
        double value = force_at(n);
        CHECK(OF(fmi2SetReal)(panel, &force, 1, &value));
        CHECK(OF(fmi2DoStep)(panel, n * STEP, STEP, fmi2True));
        CHECK(OF(fmi2GetReal)(panel, &acceleration, 1, &value));
        printf("%.17g\n", value);
    }
    OF(fmi2FreeInstance)(panel);
}

static void run3(HMODULE library, const char *token, const char *place, fmi3ValueReference force, fmi3ValueReference acceleration) {
    fmi3Instance panel = OF(fmi3InstantiateCoSimulation)(
        "panel", token, place, fmi3False, fmi3False, fmi3False, fmi3False, NULL, 0, NULL, told3, NULL);
    if (!panel) exit(5);
    CHECK(OF(fmi3EnterInitializationMode)(panel, fmi3False, 0.0, 0.0, fmi3False, 0.0));
    CHECK(OF(fmi3ExitInitializationMode)(panel));
    for (int n = 0; n < STEPS; n++) {
        double value = force_at(n), time;
        fmi3Boolean event, terminate, early;
        CHECK(OF(fmi3SetFloat64)(panel, &force, 1, &value, 1));
        CHECK(OF(fmi3DoStep)(panel, n * STEP, STEP, fmi3True, &event, &terminate, &early, &time));
        CHECK(OF(fmi3GetFloat64)(panel, &acceleration, 1, &value, 1));
        printf("%.17g\n", value);
    }
    OF(fmi3FreeInstance)(panel);
}

int wmain(int count, wchar_t **words) {
    if (count != 7) return 2;
    HMODULE library = LoadLibraryW(words[2]);
    if (!library) return fprintf(stderr, "not loaded: error %lu\n", GetLastError()), 3;
    unsigned force = wcstoul(words[5], NULL, 10), acceleration = wcstoul(words[6], NULL, 10);
    char *token = utf8(words[3]), *place = utf8(words[4]);
    if (words[1][0] == L'2') run2(library, token, place, force, acceleration);
    else run3(library, token, place, force, acceleration);
    return 0;
}

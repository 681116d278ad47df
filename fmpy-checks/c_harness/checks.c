/* What an importer in C sees of an FMI 2.0 FMU: numbers, reset, state round trips, derivatives against differences, a panel
 * solved anew, one that is tuned, many instances.
 *
 *     checks LIBRARY GUID RESOURCES-URI MODES-TEXT FORCE ACCELERATION DISPLACEMENT PARAMETER VALUE MODES-TEXT
 *         TUNABLE VALUE MODES-TEXT INSTANCES
 *
 * The first three are value references, as the parameters; the modes are those that the numbers are held against, the others those
 * of the panel with that value of the fixed or tunable parameter. Prints what failed, and returns how many checks did.
 */
#include "common.h"
#include "fmi2Functions.h"

static void logger(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String message, ...) {
    (void)e, (void)n, (void)s, (void)c, (void)message;
}

int main(int argc, char **argv) {
    if (argc != 15) return 101;
    void *library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        printf("%s\n", dlerror());
        return 100;
    }
    LOAD(fmi2Instantiate);
    LOAD(fmi2FreeInstance);
    LOAD(fmi2EnterInitializationMode);
    LOAD(fmi2ExitInitializationMode);
    LOAD(fmi2Reset);
    LOAD(fmi2SetReal);
    LOAD(fmi2GetReal);
    LOAD(fmi2DoStep);
    LOAD(fmi2GetFMUstate);
    LOAD(fmi2SetFMUstate);
    LOAD(fmi2FreeFMUstate);
    LOAD(fmi2SerializedFMUstateSize);
    LOAD(fmi2SerializeFMUstate);
    LOAD(fmi2DeSerializeFMUstate);
    LOAD(fmi2GetDirectionalDerivative);
    const fmi2ValueReference force = (fmi2ValueReference)atoi(argv[5]);
    const fmi2ValueReference outputs[2] = {(fmi2ValueReference)atoi(argv[6]), (fmi2ValueReference)atoi(argv[7])};
    const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};

    fmi2Component c = fmi2Instantiate_("one", fmi2CoSimulation, argv[2], argv[3], &callbacks, fmi2False, fmi2False);
    if (!c) return 102;

    /* The same run three times: first, after a reset, and from a state that went through bytes. */
    double runs[3][STEPS][2], expected[STEPS];
    expect(argv[4], expected);
    fmi2FMUstate half = NULL;
    for (int run = 0; run < 3; run++) {
        int first = 0;
        if (run < 2) {
            if (run) CHECK(fmi2Reset_(c) == fmi2OK);
            CHECK(fmi2EnterInitializationMode_(c) == fmi2OK && fmi2ExitInitializationMode_(c) == fmi2OK);
        } else {
            size_t size = 0;
            CHECK(fmi2SerializedFMUstateSize_(c, half, &size) == fmi2OK && size > 0);
            char *bytes = malloc(size);
            CHECK(fmi2SerializeFMUstate_(c, half, bytes, size) == fmi2OK);
            CHECK(fmi2SerializeFMUstate_(c, half, bytes, size - 1) == fmi2Error);
            CHECK(fmi2FreeFMUstate_(c, &half) == fmi2OK && half == NULL);
            CHECK(fmi2DeSerializeFMUstate_(c, bytes, size, &half) == fmi2OK);
            CHECK(fmi2SetFMUstate_(c, half) == fmi2OK);
            free(bytes);
            memcpy(runs[2], runs[0], sizeof runs[2]);
            first = STEPS / 2;
        }
        for (int n = first; n < STEPS; n++) {
            if (run == 1 && n == STEPS / 2) CHECK(fmi2GetFMUstate_(c, &half) == fmi2OK && half != NULL);
            double value = force_at(n);
            CHECK(fmi2SetReal_(c, &force, 1, &value) == fmi2OK);
            CHECK(fmi2DoStep_(c, n * STEP, STEP, fmi2False) == fmi2OK);
            CHECK(fmi2GetReal_(c, outputs, 2, runs[run][n]) == fmi2OK);
        }
        CHECK(memcmp(runs[run], runs[0], sizeof runs[0]) == 0);
        CHECK(as_expected(runs[run], expected));
    }
    CHECK(fmi2FreeFMUstate_(c, &half) == fmi2OK);

    /* Derivatives by the force against differences, which for a linear panel are exact at any size. */
    double one = 1.0, slope[2], low[2], high[2], values[2] = {-1.0, 1.0};
    CHECK(fmi2GetDirectionalDerivative_(c, outputs, 2, &force, 1, &one, slope) == fmi2OK);
    CHECK(fmi2SetReal_(c, &force, 1, &values[0]) == fmi2OK && fmi2GetReal_(c, outputs, 2, low) == fmi2OK);
    CHECK(fmi2SetReal_(c, &force, 1, &values[1]) == fmi2OK && fmi2GetReal_(c, outputs, 2, high) == fmi2OK);
    for (int i = 0; i < 2; i++) {
        double scale = fabs(high[i]) + fabs(low[i]);
        CHECK(fabs((high[i] - low[i]) / 2.0 - slope[i]) <= 1e-14 * scale);
    }
    fmi2FreeInstance_(c);

    /* A parameter set before the start: the modes are solved anew. */
    const fmi2ValueReference parameter = (fmi2ValueReference)atoi(argv[8]);
    const double value = atof(argv[9]);
    c = fmi2Instantiate_("changed", fmi2CoSimulation, argv[2], argv[3], &callbacks, fmi2False, fmi2False);
    CHECK(c && fmi2SetReal_(c, &parameter, 1, &value) == fmi2OK);
    CHECK(fmi2EnterInitializationMode_(c) == fmi2OK && fmi2ExitInitializationMode_(c) == fmi2OK);
    for (int n = 0; n < STEPS; n++) {
        double pushed = force_at(n);
        CHECK(fmi2SetReal_(c, &force, 1, &pushed) == fmi2OK && fmi2DoStep_(c, n * STEP, STEP, fmi2False) == fmi2OK);
        CHECK(fmi2GetReal_(c, outputs, 2, runs[1][n]) == fmi2OK);
    }
    CHECK(!as_expected(runs[1], expected));
    expect(argv[10], expected);
    CHECK(as_expected(runs[1], expected));
    fmi2FreeInstance_(c);

    /* A tunable parameter set half way: the motion goes on as another panel's. The state from before brings the old one back. */
    const fmi2ValueReference tunable = (fmi2ValueReference)atoi(argv[11]);
    const double tuned = atof(argv[12]), nowhere = 1e3;
    c = fmi2Instantiate_("tuned", fmi2CoSimulation, argv[2], argv[3], &callbacks, fmi2False, fmi2False);
    half = NULL;
    CHECK(c && fmi2EnterInitializationMode_(c) == fmi2OK && fmi2ExitInitializationMode_(c) == fmi2OK);
    for (int n = 0; n < STEPS; n++) {
        double pushed = force_at(n);
        if (n == STEPS / 2) {
            CHECK(fmi2GetFMUstate_(c, &half) == fmi2OK && fmi2SetReal_(c, &tunable, 1, &nowhere) == fmi2Error);
            CHECK(fmi2SetReal_(c, &parameter, 1, &value) == fmi2Error && fmi2SetReal_(c, &tunable, 1, &tuned) == fmi2OK);
        }
        CHECK(fmi2SetReal_(c, &force, 1, &pushed) == fmi2OK && fmi2DoStep_(c, n * STEP, STEP, fmi2False) == fmi2OK);
        CHECK(fmi2GetReal_(c, outputs, 2, runs[1][n]) == fmi2OK);
    }
    expect(argv[4], expected);
    CHECK(memcmp(runs[1], runs[0], sizeof runs[0] / 2) == 0 && !as_expected(runs[1], expected));
    expect_in_halves(argv[4], argv[13], expected);
    CHECK(as_expected(runs[1], expected));
    CHECK(fmi2SetFMUstate_(c, half) == fmi2OK && fmi2FreeFMUstate_(c, &half) == fmi2OK);
    for (int n = STEPS / 2; n < STEPS; n++) {
        double pushed = force_at(n);
        CHECK(fmi2SetReal_(c, &force, 1, &pushed) == fmi2OK && fmi2DoStep_(c, n * STEP, STEP, fmi2False) == fmi2OK);
        CHECK(fmi2GetReal_(c, outputs, 2, runs[1][n]) == fmi2OK);
    }
    CHECK(memcmp(runs[1], runs[0], sizeof runs[0]) == 0);
    fmi2FreeInstance_(c);

    /* Many instances, one after the other, each with a state that is never freed: no growth once the heap has settled. */
    long instances = atol(argv[14]), settled = 0;
    for (long n = 0; n < instances; n++) {
        c = fmi2Instantiate_("many", fmi2CoSimulation, argv[2], argv[3], &callbacks, fmi2False, fmi2False);
        fmi2FMUstate left = NULL;
        CHECK(c && fmi2EnterInitializationMode_(c) == fmi2OK && fmi2ExitInitializationMode_(c) == fmi2OK);
        CHECK(fmi2DoStep_(c, 0.0, STEP, fmi2True) == fmi2OK && fmi2GetFMUstate_(c, &left) == fmi2OK);
        fmi2FreeInstance_(c);
        if (n == instances / 4) settled = resident();
    }
    /* Of 1,500 instances: the heap's own wandering; 22 bytes an instance would show. */
    CHECK(settled > 0 && resident() <= settled + 32);
    dlclose(library);
    return failed > 100 ? 100 : failed;
}

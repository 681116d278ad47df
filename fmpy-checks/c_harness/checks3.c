/* What an importer in C sees of an FMI 3.0 FMU: numbers, reset, state round trips, derivatives of both interfaces against
 * differences, instances side by side, a panel solved anew, one that is tuned, many instances.
 *
 *     checks3 LIBRARY TOKEN RESOURCES MODES-TEXT FORCE ACCELERATION DISPLACEMENT STATES DERIVATIVES PARAMETER VALUE MODES-TEXT
 *         TUNABLE VALUE MODES-TEXT INSTANCES
 *
 * The folder of the resources ends in a slash; the first three are value references, as the parameter, states and their
 * derivatives lists of such with commas; the modes are those that the numbers are held against, the others those of the panel
 * with that value of the fixed or tunable parameter. Prints what failed, and returns how many checks did.
 */
#include "common.h"
#include "fmi3Functions.h"

static void logger(fmi3InstanceEnvironment e, fmi3Status s, fmi3String c, fmi3String message) {
    (void)e, (void)s, (void)c, (void)message;
}

static size_t references(const char *list, fmi3ValueReference *found) {
    size_t count = 0;
    for (const char *rest = list; rest && count < MOST; rest = strchr(rest, ',') ? strchr(rest, ',') + 1 : NULL)
        found[count++] = (fmi3ValueReference)atoi(rest);
    return count;
}

int main(int argc, char **argv) {
    if (argc != 17) return 101;
    void *library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        printf("%s\n", dlerror());
        return 100;
    }
    LOAD(fmi3InstantiateCoSimulation);
    LOAD(fmi3InstantiateModelExchange);
    LOAD(fmi3FreeInstance);
    LOAD(fmi3EnterInitializationMode);
    LOAD(fmi3ExitInitializationMode);
    LOAD(fmi3EnterContinuousTimeMode);
    LOAD(fmi3Reset);
    LOAD(fmi3SetFloat64);
    LOAD(fmi3GetFloat64);
    LOAD(fmi3DoStep);
    LOAD(fmi3GetFMUState);
    LOAD(fmi3SetFMUState);
    LOAD(fmi3FreeFMUState);
    LOAD(fmi3SerializedFMUStateSize);
    LOAD(fmi3SerializeFMUState);
    LOAD(fmi3DeserializeFMUState);
    LOAD(fmi3GetDirectionalDerivative);
    LOAD(fmi3GetAdjointDerivative);
    LOAD(fmi3GetNumberOfContinuousStates);
    LOAD(fmi3SetContinuousStates);
    LOAD(fmi3GetContinuousStateDerivatives);
    const fmi3ValueReference force = (fmi3ValueReference)atoi(argv[5]);
    const fmi3ValueReference outputs[2] = {(fmi3ValueReference)atoi(argv[6]), (fmi3ValueReference)atoi(argv[7])};
    fmi3ValueReference states[MOST], rates[MOST];
    const size_t count = references(argv[8], states);
    CHECK(references(argv[9], rates) == count);
    fmi3Boolean event, terminate, early;
    double reached, expected[STEPS];
    expect(argv[4], expected);
#define NEW(name) \
    fmi3InstantiateCoSimulation_(name, argv[2], argv[3], fmi3False, fmi3False, fmi3False, fmi3False, NULL, 0, NULL, logger, NULL)
#define INITIALIZED(c) \
    (fmi3EnterInitializationMode_(c, fmi3False, 0.0, 0.0, fmi3False, 0.0) == fmi3OK && fmi3ExitInitializationMode_(c) == fmi3OK)
#define STEPPED(c, n) \
    (fmi3DoStep_(c, (n) * STEP, STEP, fmi3False, &event, &terminate, &early, &reached) == fmi3OK && !event && !terminate && \
     !early && reached == (n) * STEP + STEP)

    fmi3Instance c = NEW("one");
    if (!c) return 102;

    /* The same run three times: first, after a reset, and from a state that went through bytes; beside it another instance
     * under another force, by turns. */
    double runs[3][STEPS][2];
    fmi3FMUState half = NULL;
    fmi3Instance beside = NEW("beside");
    CHECK(beside && INITIALIZED(beside));
    for (int run = 0; run < 3; run++) {
        int first = 0;
        if (run < 2) {
            if (run) CHECK(fmi3Reset_(c) == fmi3OK);
            CHECK(INITIALIZED(c));
        } else {
            size_t size = 0;
            CHECK(fmi3SerializedFMUStateSize_(c, half, &size) == fmi3OK && size > 0);
            fmi3Byte *bytes = malloc(size);
            CHECK(fmi3SerializeFMUState_(c, half, bytes, size) == fmi3OK);
            CHECK(fmi3SerializeFMUState_(c, half, bytes, size - 1) == fmi3Error);
            CHECK(fmi3FreeFMUState_(c, &half) == fmi3OK && half == NULL);
            bytes[size / 2] ^= 1;
            CHECK(fmi3DeserializeFMUState_(c, bytes, size, &half) == fmi3Error && half == NULL);
            bytes[size / 2] ^= 1;
            CHECK(fmi3DeserializeFMUState_(c, bytes, size, &half) == fmi3OK);
            CHECK(fmi3SetFMUState_(c, half) == fmi3OK);
            free(bytes);
            memcpy(runs[2], runs[0], sizeof runs[2]);
            first = STEPS / 2;
        }
        for (int n = first; n < STEPS; n++) {
            if (run == 1 && n == STEPS / 2) CHECK(fmi3GetFMUState_(c, &half) == fmi3OK && half != NULL);
            double value = force_at(n), other = 100.0 * n;
            CHECK(fmi3SetFloat64_(c, &force, 1, &value, 1) == fmi3OK);
            if (run == 0) CHECK(fmi3SetFloat64_(beside, &force, 1, &other, 1) == fmi3OK && STEPPED(beside, n));
            CHECK(STEPPED(c, n));
            CHECK(fmi3GetFloat64_(c, outputs, 2, runs[run][n], 2) == fmi3OK);
        }
        CHECK(memcmp(runs[run], runs[0], sizeof runs[0]) == 0);
        CHECK(as_expected(runs[run], expected));
    }
    CHECK(fmi3FreeFMUState_(c, &half) == fmi3OK);
    fmi3FreeInstance_(beside);

    /* Derivatives by the force against differences, which for a linear panel are exact at any size. */
    double one = 1.0, slope[2], low[2], high[2], values[2] = {-1.0, 1.0};
    CHECK(fmi3GetDirectionalDerivative_(c, outputs, 2, &force, 1, &one, 1, slope, 2) == fmi3OK);
    CHECK(fmi3SetFloat64_(c, &force, 1, &values[0], 1) == fmi3OK && fmi3GetFloat64_(c, outputs, 2, low, 2) == fmi3OK);
    CHECK(fmi3SetFloat64_(c, &force, 1, &values[1], 1) == fmi3OK && fmi3GetFloat64_(c, outputs, 2, high, 2) == fmi3OK);
    for (int i = 0; i < 2; i++) {
        double scale = fabs(high[i]) + fabs(low[i]);
        CHECK(fabs((high[i] - low[i]) / 2.0 - slope[i]) <= 1e-14 * scale);
    }
    fmi3FreeInstance_(c);

    /* A parameter set before the start: the modes are solved anew. */
    const fmi3ValueReference parameter = (fmi3ValueReference)atoi(argv[10]);
    const double value = atof(argv[11]);
    c = NEW("changed");
    CHECK(c && fmi3SetFloat64_(c, &parameter, 1, &value, 1) == fmi3OK && INITIALIZED(c));
    for (int n = 0; n < STEPS; n++) {
        double pushed = force_at(n);
        CHECK(fmi3SetFloat64_(c, &force, 1, &pushed, 1) == fmi3OK && STEPPED(c, n));
        CHECK(fmi3GetFloat64_(c, outputs, 2, runs[1][n], 2) == fmi3OK);
    }
    CHECK(!as_expected(runs[1], expected));
    expect(argv[12], expected);
    CHECK(as_expected(runs[1], expected));
    fmi3FreeInstance_(c);

    /* A tunable parameter set half way: the motion goes on as another panel's. The state from before brings the old one back. */
    const fmi3ValueReference tunable = (fmi3ValueReference)atoi(argv[13]);
    const double tuned = atof(argv[14]), nowhere = 1e3;
    c = NEW("tuned");
    half = NULL;
    CHECK(c && INITIALIZED(c));
    for (int n = 0; n < STEPS; n++) {
        double pushed = force_at(n);
        if (n == STEPS / 2) {
            CHECK(fmi3GetFMUState_(c, &half) == fmi3OK && fmi3SetFloat64_(c, &tunable, 1, &nowhere, 1) == fmi3Error);
            CHECK(fmi3SetFloat64_(c, &parameter, 1, &value, 1) == fmi3Error && fmi3SetFloat64_(c, &tunable, 1, &tuned, 1) == fmi3OK);
        }
        CHECK(fmi3SetFloat64_(c, &force, 1, &pushed, 1) == fmi3OK && STEPPED(c, n));
        CHECK(fmi3GetFloat64_(c, outputs, 2, runs[1][n], 2) == fmi3OK);
    }
    expect(argv[4], expected);
    CHECK(memcmp(runs[1], runs[0], sizeof runs[0] / 2) == 0 && !as_expected(runs[1], expected));
    expect_in_halves(argv[4], argv[15], expected);
    CHECK(as_expected(runs[1], expected));
    CHECK(fmi3SetFMUState_(c, half) == fmi3OK && fmi3FreeFMUState_(c, &half) == fmi3OK);
    for (int n = STEPS / 2; n < STEPS; n++) {
        double pushed = force_at(n);
        CHECK(fmi3SetFloat64_(c, &force, 1, &pushed, 1) == fmi3OK && STEPPED(c, n));
        CHECK(fmi3GetFloat64_(c, outputs, 2, runs[1][n], 2) == fmi3OK);
    }
    CHECK(memcmp(runs[1], runs[0], sizeof runs[0]) == 0);
    fmi3FreeInstance_(c);

    /* Model exchange: the same of the derivatives of all states by all states, along a seed, and the adjoint of it. */
    c = fmi3InstantiateModelExchange_("continuous", argv[2], argv[3], fmi3False, fmi3False, NULL, logger);
    size_t told = 0;
    CHECK(c && INITIALIZED(c) && fmi3EnterContinuousTimeMode_(c) == fmi3OK);
    CHECK(fmi3GetNumberOfContinuousStates_(c, &told) == fmi3OK && told == count);
    double seed[MOST], weights[MOST], forth[MOST], back[MOST], moved[MOST], along[MOST], adjoint[MOST];
    for (size_t i = 0; i < count; i++) {
        /* Positions are small beside velocities, as in a motion. */
        seed[i] = (i % 2 ? 1.0 : 1e-4) * sin(1.0 + (double)i);
        weights[i] = cos(2.0 * (double)i);
        moved[i] = -seed[i];
    }
    CHECK(fmi3SetContinuousStates_(c, seed, count) == fmi3OK);
    CHECK(fmi3GetContinuousStateDerivatives_(c, forth, count) == fmi3OK);
    CHECK(fmi3SetContinuousStates_(c, moved, count) == fmi3OK);
    CHECK(fmi3GetContinuousStateDerivatives_(c, back, count) == fmi3OK);
    CHECK(fmi3GetDirectionalDerivative_(c, rates, count, states, count, seed, count, along, count) == fmi3OK);
    CHECK(fmi3GetAdjointDerivative_(c, rates, count, states, count, weights, count, adjoint, count) == fmi3OK);
    double by_rates = 0.0, by_states = 0.0, size = 0.0;
    for (size_t i = 0; i < count; i++) {
        CHECK(fabs((forth[i] - back[i]) / 2.0 - along[i]) <= 1e-14 * (fabs(forth[i]) + fabs(back[i])));
        by_rates += weights[i] * along[i];
        by_states += adjoint[i] * seed[i];
        size += fabs(weights[i] * along[i]);
    }
    CHECK(size > 0.0 && fabs(by_rates - by_states) <= 1e-14 * size);
    if (c) fmi3FreeInstance_(c);

    /* Many instances, one after the other, each with a state that is never freed: no growth once the heap has settled. */
    long instances = atol(argv[16]), settled = 0;
    for (long n = 0; n < instances; n++) {
        c = NEW("many");
        fmi3FMUState left = NULL;
        CHECK(c && INITIALIZED(c) && STEPPED(c, 0) && fmi3GetFMUState_(c, &left) == fmi3OK);
        fmi3FreeInstance_(c);
        if (n == instances / 4) settled = resident();
    }
    /* Of 1,500 instances: the heap's own wandering; 22 bytes an instance would show. */
    CHECK(settled > 0 && resident() <= settled + 32);
    dlclose(library);
    return failed > 100 ? 100 : failed;
}

/* Every entry point of an FMI 3.0 FMU under hosts that trap, round and flush as they like (`hosts.h`).
 *
 *     hosts3 LIBRARY TOKEN RESOURCES VARIABLES-TEXT
 */
#include "hosts.h"

#include "fmi3Functions.h"

static void logger(fmi3InstanceEnvironment e, fmi3Status s, fmi3String c, fmi3String message) {
    (void)e, (void)s, (void)c, (void)message;
}

static variables inputs, outputs, fixed, tunables, states, rates, booleans;

static fmi3Instance made(char **argv, int exchanging) {
    begin("fmi3Instantiate...");
    fmi3Instance c = exchanging
        ? FUNCTION(fmi3InstantiateModelExchange)("one", argv[2], argv[3], fmi3False, fmi3True, NULL, logger)
        : FUNCTION(fmi3InstantiateCoSimulation)("one", argv[2], argv[3], fmi3False, fmi3True, fmi3False, fmi3False, NULL, 0,
                                                NULL, logger, NULL);
    end(0);
    if (!c) exit(102);
    CHECK(!strcmp(FUNCTION(fmi3GetVersion)(), "3.0"));
    CHECK(!FUNCTION(fmi3InstantiateScheduledExecution)("one", argv[2], argv[3], fmi3False, fmi3True, NULL, logger, NULL, NULL,
                                                       NULL));
    DONE(fmi3SetDebugLogging, c, fmi3True, 0, NULL);
    return c;
}

static void freed(fmi3Instance c) {
    begin("fmi3FreeInstance");
    FUNCTION(fmi3FreeInstance)(c);
    end(0);
}

static void read_all(fmi3Instance c) {
    double values[MOST_VARIABLES];
    const variables *all[] = {&outputs, &states, &rates, &inputs, &fixed, &tunables};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        DONE(fmi3GetFloat64, c, all[i]->references, all[i]->count, values, all[i]->size);
        record(values, all[i]->size);
    }
}

/* Along all inputs, all states and the parameters given; and back. */
static void derivatives(fmi3Instance c, const variables *parameters) {
    double seed[MOST_VARIABLES], found[MOST_VARIABLES];
    const variables *knowns[] = {&inputs, &states, parameters}, *unknowns[] = {&outputs, &rates};
    for (int known = 0; known < 3; known++)
        for (int unknown = 0; unknown < 2; unknown++) {
            const variables *y = unknowns[unknown], *x = knowns[known];
            for (size_t i = 0; i < x->size; i++) seed[i] = known == 2 ? 1e-2 * x->values[i] : 0.5;
            DONE(fmi3GetDirectionalDerivative, c, y->references, y->count, x->references, x->count, seed, x->size, found,
                 y->size);
            record(found, y->size);
            /* Back from a parameter is four solutions for each: once is enough. */
            if (known == 2 && (unknown == 1 || parameters == &tunables)) continue;
            if (known == 2 && host > 1) {
                place += (long)x->size;
                continue;
            }
            for (size_t i = 0; i < y->size; i++) seed[i] = 0.5;
            DONE(fmi3GetAdjointDerivative, c, y->references, y->count, x->references, x->count, seed, y->size, found, x->size);
            record(found, x->size);
        }
}

static void state_round_trip(fmi3Instance c) {
    fmi3FMUState state = NULL, again = NULL;
    size_t size = 0;
    DONE(fmi3GetFMUState, c, &state);
    DONE(fmi3SerializedFMUStateSize, c, state, &size);
    fmi3Byte *bytes = malloc(size);
    DONE(fmi3SerializeFMUState, c, state, bytes, size);
    DONE(fmi3DeserializeFMUState, c, bytes, size, &again);
    DONE(fmi3SetFMUState, c, again);
    DONE(fmi3FreeFMUState, c, &state);
    DONE(fmi3FreeFMUState, c, &again);
    free(bytes);
}

/* What has no variable or is not offered. */
static void others(fmi3Instance c) {
    size_t count;
    DONE(fmi3GetFloat32, c, NULL, 0, NULL, 0);
    DONE(fmi3SetFloat32, c, NULL, 0, NULL, 0);
    DONE(fmi3GetInt8, c, NULL, 0, NULL, 0);
    DONE(fmi3SetInt8, c, NULL, 0, NULL, 0);
    DONE(fmi3GetUInt8, c, NULL, 0, NULL, 0);
    DONE(fmi3SetUInt8, c, NULL, 0, NULL, 0);
    DONE(fmi3GetInt16, c, NULL, 0, NULL, 0);
    DONE(fmi3SetInt16, c, NULL, 0, NULL, 0);
    DONE(fmi3GetUInt16, c, NULL, 0, NULL, 0);
    DONE(fmi3SetUInt16, c, NULL, 0, NULL, 0);
    DONE(fmi3GetInt32, c, NULL, 0, NULL, 0);
    DONE(fmi3SetInt32, c, NULL, 0, NULL, 0);
    DONE(fmi3GetUInt32, c, NULL, 0, NULL, 0);
    DONE(fmi3SetUInt32, c, NULL, 0, NULL, 0);
    DONE(fmi3GetInt64, c, NULL, 0, NULL, 0);
    DONE(fmi3SetInt64, c, NULL, 0, NULL, 0);
    DONE(fmi3GetUInt64, c, NULL, 0, NULL, 0);
    DONE(fmi3SetUInt64, c, NULL, 0, NULL, 0);
    DONE(fmi3GetString, c, NULL, 0, NULL, 0);
    DONE(fmi3SetString, c, NULL, 0, NULL, 0);
    DONE(fmi3GetBinary, c, NULL, 0, NULL, NULL, 0);
    DONE(fmi3SetBinary, c, NULL, 0, NULL, NULL, 0);
    DONE(fmi3GetClock, c, NULL, 0, NULL);
    DONE(fmi3SetClock, c, NULL, 0, NULL);
    ASKED(fmi3GetNumberOfVariableDependencies, c, outputs.references[0], &count);
    ASKED(fmi3GetVariableDependencies, c, outputs.references[0], NULL, NULL, NULL, NULL, 0);
    ASKED(fmi3EnterConfigurationMode, c);
    ASKED(fmi3ExitConfigurationMode, c);
    ASKED(fmi3EnterStepMode, c);
    ASKED(fmi3EvaluateDiscreteStates, c);
    ASKED(fmi3GetIntervalDecimal, c, NULL, 0, NULL, NULL);
    ASKED(fmi3GetIntervalFraction, c, NULL, 0, NULL, NULL, NULL);
    ASKED(fmi3GetShiftDecimal, c, NULL, 0, NULL);
    ASKED(fmi3GetShiftFraction, c, NULL, 0, NULL, NULL);
    ASKED(fmi3SetIntervalDecimal, c, NULL, 0, NULL);
    ASKED(fmi3SetIntervalFraction, c, NULL, 0, NULL, NULL);
    ASKED(fmi3SetShiftDecimal, c, NULL, 0, NULL);
    ASKED(fmi3SetShiftFraction, c, NULL, 0, NULL, NULL);
    ASKED(fmi3ActivateModelPartition, c, 0, 0.0);
}

static void set_initial(fmi3Instance c) {
    for (const variables *all[] = {&fixed, &tunables, NULL}, **list = all; *list; list++)
        for (size_t i = 0; i < (*list)->count; i++) {
            DONE(fmi3SetFloat64, c, &(*list)->references[i], 1, &(*list)->values[i], 1);
            read_all(c);
        }
    for (size_t i = 0; i < states.count; i++) {
        double value = 1e-5 * (double)(i + 1);
        DONE(fmi3SetFloat64, c, &states.references[i], 1, &value, 1);
    }
}

static void co_simulate(char **argv) {
    fmi3Instance c = made(argv, 0);
    double time = 0.0, derivative[MOST_VARIABLES], forces[MOST_VARIABLES], reached;
    int32_t orders[MOST_VARIABLES];
    bool on, needed, terminate, early;
    for (size_t i = 0; i < MOST_VARIABLES; i++) orders[i] = 1;
    /* As exported; under traps also with every parameter set before the start, in initialization mode, and with a linear force. */
    for (int run = 0; run < (host < 2 ? 4 : 1); run++) {
        for (size_t i = 0; run == 1 && i < fixed.count; i++)
            DONE(fmi3SetFloat64, c, &fixed.references[i], 1, &fixed.values[i], 1);
        DONE(fmi3EnterInitializationMode, c, fmi3True, 1e-6, 0.0, fmi3True, 1.0);
        if (run == 2) set_initial(c);
        on = run == 3;
        DONE(fmi3SetBoolean, c, booleans.references, 1, &on, 1);
        DONE(fmi3GetBoolean, c, booleans.references, 1, &on, 1);
        if (run == 0) derivatives(c, &fixed);
        DONE(fmi3ExitInitializationMode, c);
        time = 0.0;
        for (int n = 0; n < 12; n++) {
            double step = n % 3 ? 1e-4 : 3.7e-5;
            for (size_t i = 0; i < inputs.size; i++) forces[i] = force_at(n);
            DONE(fmi3SetFloat64, c, inputs.references, inputs.count, forces, inputs.size);
            if (n >= 6 && (size_t)n - 6 < tunables.count)
                DONE(fmi3SetFloat64, c, &tunables.references[n - 6], 1, &tunables.values[n - 6], 1);
            DONE(fmi3DoStep, c, time, step, fmi3True, &needed, &terminate, &early, &reached);
            time += step;
            read_all(c);
            DONE(fmi3GetOutputDerivatives, c, outputs.references, outputs.count, orders, derivative, outputs.size);
            record(derivative, outputs.size);
            if (n == 8) state_round_trip(c);
        }
        if (run == 0) derivatives(c, &tunables);
        others(c);
        DONE(fmi3Terminate, c);
        read_all(c);
        DONE(fmi3Reset, c);
    }
    freed(c);
}

/* Steps that no simulation takes: from 1e30 s on they are refused, and what comes out of shorter ones is for the FMU to say. */
static void step_for_ever(char **argv) {
    const double steps[] = {1.0, 1e10, 9e29, 1e30, 1e80, 1.7e308};
    fmi3Instance c = made(argv, 0);
    double values[MOST_VARIABLES], forces[MOST_VARIABLES], reached;
    fmi3Boolean needed, terminate, early;
    for (size_t i = 0; i < inputs.size; i++) forces[i] = 1e3;
    for (size_t n = 0; n < sizeof steps / sizeof *steps; n++) {
        DONE(fmi3EnterInitializationMode, c, fmi3False, 0.0, 0.0, fmi3False, 0.0);
        DONE(fmi3ExitInitializationMode, c);
        DONE(fmi3SetFloat64, c, inputs.references, inputs.count, forces, inputs.size);
        const int status = STATUS(fmi3DoStep, c, 0.0, steps[n], fmi3True, &needed, &terminate, &early, &reached);
        CHECK(status == 3 || steps[n] < 1e30);
        ASKED(fmi3GetFloat64, c, outputs.references, outputs.count, values, outputs.size);
        DONE(fmi3Reset, c);
    }
    freed(c);
}

static void exchange(char **argv) {
    fmi3Instance c = made(argv, 1);
    double x[MOST_VARIABLES], rate[MOST_VARIABLES], forces[MOST_VARIABLES], next;
    size_t count = 0, indicators = 1;
    bool flags[5];
    for (size_t i = 0; i < fixed.count; i++) DONE(fmi3SetFloat64, c, &fixed.references[i], 1, &fixed.values[i], 1);
    DONE(fmi3EnterInitializationMode, c, fmi3False, 0.0, 0.0, fmi3False, 0.0);
    DONE(fmi3GetNumberOfContinuousStates, c, &count);
    DONE(fmi3GetNumberOfEventIndicators, c, &indicators);
    CHECK(count == states.size && indicators == 0);
    DONE(fmi3ExitInitializationMode, c);
    for (int n = 0; n < 4; n++) {
        for (size_t i = 0; i < tunables.count; i++) {
            double value = n % 2 ? tunables.values[i] : 0.98 * tunables.values[i];
            DONE(fmi3SetFloat64, c, &tunables.references[i], 1, &value, 1);
        }
        DONE(fmi3UpdateDiscreteStates, c, &flags[0], &flags[1], &flags[2], &flags[3], &flags[4], &next);
        DONE(fmi3GetNominalsOfContinuousStates, c, x, count);
        record(x, count);
        const volatile double time = 1e-4 * n;
        DONE(fmi3EnterContinuousTimeMode, c);
        DONE(fmi3SetTime, c, time);
        for (size_t i = 0; i < inputs.size; i++) forces[i] = force_at(n);
        DONE(fmi3SetFloat64, c, inputs.references, inputs.count, forces, inputs.size);
        DONE(fmi3GetContinuousStates, c, x, count);
        DONE(fmi3GetContinuousStateDerivatives, c, rate, count);
        record(rate, count);
        for (size_t i = 0; i < count; i++) x[i] += 1e-6 * (double)(i + 1);
        DONE(fmi3SetContinuousStates, c, x, count);
        DONE(fmi3GetEventIndicators, c, NULL, 0);
        DONE(fmi3CompletedIntegratorStep, c, fmi3True, &flags[0], &flags[1]);
        read_all(c);
        if (n == 1) derivatives(c, &tunables);
        DONE(fmi3EnterEventMode, c);
        if (n == 2) state_round_trip(c);
    }
    DONE(fmi3Terminate, c);
    freed(c);
}

int main(int argc, char **argv) {
    if (argc != 5) return 101;
    library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        printf("%s\n", dlerror());
        return 100;
    }
    inputs = of_kind(argv[4], 'i'), outputs = of_kind(argv[4], 'o'), fixed = of_kind(argv[4], 'p');
    tunables = of_kind(argv[4], 't'), states = of_kind(argv[4], 's'), rates = of_kind(argv[4], 'd');
    booleans = of_kind(argv[4], 'b');
    signal(SIGFPE, die);
    for (int which = 0; which < HOSTS; which++) {
        host = which;
        place = 0;
        exchange(argv);
        co_simulate(argv);
        step_for_ever(argv);
    }
    CHECK(place > 100);
    return failed > 90 ? 90 : failed;
}

/* Every entry point of an FMI 2.0 FMU under hosts that trap, round and flush as they like (`hosts.h`).
 *
 *     hosts LIBRARY GUID RESOURCES-URI VARIABLES-TEXT
 */
#include "hosts.h"

#include "fmi2Functions.h"

static void logger(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String message, ...) {
    (void)e, (void)n, (void)s, (void)c, (void)message;
}

static const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
static variables inputs, outputs, fixed, tunables, states, rates, booleans;

static fmi2Component made(char **argv, fmi2Type type) {
    begin("fmi2Instantiate");
    fmi2Component c = FUNCTION(fmi2Instantiate)("one", type, argv[2], argv[3], &callbacks, fmi2False, fmi2True);
    end(0);
    if (!c) exit(102);
    CHECK(!strcmp(FUNCTION(fmi2GetVersion)(), "2.0") && !strcmp(FUNCTION(fmi2GetTypesPlatform)(), "default"));
    DONE(fmi2SetDebugLogging, c, fmi2True, 0, NULL);
    DONE(fmi2SetupExperiment, c, fmi2True, 1e-6, 0.0, fmi2True, 1.0);
    return c;
}

static void freed(fmi2Component c) {
    begin("fmi2FreeInstance");
    FUNCTION(fmi2FreeInstance)(c);
    end(0);
}

static void read_all(fmi2Component c) {
    double values[MOST_VARIABLES];
    const variables *all[] = {&outputs, &states, &rates, &inputs, &fixed, &tunables};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        DONE(fmi2GetReal, c, all[i]->references, all[i]->count, values);
        record(values, all[i]->count);
    }
}

/* Along one input, all states and the parameters given. */
static void derivatives(fmi2Component c, const variables *parameters) {
    double seed[MOST_VARIABLES], found[MOST_VARIABLES];
    const variables *knowns[] = {&inputs, &states, parameters}, *unknowns[] = {&outputs, &rates};
    for (size_t i = 0; i < MOST_VARIABLES; i++) seed[i] = 0.5;
    for (int known = 0; known < 3; known++)
        for (int unknown = 0; unknown < 2; unknown++) {
            const variables *y = unknowns[unknown], *x = knowns[known];
            for (size_t i = 0; known == 2 && i < x->count; i++) seed[i] = 1e-2 * x->values[i];
            DONE(fmi2GetDirectionalDerivative, c, y->references, y->count, x->references, x->count, seed, found);
            record(found, y->count);
        }
}

static void state_round_trip(fmi2Component c) {
    fmi2FMUstate state = NULL, again = NULL;
    size_t size = 0;
    DONE(fmi2GetFMUstate, c, &state);
    DONE(fmi2SerializedFMUstateSize, c, state, &size);
    char *bytes = malloc(size);
    DONE(fmi2SerializeFMUstate, c, state, bytes, size);
    DONE(fmi2DeSerializeFMUstate, c, bytes, size, &again);
    DONE(fmi2SetFMUstate, c, again);
    DONE(fmi2FreeFMUstate, c, &state);
    DONE(fmi2FreeFMUstate, c, &again);
    free(bytes);
}

/* What has no variable or is not offered. */
static void others(fmi2Component c) {
    fmi2Status status;
    double real;
    int integer;
    const char *text = "";
    DONE(fmi2GetInteger, c, NULL, 0, NULL);
    DONE(fmi2SetInteger, c, NULL, 0, NULL);
    DONE(fmi2GetString, c, NULL, 0, NULL);
    DONE(fmi2SetString, c, NULL, 0, NULL);
    ASKED(fmi2CancelStep, c);
    ASKED(fmi2GetStatus, c, fmi2DoStepStatus, &status);
    ASKED(fmi2GetRealStatus, c, fmi2LastSuccessfulTime, &real);
    ASKED(fmi2GetIntegerStatus, c, fmi2DoStepStatus, &integer);
    ASKED(fmi2GetBooleanStatus, c, fmi2Terminated, &integer);
    ASKED(fmi2GetStringStatus, c, fmi2PendingStatus, &text);
    (void)text;
}

static void set_initial(fmi2Component c) {
    for (const variables *all[] = {&fixed, &tunables, NULL}, **list = all; *list; list++)
        for (size_t i = 0; i < (*list)->count; i++) {
            DONE(fmi2SetReal, c, &(*list)->references[i], 1, &(*list)->values[i]);
            read_all(c);
        }
    for (size_t i = 0; i < states.count; i++) {
        double value = 1e-5 * (double)(i + 1);
        DONE(fmi2SetReal, c, &states.references[i], 1, &value);
    }
}

static void co_simulate(char **argv) {
    fmi2Component c = made(argv, fmi2CoSimulation);
    double time = 0.0, derivative[MOST_VARIABLES];
    int orders[MOST_VARIABLES], on;
    for (size_t i = 0; i < MOST_VARIABLES; i++) orders[i] = 1;
    /* As exported; under traps also with every parameter set before the start, in initialization mode, and with a linear force. */
    for (int run = 0; run < (host < 2 ? 4 : 1); run++) {
        for (size_t i = 0; run == 1 && i < fixed.count; i++)
            DONE(fmi2SetReal, c, &fixed.references[i], 1, &fixed.values[i]);
        DONE(fmi2EnterInitializationMode, c);
        if (run == 2) set_initial(c);
        on = run == 3;
        DONE(fmi2SetBoolean, c, booleans.references, 1, &on);
        DONE(fmi2GetBoolean, c, booleans.references, 1, &on);
        if (run == 0) derivatives(c, &fixed);
        DONE(fmi2ExitInitializationMode, c);
        time = 0.0;
        for (int n = 0; n < 12; n++) {
            double step = n % 3 ? 1e-4 : 3.7e-5, value = force_at(n);
            for (size_t i = 0; i < inputs.count; i++) DONE(fmi2SetReal, c, &inputs.references[i], 1, &value);
            if (n == 5 && run < 3) DONE(fmi2SetRealInputDerivatives, c, inputs.references, 1, orders, &value);
            if (n >= 6 && (size_t)n - 6 < tunables.count)
                DONE(fmi2SetReal, c, &tunables.references[n - 6], 1, &tunables.values[n - 6]);
            DONE(fmi2DoStep, c, time, step, fmi2True);
            time += step;
            read_all(c);
            DONE(fmi2GetRealOutputDerivatives, c, outputs.references, outputs.count, orders, derivative);
            record(derivative, outputs.count);
            if (n == 8) state_round_trip(c);
        }
        if (run == 0) derivatives(c, &tunables);
        others(c);
        DONE(fmi2Terminate, c);
        read_all(c);
        DONE(fmi2Reset, c);
        DONE(fmi2SetupExperiment, c, fmi2False, 0.0, 0.0, fmi2False, 0.0);
    }
    freed(c);
}

/* Steps that no simulation takes: from 1e30 s on they are refused, and what comes out of shorter ones is for the FMU to say. */
static void step_for_ever(char **argv) {
    const double steps[] = {1.0, 1e10, 9e29, 1e30, 1e80, 1.7e308}, force = 1e3;
    fmi2Component c = made(argv, fmi2CoSimulation);
    double values[MOST_VARIABLES];
    for (size_t n = 0; n < sizeof steps / sizeof *steps; n++) {
        DONE(fmi2SetupExperiment, c, fmi2False, 0.0, 0.0, fmi2False, 0.0);
        DONE(fmi2EnterInitializationMode, c);
        DONE(fmi2ExitInitializationMode, c);
        for (size_t i = 0; i < inputs.count; i++) DONE(fmi2SetReal, c, &inputs.references[i], 1, &force);
        const int status = STATUS(fmi2DoStep, c, 0.0, steps[n], fmi2True);
        CHECK(status == 3 || steps[n] < 1e30);
        ASKED(fmi2GetReal, c, outputs.references, outputs.count, values);
        DONE(fmi2Reset, c);
    }
    freed(c);
}

static void exchange(char **argv) {
    fmi2Component c = made(argv, fmi2ModelExchange);
    double x[MOST_VARIABLES], rate[MOST_VARIABLES];
    fmi2EventInfo event;
    fmi2Boolean enter, terminate;
    const size_t count = states.count;
    DONE(fmi2GetNominalsOfContinuousStates, c, x, count);
    for (size_t i = 0; i < fixed.count; i++) DONE(fmi2SetReal, c, &fixed.references[i], 1, &fixed.values[i]);
    DONE(fmi2EnterInitializationMode, c);
    DONE(fmi2ExitInitializationMode, c);
    for (int n = 0; n < 4; n++) {
        for (size_t i = 0; i < tunables.count; i++) {
            double value = n % 2 ? tunables.values[i] : 0.98 * tunables.values[i];
            DONE(fmi2SetReal, c, &tunables.references[i], 1, &value);
        }
        DONE(fmi2NewDiscreteStates, c, &event);
        DONE(fmi2GetNominalsOfContinuousStates, c, x, count);
        record(x, count);
        const volatile double time = 1e-4 * n;
        DONE(fmi2EnterContinuousTimeMode, c);
        DONE(fmi2SetTime, c, time);
        for (size_t i = 0; i < inputs.count; i++) {
            double value = force_at(n);
            DONE(fmi2SetReal, c, &inputs.references[i], 1, &value);
        }
        DONE(fmi2GetContinuousStates, c, x, count);
        DONE(fmi2GetDerivatives, c, rate, count);
        record(rate, count);
        for (size_t i = 0; i < count; i++) x[i] += 1e-6 * (double)(i + 1);
        DONE(fmi2SetContinuousStates, c, x, count);
        DONE(fmi2GetEventIndicators, c, NULL, 0);
        DONE(fmi2CompletedIntegratorStep, c, fmi2True, &enter, &terminate);
        read_all(c);
        if (n == 1) derivatives(c, &tunables);
        DONE(fmi2EnterEventMode, c);
        if (n == 2) state_round_trip(c);
    }
    DONE(fmi2Terminate, c);
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

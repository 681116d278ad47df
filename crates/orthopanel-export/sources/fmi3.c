/* FMI 3.0, co-simulation. Functions of capabilities that modelDescription.xml denies refuse. */
#include "panel.c"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(FMI3_FUNCTION_PREFIX)
#define PASTE(a, b) a##b
#define PASTED(a, b) PASTE(a, b)
#define FULL(name) PASTED(FMI3_FUNCTION_PREFIX, name)
#else
#define FULL(name) name
#endif
#if defined(FMI3_Export)
#define EXPORT FMI3_Export
#elif (defined(_WIN32) || defined(__CYGWIN__)) && !defined(FMI3_FUNCTION_PREFIX)
#define EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

typedef uint32_t Reference;
typedef const char *Text;
typedef int Status;
typedef void (*Logger)(void *environment, Status status, Text category, Text message);

static Status tell(Logger logger, void *environment, Text refused) {
    if (logger) logger(environment, STATUS_ERROR, "logStatusError", refused);
    return STATUS_ERROR;
}

static Status answer(void *instance, const char *refused) {
    Panel *panel = instance;
    Logger logger = NULL;
    if (!refused) return STATUS_OK;
    if (!panel) return STATUS_ERROR;
    memcpy(&logger, &panel->logger, sizeof logger);
    return tell(logger, panel->environment, refused);
}

#define LIVE(instance) \
    Panel *panel = instance; \
    if (!panel) return STATUS_ERROR
#define GIVEN(count, values_count, pointer) \
    if ((count) != (values_count)) return answer(panel, "another number of values than of variables"); \
    if ((count) > 0 && !(pointer)) return answer(panel, "a null pointer")

EXPORT Text FULL(fmi3GetVersion)(void) { return "3.0"; }

EXPORT void *FULL(fmi3InstantiateCoSimulation)(
    Text name, Text token, Text path, bool visible, bool logging, bool events, bool early, const Reference *required, size_t count,
    void *environment, Logger logger, void (*update)(void)) {
    Panel *panel;
    (void)name, (void)path, (void)visible, (void)logging, (void)early, (void)required, (void)count, (void)update;
    if (events) return tell(logger, environment, "there is no event mode (hasEventMode = false)"), NULL;
    if (!panel_is_token(token)) {
        return tell(logger, environment, "the token is not that of this model: compile the sources of this FMU again"), NULL;
    }
    panel = calloc(1, sizeof *panel);
    if (!panel) return NULL;
    panel->environment = environment;
    memcpy(&panel->logger, &logger, sizeof panel->logger);
    panel_reset(panel);
    return panel;
}

EXPORT void *FULL(fmi3InstantiateModelExchange)(void) { return NULL; }
EXPORT void *FULL(fmi3InstantiateScheduledExecution)(void) { return NULL; }
EXPORT void FULL(fmi3FreeInstance)(void *instance) { free(instance); }

EXPORT Status FULL(fmi3SetDebugLogging)(void *instance, bool on, size_t count, const Text *categories) {
    LIVE(instance);
    (void)on, (void)count, (void)categories, (void)panel;
    return STATUS_OK;
}

EXPORT Status FULL(fmi3EnterInitializationMode)(void *instance, bool tolerates, double tolerance, double start, bool stops, double stop) {
    LIVE(instance);
    (void)tolerates, (void)tolerance;
    return answer(panel, panel_enter(panel, start, stops, stop));
}

EXPORT Status FULL(fmi3ExitInitializationMode)(void *instance) {
    LIVE(instance);
    return answer(panel, panel_exit(panel));
}

EXPORT Status FULL(fmi3Terminate)(void *instance) {
    LIVE(instance);
    return answer(panel, panel_terminate(panel));
}

EXPORT Status FULL(fmi3Reset)(void *instance) {
    LIVE(instance);
    panel_reset(panel);
    return STATUS_OK;
}

EXPORT Status FULL(fmi3GetFloat64)(void *instance, const Reference *references, size_t count, double *values, size_t values_count) {
    LIVE(instance);
    GIVEN(count, values_count, references && values);
    return answer(panel, panel_get(panel, references, count, values));
}

EXPORT Status FULL(fmi3SetFloat64)(void *instance, const Reference *references, size_t count, const double *values, size_t values_count) {
    LIVE(instance);
    GIVEN(count, values_count, references && values);
    return answer(panel, panel_set(panel, references, count, values));
}

EXPORT Status FULL(fmi3GetBoolean)(void *instance, const Reference *references, size_t count, bool *values, size_t values_count) {
    const char *refused;
    size_t i;
    LIVE(instance);
    GIVEN(count, values_count, references && values);
    refused = panel_is_boolean(references, count);
    for (i = 0; !refused && i < count; i++) values[i] = panel->force_linear != 0;
    return answer(panel, refused);
}

EXPORT Status FULL(fmi3SetBoolean)(void *instance, const Reference *references, size_t count, const bool *values, size_t values_count) {
    LIVE(instance);
    GIVEN(count, values_count, references && values);
    return answer(panel, panel_set_linear(panel, references, count, count > 0 && values[count - 1]));
}

EXPORT Status FULL(fmi3DoStep)(
    void *instance, double start, double step, bool no_state_before, bool *event, bool *terminate, bool *early, double *last) {
    Status status;
    LIVE(instance);
    (void)no_state_before;
    if (!(event && terminate && early && last)) return answer(panel, "a null pointer");
    status = answer(panel, panel_step(panel, start, step));
    *event = *terminate = *early = false;
    *last = panel->time;
    return status;
}

/* What modelDescription.xml denies: arguments are left unread. */
#define NOT_OFFERED(name) \
    EXPORT Status FULL(name)(void *instance) { return answer(instance, #name " is not offered: see modelDescription.xml"); }
NOT_OFFERED(fmi3EnterEventMode)
NOT_OFFERED(fmi3GetFloat32)
NOT_OFFERED(fmi3GetInt8)
NOT_OFFERED(fmi3GetUInt8)
NOT_OFFERED(fmi3GetInt16)
NOT_OFFERED(fmi3GetUInt16)
NOT_OFFERED(fmi3GetInt32)
NOT_OFFERED(fmi3GetUInt32)
NOT_OFFERED(fmi3GetInt64)
NOT_OFFERED(fmi3GetUInt64)
NOT_OFFERED(fmi3GetString)
NOT_OFFERED(fmi3GetBinary)
NOT_OFFERED(fmi3GetClock)
NOT_OFFERED(fmi3SetFloat32)
NOT_OFFERED(fmi3SetInt8)
NOT_OFFERED(fmi3SetUInt8)
NOT_OFFERED(fmi3SetInt16)
NOT_OFFERED(fmi3SetUInt16)
NOT_OFFERED(fmi3SetInt32)
NOT_OFFERED(fmi3SetUInt32)
NOT_OFFERED(fmi3SetInt64)
NOT_OFFERED(fmi3SetUInt64)
NOT_OFFERED(fmi3SetString)
NOT_OFFERED(fmi3SetBinary)
NOT_OFFERED(fmi3SetClock)
NOT_OFFERED(fmi3GetNumberOfVariableDependencies)
NOT_OFFERED(fmi3GetVariableDependencies)
NOT_OFFERED(fmi3GetFMUState)
NOT_OFFERED(fmi3SetFMUState)
NOT_OFFERED(fmi3FreeFMUState)
NOT_OFFERED(fmi3SerializedFMUStateSize)
NOT_OFFERED(fmi3SerializeFMUState)
NOT_OFFERED(fmi3DeserializeFMUState)
NOT_OFFERED(fmi3GetDirectionalDerivative)
NOT_OFFERED(fmi3GetAdjointDerivative)
NOT_OFFERED(fmi3EnterConfigurationMode)
NOT_OFFERED(fmi3ExitConfigurationMode)
NOT_OFFERED(fmi3GetIntervalDecimal)
NOT_OFFERED(fmi3GetIntervalFraction)
NOT_OFFERED(fmi3GetShiftDecimal)
NOT_OFFERED(fmi3GetShiftFraction)
NOT_OFFERED(fmi3SetIntervalDecimal)
NOT_OFFERED(fmi3SetIntervalFraction)
NOT_OFFERED(fmi3SetShiftDecimal)
NOT_OFFERED(fmi3SetShiftFraction)
NOT_OFFERED(fmi3EvaluateDiscreteStates)
NOT_OFFERED(fmi3UpdateDiscreteStates)
NOT_OFFERED(fmi3EnterContinuousTimeMode)
NOT_OFFERED(fmi3CompletedIntegratorStep)
NOT_OFFERED(fmi3SetTime)
NOT_OFFERED(fmi3SetContinuousStates)
NOT_OFFERED(fmi3GetContinuousStateDerivatives)
NOT_OFFERED(fmi3GetEventIndicators)
NOT_OFFERED(fmi3GetContinuousStates)
NOT_OFFERED(fmi3GetNominalsOfContinuousStates)
NOT_OFFERED(fmi3GetNumberOfEventIndicators)
NOT_OFFERED(fmi3GetNumberOfContinuousStates)
NOT_OFFERED(fmi3EnterStepMode)
NOT_OFFERED(fmi3GetOutputDerivatives)
NOT_OFFERED(fmi3ActivateModelPartition)

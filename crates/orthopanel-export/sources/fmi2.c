/* FMI 2.0, co-simulation. Functions of capabilities that modelDescription.xml denies refuse. */
#include "panel.c"

#include <stdlib.h>
#include <string.h>

#if defined(FMI2_FUNCTION_PREFIX)
#define PASTE(a, b) a##b
#define PASTED(a, b) PASTE(a, b)
#define FULL(name) PASTED(FMI2_FUNCTION_PREFIX, name)
#else
#define FULL(name) name
#endif
#if defined(FMI2_Export)
#define EXPORT FMI2_Export
#elif (defined(_WIN32) || defined(__CYGWIN__)) && !defined(FMI2_FUNCTION_PREFIX)
#define EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

typedef unsigned int Reference;
typedef int Boolean;
typedef const char *Text;
typedef int Status;
typedef void (*Logger)(void *environment, Text name, Status status, Text category, Text message, ...);

typedef struct {
    Logger logger;
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void (*finished)(void *, Status);
    void *environment;
} Callbacks;

static Status tell(Logger logger, void *environment, Text name, Text refused) {
    if (logger) logger(environment, name, STATUS_ERROR, "logStatusError", "%s", refused);
    return STATUS_ERROR;
}

static Status answer(void *instance, const char *refused) {
    Panel *panel = instance;
    Logger logger = NULL;
    if (!refused) return STATUS_OK;
    if (!panel) return STATUS_ERROR;
    memcpy(&logger, &panel->logger, sizeof logger);
    return tell(logger, panel->environment, panel->name, refused);
}

#define LIVE(instance) \
    Panel *panel = instance; \
    if (!panel) return STATUS_ERROR
#define GIVEN(count, pointer) \
    if ((count) > 0 && !(pointer)) return answer(panel, "a null pointer")

EXPORT Text FULL(fmi2GetTypesPlatform)(void) { return "default"; }
EXPORT Text FULL(fmi2GetVersion)(void) { return "2.0"; }

EXPORT void *FULL(fmi2Instantiate)(Text name, int kind, Text token, Text location, const Callbacks *functions, Boolean visible, Boolean logging) {
    Panel *panel;
    (void)location, (void)visible, (void)logging;
    if (!functions) return NULL;
    if (!name) name = "";
    if (kind != 1) return tell(functions->logger, functions->environment, name, "only co-simulation is offered"), NULL;
    if (!panel_is_token(token)) {
        return tell(functions->logger, functions->environment, name, "the guid is not that of this model: compile this FMU's sources again"), NULL;
    }
    panel = calloc(1, sizeof *panel);
    if (!panel) return NULL;
    panel->environment = functions->environment;
    memcpy(&panel->logger, &functions->logger, sizeof panel->logger);
    strncpy(panel->name_text, name, sizeof panel->name_text - 1);
    panel->name = panel->name_text;
    panel_reset(panel);
    return panel;
}

EXPORT void FULL(fmi2FreeInstance)(void *instance) { free(instance); }

EXPORT Status FULL(fmi2SetDebugLogging)(void *instance, Boolean on, size_t count, const Text *categories) {
    LIVE(instance);
    (void)on, (void)count, (void)categories, (void)panel;
    return STATUS_OK;
}

EXPORT Status FULL(fmi2SetupExperiment)(void *instance, Boolean tolerates, double tolerance, double start, Boolean stops, double stop) {
    LIVE(instance);
    (void)tolerates, (void)tolerance;
    if (panel->phase != INSTANTIATED) return answer(panel, "not allowed in this state of the life cycle");
    panel->time = start;
    panel->stops = stops;
    panel->stop_time = stop;
    return STATUS_OK;
}

EXPORT Status FULL(fmi2EnterInitializationMode)(void *instance) {
    LIVE(instance);
    return answer(panel, panel_enter(panel, panel->time, panel->stops, panel->stop_time));
}

EXPORT Status FULL(fmi2ExitInitializationMode)(void *instance) {
    LIVE(instance);
    return answer(panel, panel_exit(panel));
}

EXPORT Status FULL(fmi2Terminate)(void *instance) {
    LIVE(instance);
    return answer(panel, panel_terminate(panel));
}

EXPORT Status FULL(fmi2Reset)(void *instance) {
    LIVE(instance);
    panel_reset(panel);
    return STATUS_OK;
}

EXPORT Status FULL(fmi2GetReal)(void *instance, const Reference *references, size_t count, double *values) {
    LIVE(instance);
    GIVEN(count, references && values);
    return answer(panel, panel_get(panel, references, count, values));
}

EXPORT Status FULL(fmi2SetReal)(void *instance, const Reference *references, size_t count, const double *values) {
    LIVE(instance);
    GIVEN(count, references && values);
    return answer(panel, panel_set(panel, references, count, values));
}

EXPORT Status FULL(fmi2GetBoolean)(void *instance, const Reference *references, size_t count, Boolean *values) {
    const char *refused;
    size_t i;
    LIVE(instance);
    GIVEN(count, references && values);
    refused = panel_is_boolean(references, count);
    for (i = 0; !refused && i < count; i++) values[i] = panel->force_linear;
    return answer(panel, refused);
}

EXPORT Status FULL(fmi2SetBoolean)(void *instance, const Reference *references, size_t count, const Boolean *values) {
    LIVE(instance);
    GIVEN(count, references && values);
    return answer(panel, panel_set_linear(panel, references, count, count > 0 && values[count - 1] != 0));
}

#define ABSENT_TYPE(name, type) \
    EXPORT Status FULL(name)(void *instance, const Reference *references, size_t count, type *values) { \
        (void)references, (void)values; \
        return answer(instance, count ? "there is no variable of this type" : NULL); \
    }
ABSENT_TYPE(fmi2GetInteger, int)
ABSENT_TYPE(fmi2SetInteger, const int)
ABSENT_TYPE(fmi2GetString, Text)
ABSENT_TYPE(fmi2SetString, const Text)

EXPORT Status FULL(fmi2DoStep)(void *instance, double start, double step, Boolean no_state_before) {
    LIVE(instance);
    (void)no_state_before;
    return answer(panel, panel_step(panel, start, step));
}

EXPORT Status FULL(fmi2GetRealStatus)(void *instance, int kind, double *value) {
    LIVE(instance);
    if (kind != 2 || !value) return answer(panel, "steps are done when they return: only the last successful time is told");
    *value = panel->time;
    return STATUS_OK;
}

EXPORT Status FULL(fmi2GetBooleanStatus)(void *instance, int kind, Boolean *value) {
    LIVE(instance);
    if (kind != 3 || !value) return answer(panel, "steps are done when they return: only terminated is told");
    *value = 0;
    return STATUS_OK;
}

/* What modelDescription.xml denies: arguments are left unread. */
#define NOT_OFFERED(name) \
    EXPORT Status FULL(name)(void *instance) { return answer(instance, #name " is not offered: see the flags in modelDescription.xml"); }
NOT_OFFERED(fmi2GetStatus)
NOT_OFFERED(fmi2GetIntegerStatus)
NOT_OFFERED(fmi2GetStringStatus)
NOT_OFFERED(fmi2CancelStep)
NOT_OFFERED(fmi2GetFMUstate)
NOT_OFFERED(fmi2SetFMUstate)
NOT_OFFERED(fmi2FreeFMUstate)
NOT_OFFERED(fmi2SerializedFMUstateSize)
NOT_OFFERED(fmi2SerializeFMUstate)
NOT_OFFERED(fmi2DeSerializeFMUstate)
NOT_OFFERED(fmi2GetDirectionalDerivative)
NOT_OFFERED(fmi2SetRealInputDerivatives)
NOT_OFFERED(fmi2GetRealOutputDerivatives)
NOT_OFFERED(fmi2EnterEventMode)
NOT_OFFERED(fmi2NewDiscreteStates)
NOT_OFFERED(fmi2EnterContinuousTimeMode)
NOT_OFFERED(fmi2CompletedIntegratorStep)
NOT_OFFERED(fmi2SetTime)
NOT_OFFERED(fmi2SetContinuousStates)
NOT_OFFERED(fmi2GetDerivatives)
NOT_OFFERED(fmi2GetEventIndicators)
NOT_OFFERED(fmi2GetContinuousStates)
NOT_OFFERED(fmi2GetNominalsOfContinuousStates)

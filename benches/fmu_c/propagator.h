/* What a careful C programmer writes by hand for the same modes: the peers of the FMU. */
#ifndef PROPAGATOR_H
#define PROPAGATOR_H

/* One force, one acceleration; modes as in the FMU: omega [rad/s], zeta [1], shapes [kg^-1/2]. */
typedef struct panel panel;

panel *panel_new(int count, const double *omega, const double *zeta, const double *at_force, const double *at_response);
void panel_free(panel *p);
/* Goes on from where another stands that has as many modes. */
void panel_go_on_from(panel *p, const panel *other);
void panel_set_force(panel *p, double force);
double panel_acceleration(const panel *p);

/* Exact for a force held over the step; coefficients are kept while the step has the same size. */
void panel_step_exact(panel *p, double step);
/* The classical Runge-Kutta method, one step. */
void panel_step_rk4(panel *p, double step);

#endif

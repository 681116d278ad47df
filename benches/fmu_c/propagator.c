#include "propagator.h"

#include <complex.h>
#include <stdlib.h>

struct panel {
    int count;
    double force, step;
    /* Structure of arrays, so that the compiler can use vector instructions. */
    double *omega, *zeta, *at_force, *at_response, *stiffness, *damping;
    double *a11, *a12, *a21, *a22, *b1, *b2;
    double *q, *v;
};

static double *numbers(int count) {
    double *values = calloc((size_t)count, sizeof *values);
    if (!values) abort();
    return values;
}

panel *panel_new(int count, const double *omega, const double *zeta, const double *at_force, const double *at_response) {
    panel *p = calloc(1, sizeof *p);
    if (!p) abort();
    p->count = count;
    double **all[] = {&p->omega, &p->zeta, &p->at_force, &p->at_response, &p->stiffness, &p->damping, &p->a11,
                      &p->a12,   &p->a21,  &p->a22,      &p->b1,          &p->b2,        &p->q,       &p->v};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) *all[i] = numbers(count);
    for (int m = 0; m < count; m++) {
        p->omega[m] = omega[m];
        p->zeta[m] = zeta[m];
        p->at_force[m] = at_force[m];
        p->at_response[m] = at_response[m];
        p->stiffness[m] = omega[m] * omega[m];
        p->damping[m] = 2.0 * zeta[m] * omega[m];
    }
    return p;
}

void panel_free(panel *p) {
    double *all[] = {p->omega, p->zeta, p->at_force, p->at_response, p->stiffness, p->damping, p->a11,
                     p->a12,   p->a21,  p->a22,      p->b1,          p->b2,        p->q,       p->v};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    free(p);
}

void panel_go_on_from(panel *p, const panel *other) {
    for (int m = 0; m < p->count && m < other->count; m++) p->q[m] = other->q[m], p->v[m] = other->v[m];
}

void panel_set_force(panel *p, double force) { p->force = force; }

double panel_acceleration(const panel *p) {
    double sum = 0.0;
    for (int m = 0; m < p->count; m++)
        sum += p->at_response[m] * (p->at_force[m] * p->force - p->damping[m] * p->v[m] - p->stiffness[m] * p->q[m]);
    return sum;
}

/* q'' + 2 zeta omega q' + omega^2 q = p in closed form, by the root s = -zeta omega + i omega_d. */
static void coefficients(panel *p, double step) {
    for (int m = 0; m < p->count; m++) {
        double w = p->omega[m], k = p->stiffness[m];
        if (w == 0.0) {
            p->a11[m] = 1.0, p->a12[m] = step, p->a21[m] = 0.0, p->a22[m] = 1.0;
            p->b1[m] = step * step / 2.0, p->b2[m] = step;
            continue;
        }
        double complex s = -p->zeta[m] * w + I * csqrt(1.0 - p->zeta[m] * p->zeta[m]) * w;
        double complex e = cexp(s * step);
        double wd = cimag(s);
        p->a12[m] = cimag(e) / wd;
        p->a11[m] = creal(e) - creal(s) * p->a12[m];
        p->a21[m] = -k * p->a12[m];
        p->a22[m] = creal(e) + creal(s) * p->a12[m];
        p->b1[m] = (1.0 - p->a11[m]) / k;
        p->b2[m] = p->a12[m];
    }
    p->step = step;
}

void panel_step_exact(panel *p, double step) {
    if (step != p->step) coefficients(p, step);
    int count = p->count;
    double force = p->force;
    double *restrict q = p->q, *restrict v = p->v;
    const double *restrict a11 = p->a11, *restrict a12 = p->a12, *restrict a21 = p->a21, *restrict a22 = p->a22;
    const double *restrict b1 = p->b1, *restrict b2 = p->b2, *restrict at_force = p->at_force;
    for (int m = 0; m < count; m++) {
        double f = at_force[m] * force, x = q[m], y = v[m];
        q[m] = a11[m] * x + a12[m] * y + b1[m] * f;
        v[m] = a21[m] * x + a22[m] * y + b2[m] * f;
    }
}

void panel_step_rk4(panel *p, double step) {
    int count = p->count;
    double force = p->force, half = step / 2.0, sixth = step / 6.0;
    double *restrict q = p->q, *restrict v = p->v;
    const double *restrict c = p->damping, *restrict k = p->stiffness, *restrict at_force = p->at_force;
    for (int m = 0; m < count; m++) {
        double f = at_force[m] * force, x = q[m], y = v[m];
        double k1 = f - c[m] * y - k[m] * x;
        double y2 = y + half * k1, k2 = f - c[m] * y2 - k[m] * (x + half * y);
        double y3 = y + half * k2, k3 = f - c[m] * y3 - k[m] * (x + half * y2);
        double y4 = y + step * k3, k4 = f - c[m] * y4 - k[m] * (x + step * y3);
        q[m] = x + sixth * (y + 2.0 * (y2 + y3) + y4);
        v[m] = y + sixth * (k1 + 2.0 * (k2 + k3) + k4);
    }
}

//! Modes of a panel whose core relaxes, continued from those at moduli that stand still.

use std::sync::Arc;

use num_complex::Complex64;

use super::{CoreModulus, SeenModes};

/// Nodes at least, and one more for so much of the stretch $2h$ of $\ln g$: what $n$ of them leave of a frequency,
/// $h^n/2^{n-1}n!$ times a derivative below one, is then some 1e-6 at most.
const NODES: usize = 3;
const NODE_EACH: f64 = 0.16;
/// Stretches of $\ln g$ are of these lengths, so that cores that differ little share their nodes.
const STRETCHES: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.6, 0.9, 1.2, 1.5];
/// Rounds for a mode's own modulus: a frequency follows the modulus by less than half, the modulus the frequency by less than that, so that
/// each gains a digit.
const ROUNDS: usize = 10;

impl CoreModulus {
    /// The factors on the low modulus at which modes are wanted for [`RelaxingModes`] up to an angular frequency \[rad/s\].
    ///
    /// They are Chebyshev's points over a stretch of $\ln g$ from zero.
    pub fn nodes(&self, highest: f64) -> Vec<f64> {
        let reached = self.factor(Complex64::new(0.0, highest)).norm().ln();
        let stretch = STRETCHES.into_iter().find(|stretch| *stretch >= reached).unwrap_or(reached);
        let count = NODES + (stretch / NODE_EACH) as usize;
        let angle = |k: usize| std::f64::consts::PI * (k as f64 + 0.5) / count as f64;
        (0..count).map(|k| (0.5 * stretch * (1.0 - angle(k).cos())).exp()).collect()
    }
}

/// Modes of a panel with a core $G(s) = G\,g(s)$ and shapes that follow it.
///
/// At a modulus that stands still the panel has real modes $\lambda_n(g)$, $W_n(g)$, which are analytic in $g$. A polynomial in $\ln g$
/// through those at some real $g$ continues them to complex ones, and with
/// $$H(s) = \sum_n\frac{s^2\,W_n(g)W_n(g)^T}{s^2+c_ns+\lambda_n(g)},\qquad g = g(s),$$
/// all lines are those of the relaxing panel; $c_n$ is what damps a mode beside the core. A pole is where a denominator is zero.
///
/// Along the stretch modes of a plate may cross: each is followed by its deflections at the places, as far as these tell neighbours apart.
///
/// # Limits
/// Modes that veer away from each other are no polynomials of low order where they do.
#[derive(Debug, Clone)]
pub struct RelaxingModes {
    core: CoreModulus,
    /// $\ln g_k$, with the weights of the barycentric formula.
    nodes: Vec<(f64, f64)>,
    /// At each node, in the sense of the first.
    modes: Vec<SeenModes>,
    near: usize,
}

/// A mode at its own modulus, with a damping ratio that is known.
#[derive(Debug, Clone, PartialEq)]
pub struct RelaxingMode {
    /// $|s_n|$ of its pole \[rad/s\].
    pub angular_frequency: f64,
    /// $c_n$ \[1/s\]: what damps it beside the core; below zero where the core takes more than the whole.
    pub damping: f64,
    /// $d/ds\,(s^2+c_ns+\lambda_n(g(s)))$ at the pole: the accelerance has the residue $s_n^2W_nW_n^T$ over this.
    pub by_s: Complex64,
    /// $W_n$ at the places \[kg^-1/2\].
    pub deflection: Vec<Complex64>,
    /// $\partial W_n/\partial x$ and $\partial W_n/\partial y$ \[kg^-1/2/m\], where these were asked for.
    pub slopes: [Vec<Complex64>; 2],
}

/// All near modes at one modulus.
#[derive(Debug, Clone, PartialEq)]
pub struct ModesAtLine {
    /// $\lambda_n(g)$ \[1/s²\].
    pub lambda: Vec<Complex64>,
    /// $W_n(g)$ at the places \[kg^-1/2\], a list a mode.
    pub deflection: Vec<Vec<Complex64>>,
    /// $\partial W_n/\partial x$ and $\partial W_n/\partial y$ \[kg^-1/2/m\], alike, where these were asked for.
    pub slopes: Vec<[Vec<Complex64>; 2]>,
    /// Weights of the nodes.
    shares: Vec<Complex64>,
    s: Complex64,
}

impl RelaxingModes {
    /// From modes at the [`CoreModulus::nodes`], of which the first `near` count each by itself.
    pub fn new(core: CoreModulus, nodes: &[f64], modes: &[Arc<SeenModes>], near: usize) -> Self {
        let logs: Vec<f64> = nodes.iter().map(|node| node.ln()).collect();
        let weight = |k: usize| {
            let others = logs.iter().enumerate().filter(|(other, _)| *other != k);
            others.map(|(_, node)| 1.0 / (logs[k] - node)).product::<f64>()
        };
        let near = modes.iter().map(|modes| modes.angular_frequency.len()).fold(near, usize::min);
        let mut aligned: Vec<SeenModes> = Vec::with_capacity(modes.len());
        for modes in modes {
            let mut modes = SeenModes::clone(modes);
            if let Some(last) = aligned.last() {
                follow(last, &mut modes, near);
            }
            aligned.push(modes);
        }
        let nodes = logs.iter().enumerate().map(|(k, log)| (*log, weight(k))).collect();
        Self { core, nodes, modes: aligned, near }
    }

    /// How many modes count each by itself.
    pub fn near(&self) -> usize {
        self.near
    }

    /// Weights of the nodes at $s$.
    fn shares(&self, s: Complex64) -> Vec<Complex64> {
        let at = self.core.factor(s).ln();
        if let Some(hit) = self.nodes.iter().position(|(node, _)| (at - node).norm() < 1e-14) {
            return (0..self.nodes.len()).map(|k| Complex64::from(f64::from(u8::from(k == hit)))).collect();
        }
        let parts: Vec<Complex64> = self.nodes.iter().map(|(node, weight)| weight / (at - node)).collect();
        let whole: Complex64 = parts.iter().sum();
        parts.into_iter().map(|part| part / whole).collect()
    }

    fn lambda(&self, n: usize, shares: &[Complex64]) -> Complex64 {
        self.modes.iter().zip(shares).map(|(modes, share)| share * modes.angular_frequency[n].powi(2)).sum()
    }

    fn slopes(&self, n: usize, shares: &[Complex64]) -> [Vec<Complex64>; 2] {
        [
            self.mixed(shares, |modes| modes.slope.get(n).map_or(&[], |slope| slope)),
            self.mixed(shares, |modes| modes.slope_across.get(n).map_or(&[], |slope| slope)),
        ]
    }

    fn mixed(&self, shares: &[Complex64], of: impl Fn(&SeenModes) -> &[f64]) -> Vec<Complex64> {
        let mut mixed = vec![Complex64::ZERO; self.modes.first().map_or(0, |modes| of(modes).len())];
        for (modes, share) in self.modes.iter().zip(shares) {
            mixed.iter_mut().zip(of(modes)).for_each(|(sum, value)| *sum += share * value);
        }
        mixed
    }

    /// The near modes at the modulus of $s$.
    pub fn at(&self, s: Complex64) -> ModesAtLine {
        let shares = self.shares(s);
        ModesAtLine {
            lambda: (0..self.near).map(|n| self.lambda(n, &shares)).collect(),
            deflection: (0..self.near).map(|n| self.mixed(&shares, |modes| &modes.deflection[n])).collect(),
            slopes: (0..self.near).map(|n| self.slopes(n, &shares)).collect(),
            shares,
            s,
        }
    }

    /// What all further modes add to the accelerance from one place to another, undamped, and its derivatives by the place of the force and
    /// of the response along x, then along y, zero where slopes were not asked for.
    pub fn far(&self, line: &ModesAtLine, [force, response]: [usize; 2]) -> [Complex64; 5] {
        let s2 = line.s * line.s;
        let mut sum = [Complex64::ZERO; 5];
        for (modes, share) in self.modes.iter().zip(&line.shares) {
            for n in self.near..modes.angular_frequency.len() {
                let factor = share * s2 / (s2 + modes.angular_frequency[n].powi(2));
                let at = |port: usize| modes.deflection[n][port];
                sum[0] += factor * (at(force) * at(response));
                for (axis, slopes) in [&modes.slope, &modes.slope_across].into_iter().enumerate() {
                    let slope = |port: usize| slopes.get(n).and_then(|of| of.get(port)).copied().unwrap_or(0.0);
                    sum[1 + 2 * axis] += factor * (slope(force) * at(response));
                    sum[2 + 2 * axis] += factor * (at(force) * slope(response));
                }
            }
        }
        sum
    }

    /// A near mode at its own modulus, with a damping ratio.
    ///
    /// With $s = \omega e^{j\theta}$, $\cos\theta = -\zeta$, both parts of $s + c + \lambda(g(s))/s = 0$ give
    /// $$\omega^2 = -\frac{\Im(\lambda e^{-j\theta})}{\sin\theta},\qquad c = \zeta\omega - \frac{\Re(\lambda e^{-j\theta})}\omega.$$
    pub fn mode(&self, n: usize, zeta: f64) -> RelaxingMode {
        let sine = (1.0 - zeta * zeta).max(f64::EPSILON).sqrt();
        let turn = Complex64::new(-zeta, sine);
        let mut omega = self.modes.first().map_or(0.0, |modes| modes.angular_frequency[n]);
        let mut damping = 0.0;
        let mut shares = self.shares(omega * turn);
        for _ in 0..ROUNDS {
            let back = self.lambda(n, &shares) * turn.conj();
            let next = (-back.im / sine).max(0.0).sqrt();
            damping = if next > 0.0 { zeta * next - back.re / next } else { 0.0 };
            let settled = (next - omega).abs() <= 1e-12 * next;
            omega = next;
            shares = self.shares(omega * turn);
            if settled {
                break;
            }
        }
        let s = omega * turn;
        // $d\lambda/ds$ along the same curve, by a step that leaves its polynomial far more digits than any use of it wants.
        let step = 1e-4 * s;
        let beyond = |s: Complex64| self.lambda(n, &self.shares(s));
        let by_s = if omega > 0.0 { (beyond(s + step) - beyond(s - step)) / (2.0 * step) } else { Complex64::ZERO };
        RelaxingMode {
            angular_frequency: omega,
            damping,
            by_s: 2.0 * s + damping + by_s,
            deflection: self.mixed(&shares, |modes| &modes.deflection[n]),
            slopes: self.slopes(n, &shares),
        }
    }
}

/// Puts modes in the order and the sense of those at the node before, of which the first `near` count: neighbours that have crossed change their
/// places.
fn follow(last: &SeenModes, modes: &mut SeenModes, near: usize) {
    let count = near.min(last.angular_frequency.len()).min(modes.angular_frequency.len());
    let along = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // The modal assurance criterion.
    let alike = |modes: &SeenModes, own: usize, other: usize| {
        let (a, b) = (&last.deflection[own], &modes.deflection[other]);
        along(a, b).powi(2) / (along(a, a) * along(b, b)).max(f64::MIN_POSITIVE)
    };
    for _ in 0..count {
        let mut is_done = true;
        for n in 1..count {
            let kept = alike(modes, n - 1, n - 1) + alike(modes, n, n);
            let crossed = alike(modes, n - 1, n) + alike(modes, n, n - 1);
            if crossed > kept + f64::EPSILON.sqrt() {
                modes.angular_frequency.swap(n - 1, n);
                modes.damping_ratio.swap(n - 1, n);
                for list in [&mut modes.deflection, &mut modes.slope, &mut modes.slope_across] {
                    if n < list.len() {
                        list.swap(n - 1, n);
                    }
                }
                is_done = false;
            }
        }
        if is_done {
            break;
        }
    }
    for n in 0..count {
        if along(&last.deflection[n], &modes.deflection[n]) < 0.0 {
            for list in [&mut modes.deflection, &mut modes.slope, &mut modes.slope_across] {
                list.get_mut(n).into_iter().flatten().for_each(|value| *value = -*value);
            }
        }
    }
}

impl RelaxingMode {
    /// Of a mode that is asked for without damping, the ratio that the core alone gives it, to first order in the loss: what would have to
    /// drive it, $-c_n/2\omega_n = \tfrac12\Im\lambda_n/\Re\lambda_n$.
    pub fn core_damping(&self) -> f64 {
        if self.angular_frequency > 0.0 { -0.5 * self.damping / self.angular_frequency } else { 0.0 }
    }
}

impl ModesAtLine {
    /// Where.
    pub fn s(&self) -> Complex64 {
        self.s
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::{
        Boundary, EffectSetting, ModeRange, ModifiedPanel, PanelModel, Piece, Place, RecordSetting, RelaxingLines,
        StructureKind,
    };

    const CORE: CoreModulus = CoreModulus { strength: 0.4, tau: 1.5e-4, alpha: 0.6 };
    const VALUES: [f64; 2] = [1.07e10, 5.363e8];
    const PLACES: [Place; 2] = [Place { x: -0.33, y: 0.0 }, Place { x: 0.31, y: 0.0 }];

    /// A strip with a mass, and the lines of the same by the Laplace domain's own matrices.
    fn both() -> (RelaxingModes, RelaxingLines) {
        let text = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
            "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
            "constants": {"e_x": 1.07e10, "g_zx": 5.363e8}, "damping": {"ratios": [], "beyond": 0.0},
            "effects": [{"id": "local-mass", "owner": "panel", "mass": 0.02, "x": 0.11},
                        {"id": "viscoelastic-core", "owner": "panel", "strength": 0.4, "tau": 1.5e-4, "alpha": 0.6}]}"#;
        let model = PanelModel::from_json(text).expect("a model");
        let lines = model.relaxing_lines(ModeRange::Count(30), &PLACES, &PLACES).expect("lines").expect("a core");
        let (_, mut effects) = model.with_effects().expect("effects");
        effects.truncate(1);
        let setting = EffectSetting {
            piece: Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 },
            boundary: Boundary::default(),
            suspension: vec![],
            record: RecordSetting { number: 1, ..RecordSetting::default() },
        };
        let panel = ModifiedPanel::new(StructureKind::TimoshenkoBeam, &setting, 14).expect("a beam");
        let nodes = CORE.nodes(TAU * 5000.0);
        let at = |node: &f64| {
            let values = panel.with_core_times(&VALUES, *node);
            Arc::new(panel.seen_from(&setting, &PLACES, true, &values, &effects).expect("modes"))
        };
        (RelaxingModes::new(CORE, &nodes, &nodes.iter().map(at).collect::<Vec<_>>(), 16), lines)
    }

    /// Two modes of a plate that cross where the core stiffens keep their shapes, slopes and senses; one place cannot tell them, and leaves the order.
    #[test]
    fn modes_that_cross_are_followed() {
        let seen = |omega: [f64; 2], shapes: [[f64; 3]; 2]| SeenModes {
            angular_frequency: omega.to_vec(),
            damping_ratio: vec![0.0; 2],
            deflection: shapes.iter().map(|shape| shape.to_vec()).collect(),
            slope: shapes.iter().map(|shape| shape.to_vec()).collect(),
            ..SeenModes::default()
        };
        let (one, other) = ([1.0, 0.2, -0.5], [0.1, 1.0, 0.4]);
        let last = seen([100.0, 101.0], [one, other]);
        let mut crossed = seen([102.0, 103.0], [other.map(|value| -value), one]);
        follow(&last, &mut crossed, 2);
        assert_eq!(crossed.angular_frequency, [103.0, 102.0]);
        assert_eq!((&crossed.deflection, &crossed.slope), (&last.deflection, &last.slope));
        let single = |omega: [f64; 2]| SeenModes {
            deflection: vec![vec![1.0], vec![0.4]],
            slope: vec![],
            ..seen(omega, [one, other])
        };
        let mut kept = single([102.0, 103.0]);
        follow(&single([100.0, 101.0]), &mut kept, 2);
        assert_eq!(kept.angular_frequency, [102.0, 103.0]);
    }

    #[test]
    fn val_lines_are_those_of_the_laplace_domain() {
        let (modes, lines) = both();
        for step in 0..60 {
            let s = Complex64::new(0.0, TAU * (40.0 + 70.0 * f64::from(step)));
            let (line, exact) = (modes.at(s), lines.at(s));
            for (force, response) in [(0, 0), (0, 1), (1, 1)] {
                let term = |n: usize| {
                    s * s * line.deflection[n][force] * line.deflection[n][response] / (s * s + line.lambda[n])
                };
                let sum = (0..modes.near()).map(term).sum::<Complex64>() + modes.far(&line, [force, response])[0];
                let whole = exact[response][force];
                assert!((sum - whole).norm() < 1e-3 * (whole.norm() + 0.1), "{} Hz: {sum} {whole}", s.im / TAU);
            }
        }
    }

    /// With the damping ratio at which nothing but the core damps it, a mode's pole is one of the panel's, with its residue.
    #[test]
    fn val_poles_and_residues_are_those_of_the_laplace_domain() {
        let (modes, lines) = both();
        for n in 2..10 {
            let mut zeta = modes.mode(n, 0.0).core_damping();
            for _ in 0..8 {
                let mode = modes.mode(n, zeta);
                zeta -= 0.5 * mode.damping / mode.angular_frequency;
            }
            let mode = modes.mode(n, zeta);
            let omega = mode.angular_frequency;
            assert!(zeta > 1e-3 && mode.damping.abs() < 1e-9 * omega, "mode {n}: {zeta} {}", mode.damping);
            assert!(
                (zeta / modes.mode(n, 0.0).core_damping() - 1.0).abs() < 0.02,
                "mode {n}: {zeta} {}",
                modes.mode(n, 0.0).core_damping()
            );
            let pole = omega * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt());
            let residue = pole * pole * mode.deflection[0] * mode.deflection[1] / mode.by_s;
            // Between four points about it all but the pole cancels: where it stands, and what it is worth.
            let radius = 1e-4 * omega;
            let around: Vec<(Complex64, Complex64)> = (0..8)
                .map(|k| Complex64::from_polar(radius, TAU * f64::from(k) / 8.0))
                .map(|step| (step, lines.at(pole + step)[1][0]))
                .collect();
            let moment = |power: i32| around.iter().map(|(step, h)| step.powi(power + 1) * h / 8.0).sum::<Complex64>();
            let off = moment(1) / moment(0);
            assert!(off.norm() < 2e-6 * omega, "mode {n}: {off} of {omega}");
            assert!((moment(0) - residue).norm() < 1e-4 * residue.norm(), "mode {n}: {} {residue}", moment(0));
        }
    }
}

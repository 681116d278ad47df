//! What a test sees of a panel with effects of panel and rig: its modes at places, and what all further modes add.

use std::ops::Range;
use std::sync::Arc;

use faer::Mat;

use super::beam_base::BeamBase;
use super::coupled_panel::{Even, ModifiedStructure, PanelWithEffects, elements, row as at_row};
use super::coupled_system::{FoundMode, System};
use super::own_modes::OwnModes;
use super::row::Row;
use super::spread_effects::SpreadEffects;
use super::wide_plate::WidePlates;
use super::{Action, EffectSetting, EffectState, ElementLaw, PointElement, Seat};
use crate::dense::product;
use crate::timoshenko_beam::Section;
use crate::{
    BEAM_CONSTANTS, Boundary, Constant, Damping, End, ModelError, Motion, PLATE_CONSTANTS, Place, ShearLoss,
    StructureKind,
};

/// A beam with its exact modes, the spans that have lost shear stiffness, and what is joined to it.
type OnBase = (Arc<BeamBase>, Vec<ShearLoss>, Vec<PointElement>);

/// Exact modes of a beam beyond those asked for.
const SPARE: usize = 8;

/// A clamp's springs stiffer than so many times $E_xI/a^3$, and $E_xI/a$, would leave rounding of what else bends.
const STIFFEST: f64 = 1e7;

/// A structure that effects modify, seen from places; what is the same for all constants and effects is worked out once.
#[derive(Debug, Clone)]
pub struct ModifiedPanel {
    pub(super) count: usize,
    pub(super) even: Even,
    pub(super) damping: Damping,
    /// What the beam is where its width counts, with the frequency \[Hz\] up to which its modes are told.
    wide: Option<Arc<(WidePlates, f64)>>,
}

/// Modes of a [`ModifiedPanel`] at places, rigid ones first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SeenModes {
    /// $\omega_n$ \[rad/s\].
    pub angular_frequency: Vec<f64>,
    /// Damping ratios that the effects' dashpots give, those of the panel itself being zero.
    pub damping_ratio: Vec<f64>,
    /// Mass-normalised deflection $W_n$ \[kg^-1/2\], a list a mode with an entry a place.
    pub deflection: Vec<Vec<f64>>,
    /// $\partial W_n/\partial x$ \[kg^-1/2/m\], alike, where that was asked for.
    pub slope: Vec<Vec<f64>>,
    /// $\partial W_n/\partial y$ \[kg^-1/2/m\], alike, of a plate.
    pub slope_across: Vec<Vec<f64>>,
    /// What the effects' dashpots couple the modes of a plate by \[1/s\], a row a mode, beside what they bring each alone; none where there is no dashpot.
    pub couplings: Vec<Vec<f64>>,
    /// What these have of the modes of a plate without what stands on it, where anything stands there: with what its damping couples them.
    pub own: OwnModes,
    /// Whether anything stands on a foot, whose side moves them.
    pub on_feet: bool,
}

impl ModifiedPanel {
    /// Of the rigid modes and the first `count` flexible ones.
    ///
    /// # Errors
    /// As [`TimoshenkoBeam::new`](crate::TimoshenkoBeam::new).
    pub fn new(structure: StructureKind, setting: &EffectSetting, count: usize) -> Result<Self, ModelError> {
        let even = match structure {
            StructureKind::TimoshenkoBeam => Even::beam(setting, count)?,
            StructureKind::MindlinPlate => Even::plate(),
        };
        Ok(Self { count, even, damping: Damping::default(), wide: None })
    }

    /// A plate, or a beam that may turn out one: seen from about these places, with its modes up to a frequency \[Hz\].
    #[must_use]
    pub fn perhaps_wide(self, setting: &EffectSetting, places: &[Place], highest: f64) -> Self {
        let touched_anywhere = matches!(self.even, Even::Plate(_));
        let plates = WidePlates::new(setting.piece, setting.boundary, places.to_vec(), touched_anywhere);
        Self { wide: Some(Arc::new((plates, highest))), ..self }
    }

    /// Number of motions of the whole panel that nothing but a suspension holds.
    pub fn rigid_modes(&self, boundary: Boundary) -> usize {
        let edges = [boundary.left, boundary.right, boundary.front, boundary.back];
        let count = |end: End| edges.iter().filter(|edge| **edge == end).count();
        match (&self.even, count(End::Pinned), count(End::Clamped)) {
            (Even::Beam(_), ..) => boundary.rigid_modes(),
            (Even::Plate(_), 0, 0) => 3,
            (Even::Plate(_), 1, 0) => 1,
            (Even::Plate(_), ..) => 0,
        }
    }

    /// What vibrates with these effects.
    fn modified(&self, parts: PanelWithEffects) -> Result<ModifiedStructure, ModelError> {
        let PanelWithEffects { setting, values, effects, .. } = parts;
        let mut ratios = None;
        let mut others = Vec::new();
        for state in effects {
            match state.acting_in(setting)?.first() {
                Some(Action::Plate(found)) => ratios = Some(*found),
                _ => others.push(state.clone()),
            }
        }
        let (beam, ratios) = match (&self.even, values) {
            (Even::Plate(_), &[e_x, e_y, nu_xy, g_xy, g_yz, g_zx]) if !spread_over(setting, effects)? => {
                (vec![e_x, g_zx], Some([e_y / e_x, nu_xy, g_xy / e_x, g_yz / g_zx]))
            }
            _ => (values.to_vec(), ratios),
        };
        match (ratios, &self.wide) {
            (Some(ratios), Some(wide)) => {
                ModifiedStructure::wide(&wide.0, wide.1, (setting, &beam, ratios), effects, &others)
            }
            (None, Some(wide)) if matches!(self.even, Even::Plate(_)) => {
                // As many modes as without what is spread over the plate, on the same basis: it must not be told apart by them. Only where edges
                // yield there may be more, as many as were they free.
                let yields = SpreadEffects::of(effects, setting)?.terms.is_some_and(|terms| terms.support.is_some());
                let boundary = if yields { setting.boundary.released() } else { setting.boundary };
                ModifiedStructure::new(parts, WidePlates::held(setting.piece, boundary, values, wide.1)?)
            }
            _ => ModifiedStructure::for_modes(parts, self.count),
        }
    }

    /// The even beam that these effects modify, with what they do to it: a clamped end that yields is a free one on springs. None where that is no
    /// matter of a beam's exact modes.
    pub(super) fn base(
        &self,
        setting: &EffectSetting,
        values: &[f64],
        effects: &[EffectState],
    ) -> Result<Option<OnBase>, ModelError> {
        let (Even::Beam(beam), &[e_x, g_zx]) = (&self.even, values) else { return Ok(None) };
        let SpreadEffects { terms, core, plate, .. } = SpreadEffects::of(effects, setting)?;
        let terms = terms.unwrap_or_default();
        if core.is_some() || plate.is_some() {
            return Ok(None);
        }
        terms.check()?;
        let mut elements = elements(effects, setting)?;
        let mut boundary = setting.boundary;
        let half = 0.5 * setting.piece.length;
        for (end, x) in [(&mut boundary.left, -half), (&mut boundary.right, half)] {
            let (Some(support), End::Clamped) = (terms.support, *end) else { continue };
            *end = End::Free;
            let spring = |stiffness: f64, motion: Motion| PointElement {
                motion,
                ..PointElement::on_deflection(
                    ElementLaw::Spring { stiffness, damping: 0.0 },
                    Seat::At(Place { x, y: 0.0 }),
                )
            };
            let length = setting.piece.length;
            let stiffest = STIFFEST * e_x * Section::of(&setting.piece).second_moment / length;
            if support.rotation > stiffest || support.translation > stiffest / length.powi(2) {
                return Ok(None);
            }
            elements.push(spring(support.translation, Motion::Deflection));
            elements.push(spring(support.rotation, Motion::Rotation));
        }
        let base = beam.base((&setting.piece, boundary), [e_x, g_zx], terms.rotary_factor, self.count + SPARE)?;
        Ok(Some((base, terms.losses, elements)))
    }

    /// The same in the coordinates of a base's exact modes and static shapes.
    fn seen_on_base(
        &self,
        (base, losses): (&BeamBase, &[ShearLoss]),
        elements: &[PointElement],
        places: &[Place],
        with_slopes: bool,
    ) -> Result<SeenModes, ModelError> {
        let ports = places.iter().map(|&place| (Motion::Deflection, place));
        let slopes = places.iter().filter(|_| with_slopes).map(|&place| (Motion::Slope, place));
        let rows: Vec<Row> = elements.iter().filter_map(at_row).chain(ports).chain(slopes).collect();
        let shapes = base.in_shapes(&rows, (elements.len(), places.len()), losses);
        let system = System::in_shapes(&base.low, &shapes, elements, &self.damping);
        let found = system.solve()?;
        let seen = in_rows(&found, &faer::concat![[shapes.near], [shapes.far]]);
        let ports = elements.len() + places.len();
        Ok(SeenModes::of(found, &seen, [elements.len()..ports, ports..rows.len(), 0..0]))
    }

    /// Constants of which those of the core are multiplied.
    pub fn with_core_times(&self, values: &[f64], factor: f64) -> Vec<f64> {
        let constants: &[Constant] = match &self.even {
            Even::Beam(_) => &BEAM_CONSTANTS,
            Even::Plate(_) => &PLATE_CONSTANTS,
        };
        let is_of_core = |constant: &Constant| matches!(constant.name, "g_zx" | "g_yz");
        let value = |(constant, value): (&Constant, &f64)| if is_of_core(constant) { factor * value } else { *value };
        constants.iter().zip(values).map(value).collect()
    }

    /// The modes in a setting at these constants with these effects, as seen from places, and beyond them as many shapes as the places and the
    /// effects have of their own: with these the sum over all is the static flexibility between places.
    ///
    /// # Errors
    /// [`ModelError::EffectNeeds`] and [`ModelError::EffectParameter`] where an effect cannot act, [`ModelError::Unsupported`] for
    /// a core that depends on frequency (see [`RelaxingModes`](super::RelaxingModes)), and as [`crate::ritz_modes()`].
    pub fn seen_from(
        &self,
        setting: &EffectSetting,
        places: &[Place],
        with_slopes: bool,
        values: &[f64],
        effects: &[EffectState],
    ) -> Result<SeenModes, ModelError> {
        if let Some((base, losses, elements)) = self.base(setting, values, effects)? {
            return self.seen_on_base((&base, &losses), &elements, places, with_slopes);
        }
        self.seen_in_basis(self.parts(setting, values, effects), places, with_slopes)
    }

    /// The same of a plate, as it deflects at places where nothing acts: no shapes stand for what forces there do.
    ///
    /// # Errors
    /// As [`Self::seen_from`].
    pub fn watched_at(
        &self,
        setting: &EffectSetting,
        places: &[Place],
        values: &[f64],
        effects: &[EffectState],
    ) -> Result<SeenModes, ModelError> {
        let watched = places.iter().map(|&place| (Motion::Deflection, place)).collect();
        self.seen_in_rows(self.parts(setting, values, effects), &[], [watched, vec![], vec![]])
    }

    fn parts<'a>(
        &'a self,
        setting: &'a EffectSetting,
        values: &'a [f64],
        effects: &'a [EffectState],
    ) -> PanelWithEffects<'a> {
        PanelWithEffects { setting, even: &self.even, values, effects, damping: &self.damping }
    }

    /// The same on a basis for the structure with what is spread over it.
    fn seen_in_basis(
        &self,
        parts: PanelWithEffects,
        places: &[Place],
        with_slopes: bool,
    ) -> Result<SeenModes, ModelError> {
        let slopes =
            |motion: Motion| places.iter().filter(|_| with_slopes).map(|&place| (motion, place)).collect::<Vec<Row>>();
        let across = if matches!(self.even, Even::Plate(_)) { slopes(Motion::SlopeAcross) } else { vec![] };
        self.seen_in_rows(parts, places, [vec![], slopes(Motion::Slope), across])
    }

    /// The same with rows where nothing acts: deflections, slopes along and slopes across.
    fn seen_in_rows(
        &self,
        parts: PanelWithEffects,
        places: &[Place],
        [watched, along, across]: [Vec<Row>; 3],
    ) -> Result<SeenModes, ModelError> {
        let damping = parts.damping;
        let modified = self.modified(parts)?;
        if modified.core.is_some() {
            return Err(ModelError::Unsupported("a core that relaxes in a model of modes".into()));
        }
        let ports = modified.ports(places);
        let asked: Vec<Row> = [&watched[..], &along, &across].concat();
        // What stands on a foot swings with the panel far above what it is asked for.
        let twice = modified.elements.iter().take_while(|element| element.motion == Motion::Foot).count();
        let answers = modified.far_answers_in(&ports, &asked, twice)?;
        let (_, system) = modified.with_residuals(&answers, places, damping);
        // Elements stand before the ports among the answers, and no coordinates belong to slopes.
        let elements = answers.near.ncols() - ports.len() - asked.len();
        let slopes = elements + ports.len() + watched.len();
        let found = system.solve()?;
        let [far, _] = &answers.series;
        let rows = faer::concat![[answers.near], [far.transpose()], [answers.second.seen.transpose()]];
        let seen = in_rows(&found, &rows);
        let is_plate = matches!(self.even, Even::Plate(_));
        let own = if is_plate { modified.own_modes(&answers, damping, &found)? } else { OwnModes::default() };
        let is_damped = is_plate && found.iter().any(|(_, zeta, _)| *zeta > 0.0);
        let couplings = if is_damped { system.couplings(&found) } else { vec![] };
        let middle = slopes + along.len();
        let mut seen = SeenModes::of(found, &seen, [elements..slopes, slopes..middle, middle..middle + across.len()]);
        (seen.own, seen.couplings, seen.on_feet) = (own, couplings, twice > 0);
        Ok(seen)
    }
}

/// Whether effects change what is spread over the panel, or along its edges.
fn spread_over(setting: &EffectSetting, effects: &[EffectState]) -> Result<bool, ModelError> {
    let spread = SpreadEffects::of(effects, setting)?;
    let along_edges = || -> Result<bool, ModelError> {
        Ok(elements(effects, setting)?.iter().any(|element| matches!(element.seat, Seat::AlongEdge { .. })))
    };
    Ok(spread.terms.is_some() || spread.core.is_some() || spread.plate.is_some() || along_edges()?)
}

impl SeenModes {
    /// Of modes, seen in rows, a column a mode: of the rows those of deflections, of slopes along and of slopes across.
    fn of(found: Vec<FoundMode>, seen: &Mat<f64>, rows: [Range<usize>; 3]) -> Self {
        let mut all = Self::default();
        for (n, (omega, zeta, _)) in found.into_iter().enumerate() {
            all.angular_frequency.push(omega);
            all.damping_ratio.push(zeta);
            let [deflection, slope, across] = rows.clone().map(|rows| seen.col_as_slice(n)[rows].to_vec());
            all.deflection.push(deflection);
            all.slope.push(slope);
            all.slope_across.push(across);
        }
        all
    }
}

/// Modes in rows, a column a mode, of which `rows` has a column each with the values of the coordinates.
fn in_rows(found: &[FoundMode], rows: &Mat<f64>) -> Mat<f64> {
    let shares = Mat::from_fn(rows.nrows(), found.len(), |i, n| found[n].2[i]);
    product(rows.transpose(), shares.as_ref())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::{ModeRange, PanelModel, Piece, RecordSetting, effect};

    fn place(x: f64) -> Place {
        Place { x, y: 0.0 }
    }

    fn setting() -> EffectSetting {
        EffectSetting {
            piece: Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 },
            boundary: Boundary::default(),
            suspension: vec![],
            record: RecordSetting { number: 1, response_at: Some(place(0.31)), ..RecordSetting::default() },
        }
    }

    /// What identification sees is what the model file of the same panel says: the carrier of the FMU, and the same without ports.
    #[test]
    fn val_modes_are_those_of_the_model_file() {
        let setting = setting();
        let places = [-0.33, 0.05, 0.31].map(place);
        let text = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
            "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
            "constants": {"e_x": 1.07e10, "g_zx": 5.363e8},
            "effects": [{"id": "local-mass", "owner": "panel", "mass": 0.02, "x": 0.11},
                        {"id": "stiffness-loss", "owner": "panel", "loss": 0.4, "span": 0.06, "x": -0.2}]}"#;
        let model = PanelModel::from_json(text).expect("a model");
        let (_, effects) = model.with_effects().expect("effects");
        let panel = ModifiedPanel::new(StructureKind::TimoshenkoBeam, &setting, 10).expect("a beam");
        let seen = panel.seen_from(&setting, &places, false, &[1.07e10, 5.363e8], &effects).expect("modes");
        let modes = model.modal_model(ModeRange::Count(10), &places, &places).expect("modes");
        for (n, mode) in modes.flexible().take(8).enumerate() {
            let own = seen.angular_frequency[n + 2];
            assert!((own / mode.angular_frequency - 1.0).abs() < 2e-6, "mode {n}: {} Hz", own / TAU);
            for (port, deflection) in mode.at_forces.iter().enumerate() {
                let product = seen.deflection[n + 2][port] * seen.deflection[n + 2][0];
                let whole = deflection * mode.at_forces[0];
                assert!((product - whole).abs() < 1e-3 * whole.abs().max(2.0), "mode {n} at {port}: {product} {whole}");
            }
        }
    }

    /// A beam that turns out a plate has the modes of the plate's own model file, as far as they are seen from its centre line.
    #[test]
    fn val_a_wide_panel_is_the_plate_of_the_model_file() {
        let setting = EffectSetting {
            piece: Piece { length: 0.8, width: 0.25, thickness: 0.03, mass_per_area: 6.88 },
            ..setting()
        };
        let places = [-0.33, 0.05, 0.31].map(place);
        let text = r#"{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
            "piece": {"length": 0.8, "width": 0.25, "thickness": 0.03, "mass_per_area": 6.88},
            "constants": {"e_x": 1.07e10, "e_y": 8.56e9, "nu_xy": 0.3, "g_xy": 3.745e9, "g_yz": 3.2178e8, "g_zx": 5.363e8}}"#;
        let model = PanelModel::from_json(text).expect("a model");
        let wide =
            EffectState::new(effect("width-coupling").expect("known"), vec![0.8, 0.3, 0.35, 0.6], 1).expect("wide");
        let panel = ModifiedPanel::new(StructureKind::TimoshenkoBeam, &setting, 8).expect("a beam");
        let panel = panel.perhaps_wide(&setting, &places, 5000.0);
        let seen = panel.seen_from(&setting, &places, false, &[1.07e10, 5.363e8], &[wide]).expect("modes");
        let modes = model.modal_model(ModeRange::UpTo(4500.0), &places, &places).expect("modes");
        let mut own = seen.angular_frequency.iter().enumerate().skip(2);
        let mut met = 0;
        for mode in modes.flexible().filter(|mode| mode.at_forces.iter().any(|value| value.abs() > 1e-3)) {
            let (n, omega) = own.next().expect("as many modes");
            assert!(
                (omega / mode.angular_frequency - 1.0).abs() < 1e-5,
                "{} Hz: {}",
                mode.angular_frequency / TAU,
                omega / TAU
            );
            for (port, deflection) in mode.at_forces.iter().enumerate() {
                let (product, whole) =
                    (seen.deflection[n][port] * seen.deflection[n][0], deflection * mode.at_forces[0]);
                assert!(
                    (product - whole).abs() < 2e-3 * whole.abs().max(2.0),
                    "{} Hz at {port}: {product} {whole}",
                    mode.angular_frequency / TAU
                );
            }
            met += 1;
        }
        assert!(met >= 8, "{met} modes");
    }

    /// A plate with a mass and a patch anywhere, as identification sees it, is what the model file of the same plate says; its slopes both ways are those of
    /// differences.
    #[test]
    fn val_a_plate_with_effects_anywhere_is_that_of_the_model_file() {
        let piece = Piece { length: 0.8, width: 0.5, thickness: 0.03, mass_per_area: 6.88 };
        let setting = EffectSetting { piece, ..setting() };
        let places = [(-0.33, 0.11), (0.05, -0.2), (0.31, 0.07)].map(|(x, y)| Place { x, y });
        let values = [1.07e10, 8.56e9, 0.3, 3.745e9, 3.2178e8, 5.363e8];
        let mass = r#"{"id": "local-mass", "owner": "panel", "mass": 0.03, "x": 0.21, "y": -0.13}"#;
        let patch = r#"{"id": "stiffness-loss", "owner": "panel", "loss": 0.7, "span": 0.1, "x": -0.12, "y": 0.08}"#;
        for on in [String::new(), mass.to_owned(), patch.to_owned(), format!("{mass}, {patch}")] {
            let text = format!(
                r#"{{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
                "piece": {{"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88}},
                "constants": {{"e_x": 1.07e10, "e_y": 8.56e9, "nu_xy": 0.3, "g_xy": 3.745e9, "g_yz": 3.2178e8, "g_zx": 5.363e8}},
                "effects": [{on}]}}"#
            );
            let model = PanelModel::from_json(&text).expect("a model");
            let (_, effects) = model.with_effects().expect("effects");
            let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, 20).expect("a plate");
            let panel = panel.perhaps_wide(&setting, &places, 2500.0);
            let seen = panel.seen_from(&setting, &places, true, &values, &effects).expect("modes");
            let modes = model.modal_model(ModeRange::Count(20), &places, &places).expect("modes");
            let told = modes.flexible().take_while(|mode| mode.angular_frequency < TAU * 2000.0);
            for (n, mode) in told.enumerate() {
                let own = seen.angular_frequency[n + 3];
                let apart = own / mode.angular_frequency - 1.0;
                // Each basis cuts off the logarithm under a point elsewhere, and follows the edges of a patch as far as it can.
                let least = match (on.contains("local-mass"), on.contains("stiffness-loss")) {
                    (true, _) => 5e-3,
                    (_, true) => 1e-3,
                    _ => 1e-6,
                };
                assert!(apart.abs() < least, "{on} mode {n}: {} Hz, {apart:e}", own / TAU);
                let product = |port: usize| seen.deflection[n + 3][port] * seen.deflection[n + 3][0];
                for (port, deflection) in mode.at_forces.iter().enumerate() {
                    let whole = deflection * mode.at_forces[0];
                    let apart = product(port) - whole;
                    assert!(apart.abs() < 2e-2 * whole.abs().max(2.0), "{on} mode {n} at {port}: {apart:e} of {whole}");
                }
            }
            let step = 1e-4;
            let beside = places.map(|place| Place { y: place.y + step, ..place });
            let moved = panel.seen_from(&setting, &[places, beside].concat(), false, &values, &effects).expect("modes");
            for n in 3..15 {
                let sense = (seen.deflection[n][0] * moved.deflection[n][0]).signum();
                for port in 0..3 {
                    let slope = sense * (moved.deflection[n][3 + port] - moved.deflection[n][port]) / step;
                    let own = seen.slope_across[n][port];
                    assert!((slope - own).abs() < 0.1 * own.abs().max(2.0), "{on} mode {n} at {port}: {own} {slope}");
                }
            }
        }
    }

    /// A mass takes no stiffness: with the shares $V$ of the plate's own modes in those with it, $V^T\mathrm{diag}(\Omega^2)V$ has $\omega^2$ on its diagonal, and
    /// the plate's own modes are those with its patches, which alone do not couple.
    #[test]
    fn val_shares_are_those_of_the_plate_with_its_patches() {
        let setting = EffectSetting {
            piece: Piece { length: 0.8, width: 0.5, thickness: 0.03, mass_per_area: 6.88 },
            ..setting()
        };
        let state =
            |id: &str, values: &[f64]| EffectState::new(effect(id).expect("known"), values.to_vec(), 1).expect("valid");
        let patch = state("stiffness-loss", &[0.7, 0.2, -0.12, 0.08]);
        let mass = state("local-mass", &[0.005, 0.21, -0.13]);
        let places = [Place { x: 0.31, y: 0.07 }];
        let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, 20).expect("a plate");
        let panel = panel.perhaps_wide(&setting, &places, 2500.0);
        let seen = |effects: &[EffectState]| {
            let values = [1.07e10, 8.56e9, 0.3, 3.745e9, 3.2178e8, 5.363e8];
            panel.seen_from(&setting, &places, false, &values, effects).expect("modes")
        };
        let (bare, patched) = (seen(&[]), seen(std::slice::from_ref(&patch)));
        assert!(bare.own.shares.is_empty() && patched.own.shares.is_empty());
        for (own, effects) in [(&bare, vec![mass.clone()]), (&patched, vec![patch.clone(), mass])] {
            let loaded = seen(&effects);
            for n in 3..18 {
                let omega = |of: &SeenModes, n: usize| of.angular_frequency[n];
                let shares = loaded.own.shares[n].iter().zip(&loaded.own.angular_frequency);
                let terms = shares.map(|(share, omega)| (share * omega).powi(2));
                let own_frequency = loaded.own.angular_frequency[n];
                assert!((own_frequency / omega(own, n) - 1.0).abs() < 1e-3, "mode {n}: {own_frequency}");
                let apart = terms.sum::<f64>().sqrt() / omega(&loaded, n) - 1.0;
                // Taken of the other plate, all that the patch does would be missing.
                let by_patch = omega(&patched, n) / omega(&bare, n) - 1.0;
                let least = 1e-3 * by_patch.abs();
                assert!(apart.abs() < least, "{} effects, mode {n}: {apart:e} of {by_patch:e}", effects.len());
            }
        }
    }

    /// Rotary inertia of the usual size is none: the plate is on another basis with it, of which what a mass does at ports must not depend. The first
    /// port lies 12 mm from the mass along x, where the answer between them falls off across alone.
    #[test]
    fn val_an_effect_without_effect_leaves_a_plate_as_it_is() {
        let setting = EffectSetting {
            piece: Piece { length: 1.077, width: 0.626, thickness: 0.034, mass_per_area: 5.416 },
            ..setting()
        };
        let state =
            |id: &str, values: &[f64]| EffectState::new(effect(id).expect("known"), values.to_vec(), 1).expect("valid");
        let mass = state("local-mass", &[0.02605, -0.189, 0.228]);
        let rotary = state("rotary-inertia", &[1.0]);
        let places = [[-0.177, 0.064], [-0.031, 0.279], [0.112, 0.007], [-0.368, 0.245]];
        let places = places.map(|[x, y]| Place { x, y });
        let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, 31).expect("a plate");
        let panel = panel.perhaps_wide(&setting, &places, 3134.0);
        let seen = |effects: &[EffectState]| {
            let values = [5.626e9, 3.406e9, 0.344, 2.325e9, 1.694e8, 2.6126e8];
            panel.seen_from(&setting, &places, false, &values, effects).expect("modes")
        };
        let (plain, same) = (seen(std::slice::from_ref(&mass)), seen(&[mass.clone(), rotary]));
        let omega = &plain.angular_frequency;
        for n in 3..28 {
            let apart = same.angular_frequency[n] / omega[n] - 1.0;
            assert!(apart.abs() < 1e-5, "mode {n}: {apart:e}");
            // Shapes of modes that lie close turn with next to nothing.
            if omega[n] / omega[n - 1] < 1.002 || omega[n + 1] / omega[n] < 1.002 {
                continue;
            }
            let product = |of: &SeenModes, port: usize| of.deflection[n][port] * of.deflection[n][3];
            let most = (0..4).map(|port| product(&plain, port).abs()).fold(0.0, f64::max);
            for port in 0..3 {
                let apart = (product(&same, port) - product(&plain, port)) / most;
                assert!(apart.abs() < 1e-3, "mode {n} at {port}: {apart:e}");
            }
        }
    }

    #[test]
    fn val_slopes_are_those_of_differences() {
        let setting = setting();
        let mass = EffectState::new(effect("sensor-mass").expect("known"), vec![0.01, 0.0], 1).expect("a sensor");
        let panel = ModifiedPanel::new(StructureKind::TimoshenkoBeam, &setting, 8).expect("a beam");
        let seen = |x: f64, slopes: bool| {
            panel
                .seen_from(&setting, &[place(x)], slopes, &[1.07e10, 5.363e8], std::slice::from_ref(&mass))
                .expect("modes")
        };
        let (here, before, after) = (seen(0.12, true), seen(0.1199, false), seen(0.1201, false));
        for n in 2..9 {
            // Each solution has a sense of its own.
            let sense = |modes: &SeenModes| {
                modes.deflection[n][0] * here.deflection[n][0].signum() * modes.deflection[n][0].signum()
            };
            let difference = (sense(&after) - sense(&before)) / 2e-4;
            let slope = here.slope[n][0];
            assert!((slope - difference).abs() < 2e-3 * difference.abs().max(10.0), "mode {n}: {slope} {difference}");
        }
    }

    /// Exact modes and static shapes against a Ritz basis for 60 modes, with every pair of ends.
    #[test]
    fn val_exact_modes_and_static_shapes_meet_a_long_ritz_basis() {
        let state =
            |id: &str, values: &[f64]| EffectState::new(effect(id).expect("known"), values.to_vec(), 1).expect("valid");
        let cases = [
            state("local-mass", &[0.02, 0.11]),
            state("sensor-mass", &[0.02, 1e-6]),
            state("resonator", &[0.03, 800.0, 0.01, 0.11]),
            state("rotary-inertia", &[2.4]),
            state("stiffness-loss", &[0.4, 0.06, -0.2]),
            state("stiffness-loss", &[0.4, 0.3, -0.1]),
            state("stiffness-loss", &[0.4, 0.1, 0.07]),
            state("stiffness-loss", &[0.9, 0.06, -0.2]),
        ];
        let places = [-0.33, 0.05, 0.31].map(place);
        let [free, pinned, clamped] = [End::Free, End::Pinned, End::Clamped];
        let ends = [[free; 2], [clamped, free], [clamped, pinned], [pinned; 2], [clamped; 2], [pinned, free]];
        for (ends, thickness) in
            ends.into_iter().flat_map(|ends| [0.003, 0.03, 0.06].map(|thickness| (ends, thickness)))
        {
            let piece = Piece { thickness, ..setting().piece };
            let setting = EffectSetting {
                piece,
                boundary: Boundary { left: ends[0], right: ends[1], ..Boundary::default() },
                ..setting()
            };
            let panel =
                |count: usize| ModifiedPanel::new(StructureKind::TimoshenkoBeam, &setting, count).expect("a beam");
            let (panel, long) = (panel(14), panel(60));
            let yields = [[3e4, 1e8], [2e3, 3e6], [1e6, 1e10]].map(|values| state("support-compliance", &values));
            let held = ends.contains(&clamped);
            for effect in cases.iter().chain(yields.iter().filter(|_| held)) {
                let effects = std::slice::from_ref(effect);
                let values = [1.07e10, 5.363e8];
                let seen = panel.seen_from(&setting, &places, true, &values, effects).expect("modes");
                let ritz = long.seen_in_basis(long.parts(&setting, &values, effects), &places, true).expect("modes");
                let coarse = effect.values[0] == 0.9;
                for n in setting.boundary.rigid_modes()..10 {
                    let (own, other) = (seen.angular_frequency[n], ritz.angular_frequency[n]);
                    let least = if coarse { 3e-5 } else { 2e-6 };
                    assert!(
                        (own / other - 1.0).abs() < least,
                        "{ends:?} {thickness} {} {:?} {n}: {own} {other}",
                        effect.effect.id(),
                        effect.values
                    );
                    for (a, b) in [(0, 2), (1, 1)] {
                        let product = |modes: &SeenModes| modes.deflection[n][a] * modes.deflection[n][b];
                        let least = if coarse { 2e-2 } else { 2e-3 };
                        let (own, other) = (product(&seen), product(&ritz));
                        assert!(
                            (own - other).abs() < least * other.abs().max(0.1),
                            "{ends:?} {thickness} {} {:?} {n}: {own} {other}",
                            effect.effect.id(),
                            effect.values
                        );
                    }
                }
            }
        }
    }

    /// A patch hangs on no basis: what one for modes to 900 Hz lacks under it are the short waves that one to 5,000 Hz has.
    #[test]
    fn val_a_patch_is_the_same_on_a_finer_basis() {
        let piece = Piece { length: 0.8, width: 0.5, thickness: 0.03, mass_per_area: 6.88 };
        let setting = EffectSetting { piece, ..setting() };
        let places = [(-0.33, 0.11), (0.05, -0.2), (0.31, 0.07)].map(|(x, y)| Place { x, y });
        let values = [1.07e10, 8.56e9, 0.3, 3.745e9, 2.1e8, 3.3e8];
        let patch = |loss: f64, span: f64| {
            let patch = effect("stiffness-loss").expect("known");
            EffectState::new(patch, vec![loss, span, -0.12, 0.08], 1).expect("valid")
        };
        let seen = |highest: f64, effects: &[EffectState]| {
            let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, 14).expect("a plate");
            let panel = panel.perhaps_wide(&setting, &places, highest);
            panel.seen_from(&setting, &places, false, &values, effects).expect("modes")
        };
        let sound = seen(900.0, &[]);
        for (loss, span) in [(0.55, 0.09), (0.9, 0.05)] {
            let [few, fine] = [900.0, 5000.0].map(|highest| seen(highest, &[patch(loss, span)]));
            let change = |of: &SeenModes, n: usize| (of.angular_frequency[n] / sound.angular_frequency[n]).ln();
            let told = sound.angular_frequency.iter().take_while(|omega| **omega < TAU * 900.0).count();
            assert!(told > 8, "{told}");
            let greatest = (3..told).map(|n| change(&few, n).abs()).fold(0.0, f64::max);
            for n in 3..told {
                let apart = change(&few, n) - change(&fine, n);
                // Without the short waves it is 0.06 at least.
                assert!(apart.abs() < 0.05 * greatest, "mode {n}, {loss} over {span}: {apart:e} of {greatest:e}");
            }
        }
    }
}

//! A model of one identified piece: its damping beyond the band, its ports, and where it comes from.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_identify::{DampingLaw, Identification, ModeFit, PieceFit};
use orthopanel_model::{PanelModel, Piece, Place, Ports, StructureKind};

/// Modal damping ratio assumed where a test measures none: typical of the paper's table 9.
pub const ASSUMED_DAMPING: f64 = 0.003;

pub(super) fn model(
    test: &ImpactTest,
    found: &Identification,
    index: usize,
    fit: &PieceFit,
    damping_law: DampingLaw,
) -> PanelModel {
    let mut model = found.panel_model(fit, test.boundary, ports(test, index, &fit.piece, found.structure));
    let (beyond, origin) = match usual_damping(fit) {
        None => (ASSUMED_DAMPING, "assumed, not measured".to_owned()),
        Some(usual) => (usual, measured_damping(fit)),
    };
    model.damping.beyond = beyond;
    model.provenance.insert("damping".into(), origin.into());
    if damping_law == DampingLaw::Hysteretic && !model.damping.ratios.is_empty() {
        let text = "identified as hysteretic, loss factor 2 zeta; the model is viscous, which is the same at resonance";
        model.provenance.insert("damping_law".into(), text.into());
    }
    model.provenance.insert("piece".into(), fit.name.clone().into());
    // Two digits say how good an error is.
    let rounded = |value: f64| to_digits(value, 2);
    model.provenance.insert("frequency_rms_percent".into(), rounded(found.frequency_rms_percent).into());
    if let Some(error) = found.accelerance_rms_percent {
        model.provenance.insert("accelerance_rms_percent".into(), rounded(error).into());
    }
    model.provenance.insert("modes".into(), fit.modes.iter().map(measured_mode).collect());
    model.provenance.insert("program".into(), concat!("orthopanel ", env!("CARGO_PKG_VERSION")).into());
    model
}

/// A mode as measured and by the model, with as many digits as their errors have: what a model file and an FMU tell of it.
fn measured_mode(mode: &ModeFit) -> serde_json::Value {
    let rounded = |value: f64, digits: i32| (value * 10f64.powi(digits)).round() / 10f64.powi(digits);
    let mut told = serde_json::json!({
        "mode": mode.mode,
        "nodes": mode.nodes,
        "measured_hz": rounded(mode.measured, 4),
        "model_hz": rounded(mode.model, 4),
        "error_percent": rounded(mode.error_percent(), 4),
    });
    let ratio = mode.damping;
    let told_where_known = [
        ("measured_std_hz", mode.measured_std.map(|std| to_digits(std, 2))),
        ("zeta", ratio.map(|ratio| to_digits(ratio.value, 4))),
        ("zeta_std", ratio.and_then(|ratio| ratio.std).map(|std| to_digits(std, 2))),
    ];
    for (key, value) in told_where_known {
        if let Some(value) = value {
            told[key] = value.into();
        }
    }
    told
}

/// So many significant digits of a value.
pub fn to_digits(value: f64, digits: usize) -> f64 {
    format!("{value:.behind$e}", behind = digits - 1).parse().unwrap_or(value)
}

/// Which of a piece's ratios were measured.
fn measured_damping(fit: &PieceFit) -> String {
    let untold = (1..=fit.damping.len()).filter(|number| {
        let seen = fit.modes.iter().any(|mode| mode.mode == *number && mode.damping.is_some());
        !seen && !fit.hidden.iter().any(|mode| mode.mode == *number && mode.damping.is_some())
    });
    let untold: Vec<String> = untold.map(|mode| mode.to_string()).collect();
    let but = match untold.is_empty() {
        true => String::new(),
        false => format!(" but for mode {}, which the records do not tell: there a usual one", untold.join(", ")),
    };
    format!("measured inside the band{but}; beyond it assumed, the median of the measured")
}

/// Median of the damping ratios that the piece's records tell.
///
/// Ratios scatter by factors of five from mode to mode (the paper's table 9), and the median is not carried away by one
/// of them as the last one or the mean would be.
fn usual_damping(fit: &PieceFit) -> Option<f64> {
    let mut ratios: Vec<f64> = fit.measured_damping().map(|ratio| ratio.value).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).copied()
}

/// The places of the piece's records; without records the paper's, -3/8 and 3/8 of the length, and for a plate as far
/// off the centre line, where it does not twist.
fn ports(test: &ImpactTest, index: usize, piece: &Piece, structure: StructureKind) -> Ports {
    let mut ports = Ports::default();
    for measurement in test.measurements.iter().filter(|measurement| measurement.piece == index) {
        if let MeasurementData::TimeHistory(record) | MeasurementData::Accelerance(record) = &measurement.data {
            for (places, place) in [(&mut ports.forces, record.force_at), (&mut ports.responses, record.response_at)] {
                if !places.contains(&place) {
                    places.push(place);
                }
            }
        }
    }
    if ports.forces.is_empty() {
        // To the micrometre, so that it reads as a round number in the files.
        let part_of = |side: f64| (375e3 * side).round() / 1e6;
        let (x, y) = (part_of(piece.length), if structure.has_modes_across() { part_of(piece.width) } else { 0.0 });
        // Zero takes the sign off a negative one.
        ports.forces.push(Place { x: -x, y: 0.0 - y });
        ports.responses.push(Place { x, y });
    }
    ports
}

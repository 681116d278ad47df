//! The panels that the calls are made on: each that makes the FMU go other ways.

use std::ffi::CString;
use std::path::Path;

use orthopanel_fmu::{Connections, Mount, Quantity, RESOURCE_FILE, Residual, Resource, content_token};
use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

/// A panel on disk, and what an importer knows of it.
pub struct Fmu {
    pub token: CString,
    pub path: CString,
    pub uri: CString,
    pub variables: u32,
    /// References of all real variables.
    pub reals: Vec<u32>,
    /// What each variable, by its reference, starts from; zero where it has no start.
    pub starts: Vec<f64>,
    pub outputs: Vec<u32>,
    pub forces: Vec<u32>,
    pub parameters: Vec<u32>,
    /// One of the parameters that stay once initialization has ended.
    pub fixed: u32,
    /// Those of the parameters that may be set under way.
    pub tunable: Vec<u32>,
    /// References of all modal coordinates and velocities.
    pub modal: Vec<u32>,
    pub force_linear: u32,
    pub time: u32,
    pub states: usize,
}

const BEAM: &str = r#""structure": "timoshenko-beam", "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}"#;
const PLATE: &str = r#""structure": "mindlin-plate",
    "constants": {"e_x": 1.07e10, "e_y": 9e9, "nu_xy": 0.3, "g_xy": 3e9, "g_yz": 3e8, "g_zx": 5.363e8}"#;
/// With all connections.
const HELD: &str = r#""structure": "timoshenko-beam", "constants": {"e_x": 1.067e10, "g_zx": 5.304e8},
    "boundary": {"left": "clamped", "right": "free"}"#;
/// Modes that dampers couple, and a span that has lost stiffness.
const WITH_EFFECTS: &str = r#"
    {"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 400, "zeta": 0.05, "x": 0.1},
    {"id": "stiffness-loss", "owner": "panel", "loss": 0.2, "span": 0.1, "x": -0.1}"#;
const CORE: &str = r#"{"id": "viscoelastic-core", "owner": "panel", "strength": 0.2, "tau": 1e-4, "alpha": 0.6}"#;

/// Writes each into a folder of its own. Half of all are the plain beam, whose parameters cost the least to set.
pub fn prepare(folder: &Path) -> Result<Vec<Fmu>, Box<dyn std::error::Error>> {
    let panels =
        [(BEAM, "", 5), (BEAM, "", 3), (HELD, "", 2), (BEAM, WITH_EFFECTS, 3), (BEAM, CORE, 2), (PLATE, "", 3)];
    let write = |(number, (panel, effects, modes)): (usize, (&str, &str, usize))| {
        let folder = folder.join(number.to_string());
        std::fs::create_dir(&folder)?;
        written(&folder, panel, effects, modes)
    };
    panels.into_iter().enumerate().map(write).collect()
}

fn written(folder: &Path, panel: &str, effects: &str, modes: usize) -> Result<Fmu, Box<dyn std::error::Error>> {
    let text = format!(
        r#"{{"schema": "orthopanel.model/1", {panel}, "damping": {{"beyond": 0.003}}, "effects": [{effects}],
            "piece": {{"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88}}}}"#
    );
    let place = |x| Place { x, y: 0.0 };
    let ports = Ports { forces: vec![place(-0.3), place(0.1)], responses: vec![place(0.3)] };
    let held = panel == HELD;
    let mount = Mount { name: "tip".into(), at: place(0.35), stiffness: 1e5, damping: 10.0 };
    let connections = Connections {
        mounts: held.then_some(mount).into_iter().collect(),
        rotations: held,
        gravity: held,
        pressure: held,
        base_acceleration: held,
    };
    let (model, range) = (PanelModel::from_json(&text)?, ModeRange::Count(modes));
    let (resource, _) = Resource::of_panel(&model, range, ports, Residual::Attachment, connections)?;
    let text = resource.to_json();
    std::fs::write(folder.join(RESOURCE_FILE), &text)?;
    let path = folder.to_str().ok_or("the temporary folder's name is not UTF-8")?;
    let table = resource.variables();
    let all = table.variables();
    let of = |causality: &str| {
        all.iter().filter(|v| v.quantity.causality() == causality).map(|v| v.reference).collect::<Vec<u32>>()
    };
    Ok(Fmu {
        token: CString::new(content_token(text.as_bytes()))?,
        path: CString::new(path)?,
        uri: CString::new(format!("file://{path}"))?,
        variables: u32::try_from(all.len())?,
        reals: all.iter().filter(|v| v.quantity != Quantity::ForceLinear).map(|v| v.reference).collect(),
        starts: all.iter().map(|v| v.start.as_ref().and_then(|text| text.parse().ok()).unwrap_or(0.0)).collect(),
        outputs: of("output"),
        forces: of("input"),
        parameters: of("parameter"),
        fixed: all.iter().find(|v| v.name == "length").ok_or("no length")?.reference,
        tunable: all.iter().filter(|v| v.tunable).map(|v| v.reference).collect(),
        modal: all.iter().filter(|v| v.nominal.is_some()).map(|v| v.reference).collect(),
        time: all.iter().find(|v| v.quantity == Quantity::Time).ok_or("no time")?.reference,
        force_linear: all.iter().find(|v| v.quantity == Quantity::ForceLinear).ok_or("no force_linear")?.reference,
        states: 2 * resource.model().modes().len(),
    })
}

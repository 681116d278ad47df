//! Resources that were tampered with, their token made anew: each is refused with its numbers before anything is made by them.

use orthopanel_fmu::{Connections, RESOURCE_FILE, Residual, Resource, content_token};
use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

fn resource() -> String {
    let place = |x| Place { x, y: 0.02 };
    let ports = Ports { forces: vec![place(-0.3)], responses: vec![place(0.1), place(0.2)] };
    let text = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
        "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
        "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}, "damping": {"beyond": 0.003}}"#;
    let panel = PanelModel::from_json(text).expect("a sound model");
    let (resource, _) =
        Resource::of_panel(&panel, ModeRange::Count(5), ports, Residual::Attachment, Connections::default())
            .expect("a sound panel");
    resource.to_json()
}

/// Reads the resource with `from` replaced by `to`.
fn read(from: &str, to: &str) -> Result<Resource, String> {
    let text = resource();
    assert!(from.is_empty() || text.contains(from), "{from} in {text}");
    let text = if from.is_empty() { text } else { text.replacen(from, to, 1) };
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join(RESOURCE_FILE), &text).expect("written");
    Resource::read(folder.path(), &content_token(text.as_bytes())).map_err(|error| error.to_string())
}

#[test]
fn a_resource_as_written_is_read() {
    assert!(read("", "").is_ok());
}

#[test]
fn regress_a_panel_that_does_not_fit_its_modes_is_refused() {
    let asked = "\"flexible_modes\":5";
    let damping = "\"damping\":{\"ratios\":[";
    let ports = "\"ports\":{\"forces\":[[-0.3,0.02]]";
    for (from, to, said) in [
        (asked, "\"flexible_modes\":1000000000000", "panel.flexible_modes = 1000000000000: the model has 5"),
        (asked, "\"flexible_modes\":4", "panel.flexible_modes = 4: the model has 5"),
        (damping, "\"damping\":{\"ratios\":[0.1,", "6 ratios for 5 flexible modes"),
        ("\"count\":2", "\"count\":3", "panel.flexible_modes = 5: the model has 4 flexible modes"),
        ("\"places\":[[-0.3,0.02]]", "\"places\":[]", "panel.residual: 2 modes of 0 places for 1 forces"),
        ("\"places\":[[-0.3,0.02]]", "\"places\":[[-0.5,0.02]]", "place (-0.5, 0.02) m lies off the piece"),
        (ports, "\"ports\":{\"forces\":[[-0.2,0.02]]", "1 forces and 2 responses, not the same places"),
        ("\"length\":0.8", "\"length\":-0.8", "length = -0.8 m"),
        ("\"e_x\":10670000000.0", "\"e_x\":-1.0", "e_x = -1e0 Pa"),
        ("\"angular_frequency\":0.0", "\"angular_frequency\":-1.0", "mode 1: angular frequency -1 rad/s"),
    ] {
        let refused = read(from, to).expect_err(to);
        assert!(refused.contains(said), "{to}: {refused}");
    }
}

#[test]
fn a_panel_has_no_more_than_ten_thousand_modes() {
    let mode = "{\"angular_frequency\":1e5,\"damping_ratio\":0.0,\"at_forces\":[0.0],\"at_responses\":[0.0,0.0]},";
    let text = resource();
    let with = |more: usize| {
        let (before, panel) = text.split_once("\"panel\":").expect("a panel");
        assert!(panel.ends_with(",\"arrays\":false}\n"), "{panel}");
        let first = format!("\"modes\":[{}", mode.repeat(more));
        let bare = before.replacen("\"modes\":[", &first, 1) + "\"panel\":null,\"arrays\":false}\n";
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join(RESOURCE_FILE), &bare).expect("written");
        Resource::read(folder.path(), &content_token(bare.as_bytes())).map_err(|error| error.to_string())
    };
    // Beside nine of the beam's own.
    assert_eq!(with(9991).expect("as many as may be").model().modes().len(), 10_000);
    let refused = with(9992).expect_err("one too many");
    assert!(refused.contains("10001 modes: a panel has 10000 at most"), "{refused}");
}

//! What each reader is fed: bytes, whatever they are. Nothing may panic, hang, or take more memory than a file of that size is worth.
//! Each function tells whether the file was accepted.
//!
//! The coverage-guided targets beside this file and the sampling mutator of `.ci/run` share it.

#[allow(dead_code, reason = "the command's own file")]
#[path = "../../crates/orthopanel/src/fmu_refusal.rs"]
pub mod fmu_refusal;
mod fmus;
#[allow(dead_code, reason = "the command's own file")]
#[path = "../../crates/orthopanel/src/force_file.rs"]
mod force_file;

pub use fmus::{fmu_archive, fmu_description};
use orthopanel_data::{Accelerance, Estimation, ImpactTest, RecordFile, RecordedResponse, TimeHistory, Window};
use orthopanel_model::{PanelModel, Place};

/// A file of records, universal or CSV, up to the accelerance that is made of it.
pub fn records(bytes: &[u8]) -> bool {
    let Ok(file) = RecordFile::from_bytes(bytes, "fuzz") else { return false };
    let place = Place { x: 0.0, y: 0.0 };
    let measurement = RecordedResponse::new("fuzz", [place; 2]);
    let _ = Accelerance::from_records(file.clone(), &measurement);
    if let Ok(history) = TimeHistory::from_records(file, &measurement) {
        for window in [Window::None, Window::Hann, Window::ForceExponential { half_width: 0.01, tau: 0.1 }] {
            let _ = history.accelerance(Estimation { window, ..Estimation::default() });
        }
    }
    true
}

/// `test.toml`: text and meaning. The records that examples name are found from the repository's root.
pub fn test_toml(bytes: &[u8]) -> bool {
    str::from_utf8(bytes).is_ok_and(|text| ImpactTest::from_toml(text, "examples/made-hits/test.toml").is_ok())
}

/// A model file: what is read is written, and read back the same.
pub fn model_json(bytes: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(bytes) else { return false };
    let Ok(model) = PanelModel::from_json(text) else { return false };
    assert_eq!(PanelModel::from_json(&model.to_json()), Ok(model));
    true
}

/// The force file of `simulate`, for one place and for two.
pub fn force_csv(bytes: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(bytes) else { return false };
    (1..=2).any(|places| force_file::ForceHistory::from_csv(text, places).is_ok())
}

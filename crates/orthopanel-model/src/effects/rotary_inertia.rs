//! `rotary-inertia`.

use super::{Action, Effect, EffectParameter, EffectSetting, FieldTerm, Owner};
use crate::{ModelError, Piece};

/// Factor \[1\] on the rotary inertia $\rho t\,b\,t^2/12$ of evenly spread mass. Faces carry most of a sandwich's mass:
/// 2.4 for faces of 1 mm and a light core; at most 3, all mass in the skins.
///
/// Source: $\int\rho z^2dz$ over the section, in place of eq. 5's $\rho I$.
#[derive(Debug, Clone, Copy)]
pub(super) struct RotaryInertia;

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::linear("factor", "1", [0.05, 4.0], &[1.5, 2.4, 1.0]).sized(2.0, 1.5).factor()];

impl Effect for RotaryInertia {
    fn id(&self) -> &'static str {
        "rotary-inertia"
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    /// With the thickness $t'=t\sqrt r$ bending has $E t'^3$ and shear $G t'$: the constants that were found are $r^{3/2}$ and $r^{1/2}$ times those.
    fn looks_like(&self, values: &[f64], piece: &Piece) -> Option<String> {
        let &[factor] = values else { return None };
        Some(format!(
            "a thickness of {:.3e} m in place of {} m would show the same as {:.3} times the rotary inertia: the moduli in the plane would then be {:.3} \
             times those found, and those of shear through the thickness {:.3} times",
            piece.thickness * factor.sqrt(),
            piece.thickness,
            factor,
            factor.powf(-1.5),
            factor.powf(-0.5)
        ))
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[factor] = values else { return Ok(vec![]) };
        Ok(vec![Action::Field(FieldTerm::RotaryFactor(factor))])
    }
}

#[cfg(test)]
mod tests {
    use crate::{Boundary, EffectSetting, EffectState, ModifiedPanel, Piece, RecordSetting, StructureKind, effect};

    fn frequencies(piece: Piece, values: &[f64], factor: Option<f64>) -> Vec<f64> {
        let (boundary, record) = (Boundary::default(), RecordSetting::default());
        let setting = EffectSetting { piece, boundary, suspension: vec![], record };
        let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, 14).expect("a plate");
        let panel = panel.perhaps_wide(&setting, &[], 2500.0);
        let rotary = effect("rotary-inertia").expect("known");
        let state = factor.map(|factor| EffectState::new(rotary, vec![factor], 1).expect("valid"));
        panel.seen_from(&setting, &[], false, values, state.as_slice()).expect("modes").angular_frequency
    }

    /// The plate that the words describe has the frequencies of the one with the factor. At these factors no printed number is rounded.
    #[test]
    fn val_what_looks_the_same_has_the_same_modes() {
        let piece = Piece { length: 0.8, width: 0.5, thickness: 0.03, mass_per_area: 6.88 };
        let values = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];
        let plain = frequencies(piece, &values, None);
        for factor in [4.0, 0.25] {
            let said = effect("rotary-inertia").expect("known").looks_like(&[factor], &piece).expect("words");
            let numbers: Vec<f64> = said.split([' ', ':']).filter_map(|word| word.parse().ok()).collect();
            let &[thickness, stated, told, in_plane, through] = &numbers[..] else { panic!("{said}") };
            assert_eq!((stated, told), (piece.thickness, factor), "{said}");
            let [e_x, e_y, nu_xy, g_xy, g_yz, g_zx] = values;
            let other = [in_plane * e_x, in_plane * e_y, nu_xy, in_plane * g_xy, through * g_yz, through * g_zx];
            let own = frequencies(piece, &values, Some(factor));
            let same = frequencies(Piece { thickness, ..piece }, &other, None);
            for n in 3..14 {
                assert!((own[n] / same[n] - 1.0).abs() < 1e-5, "mode {n}: {} {}, {said}", own[n], same[n]);
            }
            assert!((own[13] / plain[13] - 1.0).abs() > 1e-3, "{} {}", own[13], plain[13]);
        }
    }
}

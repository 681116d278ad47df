//! Where the effects sit that a trace found.

use orthopanel_identify::{TracedEffect, TracedParameter};
use orthopanel_model::{Estimate, Place, effect};

use super::Traced;
use crate::pictures::FoundPlace;
use crate::tables::HALF_95;

/// Half axes of a region of 95 % in two directions, in deviations: $\sqrt{-2\ln0.05}$.
const REGION: f64 = 2.448;

impl Traced {
    /// A sentence an effect that sits somewhere: "Shear stiffness lost over about 0.10 m around x = 0.21, y = -0.08 m (95 %: ...)."
    pub(crate) fn places(&self) -> impl Iterator<Item = String> {
        self.tracing.effects.iter().filter_map(sentence)
    }
}

/// Where effects sit on a plate.
pub fn found_places(effects: &[TracedEffect]) -> Vec<FoundPlace> {
    let place = |effect: &TracedEffect| {
        let [x, y] = [of(effect, "x")?, of(effect, "y").filter(|y| y.value.is_finite())?];
        let region = x.std.zip(y.std).map(|(along, across)| [along, across].map(|std| REGION * std));
        let span = of(effect, "span").map(|span| span.value);
        Some(FoundPlace { name: effect.id.to_owned(), at: Place { x: x.value, y: y.value }, region, span })
    };
    effects.iter().filter_map(place).collect()
}

fn sentence(found: &TracedEffect) -> Option<String> {
    let x = of(found, "x")?;
    let places = [Some(("x", x)), of(found, "y").filter(|y| y.value.is_finite()).map(|y| ("y", y))];
    let places: Vec<(&str, Estimate)> = places.into_iter().flatten().collect();
    let at: Vec<String> = places.iter().map(|(name, of)| format!("{name} = {}", metres(of.value, of.std))).collect();
    let within = |(name, of): &(&str, Estimate)| {
        let std = of.std?;
        let [low, high] = [-HALF_95, HALF_95].map(|widths| metres(of.value + widths * std, of.std));
        Some(format!("{name} from {low} to {high}"))
    };
    let within: Vec<String> = places.iter().filter_map(within).collect();
    let within = if within.is_empty() { String::new() } else { format!(" (95 %: {} m)", within.join(", ")) };
    let over =
        of(found, "span").map_or(String::new(), |span| format!(" over about {} m", metres(span.value, span.std)));
    let what = effect(found.id).map_or(found.id, |known| known.in_words());
    let mut told = format!("{what}{over} around {} m{within}.", at.join(", "));
    if let Some(first) = told.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    Some(told)
}

fn of(effect: &TracedEffect, name: &str) -> Option<Estimate> {
    let is_it = |parameter: &&TracedParameter| parameter.name == name && parameter.unit == "m";
    effect.parameters.iter().find(is_it)?.values.first().copied()
}

/// To a millimetre, or to ten or a tenth of them as far as it is known.
fn metres(value: f64, std: Option<f64>) -> String {
    let digits = match std {
        Some(std) if std > 5e-3 => 2,
        Some(std) if std < 5e-4 => 4,
        _ => 3,
    };
    let told = format!("{value:.digits$}");
    if told.trim_start_matches(['-', '0', '.']).is_empty() { told.trim_start_matches('-').to_owned() } else { told }
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Owner;

    use super::*;

    fn found(id: &'static str, parameters: &[(&'static str, &'static str, f64, f64)]) -> TracedEffect {
        let parameter = |&(name, unit, value, std): &(&'static str, &'static str, f64, f64)| TracedParameter {
            name,
            unit,
            values: vec![Estimate { value, std: Some(std) }],
        };
        TracedEffect { id, owner: Owner::Panel, parameters: parameters.iter().map(parameter).collect() }
    }

    #[test]
    fn a_patch_and_a_mass_are_told_with_their_places() {
        let patch =
            [("loss", "1", 0.4, 0.1), ("span", "m", 0.1, 0.01), ("x", "m", 0.21, 0.01), ("y", "m", -0.08, 0.02)];
        let patch = found("stiffness-loss", &patch);
        let told = "Shear stiffness lost over about 0.10 m around x = 0.21, y = -0.08 m (95 %: x from 0.19 to 0.23, y from -0.12 to -0.04 m).";
        assert_eq!(sentence(&patch).as_deref(), Some(told));
        let mass =
            found("local-mass", &[("mass", "kg", 0.02, 1e-4), ("x", "m", -1e-4, 1e-3), ("y", "m", f64::NAN, 1.0)]);
        assert_eq!(sentence(&mass).as_deref(), Some("A mass around x = 0.000 m (95 %: x from -0.002 to 0.002 m)."));
        assert_eq!(sentence(&found("gain", &[("gain", "1", 1.1, 0.1)])), None);
        let places = found_places(&[patch, mass]);
        assert_eq!((places.len(), places[0].span, places[0].at), (1, Some(0.1), Place { x: 0.21, y: -0.08 }));
    }
}

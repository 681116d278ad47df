//! A model file as text: reading it, writing it, and telling a person what is wrong with it.

use std::fmt;

use serde::{
    Deserialize, Deserializer,
    de::{Error, MapAccess, Visitor, value::MapAccessDeserializer},
};

use crate::{Estimate, MODEL_SCHEMA, ModelError, PanelModel};

impl PanelModel {
    /// Reads a model file's text, with or without a byte order mark.
    ///
    /// # Errors
    /// [`ModelError::ModelText`] where the text is not such a file (with line, key and what is wanted),
    /// [`ModelError::MissingSchema`] and [`ModelError::Schema`] for no or another schema, what [`PanelModel::check`] finds, and
    /// [`ModelError::Deviation`].
    pub fn from_json(text: &str) -> Result<Self, ModelError> {
        #[derive(Deserialize)]
        struct SchemaOnly {
            schema: Option<String>,
        }
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        // The schema is judged first: a file of another schema has other keys, and naming those would mislead.
        match read::<SchemaOnly>(text)?.schema {
            None => return Err(ModelError::MissingSchema { expected: MODEL_SCHEMA }),
            Some(found) if found != MODEL_SCHEMA => return Err(ModelError::Schema { found, expected: MODEL_SCHEMA }),
            Some(_) => {}
        }
        let model: Self = read(text)?;
        model.check()?;
        model.check_deviations()?;
        #[cfg(not(feature = "compact"))]
        model.check_covariance()?;
        Ok(model)
    }

    /// The text of the model file, indented, with a final newline.
    pub fn to_json(&self) -> String {
        // Every field is a plain number, text or list: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

fn read<'de, T: Deserialize<'de>>(text: &'de str) -> Result<T, ModelError> {
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let key = error.path().to_string();
        malformed(if key == "." { "" } else { &key }, &error.into_inner())
    })?;
    deserializer.end().map_err(|error| malformed("", &error))?;
    Ok(value)
}

/// Says the fault at `key` in the words of the file, not of the language that reads it.
fn malformed(key: &str, error: &serde_json::Error) -> ModelError {
    let text = error.to_string();
    let text = text.split(" at line ").next().unwrap_or_default();
    let mut names = text.split('`').skip(1).step_by(2);
    let at = |key: &str| if key.is_empty() { String::new() } else { format!("{key}: ") };
    let problem = if let Some(field) = text.strip_prefix("missing field ") {
        let dot = if key.is_empty() { "" } else { "." };
        format!("{key}{dot}{} is missing", field.trim_matches('`'))
    } else if text.starts_with("unknown ") {
        let name = names.next().unwrap_or_default();
        let path = key.strip_suffix(name).unwrap_or(key).trim_end_matches('.');
        format!("{}{name:?} is unknown: known are {}", at(path), names.collect::<Vec<_>>().join(", "))
    } else if let Some((found, wanted)) = text.split_once(", expected ")
        && let Some((_, found)) = found.split_once(": ").or(found.split_once("invalid "))
    {
        format!("{}must be {}, not {}", at(key), wanted_words(wanted), found_words(found))
    } else if text == "trailing characters" && !key.is_empty() {
        // The only lists of a fixed length are places.
        format!("{}must be {}, not more numbers", at(key), wanted_words("an array of length 2"))
    } else {
        format!("{}{text}", at(key))
    };
    ModelError::ModelText { line: error.line(), problem }
}

/// What a reader wants, in the words of the file.
fn wanted_words(wanted: &str) -> &str {
    match wanted {
        "f64" => "a number",
        "a string" | "string" => "a text in quotes",
        "a sequence" => "a list [..]",
        "an array of length 2" => "a place [x, y] in m",
        _ if wanted.starts_with("struct ") || wanted == "a map" => "an object {..}",
        _ => wanted,
    }
}

/// What a reader found, in the words of the file.
fn found_words(found: &str) -> String {
    let (kind, value) = found.split_once(' ').unwrap_or((found, ""));
    match kind {
        "string" => format!("the text {value}"),
        "sequence" => "a list".into(),
        "map" => "an object".into(),
        "integer" | "floating" | "boolean" => value.trim_start_matches("point ").trim_matches('`').into(),
        _ => found.into(),
    }
}

// Told apart by the shape of the value, through a visitor: serde's `untagged` would buffer the value, lose its line, and
// answer a wrong key with "data did not match any variant".
impl<'de> Deserialize<'de> for Estimate {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EstimateVisitor;
        impl<'de> Visitor<'de> for EstimateVisitor {
            type Value = Estimate;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or {\"value\": .., \"std\": ..}")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Estimate, E> {
                Ok(Estimate { value, std: None })
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Estimate, E> {
                self.visit_f64(value as f64)
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<Estimate, E> {
                self.visit_f64(value as f64)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Estimate, A::Error> {
                #[derive(Deserialize)]
                #[serde(deny_unknown_fields)]
                struct Full {
                    value: f64,
                    std: Option<f64>,
                }
                let Full { value, std } = Full::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Estimate { value, std })
            }
        }
        deserializer.deserialize_any(EstimateVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "{\"schema\": \"orthopanel.model/1\",\n\
        \"piece\": {\"length\": 0.8, \"width\": 0.1, \"thickness\": 0.03, \"mass_per_area\": 6.88},\n\
        \"structure\": \"timoshenko-beam\", \"boundary\": {\"left\": \"free\"},\n\
        \"constants\": {\"e_x\": {\"value\": 1.07e10, \"std\": 4e7},\n\"g_zx\": 5.363e8},\n\
        \"damping\": {\"ratios\": [0.002, 0.003]},\n\"ports\": {\"forces\": [[-0.3, 0]]}}";

    #[test]
    fn faults_name_line_key_and_what_is_wanted() {
        let faults = [
            (
                "\"ratios\": [0.002, 0.003]",
                "\"ratios\": [0.002, \"x\"]",
                "line 6: damping.ratios[1]: must be a number, not the text \"x\"",
            ),
            ("0.8", "\"long\"", "line 2: piece.length: must be a number, not the text \"long\""),
            ("0.8", "null", "line 2: piece.length: must be a number, not null"),
            ("0.8", "1e999", "line 2: piece.length: number out of range"),
            ("\"length\": 0.8, ", "", "line 2: piece.length is missing"),
            (
                "length",
                "lenght",
                "line 2: piece: \"lenght\" is unknown: known are length, width, thickness, mass_per_area",
            ),
            ("5.363e8", "true", "line 5: constants.g_zx: must be a number or {\"value\": .., \"std\": ..}, not true"),
            ("\"std\"", "\"sd\"", "line 4: constants.e_x: \"sd\" is unknown: known are value, std"),
            ("4e7", "[]", "line 4: constants.e_x.std: must be a number, not a list"),
            (
                "timoshenko-beam",
                "beam",
                "line 3: structure: \"beam\" is unknown: known are timoshenko-beam, mindlin-plate",
            ),
            ("[-0.3, 0]", "-0.3", "line 7: ports.forces[0]: must be a place [x, y] in m, not -0.3"),
            ("[-0.3, 0]", "[-0.3]", "line 7: ports.forces[0]: must be a place [x, y] in m, not length 1"),
            ("[-0.3, 0]", "[-0.3, 0, 1]", "line 7: ports.forces[0]: must be a place [x, y] in m, not more numbers"),
            ("{\"ratios\"", "{\"ratio\"", "line 6: damping: \"ratio\" is unknown: known are ratios, std, beyond"),
            ("\"free\"", "\"loose\"", "line 3: boundary.left: \"loose\" is unknown: known are free, pinned, clamped"),
            ("g_zx", "g_xz", "constants.g_xz is unknown: the structure has e_x, g_zx"),
            ("\"orthopanel.model/1\"", "1", "line 1: schema: must be a text in quotes, not 1"),
            (
                "\"schema\": \"orthopanel.model/1\",",
                "",
                "schema is missing: a model file begins with {\"schema\": \"orthopanel.model/1\", ...",
            ),
        ];
        for (from, to, said) in faults {
            assert!(MODEL.contains(from), "{from}");
            let error = PanelModel::from_json(&MODEL.replacen(from, to, 1)).expect_err(to);
            assert_eq!(error.to_string(), said);
        }
    }

    #[test]
    fn what_was_written_reads_back() {
        let model = PanelModel::from_json(MODEL).expect("a model");
        assert_eq!(PanelModel::from_json(&model.to_json()), Ok(model));
    }

    #[test]
    fn numbers_are_read_to_their_last_place() {
        // A quick conversion misses each of these by one unit of it.
        for length in [
            51.248_178_375_505_4,
            93.311_370_376_880_33,
            36.573_994_842_753_44,
            52.314_008_204_106_24,
            97.453_653_200_346_85,
        ] {
            let model = PanelModel::from_json(&MODEL.replacen("0.8", &length.to_string(), 1)).expect("a model");
            assert_eq!(model.piece.length, length);
        }
    }
}

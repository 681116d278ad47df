//! A value of the wrong type: which key it is, and what is wanted there, instead of the TOML reader's own words.

use std::collections::BTreeMap;

/// What each key wants.
const WANTED: [(&str, &str); 49] = [
    ("length", "a number in m"),
    ("width", "a number in m"),
    ("thickness", "a number in m"),
    ("mass_per_area", "a number in kg/m2"),
    ("weighings", "a list of [length, width, mass] in m, m, kg"),
    ("length_std", "a number in m, the standard deviation of length"),
    ("width_std", "a number in m, the standard deviation of width"),
    ("thickness_std", "a number in m, the standard deviation of thickness"),
    ("mass_per_area_std", "a number in kg/m2, the standard deviation of mass_per_area"),
    ("own_constants", "a list of names, such as [\"g_zx\"]"),
    ("name", "text in quotes"),
    ("piece", "a table [piece], or in a measurement a piece's name in quotes"),
    ("at", "a list of x in m, such as [-0.22, 0.22], or of [x, y]"),
    ("left", "\"free\", \"pinned\" or \"clamped\""),
    ("right", "\"free\", \"pinned\" or \"clamped\""),
    ("front", "\"free\", \"pinned\" or \"clamped\""),
    ("back", "\"free\", \"pinned\" or \"clamped\""),
    ("boundary", "a table [boundary]"),
    ("suspension", "a table [suspension]"),
    ("constants", "a table [constants]"),
    ("effect", "tables [[effect]]"),
    ("measurement", "tables [[measurement]]"),
    ("structure", "a structure's name in quotes, such as \"mindlin-plate\""),
    ("kind", "\"natural-frequencies\", \"time-history\" or \"accelerance\""),
    ("values", "a list of frequencies in Hz"),
    ("resolution", "one number [Hz], or a list with one number a mode"),
    ("scatter", "one number [Hz], or a list with one number a mode"),
    ("shape", "a list with one [nodes_x, nodes_y] a mode, whole numbers from 0"),
    ("file", "a file's name in quotes, a list of names, or {force = .., response = ..}"),
    ("unit", "a unit in quotes, such as \"m/s2\" or \"g\""),
    ("response_unit", "a unit in quotes, such as \"m/s2\", \"g\" or \"mm/s\""),
    ("force_unit", "a unit in quotes, such as \"N\" or \"lbf\""),
    ("quantity", "\"acceleration\", \"velocity\" or \"displacement\""),
    ("response_sensitivity", "a number in V a response_unit"),
    ("force_sensitivity", "a number in V a force_unit"),
    ("trigger", "a table {level = .., before = .., length = ..} in N, s and s"),
    ("columns", "a table such as {time = \"Time (s)\", force = 2, response = 3}"),
    ("places", "a file's name in quotes, with the columns node,x,y in m"),
    ("origin", "a place [x, y] in m: the piece's centre as the file of places has it"),
    ("band", "two frequencies [from, to] in Hz"),
    ("start", "a number (Pa; a Poisson's ratio has no unit)"),
    ("std", "a number (Pa; a Poisson's ratio has no unit)"),
    ("level", "a number in N"),
    ("before", "a number in s"),
    ("sampling_rate", "a number in Hz"),
    ("frequency_unit", "a unit of frequency in quotes, such as \"kHz\""),
    ("window_decay", "a number in s"),
    ("direction", "1 or -1"),
    ("record", "the record's number in the file, from 1"),
];

/// The key of the value at byte `start`, and what the TOML reader's `message` means; `None` where it is no complaint
/// about a type.
pub(super) fn in_plain_words(text: &str, start: usize, message: &str) -> Option<(String, String)> {
    let complaint = ["invalid type: ", "invalid value: ", "invalid length "];
    let rest = complaint.iter().find_map(|words| message.strip_prefix(words))?;
    let (found, expected) = rest.split_once(", expected ")?;
    let key = key_at(text, start);
    let name = key.rsplit('.').next().unwrap_or_default();
    let name = name.split('[').next().unwrap_or_default();
    let wanted = match name {
        "force_at" | "response_at" => "a place [x, y] in m from the piece's centre",
        _ if key.starts_with("constants.") => {
            "a number (Pa; a Poisson's ratio has no unit), {start = ..} or {value = .., std = ..}"
        }
        _ => WANTED.iter().find(|(known, _)| *known == name).map_or(expected, |(_, wanted)| wanted),
    };
    let value = found.split_once('`').and_then(|(_, value)| value.strip_suffix('`'));
    let found = match found.split_once(' ') {
        _ if message.starts_with("invalid length") => format!("a list of {found}"),
        Some(("string", text)) => format!("text {text}"),
        _ if found == "sequence" => "a list".to_owned(),
        _ if found == "map" => "a table".to_owned(),
        _ => value.unwrap_or(found).to_owned(),
    };
    Some((key, format!("{found} given, wanted is {wanted}")))
}

/// Path of the key whose value holds byte `start`; entries of `[[...]]` are counted from 1.
fn key_at(text: &str, start: usize) -> String {
    let line_end = text.get(start..).and_then(|rest| rest.find('\n')).map_or(text.len(), |length| start + length);
    let (mut table, mut key, mut counts) = (String::new(), "", BTreeMap::new());
    for line in text.get(..line_end).unwrap_or_default().lines() {
        let header = line.split('#').next().unwrap_or_default().trim();
        let list = header.strip_prefix("[[").and_then(|name| name.strip_suffix("]]")).map(str::trim);
        let single = header.strip_prefix('[').and_then(|name| name.strip_suffix(']')).map(str::trim);
        if let Some(name) = list.filter(|name| is_bare(name)) {
            let count: &mut usize = counts.entry(name).or_default();
            *count += 1;
            (table, key) = (format!("{name}[{count}]"), "");
        } else if let Some(name) = single.filter(|name| is_bare(name)) {
            (table, key) = (name.to_owned(), "");
        } else if let Some((name, _)) = line.split_once('=').filter(|(name, _)| is_bare(name.trim())) {
            key = name.trim();
        }
    }
    match (table.as_str(), key) {
        (table, "") => table.to_owned(),
        ("", key) => key.to_owned(),
        (table, key) => format!("{table}.{key}"),
    }
}

/// True for a name that TOML takes without quotes; a row of a list, such as `[1, 2]`, is none.
fn is_bare(name: &str) -> bool {
    let letters = |byte: u8| byte.is_ascii_alphabetic() || byte == b'_' || byte == b'-';
    name.bytes().next().is_some_and(letters) && name.bytes().all(|byte| letters(byte) || byte.is_ascii_digit())
}

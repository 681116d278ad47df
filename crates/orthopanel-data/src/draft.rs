//! A first test file, written from the records that there are: what they tell is filled in, what they do not is left to be.

use std::{fmt::Write as _, path::Path};

use crate::{
    Channel, Record, RecordFile, RecordKind,
    listing::port_text,
    records::{Node, Port, Quantity, Samples, blows, is_force, quantity, without_unit},
    spectra::doubt_of_frequencies,
};

/// Pairs of nodes in one file up to which each has a measurement of its own; above, `places` has them all.
const WRITTEN_OUT: usize = 3;

/// A commented `test.toml` for files of records, each by the path that the test file shall have for it.
///
/// Sizes, mass and places that the files do not tell stand as comments: what is missing is then asked for by its name when the test is
/// read, and nothing is made up.
pub fn draft(files: &[(&Path, &RecordFile)]) -> String {
    let mut text = String::from(HEAD);
    if files.len() > 1 {
        text += "\n# Hits of one place may share a [[measurement]]: file = [\"a.csv\", \"b.csv\"], or a pattern such as \"hit-*.csv\".\n";
    }
    let paired = in_two_files(files);
    for (place, (path, file)) in files.iter().enumerate() {
        match paired.iter().find(|(_, motion)| *motion == place) {
            Some((force, _)) => text += &of_two_files(files[*force], (path, file)),
            None if paired.iter().any(|(force, _)| *force == place) => {}
            None => text += &measurement(path, file),
        }
    }
    text
}

/// What the records of a file against time hold, where they hold one thing alone.
fn held(path: &Path, file: &RecordFile) -> Option<Channel> {
    let is_of_time = |record: &&Record| record.kind == RecordKind::Time;
    let mut held = file.records.iter().filter(is_of_time).map(|record| match quantity(&record.numerator) {
        Quantity::Force => Some(Channel::Force),
        Quantity::Motion(_) => Some(Channel::Acceleration),
        Quantity::Untold => told_by_name(path),
        Quantity::Other(_) => None,
    });
    let first = held.next()??;
    (file.records.iter().all(|record| is_of_time(&record)) && held.all(|other| other == Some(first))).then_some(first)
}

/// Words in the names of files that hold one channel.
const NAMES: [(Channel, &[&str]); 2] = [
    (Channel::Force, &["force", "hammer", "kraft", "impact"]),
    (Channel::Acceleration, &["acc", "response", "beschl", "motion", "sensor", "velocity", "vib"]),
];

fn told_by_name(path: &Path) -> Option<Channel> {
    let name = path.file_stem()?.to_string_lossy().to_lowercase();
    let has = |(_, words): &&(Channel, &[&str])| words.iter().any(|word| name.contains(word));
    NAMES.iter().find(has).map(|(channel, _)| *channel)
}

/// Places of the files that hold the force and the motion of one record: as many of each, in the order of their names, or one force for
/// all; none where they do not fit.
fn in_two_files(files: &[(&Path, &RecordFile)]) -> Vec<(usize, usize)> {
    let of = |channel: Channel| {
        let mut places: Vec<usize> =
            (0..files.len()).filter(|&place| held(files[place].0, files[place].1) == Some(channel)).collect();
        places.sort_by_key(|&place| files[place].0);
        places
    };
    let (forces, motions) = (of(Channel::Force), of(Channel::Acceleration));
    let pairs: Vec<(usize, usize)> = match (&forces[..], &motions[..]) {
        ([force], motions) => motions.iter().map(|motion| (*force, *motion)).collect(),
        _ if forces.len() == motions.len() => forces.into_iter().zip(motions).collect(),
        _ => Vec::new(),
    };
    // Of one blow both have as many samples.
    let samples =
        |place: usize| -> Vec<usize> { files[place].1.records.iter().map(|record| record.ordinate.len()).collect() };
    if pairs.iter().all(|&(force, motion)| samples(force) == samples(motion)) { pairs } else { Vec::new() }
}

/// The measurement of a force and a motion that have files of their own.
fn of_two_files((of_force, force): (&Path, &RecordFile), (of_motion, motion): (&Path, &RecordFile)) -> String {
    let [force_name, motion_name] = [of_force, of_motion].map(|path| path.to_string_lossy().replace('\\', "/"));
    let port = |file: &RecordFile| file.records.first().map_or(Port::default(), |record| record.response);
    format!(
        "\n# {}, and {}: do these two belong together?\n[[measurement]]\nkind = \"time-history\"\nfile = {{force = {}, response = {}}}\n{}{}{}",
        summary(force).replace(['\n', '\r'], " "),
        summary(motion).replace(['\n', '\r'], " "),
        quoted(&force_name),
        quoted(&motion_name),
        place("force_at", port(force), &force.nodes),
        place("response_at", port(motion), &motion.nodes),
        untold_of_two(force, motion)
    )
}

/// Lines for what two such files do not tell.
fn untold_of_two(force: &RecordFile, motion: &RecordFile) -> String {
    let has_no_unit = |file: &RecordFile| {
        file.records.iter().any(|record| record.numerator.unit.is_empty() && record.numerator.system.is_none())
    };
    let mut text = String::new();
    if has_no_unit(force) {
        text += "# force_unit = \"N\"   # the record tells no unit: N unless said; \"lbf\", \"kN\", ...\n";
    }
    if has_no_unit(motion) {
        text += "# response_unit = \"m/s2\"   # the record tells no unit: m/s2 unless said; \"g\", \"mm/s\", ...\n";
    }
    text + BAND
}

const BAND: &str = "# band = [20.0, 4000.0]   # Hz, the lines that count\n";

/// What no record tells.
const HEAD: &str = "\
# A hammer test. Write what stands behind # without its #, with your numbers. Units are SI; x and y are in m from the piece's centre.
# Then: orthopanel run TEST -o out

[piece]
# length = 0.8             # m, along x
# width = 0.1              # m, along y
# thickness = 0.03         # m
# mass_per_area = 6.88     # kg/m2; or weighings = [[length, width, mass], ..] in m, m, kg
# thickness_std = 0.1e-3   # m; standard deviations of sizes and mass, where they count

# structure = \"mindlin-plate\"   # above the tables; a Timoshenko beam where nothing is said

# [boundary]               # free where nothing is said; or \"pinned\", \"clamped\"
# left = \"free\"
# right = \"free\"

# [suspension]             # the points that carry the piece
# at = [-0.22, 0.22]

# [[effect]]               # what is known beforehand, such as the sensor's mass in kg
# id = \"sensor-mass\"
# mass = 0.004
";

/// The measurements of one file.
fn measurement(path: &Path, file: &RecordFile) -> String {
    let count = |kind: RecordKind| file.records.iter().filter(|record| record.kind == kind).count();
    let (responses, times) = (count(RecordKind::FrequencyResponse), count(RecordKind::Time));
    let name = path.to_string_lossy().replace('\\', "/");
    let mut text = format!("\n# {}\n", summary(file).replace(['\n', '\r'], " "));
    let is_of_responses = responses > 0;
    let kind = match (responses, times) {
        (0, 0) => {
            let _ = writeln!(
                text,
                "# {}: no record against time, and no frequency response: nothing to read in it",
                comment(&name)
            );
            return text;
        }
        (0, _) => "time-history",
        _ => "accelerance",
    };
    if is_of_responses && has_runs(file) {
        return text + &each_record(file, kind, &name);
    }
    let pairs = file.pairs(is_of_responses);
    let told = |pair: &&[Port; 2]| pair.iter().any(|port| port.node != 0);
    let several = pairs.len() > 1;
    if several && pairs.len() > WRITTEN_OUT && pairs.iter().all(|pair| told(&pair)) {
        text += &header(kind, &name);
        text += &places(&pairs, &file.nodes, &name);
        text += &untold(file, is_of_responses);
        return text;
    }
    let of_responses = several_responses(file);
    if !is_of_responses && !of_responses.is_empty() && pairs.len() < 2 {
        let pair = pairs.first().copied().unwrap_or_default();
        for (number, channel) in (1..).zip(&of_responses) {
            if number > 1 {
                text.push('\n');
            }
            text += &header(kind, &name);
            text += &format!("response_channel = {channel}\n");
            for (key, port) in [("force_at", pair[0]), ("response_at", pair[1])] {
                text += &place(key, port, &file.nodes);
            }
            text += &untold(file, is_of_responses);
        }
        return text;
    }
    let alone = [[Port::default(); 2]];
    for (number, pair) in (1..).zip(if pairs.is_empty() { &alone[..] } else { &pairs[..] }) {
        if number > 1 {
            text.push('\n');
        }
        text += &header(kind, &name);
        for (key, port) in [("force_at", pair[0]), ("response_at", pair[1])] {
            text += &place(key, port, &file.nodes);
        }
        if several {
            text += &channels(pair);
        }
        text += &untold(file, is_of_responses);
    }
    text
}

/// The responses to one blow, as `response_channel` names them, where there are several that no node tells apart.
fn several_responses(file: &RecordFile) -> Vec<String> {
    let Some(first) = blows(&file.records, is_force).into_iter().next() else { return Vec::new() };
    let motions: Vec<&Record> = first
        .iter()
        .filter_map(|&at| file.records.get(at))
        .filter(|record| matches!(quantity(&record.numerator), Quantity::Motion(_)))
        .collect();
    let name = |record: &&Record| match without_unit(record.title.split(" | ").next().unwrap_or_default()) {
        "" => record.number.to_string(),
        title => quoted(title),
    };
    let names: Vec<String> = motions.iter().map(name).collect();
    let is_told = (1..names.len()).all(|at| !names[..at].contains(&names[at]));
    match names.len() {
        0 | 1 => Vec::new(),
        _ if is_told => names,
        _ => motions.iter().map(|record| record.number.to_string()).collect(),
    }
}

/// The frequency responses along z by their pairs of nodes, in the order of the file; what tells no node is alone.
fn runs(file: &RecordFile) -> Vec<([Port; 2], Vec<usize>)> {
    let along_z = file.pairs(true);
    let mut runs: Vec<([Port; 2], Vec<usize>)> = Vec::new();
    for record in file.records.iter().filter(|record| record.kind == RecordKind::FrequencyResponse) {
        let pair = [record.reference, record.response];
        let is_told = pair.iter().any(|port| port.node != 0);
        match runs.iter_mut().find(|(known, _)| is_told && *known == pair) {
            Some((_, numbers)) => numbers.push(record.number),
            None if along_z.contains(&pair) => runs.push((pair, vec![record.number])),
            None => {}
        }
    }
    runs
}

/// Whether nodes do not tell the frequency responses of a file apart: they have none, or there are several runs.
fn has_runs(file: &RecordFile) -> bool {
    let runs = runs(file);
    let is_untold = |(pair, _): &([Port; 2], Vec<usize>)| pair.iter().all(|port| port.node == 0);
    runs.iter().any(|(_, numbers)| numbers.len() > 1) || (runs.len() > 1 && runs.iter().any(is_untold))
}

/// A measurement for each pair of nodes, with the number of its record: of several runs that with the best coherence.
fn each_record(file: &RecordFile, kind: &str, name: &str) -> String {
    let listed = file.listed();
    let coherence = |number: usize| listed.iter().find(|of| of.record == number).and_then(|of| of.mean_coherence);
    let of_run = |(pair, numbers): ([Port; 2], Vec<usize>)| {
        let best = numbers.iter().copied().max_by(|a, b| {
            // Of runs alike the first.
            coherence(*a).unwrap_or(-1.0).total_cmp(&coherence(*b).unwrap_or(-1.0)).then(b.cmp(a))
        });
        let number = best.unwrap_or(1);
        let title = file.records.iter().find(|record| record.number == number).map_or("", |record| &record.title);
        let others: Vec<String> = numbers.iter().map(usize::to_string).collect();
        let note = match (&numbers[..], coherence(number)) {
            ([_], _) => comment(title),
            (_, Some(mean)) => {
                format!("of the runs {}, that with the best coherence, {mean:.3}", crate::error::some_of(&others, ", "))
            }
            (_, None) => format!("or another of the runs {}", crate::error::some_of(&others, ", ")),
        };
        let mut text = header(kind, name) + &format!("record = {number}   # {note}\n");
        for (key, port) in [("force_at", pair[0]), ("response_at", pair[1])] {
            text += &place(key, port, &file.nodes);
        }
        text + &untold(file, true)
    };
    runs(file).into_iter().map(of_run).collect::<Vec<_>>().join("\n")
}

fn header(kind: &str, name: &str) -> String {
    format!("[[measurement]]\nkind = {}\nfile = {}\n", quoted(kind), quoted(name))
}

/// A text in the quotes of TOML.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A text that stays within a comment.
fn comment(text: &str) -> String {
    text.chars().map(|character| if character.is_control() { ' ' } else { character }).collect()
}

/// What the file holds, in a line.
fn summary(file: &RecordFile) -> String {
    let listed = file.listed();
    let mut parts: Vec<(String, usize)> = Vec::new();
    for record in &listed {
        let unit = if record.unit.is_empty() { "unit not told".to_owned() } else { record.unit.clone() };
        let part = format!("{} ({unit}), {}", record.quantity, record.extent());
        match parts.iter_mut().find(|(known, _)| *known == part) {
            Some((_, times)) => *times += 1,
            None => parts.push((part, 1)),
        }
    }
    let parts: Vec<String> = parts.into_iter().map(|(part, times)| format!("{times} x {part}")).collect();
    comment(&crate::error::some_of(&parts, "; "))
}

/// The place of a channel where the file tells it, else the line to fill in.
fn place(key: &str, port: Port, nodes: &[Node]) -> String {
    let node = nodes.iter().find(|node| node.number == port.node && port.node != 0);
    match (node, port.node) {
        (Some(node), number) => format!(
            "{key} = [{}, {}]   # node {number}, as the file places it: from the piece's centre?\n",
            decimal(node.at[0]),
            decimal(node.at[1])
        ),
        (None, 0) => format!("# {key} = [0.0, 0.0]   # x, y in m from the piece's centre\n"),
        (None, number) => format!("# {key} = [0.0, 0.0]   # x, y of node {number}, in m from the piece's centre\n"),
    }
}

/// A length to a micrometre, as TOML wants it.
fn decimal(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == rounded.trunc() { format!("{rounded:.1}") } else { rounded.to_string() }
}

/// One measurement for many nodes.
fn places(pairs: &[[Port; 2]], nodes: &[Node], name: &str) -> String {
    let mut numbers: Vec<i64> = pairs.iter().flatten().map(|port| port.node).filter(|node| *node != 0).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let listed = numbers.iter().map(i64::to_string).collect::<Vec<_>>();
    let mut text = if numbers.iter().all(|number| nodes.iter().any(|node| node.number == *number)) {
        format!(
            "places = {}   # its nodes, datasets 15 or 2411\n# origin = [0.0, 0.0]   # the piece's centre, where the file counts from elsewhere\n",
            quoted(name)
        )
    } else {
        format!(
            "places = \"places.csv\"   # to write: a line node,x,y, then a row a node, in m from the piece's centre: {}\n",
            crate::error::some_of(&listed, ", ")
        )
    };
    for (key, channel) in [("force_at", 0), ("response_at", 1)] {
        if pairs.iter().any(|pair| pair[channel].node == 0) {
            let _ = writeln!(text, "# {key} = [0.0, 0.0]   # the file tells no node of it");
        }
    }
    text
}

/// The channels of one of several pairs.
fn channels(pair: &[Port; 2]) -> String {
    let mut text = String::new();
    for (key, port) in [("force_channel", pair[0]), ("response_channel", pair[1])] {
        if port.node != 0 {
            let _ = writeln!(text, "{key} = {}", quoted(&port_text(port)));
        }
    }
    text
}

/// Lines for what the records do not tell of their channels.
fn untold(file: &RecordFile, is_of_responses: bool) -> String {
    let kind = if is_of_responses { RecordKind::FrequencyResponse } else { RecordKind::Time };
    let of_kind = || file.records.iter().filter(|record| record.kind == kind);
    let mut text = String::new();
    let is_untold = |axis: &crate::Axis| quantity(axis) == Quantity::Untold;
    let volts = |axis: &crate::Axis| {
        axis.unit.trim().to_lowercase().starts_with(['v', 'm']) && axis.unit.to_lowercase().contains('v')
    };
    let no_unit = |is_force: bool| {
        of_kind().any(|record| {
            let axis = if is_of_responses && is_force { &record.denominator } else { &record.numerator };
            let is_it = is_of_responses || (quantity(axis) == Quantity::Force) == is_force;
            is_it && axis.unit.is_empty() && axis.system.is_none()
        })
    };
    if of_kind().any(|record| volts(&record.numerator) || volts(&record.denominator)) {
        text += "# response_sensitivity = 0.0102   # V a unit of response_unit, and\n# force_sensitivity = 0.00224      # V a unit of force_unit: the record is in volts\n";
    }
    if no_unit(false) && !is_own(file) {
        text += "# response_unit = \"m/s2\"   # the records tell no unit: m/s2 unless said; \"g\", \"mm/s\", ...\n";
    }
    if of_kind().any(|record| is_untold(&record.numerator)) {
        text += if is_of_responses {
            "# quantity = \"acceleration\"   # the records do not tell: or \"velocity\" (mobility), \"displacement\" (receptance)\n"
        } else {
            "# force_channel = 1        # the records do not tell which they are: a number, a node, or a line of the title\n# response_channel = 2\n"
        };
    }
    if is_of_responses && of_kind().any(|record| doubt_of_frequencies(record).is_some()) {
        text += "# frequency_unit = \"kHz\"   # or \"Hz\": the lines end lower than those of hammer tests, and their label does not say\n";
    }
    if is_of_responses {
        text += "# window_decay = 0.25   # s, where it was averaged under an exponential window e^(-t/0.25)\n";
        if of_kind().any(|record| matches!(record.ordinate, Samples::Real(_))) {
            text += "# the frequency response is real: export it complex, or with its phase\n";
        }
    }
    text + BAND
}

/// This project's own columns are in m/s2 and N by their names.
fn is_own(file: &RecordFile) -> bool {
    file.records.first().is_some_and(|record| record.title == "accelerance" && !record.abscissa.is_empty())
}

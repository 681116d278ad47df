//! The force file of `simulate`: `time_s,force_n`, or `time_s,force_1_n,force_2_n,...` for several force places.

use orthopanel_model::Readable;

/// No hammer or shaker has as much \[N\]; the motion under more is no number.
const NO_FORCE: f64 = 1e30;

/// Forces against time, as read: at least two samples, time rising, every number finite.
pub struct ForceHistory {
    /// Time \[s\].
    pub time: Vec<f64>,
    /// Force \[N\], one column a force place.
    pub forces: Vec<Vec<f64>>,
}

/// What is wrong with a force file, and in which line.
pub struct Fault {
    pub line: Option<u64>,
    pub problem: String,
}

impl ForceHistory {
    /// Forces of all places at sample `index`.
    pub fn at(&self, index: usize) -> Vec<f64> {
        self.forces.iter().map(|column| column.get(index).copied().unwrap_or(0.0)).collect()
    }

    /// A half-sine hit at the first of `places` force places: 100 N, 0.5 ms, then silence up to 50 ms.
    pub fn half_sine(places: usize) -> Self {
        const PEAK: f64 = 100.0;
        const DURATION: f64 = 5e-4;
        const RATE: f64 = 1e5;
        let time: Vec<f64> = (0..=5000).map(|sample| f64::from(sample) / RATE).collect();
        let pulse =
            |&time: &f64| if time < DURATION { PEAK * (std::f64::consts::PI * time / DURATION).sin() } else { 0.0 };
        let hit: Vec<f64> = time.iter().map(pulse).collect();
        let silence = vec![0.0; time.len()];
        let forces = std::iter::once(hit).chain(std::iter::repeat(silence)).take(places).collect();
        Self { time, forces }
    }

    /// Reads the columns for `places` force places; other columns are left alone.
    pub fn from_csv(text: &str, places: usize) -> Result<Self, Fault> {
        let fault = |line: Option<u64>, problem: String| Fault { line, problem };
        let broken = |error: csv::Error| fault(error.position().map(csv::Position::line), error.to_string());
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
        let names = reader.headers().map_err(broken)?.clone();
        let wanted: Vec<Vec<String>> = std::iter::once(vec!["time_s".to_owned()])
            .chain((1..=places).map(|port| force_names(port, places)))
            .collect();
        let mut positions = Vec::with_capacity(wanted.len());
        for alternatives in &wanted {
            let position = names.iter().position(|name| alternatives.iter().any(|wanted| wanted == name));
            positions.push(position.ok_or_else(|| {
                let name = alternatives.first().map_or("", String::as_str);
                fault(Some(1), format!("column {name} is missing: the columns are {}", columns(&wanted)))
            })?);
        }
        let mut history = Self { time: Vec::new(), forces: vec![Vec::new(); places] };
        for row in reader.records() {
            let row = row.map_err(broken)?;
            let line = row.position().map(csv::Position::line);
            for (column, &position) in positions.iter().enumerate() {
                let text = row.get(position).unwrap_or("");
                let value = text.parse().ok().filter(|value: &f64| value.is_finite());
                let name = names.get(position).unwrap_or("");
                let value = value.ok_or_else(|| {
                    let found: String = text.chars().take(40).collect();
                    fault(line, format!("{name} = {found:?}: must be a finite number"))
                })?;
                match column.checked_sub(1) {
                    Some(_) if value.abs() >= NO_FORCE => {
                        let (value, most) = (Readable(value), Readable(NO_FORCE));
                        return Err(fault(line, format!("{name} = {value}: must be less than {most} N")));
                    }
                    Some(port) => history.forces[port].push(value),
                    None => history.push_time(value).map_err(|problem| fault(line, problem))?,
                }
            }
        }
        if history.time.len() < 2 {
            return Err(fault(None, format!("{} samples: give at least two", history.time.len())));
        }
        Ok(history)
    }

    fn push_time(&mut self, time: f64) -> Result<(), String> {
        match self.time.last() {
            Some(&before) if time <= before => {
                Err(format!("time_s = {} after {}: time must rise", Readable(time), Readable(before)))
            }
            _ => {
                self.time.push(time);
                Ok(())
            }
        }
    }
}

/// Names under which a force column may stand.
fn force_names(port: usize, places: usize) -> Vec<String> {
    let numbered = format!("force_{port}_n");
    if places == 1 { vec!["force_n".into(), numbered] } else { vec![numbered] }
}

fn columns(wanted: &[Vec<String>]) -> String {
    wanted.iter().filter_map(|names| names.first()).cloned().collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, places: usize) -> Result<ForceHistory, String> {
        ForceHistory::from_csv(text, places).map_err(|fault| match fault.line {
            Some(line) => format!("{line}: {}", fault.problem),
            None => fault.problem,
        })
    }

    #[test]
    fn columns_are_found_by_name_in_any_order() {
        let history = read("force_2_n, time_s, note, force_1_n\n2,0,a,1\n4,0.5,b,3\n", 2).expect("a force file");
        assert_eq!(history.time, [0.0, 0.5]);
        assert_eq!([history.at(0), history.at(1)], [[1.0, 2.0], [3.0, 4.0]]);
    }

    #[test]
    fn faults_name_line_and_remedy() {
        let fault = |text, places| read(text, places).err().expect("a fault");
        assert_eq!(fault("time_s\n0\n1\n", 1), "1: column force_n is missing: the columns are time_s,force_n");
        assert_eq!(fault("time_s,force_n\n0,1\n0,1\n", 1), "3: time_s = 0 after 0: time must rise");
        assert_eq!(fault("time_s,force_n\n0,1\n1,nan\n", 1), "3: force_n = \"nan\": must be a finite number");
        assert_eq!(fault("time_s,force_n\n0,1\n", 1), "1 samples: give at least two");
    }
}

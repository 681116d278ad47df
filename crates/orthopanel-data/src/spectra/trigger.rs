//! Several blows in one continuous record: cut into hits where the force passes a level.

use orthopanel_model::Readable;

use super::{
    extremes::{extremes, median, peak, sampled_median},
    hit::Hit,
};
use crate::{DataError, Location, Trigger};

/// Blows stand this far apart at least \[s\]; what comes sooner is a second touch of one blow, and is judged as such.
const APART: f64 = 0.5;

/// A level over the highest blow, and over the noise of the force's channel in standard deviations, where none is declared.
const LEVEL: f64 = 0.1;
const ABOVE_NOISE: f64 = 10.0;

/// A declared level within so many standard deviations of that noise is passed by noise, in a record of a million samples.
const AMONG_NOISE: f64 = 5.0;

/// Time before the level is passed \[s\], and samples, where none is declared: enough to read the noise of the channels.
const BEFORE: f64 = 0.02;
const LEAST_BEFORE: usize = 128;

/// A gap between blows shorter than this part of their median is a blow too soon.
const SOON: f64 = 0.6;

/// Response at the end of a hit over its own at the beginning, rms, up to which blows apart are hits of their own.
const DECAYED: f64 = 0.2;

/// How a continuous record was cut, to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// Length of the record \[s\].
    pub duration: f64,
    /// Least and greatest force \[N\] of each of [`Cut::STRETCHES`] equal stretches of it, or fewer of a short one.
    pub force: Vec<[f64; 2]>,
    /// The force that a blow passes \[N\].
    pub level: f64,
    /// From and to \[s\] of each hit.
    pub hits: Vec<[f64; 2]>,
    /// Where the force of a blow that was left out passes the level \[s\].
    pub left_out: Vec<f64>,
}

impl Cut {
    /// More than a picture has columns.
    pub const STRETCHES: usize = 1600;

    fn of(force: &[f64], rate: f64, level: f64) -> Self {
        let stretch = force.len().div_ceil(Self::STRETCHES).max(1);
        Self {
            duration: force.len() as f64 / rate,
            force: force.chunks(stretch).map(extremes).collect(),
            level,
            hits: Vec::new(),
            left_out: Vec::new(),
        }
    }
}

/// Hits of a record, and how it was cut where it was.
pub(super) struct Blows {
    pub(super) hits: Vec<Hit>,
    pub(super) cut: Option<Cut>,
}

impl Blows {
    fn whole(hit: Hit) -> Self {
        Self { hits: vec![hit], cut: None }
    }
}

/// The hits in a record, cut by the force; the record as it is, where it holds one blow.
///
/// What is not declared in `trigger` is found: the level from the highest blow and the noise, the length from the gaps between blows.
/// Blows that follow too soon, and a last one that the record's end cuts short, are left out, which the notes tell.
///
/// # Errors
/// [`DataError::Channels`] where a declared trigger finds no blow.
pub(super) fn cut(
    hit: Hit,
    rate: f64,
    trigger: Option<Trigger>,
    at: &Location,
    notes: &mut Vec<String>,
) -> Result<Blows, DataError> {
    let declared = trigger.unwrap_or_default();
    let offset = sampled_median(&hit.force);
    let (_, height) = peak(&hit.force, offset);
    let push = |value: f64| height.signum() * (value - offset);
    let noise = {
        let stride = (hit.force.len() / 1000).max(1);
        median(hit.force.iter().step_by(stride).map(|value| (value - offset).abs()).collect()) / 0.674_49
    };
    let level = declared.level.unwrap_or((LEVEL * height.abs()).max(ABOVE_NOISE * noise));
    let refused = |problem: String| Err(DataError::Channels { at: Box::new(at.clone()), problem });
    if level < AMONG_NOISE * noise && declared.level.is_some() {
        return refused(format!(
            "trigger.level = {} N lies in the noise of the force, {} N: noise would pass for blows; raise it to {} N, or leave it out",
            Readable(level),
            digits(noise),
            digits((LEVEL * height.abs()).max(ABOVE_NOISE * noise))
        ));
    }
    let apart = (APART * rate) as usize;
    let mut starts: Vec<usize> = Vec::new();
    let mut last_touch: Option<usize> = None;
    for (n, _) in hit.force.iter().enumerate().filter(|(_, value)| push(**value) > level) {
        if last_touch.is_none_or(|last| n - last > apart) {
            starts.push(n);
        }
        last_touch = Some(n);
    }
    if trigger.is_some() && starts.is_empty() {
        return refused(format!(
            "no blow passes trigger.level = {} N: the highest has {:.4} N; lower it to {} N, or leave it out",
            Readable(level),
            Readable(height.abs()),
            digits((LEVEL * height.abs()).max(ABOVE_NOISE * noise))
        ));
    }
    if trigger.is_none() && starts.len() < 2 {
        return Ok(Blows::whole(hit));
    }
    let ends = || starts.iter().skip(1).copied().chain([hit.force.len()]);
    let gaps: Vec<usize> = starts.iter().zip(ends()).map(|(start, end)| end - start).collect();
    let usual = median(
        gaps.get(..gaps.len().saturating_sub(1).max(1)).unwrap_or_default().iter().map(|gap| *gap as f64).collect(),
    );
    let full = gaps.iter().copied().filter(|gap| *gap as f64 >= SOON * usual).min().unwrap_or(0);
    let found_before = ((BEFORE * rate) as usize).max(LEAST_BEFORE).min(full / 10);
    // The next blow begins before its level is passed.
    let found_length = |before: usize| full.saturating_sub(before.min(full / 20));
    let before = declared.before.map_or(found_before, |seconds| (seconds * rate).round() as usize);
    let length = declared.length.map_or(found_length(before), |seconds| (seconds * rate).round() as usize);
    let seconds = |samples: usize| Readable((samples as f64 / rate * 1e6).round() / 1e6);
    // What would do, in place of what was declared.
    let instead = format!(
        "blows stand {} s apart: trigger = {{level = {}, before = {}, length = {}}} (N, s, s) takes each whole",
        seconds(usual as usize),
        digits(level),
        seconds(found_before),
        seconds(found_length(found_before))
    );
    let too_short = length < 2 * LEAST_BEFORE;
    let too_early = before >= length || (starts.len() > 1 && before as f64 > SOON * usual);
    if too_short || too_early {
        let problem = match (too_early, declared.before.is_some()) {
            (true, true) => format!(
                "trigger.before = {} s reaches over a hit of {} s, or back into the blow before; {instead}",
                seconds(before),
                seconds(length)
            ),
            _ => format!(
                "hits of {} s, {length} samples, are too short for a hammer test, {} samples at least; {instead}",
                seconds(length),
                2 * LEAST_BEFORE
            ),
        };
        return if trigger.is_some() { refused(problem) } else { Ok(Blows::whole(hit)) };
    }
    let (mut hits, mut left_out) = (Vec::new(), Vec::new());
    let mut cut = Cut::of(&hit.force, rate, offset + height.signum() * level);
    for (number, ((&start, gap), earlier)) in (1..).zip(starts.iter().zip(&gaps).zip([usize::MAX].iter().chain(&gaps)))
    {
        let from = start.saturating_sub(before);
        // A record that begins with its first blow gives that less rest before it, and as much after.
        let whole = hit.force.get(from..from + length).zip(hit.acceleration.get(from..from + length));
        let soon = (*earlier as f64) < SOON * usual || start + gap < from + length;
        match whole {
            Some((force, acceleration)) if !soon => {
                hits.push(Hit { force: force.to_vec(), acceleration: acceleration.to_vec() });
                cut.hits.push([from as f64 / rate, (from + length) as f64 / rate]);
            }
            _ => {
                left_out.push(number.to_string());
                cut.left_out.push(start as f64 / rate);
            }
        }
    }
    if hits.is_empty() {
        let problem = format!("no blow has trigger.length = {} s of the record to itself; {instead}", seconds(length));
        return if trigger.is_some() { refused(problem) } else { Ok(Blows::whole(hit)) };
    }
    if trigger.is_none() && !hits.iter().all(|hit| has_decayed(&hit.acceleration, before)) {
        return Ok(Blows::whole(hit));
    }
    notes.push(format!(
        "{}: {} blows in one record of {:.2} s, cut into hits by trigger = {{level = {}, before = {}, length = {}}}",
        at.key,
        starts.len(),
        hit.force.len() as f64 / rate,
        digits(level),
        seconds(before),
        seconds(length)
    ));
    if !left_out.is_empty() {
        let which = crate::error::some_of(&left_out, ", ");
        notes.push(format!(
            "{}: blow {which} left out: too soon before or after another, or cut short by an end of the record",
            at.key
        ));
    }
    Ok(Blows { hits, cut: Some(cut) })
}

/// A number to four digits, as a test file takes it.
fn digits(value: f64) -> Readable {
    Readable(format!("{value:.3e}").parse().unwrap_or(value))
}

/// Whether a response has mostly died away at its end; `before` samples stand before the blow.
fn has_decayed(response: &[f64], before: usize) -> bool {
    let part = (response.len() / 20).max(1);
    let rms = |range: Option<&[f64]>| {
        let range = range.unwrap_or_default();
        let mean = range.iter().sum::<f64>() / range.len().max(1) as f64;
        (range.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / range.len().max(1) as f64).sqrt()
    };
    let first = rms(response.get(before..(before + part).min(response.len())));
    rms(response.get(response.len() - part..)) <= DECAYED * first
}

//! What is wrong with each hit, in itself or shared with others.

use super::{
    blow::force_fault,
    extremes::Levels,
    hit::Hit,
    hit_faults::{Channel, HitFault},
    hit_verdict::HitVerdict,
    overload::{overload, shared_extremes},
    time_history::TimeHistory,
    wrong_sample::{cut_crest, dropped_sample},
};

/// Rms left at the end, over the greatest, that leakage makes visible between the peaks.
const DECAYED: f64 = 1e-3;

/// Rms left at the end that is ringing for certain, unless the channel is that noisy.
const RINGING: f64 = 0.1;

/// Rms over the noise's, below which it may be all noise.
const NOISY: f64 = 1.5;

/// Rms of four twentieths over that of the four before, below which it still falls; noise stays as it is.
const FALLING: f64 = 0.9;

impl Hit {
    /// What is wrong with the hit; `rate` is the sampling rate \[Hz\].
    ///
    /// Not to be found in one hit: a single sample of the force cut off at a ceiling, one of the response that was not
    /// recorded through an anti-alias filter, and a channel that goes gently into its ceiling. Hits whose greatest samples
    /// are exactly alike tell the first two: [`TimeHistory::accelerance`](crate::TimeHistory::accelerance)
    /// looks for them. Nor a lost sample that fits its neighbours, one on a crest, or one whose time was lost too.
    pub fn faults(&self, rate: f64) -> Vec<HitFault> {
        let channels = [(Channel::Force, &self.force), (Channel::Acceleration, &self.acceleration)];
        let silent =
            channels.iter().filter(|(_, values)| values.windows(2).all(|pair| matches!(pair, [a, b] if a == b)));
        let silent: Vec<_> = silent.map(|&(channel, _)| HitFault::Silent(channel)).collect();
        if !silent.is_empty() {
            return silent;
        }
        let [force, motion] = [&self.force, &self.acceleration].map(|channel| Levels::of(channel));
        let both = channels.iter().zip([force, motion]);
        let mut faults: Vec<_> =
            both.filter_map(|((channel, values), levels)| overload(*channel, values, levels)).collect();
        // What is cut off has many corners: a lost sample is told of whole channels only.
        if faults.is_empty() {
            faults.extend(cut_crest(&self.acceleration, motion));
        }
        if faults.is_empty() {
            faults.extend(channels.iter().filter_map(|(channel, values)| dropped_sample(*channel, values)));
        }
        faults.extend(force_fault(&self.force, force, rate));
        faults.extend(self.not_decayed());
        faults
    }

    fn not_decayed(&self) -> Option<HitFault> {
        let acceleration = &self.acceleration;
        let mean = acceleration.iter().sum::<f64>() / acceleration.len() as f64;
        let part = (acceleration.len() / 20).max(1);
        let rms: Vec<f64> = acceleration
            .chunks_exact(part)
            .map(|chunk| (chunk.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / part as f64).sqrt())
            .collect();
        let greatest = rms.iter().copied().fold(0.0, f64::max);
        let last = rms.last().copied().unwrap_or(0.0);
        let ratio = last / greatest;
        let mut last_eight = rms.rchunks(4).map(|part| part.iter().sum::<f64>());
        let falls = last_eight.next().zip(last_eight.next()).is_some_and(|(last, before)| last < FALLING * before);
        // A weak hit's channel is all noise at the end, as it was before the blow.
        let is_noise = || self.noise_before_blow().is_some_and(|noise| last < NOISY * noise.acceleration);
        ((ratio > RINGING && !is_noise()) || (ratio > DECAYED && falls)).then_some(HitFault::NotDecayed { ratio })
    }
}

impl TimeHistory {
    /// What is wrong with each hit that is left out, a sentence a fault.
    pub fn left_out_of(&self, verdicts: &[HitVerdict]) -> Vec<String> {
        let left_out = verdicts.iter().enumerate().filter(|(_, verdict)| !verdict.is_kept());
        left_out.flat_map(|(index, verdict)| verdict.notes(&self.hit_name(index))).collect()
    }

    /// Before the hits are held against one another.
    pub(super) fn first_verdicts(&self) -> Vec<HitVerdict> {
        let shared = shared_extremes(&self.hits);
        let verdict = |(index, hit): (usize, &Hit)| {
            let mut faults = hit.faults(self.rate);
            if !faults.iter().any(|fault| matches!(fault, HitFault::Overload { .. })) {
                faults.extend(shared.iter().filter(|(of, _)| *of == index).map(|(_, fault)| *fault));
            }
            let original = self.hits.iter().take(index).position(|earlier| earlier == hit);
            faults.extend(original.map(|of| HitFault::Copy { of: of + 1 }));
            HitVerdict { faults }
        };
        self.hits.iter().enumerate().map(verdict).collect()
    }

    /// The hits that are kept, with their numbers from zero.
    pub(super) fn kept(&self, verdicts: &[HitVerdict]) -> Vec<(usize, &Hit)> {
        let judged = self.hits.iter().enumerate().zip(verdicts);
        judged.filter(|(_, verdict)| verdict.is_kept()).map(|(hit, _)| hit).collect()
    }
}

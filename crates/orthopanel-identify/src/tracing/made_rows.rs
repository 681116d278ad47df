//! The rows that records make at one state: what the lines of a target miss, over its noise, and how that follows the parameters.

use num_complex::Complex64;
use orthopanel_model::{LineBlock, ReceptanceModel};

use super::line_noise::LineNoise;
use super::reactions::lines::{ReactionLines, Taken};
use super::record_problem::Grouping;
use super::widened_lines::WidenedLines;

/// What a state makes of the records.
pub(super) struct Made {
    pub model: ReceptanceModel,
    pub reactions: Option<ReactionLines>,
    /// Column of the model and factor of each parameter.
    pub plan: Vec<(usize, f64)>,
}

/// Data that rows are about: a record's hits together, or one of them.
pub(super) struct Target<'a> {
    measured: &'a [Complex64],
    noise: &'a LineNoise,
    taken: Option<Taken>,
}

impl Made {
    pub(super) fn targets<'a>(&self, index: usize, record: &'a WidenedLines, grouping: Grouping) -> Vec<Target<'a>> {
        let data: Vec<(&[Complex64], &LineNoise)> = match grouping {
            Grouping::Places => vec![(&record.value, record.noise())],
            Grouping::Hits => record.hits.iter().map(|hit| (&hit.value[..], hit.noise(record.step()))).collect(),
        };
        let taken = self.reactions.as_ref().map(|all| all.taken(index, record, grouping, &self.plan));
        let mut taken = taken.into_iter().flatten();
        data.into_iter().map(|(measured, noise)| Target { measured, noise, taken: taken.next() }).collect()
    }
}

impl Target<'_> {
    /// Real and imaginary parts of a column of rows, for the lines of a block from `first` on: the derivatives by a parameter, its
    /// number given with its column of the model and factor, or what is missed.
    pub(super) fn column(
        &self,
        at: (usize, LineBlock),
        parameter: Option<(usize, (usize, f64))>,
        [re, im]: [&mut [f64]; 2],
    ) {
        self.over_noise(at, parameter, [&mut *re, &mut *im]);
        self.noise.whiten(at.0, [re, im]);
    }

    /// The same over the noise that lines do not share.
    fn over_noise(
        &self,
        (first, block): (usize, LineBlock),
        parameter: Option<(usize, (usize, f64))>,
        [re, im]: [&mut [f64]; 2],
    ) {
        let weights = &self.noise.weights[first..first + block.len()];
        let Some((column, (of_model, factor))) = parameter else {
            for (line, ((re, im), weight)) in re.iter_mut().zip(im).zip(weights).enumerate() {
                let taken = self.taken.as_ref().map_or(Complex64::ZERO, |taken| taken.value[first + line]);
                let missed = *weight * (block.value(line) - taken - self.measured[first + line]);
                (*re, *im) = (missed.re, missed.im);
            }
            return;
        };
        let [by_re, by_im] = block.by(of_model);
        for (part, by) in [(&mut *re, by_re), (&mut *im, by_im)] {
            part.iter_mut().zip(by).zip(weights).for_each(|((entry, by), weight)| *entry = weight * (factor * by));
        }
        if let Some(taken) = &self.taken {
            for (line, ((re, im), weight)) in re.iter_mut().zip(im).zip(weights).enumerate() {
                let taken = *weight * taken.by[first + line][column];
                (*re, *im) = (*re - taken.re, *im - taken.im);
            }
        }
    }
}

//! The one further measurement that would part the hypotheses best, worked out from their models.
//!
//! What parts the chosen hypothesis from one rival may part it from another by nothing. So the measurement is taken that parts it the
//! most from the rival that it parts it the least from.

mod foretold;
mod harder;
mod places;

use orthopanel_data::ImpactTest;

use super::fit::Fit;
use super::ranking::{Ranking, Search};
use super::reactions::cubic;
use super::report::name;
use crate::outcome::Verdict;
use crate::to_check::to_check;

/// What to measure next, in words, with the difference that the hypotheses then show over the noise.
pub(super) fn next_experiment(
    test: &ImpactTest,
    search: &Search,
    ranking: &Ranking,
    verdict: Verdict,
    rivals: &[usize],
) -> String {
    if verdict == Verdict::NothingMissing {
        return "none: the base model meets the records within their noise".to_owned();
    }
    if search.records.are_too_few() {
        return "hit each place three times, or hit three places: so far nothing can be left out to judge by"
            .to_owned();
    }
    if verdict == Verdict::Unexplained {
        let left = ranking.fits[ranking.chosen].chi_square(search.records).sqrt();
        return to_check(test, left);
    }
    let chosen = &ranking.fits[ranking.chosen];
    let is_cubic = |fit: &Fit| cubic(&fit.state.hypothesis, 0).is_some();
    let mut compared: Vec<usize> =
        if rivals.is_empty() { ranking.nearest().into_iter().collect() } else { rivals.to_vec() };
    // Springs that stiffen are surest seen at another strength, where every linear model answers as before: the base stands for these.
    if compared.is_empty() && is_cubic(chosen) && ranking.chosen > 0 {
        compared.push(0);
    }
    if compared.is_empty() {
        return "none: every other effect of the catalogue that could be tried stayed far behind".to_owned();
    }
    let sureness = if rivals.is_empty() { "to be surer still: " } else { "" };
    let others: Vec<&Fit> = compared.iter().map(|&index| &ranking.fits[index]).collect();
    // What is linear answers to harder hits alike, and places part springs that are not by their linear part only.
    let level_tells = others.iter().chain([&chosen]).any(|fit| is_cubic(fit));
    let further = if level_tells {
        harder::harder(search, chosen, &others)
    } else {
        places::places(test, search, chosen, &others)
    };
    let names: Vec<String> = others.iter().map(|fit| name(fit, search.declared())).collect();
    let proposal = in_words(&further, &name(chosen, search.declared()), &names);
    format!("{sureness}{proposal}")
}

/// A further measurement.
#[derive(Debug, Clone, PartialEq)]
struct Further {
    words: String,
    /// Rms difference of the chosen hypothesis from each rival, over the noise.
    apart: Vec<f64>,
}

impl Further {
    /// Position and difference of the rival that the chosen hypothesis differs the least from; `None` where one cannot be compared.
    fn least(&self) -> Option<(usize, f64)> {
        let all = self.apart.iter().copied().enumerate();
        self.apart.iter().all(|apart| apart.is_finite()).then(|| all.min_by(|a, b| a.1.total_cmp(&b.1)))?
    }
}

/// The further measurement whose least difference is the greatest.
fn in_words(further: &[Further], chosen: &str, rivals: &[String]) -> String {
    let least = further.iter().filter_map(|one| Some((one, one.least()?)));
    let best = least.max_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b));
    let Some((best, (from, apart))) = best else {
        return format!("{chosen} and {} cannot be compared by another place, mass or strength", rivals.join(", "));
    };
    let words = &best.words;
    match rivals {
        [rival] => {
            format!("{words}: there {chosen} and {rival} differ by {apart:.1} times the noise (rms over the lines)")
        }
        _ => format!(
            "{words}: there {chosen} differs from each of {} by {apart:.1} times the noise or more (rms over the lines), least from {}",
            rivals.join(", "),
            rivals.get(from).map_or("", String::as_str)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn further(words: &str, apart: &[f64]) -> Further {
        Further { words: words.to_owned(), apart: apart.to_vec() }
    }

    /// The first parts one rival best of all, and the other not at all.
    #[test]
    fn every_rival_is_to_be_parted() {
        let all = [
            further("one", &[90.0, 0.1]),
            further("two", &[6.0, 5.0]),
            further("three", &[4.0, 70.0]),
            further("four", &[100.0, f64::NAN]),
        ];
        let names = ["first".to_owned(), "second".to_owned()];
        let said = in_words(&all, "chosen", &names);
        assert!(said.starts_with("two: there chosen differs from each of first, second by 5.0 times"), "{said}");
        assert!(said.ends_with("least from second"), "{said}");
        let said = in_words(&[further("one", &[90.0]), further("two", &[6.0])], "chosen", &names[..1]);
        assert!(said.starts_with("one: there chosen and first differ by 90.0 times"), "{said}");
        assert!(in_words(&all[3..], "chosen", &names).contains("cannot be compared"));
    }
}

//! What damps the modes of a plate that no record shows.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::column::Column;
use super::kind::{Kind, least_quadrature};
use crate::comparison::OWN_DAMPING;
use crate::predicted::{Prediction, Predictor};

/// Part of the least error of a residue below which a mode of the plate is left out.
const LEAST: f64 = 0.1;

/// What the damping $c_m$ of each of the plate's own modes does beyond what is found of it: of those above the band nothing is measured. Where something
/// stands on the plate it couples its modes. With $V$ their shares in the modes $\phi_n$, $D_n(s) = s^2+sC_{nn}+\omega_n^2$ and
/// $\psi_m(s) = \sum_jV_{mj}\phi_j/D_j(s)$,
/// $$\delta H(s) = -s^3\,\delta c_m\,\psi_m\psi_m^T\ ,\qquad
/// \delta\phi_n = -\lambda_n\,\delta c_m\,V_{mn}\sum_{j\ne n}\frac{V_{mj}\phi_j}{D_j(\lambda_n)}\ .$$
/// $C_{nn}$ is measured, and its part is left out. Without coupling $\psi_m = \phi_m/D_m$, and modes that a pole belongs to have no part. The deviation of $c_m$ is the size, so that the column goes with the power zero of any.
pub(super) fn columns(predictor: &Predictor, at: &Prediction) -> Vec<Column> {
    let Some((channels, seen)) = &at.seen else { return vec![] };
    let (comparison, measured) = (predictor.comparison, predictor.comparison.measured);
    let partners = predictor.partners_of(at);
    let decay = channels.first().map_or(0.0, |channel| channel.decay);
    let (mut columns, mut uncoupled): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (vec![], vec![]);
    for (number, view) in seen.views.iter().enumerate() {
        let modes = &view.modes;
        let records: Vec<usize> =
            (0..measured.records.len()).filter(|record| seen.number_of(*record) == number).collect();
        let Some(coupled) = predictor.coupled(view, &partners, channels.first()) else {
            let usual = predictor.usual_damping(view, &partners, channels.first());
            for n in (0..view.near()).filter(|n| !predictor.hangs(*n) && !partners.contains(&Some(*n))) {
                let omega = modes.angular_frequency[n];
                let damping = 2.0 * usual * omega;
                let mut column = vec![0.0; comparison.size()];
                for &record in &records {
                    let channel = &channels[record];
                    let (_, [force, response]) = seen.of_record(record);
                    let product = modes.deflection[n][force] * modes.deflection[n][response];
                    for (line, frequency) in measured.remainder_frequencies.iter().enumerate() {
                        let s = Complex64::new(0.0, TAU * frequency) + channel.decay;
                        let answer = s * s + s * damping + omega * omega;
                        let value = -s.powi(3) * OWN_DAMPING * damping * product * channel.at(s) / (answer * answer);
                        comparison.put(&mut column, comparison.remainder_place(record, line), value);
                    }
                }
                uncoupled.push(column);
            }
            continue;
        };
        columns.resize(columns.len().max(coupled.deviations().len()), vec![0.0; comparison.size()]);
        let mut residues =
            vec![vec![vec![Complex64::ZERO; measured.poles.len()]; measured.records.len()]; columns.len()];
        for (pole, n) in partners.iter().enumerate().filter_map(|(pole, n)| Some((pole, (*n)?))) {
            let Some(lambda) = records.iter().find_map(|record| at.partners[*record][pole]).map(|own| own.pole) else {
                continue;
            };
            // A window shifts the poles of what is seen, not those of the plate.
            let lambda = lambda + decay;
            let [re, im] = coupled.seen_by_panel(modes, lambda, Some(n));
            for (m, deviation) in coupled.deviations().iter().enumerate() {
                let share = -lambda * *deviation * coupled.share(m, n);
                for &record in &records {
                    let Some(own) = at.partners[record][pole] else { continue };
                    let (_, ports) = seen.of_record(record);
                    let [force, response] = ports.map(|port| share * Complex64::new(re[(m, port)], im[(m, port)]));
                    residues[m][record][pole] = own.unit * (own.deflection[0] * response + force * own.deflection[1]);
                }
            }
        }
        let lines = measured.remainder_frequencies.iter().map(|frequency| Complex64::new(0.0, TAU * frequency));
        for (line, s) in lines.enumerate() {
            let of_plate = s + decay;
            let [re, im] = coupled.seen_by_panel(modes, of_plate, None);
            let squares: Vec<(usize, Complex64)> =
                partners.iter().flatten().map(|&n| (n, coupled.stiffness(modes, n, of_plate).powi(2).inv())).collect();
            for (m, deviation) in coupled.deviations().iter().enumerate() {
                for &record in &records {
                    let (_, ports) = seen.of_record(record);
                    let [force, response] = ports.map(|port| Complex64::new(re[(m, port)], im[(m, port)]));
                    // What changes the damping of a mode itself.
                    let own: Complex64 = squares
                        .iter()
                        .map(|&(n, square)| {
                            let [force, response] = ports.map(|port| modes.deflection[n][port]);
                            coupled.share(m, n).powi(2) * force * response * square
                        })
                        .sum();
                    let whole =
                        -of_plate.powi(3) * *deviation * (force * response - own) * channels[record].at(of_plate);
                    let apart = |(residue, own): (&Complex64, &Option<_>)| -> Option<Complex64> {
                        let own: &crate::predicted::PartnerInRecord = own.as_ref()?;
                        Some(residue / (s - own.pole) + residue.conj() / (s - own.pole.conj()))
                    };
                    let in_poles: Complex64 =
                        residues[m][record].iter().zip(&at.partners[record]).filter_map(apart).sum();
                    comparison.put(&mut columns[m], comparison.remainder_place(record, line), whole - in_poles);
                }
            }
        }
        for (column, residues) in columns.iter_mut().zip(&residues) {
            for &record in &records {
                for (pole, residue) in residues[record].iter().enumerate() {
                    comparison.put(column, comparison.residue_place(record, pole), *residue);
                }
            }
        }
    }
    let counts = |column: &Vec<f64>| {
        let largest = column.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        largest > LEAST * least_quadrature()
    };
    let told = columns.into_iter().chain(uncoupled).filter(counts);
    let sparse = |column: Vec<f64>| column.into_iter().enumerate().filter(|(_, value)| *value != 0.0).collect();
    told.map(|column| ((Kind::Quadrature as usize, 0), sparse(column))).collect()
}

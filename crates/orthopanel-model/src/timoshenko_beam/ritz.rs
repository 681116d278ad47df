//! The beam behind [`Structure`], on the Legendre strain basis.

use faer::Mat;

use super::beam_terms::{BeamTerms, ShearLoss};
use super::inertial_remainder::InertialRemainder;
use super::strain_basis::{Parity, StrainFunction, end_motions, steps, strain_functions};
use super::term_matrices::{Quadrature, series_products, support_stiffness};
use super::{BEAM_CONSTANTS, Section, StaticFlexibility};
use crate::legendre::legendre;
use crate::structure::{Block, Flexibility, Motion, Structure, TermDerivative};
use crate::{Boundary, Constant, ModelError, Piece, Place, SymmetricMatrix};

/// The beam of eq. 5 as a [`Structure`]: coefficients are $E_x$ and $G_{zx}$ themselves, with
/// $K_E = I\int\psi_i'\psi_j'dx$ and $K_G = k'A\int(w'+\psi)_i(w'+\psi)_jdx$.
///
/// Converges as fast as any power of the number of terms: with 60, the first 20 modes agree with [`crate::ExactBeam`]
/// to 1e-9. Where shear stiffness is lost over a span, functions that begin at its edges carry the strain's jumps.
#[derive(Debug, Clone)]
pub struct TimoshenkoBeam {
    half_length: f64,
    section: Section,
    terms: BeamTerms,
    functions: Vec<Vec<StrainFunction>>,
    blocks: Vec<Block>,
    flexibility: StaticFlexibility,
    inertia: InertialRemainder,
}

impl TimoshenkoBeam {
    /// A beam with `terms` Legendre terms (at least 4) of curvature and as many of shear strain.
    ///
    /// # Errors
    /// [`ModelError::Size`] where the piece has no physical meaning, [`ModelError::HeldSide`] where front or back is held.
    pub fn new(piece: &Piece, boundary: Boundary, terms: usize) -> Result<Self, ModelError> {
        Self::with_terms(piece, boundary, terms, BeamTerms::default())
    }

    /// A beam that is not even, or whose clamped ends yield: see [`BeamTerms`].
    ///
    /// Where supports yield, the springs add a third coefficient of fixed value 1. The parameters of
    /// [`Structure::term_derivatives`] stand in this order: the rotary factor; loss, span and place of each shear loss;
    /// translation and rotation stiffness of the supports; the waves of an uneven core. Span and place have no matrices: see
    /// [`TermDerivative`].
    ///
    /// # Errors
    /// [`ModelError::Size`] where a size, factor or stiffness has no physical meaning, [`ModelError::HeldSide`]
    /// where front or back is held.
    pub fn with_terms(piece: &Piece, boundary: Boundary, order: usize, terms: BeamTerms) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let boundary = boundary.of_beam()?;
        terms.check()?;
        let mut section = Section::of(&piece);
        section.rotary_inertia *= terms.rotary_factor;
        let half_length = 0.5 * piece.length;
        let mut functions = strain_functions(half_length, boundary, order.max(4));
        if terms.support.is_some() {
            functions.extend(end_motions(half_length, boundary));
        }
        functions
            .extend(terms.losses.iter().flat_map(|loss| steps(half_length, loss.edges(half_length), order.max(4))));
        let uneven = !terms.losses.is_empty() || !terms.core_waves.is_empty() || terms.support.is_some();
        let (mut even, mut odd, mut all) = (vec![], vec![], vec![]);
        for function in functions {
            match function.parity {
                _ if uneven => all.push(function),
                Parity::Even => even.push(function),
                Parity::Odd => odd.push(function),
                Parity::Neither => all.push(function),
            }
        }
        // By degree, so that functions stand near those that they meet, and rows of the matrices are short. Over spans
        // that have lost stiffness all strains of shear meet: they stay behind the curvatures, which do not.
        if !uneven {
            for block in [&mut even, &mut odd, &mut all] {
                block.sort_unstable_by_key(|function: &StrainFunction| function.deflection.len());
            }
        }
        let functions: Vec<_> = [even, odd, all].into_iter().filter(|block| !block.is_empty()).collect();
        let blocks = functions.iter().map(|block| assemble(block, section, half_length, &terms)).collect();
        let flexibility = StaticFlexibility::with_terms(&piece, boundary, &terms)?;
        let inertia = InertialRemainder::new(half_length, section, order.max(4), &terms.losses);
        Ok(Self { half_length, section, terms, functions, blocks, flexibility, inertia })
    }
}

/// $\sum_ic_iA_i$.
#[inline(never)] // As series_products.
fn sum(terms: &[(f64, &SymmetricMatrix)]) -> SymmetricMatrix {
    SymmetricMatrix::sum(terms.iter().copied(), terms.first().map_or(0, |(_, matrix)| matrix.nrows()))
}

fn assemble(functions: &[StrainFunction], section: Section, half_length: f64, terms: &BeamTerms) -> Block {
    let size = functions.len();
    let Section { second_moment, shear_area, mass, rotary_inertia } = section;
    let curvature = series_products(functions, half_length, |f| &f.curvature).into();
    let rotation = series_products(functions, half_length, |f| &f.rotation).into();
    let (strain, deflection) = if terms.losses.is_empty() && terms.core_waves.is_empty() {
        let strain = series_products(functions, half_length, |f| &f.shear);
        (strain.into(), series_products(functions, half_length, |f| &f.deflection).into())
    } else {
        let quadrature = Quadrature::new(functions, half_length, terms);
        let mut strain = SymmetricMatrix::from(quadrature.shear());
        for loss in &terms.losses {
            strain = sum(&[(1.0, &strain), (-loss.loss, &quadrature.span(loss).into())]);
        }
        for (amplitude, wave) in terms.core_waves.iter().zip(quadrature.waves(terms.core_waves.len())) {
            strain = sum(&[(1.0, &strain), (*amplitude, &wave.into())]);
        }
        (strain, quadrature.deflection().into())
    };
    let mass = sum(&[(mass, &deflection), (rotary_inertia, &rotation)]);
    let mut stiffness = vec![sum(&[(second_moment, &curvature)]), sum(&[(shear_area, &strain)])];
    if let Some(support) = terms.support {
        stiffness.push(support_stiffness(functions, [support.translation, support.rotation]).into());
    }
    let strainless = |f: &StrainFunction| {
        f.step.is_none() && terms.support.is_none() && f.curvature.iter().chain(&f.shear).all(|&value| value == 0.0)
    };
    let rigid = (0..size)
        .filter(|&i| strainless(&functions[i]))
        .map(|i| {
            let scale = mass[(i, i)].sqrt().recip();
            (0..size).map(|j| if i == j { scale } else { 0.0 }).collect()
        })
        .collect();
    Block { stiffness, mass, rigid }
}

impl Structure for TimoshenkoBeam {
    fn constants(&self) -> &'static [Constant] {
        &BEAM_CONSTANTS
    }

    fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let springs = self.terms.support.map(|_| 1.0);
        Ok(values.iter().copied().chain(springs).collect())
    }

    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError> {
        let springs = usize::from(self.terms.support.is_some());
        Ok(Mat::identity(values.len() + springs, values.len()))
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    fn shape_row(&self, block: usize, place: Place) -> Vec<f64> {
        self.motion_row(block, Motion::Deflection, place).unwrap_or_default()
    }

    fn motion_row(&self, block: usize, motion: Motion, place: Place) -> Option<Vec<f64>> {
        let functions = self.functions.get(block)?;
        let terms = functions.iter().map(|f| f.deflection.len()).max().unwrap_or(0);
        let t = place.x / self.half_length;
        let polynomials = legendre(terms, t);
        Some(functions.iter().map(|f| f.at(motion, t, &polynomials, self.half_length)).collect())
    }

    fn static_flexibility(&self, values: &[f64], motions: [(Motion, Place); 2]) -> Option<Flexibility> {
        let [&e_x, &g_zx] = [values.first()?, values.get(1)?];
        let parts = self.flexibility.between_motions(motions.map(|(motion, place)| (motion, place.x)), [e_x, g_zx]);
        let known = parts.by_losses.into_iter().flat_map(|by| [Some(by), None, None]);
        let support = self.terms.support.map(|_| parts.by_support).into_iter().flatten();
        let waves = parts.by_waves.into_iter().map(Some);
        Some(Flexibility {
            value: parts.value,
            by_constants: parts.by_constants.to_vec(),
            // Rotary inertia alters the field that a free beam's own inertia balances.
            by_terms: std::iter::once(None).chain(known).chain(support.map(Some)).chain(waves).collect(),
        })
    }

    fn inertial_remainders(&self, values: &[f64], rows: &[(Motion, Place)], columns: usize) -> Vec<Flexibility> {
        let Some(g_zx) = values.get(1) else { return vec![] };
        let rows: Vec<_> = rows.iter().map(|(motion, place)| self.inertia.unheld(*motion, place.x)).collect();
        let pairs = rows.iter().flat_map(|a| rows.iter().take(columns).map(move |b| (a, b)));
        let pairs = pairs.map(|(a, b)| {
            let value = self.inertia.between(a, b) / (g_zx * g_zx);
            // It goes with the flexibility at both places; the rotary inertia and supports have no part in it.
            let by_loss = |loss: &ShearLoss| {
                let inside = [a, b].into_iter().filter(|row| loss.holds(row.at, self.half_length)).count();
                value * inside as f64 / (1.0 - loss.loss)
            };
            let by_losses = self.terms.losses.iter().flat_map(|loss| [Some(by_loss(loss)), None, None]);
            let by_terms = std::iter::once(None).chain(by_losses).collect();
            Flexibility { value, by_constants: vec![0.0, -2.0 * value / g_zx], by_terms }
        });
        pairs.collect()
    }

    fn term_derivatives(&self, values: &[f64]) -> Vec<TermDerivative> {
        let shear = values.get(1).copied().unwrap_or_default() * self.section.shear_area;
        let of_stiffness = |matrices: Vec<Mat<f64>>| TermDerivative { stiffness: matrices, mass: vec![] };
        let even_inertia = self.section.rotary_inertia / self.terms.rotary_factor;
        let by_rotary = |functions: &Vec<StrainFunction>| {
            faer::Scale(even_inertia) * series_products(functions, self.half_length, |f| &f.rotation)
        };
        let mut list = vec![TermDerivative { stiffness: vec![], mass: self.functions.iter().map(by_rotary).collect() }];
        for loss in &self.terms.losses {
            let by_loss = |functions: &Vec<StrainFunction>| {
                faer::Scale(-shear) * Quadrature::new(functions, self.half_length, &self.terms).span(loss)
            };
            list.push(of_stiffness(self.functions.iter().map(by_loss).collect()));
            // With span and place the edges move, and with them the functions that begin there.
            list.extend([of_stiffness(vec![]), of_stiffness(vec![])]);
        }
        if self.terms.support.is_some() {
            for springs in [[1.0, 0.0], [0.0, 1.0]] {
                let matrices = self.functions.iter().map(|functions| support_stiffness(functions, springs));
                list.push(of_stiffness(matrices.collect()));
            }
        }
        let count = self.terms.core_waves.len();
        if count > 0 {
            let waves = |functions: &Vec<StrainFunction>| {
                Quadrature::new(functions, self.half_length, &self.terms).waves(count).into_iter()
            };
            let mut blocks: Vec<_> = self.functions.iter().map(waves).collect();
            list.extend((0..count).map(|_| {
                let of_blocks = blocks.iter_mut().filter_map(Iterator::next);
                of_stiffness(of_blocks.map(|wave| faer::Scale(shear) * wave).collect())
            }));
        }
        list
    }
}

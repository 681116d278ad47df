//! An even beam as effects modify it: its exact modes, and what all further modes do under forces that stand still.
//!
//! A force at a place bends the beam to a static shape. With the modes and these shapes, less what the modes hold of them, as coordinates,
//! stiffness and mass are $\mathrm{diag}(\omega_m^2)\oplus C_0$ and $I\oplus C_1$ (Rubin, AIAA J. 13 (1975) 995),
//! $$C_0 = \int\frac{M_pM_q}{E_xI}+\frac{V_pV_q}{k'G_{zx}A}\,dx - \sum_m\frac{\phi_m(p)\phi_m(q)}{\omega_m^2},\qquad
//! C_1 = \int\rho A\,w_pw_q+\rho I\,\psi_p\psi_q\,dx - \sum_m\frac{\phi_m(p)\phi_m(q)}{\omega_m^4}.$$
//! Where shear stiffness is lost over a span, the strain jumps at its edges: the static shapes of strains $P_k$ of Legendre in
//! the span join the coordinates, and $-\text{loss}\,k'G_{zx}A\int\gamma\gamma^T dx$ over the span joins the stiffness. What an element or a
//! strain brings is answered by inertia once more, $K^{-1}MK^{-1}f$.

use faer::Mat;

use super::low_modes::LowModes;
use super::row::Row;
use crate::structure::Motion;
use crate::timoshenko_beam::{BeamMode, ExactBeam, Grid, Section, StaticShape, StaticShapes};
use crate::{BeamConstants, BeamTerms, Boundary, ModelError, Piece, ShearLoss};

/// Flexible modes that leave a shape point by point: as parts of integrals, they would leave rounding of what lies beyond them.
const LOWEST: usize = 6;
/// Strains of a loss whose inertia is answered.
const ANSWERED: usize = 6;

/// An even beam at some values of its constants.
#[derive(Debug)]
pub(super) struct BeamBase {
    pub modes: Vec<BeamMode>,
    pub low: LowModes,
    statics: StaticShapes,
}

/// A beam in coordinates of its modes and of static shapes beyond them.
pub(super) struct InShapes {
    /// Values of the modes in the rows that were asked for: a row a mode.
    pub near: Mat<f64>,
    /// Values of the shapes in these rows: a row a shape.
    pub far: Mat<f64>,
    /// Between the shapes, which the modes are orthogonal to.
    pub stiffness: Mat<f64>,
    /// Alike.
    pub mass: Mat<f64>,
    /// Taken from the stiffness of modes and shapes; none without a loss.
    pub lost: Option<Mat<f64>>,
}

/// Static shapes of a base on a grid, less what the lowest modes hold of them.
struct Shapes<'a> {
    base: &'a BeamBase,
    grid: &'a Grid,
    /// The lowest modes at the points: deflection, rotation, curvature and strain.
    lowest: Vec<[Vec<f64>; 4]>,
    all: Vec<StaticShape>,
    /// Of each shape its shares of all modes; those of the lowest have left it.
    shares: Vec<Vec<f64>>,
}

/// A field of a shape, with what it weighs in an energy.
struct Energy(f64, fn(&StaticShape) -> &Vec<f64>);

impl BeamBase {
    /// On the rigid modes and the first `count` flexible ones, with this factor on the rotary inertia.
    ///
    /// # Errors
    /// As [`ExactBeam::new`], and as [`BeamTerms::check`].
    pub(super) fn new(
        (piece, boundary): (&Piece, Boundary),
        [e_x, g_zx]: [f64; 2],
        rotary_factor: f64,
        count: usize,
    ) -> Result<Self, ModelError> {
        let terms = BeamTerms { rotary_factor, ..BeamTerms::default() };
        terms.check()?;
        let beam = ExactBeam::new(piece, boundary, BeamConstants { e_x, g_zx })?.with_rotary_factor(rotary_factor);
        let modes = beam.modes(count);
        let rigid = modes.iter().take_while(|mode| mode.angular_frequency() == 0.0).count();
        let statics = StaticShapes::new((piece, boundary), [e_x, g_zx], &terms, &modes[..rigid])?;
        let low = modes.iter().map(|mode| (0, vec![], mode.angular_frequency().powi(2))).collect();
        Ok(Self { modes, low: LowModes::sorted(low, rigid), statics })
    }

    /// With losses of shear stiffness, seen in `rows`, the first of which belong to elements and then to ports: these bring shapes, and follow a
    /// deflection or a rotation.
    pub(super) fn in_shapes(&self, rows: &[Row], (elements, ports): (usize, usize), losses: &[ShearLoss]) -> InShapes {
        let h = self.statics.half_length;
        // No zero below zero: places are looked up.
        let rows: Vec<(Motion, f64)> = rows.iter().map(|row| (row.0, row.1.x.clamp(-h, h) + 0.0)).collect();
        let grid = self.statics.grid(rows.iter().map(|row| row.1), losses);
        let on = self.statics.on(&grid);
        let near = Mat::from_fn(self.modes.len(), rows.len(), |m, number| self.modes[m].motion(rows[number]));
        let mut shapes = Shapes::new(self, &grid);
        for (number, row) in rows[..elements + ports].iter().enumerate() {
            let shape = shapes.add(on.under(*row), |m| near[(m, number)], 1);
            if number < elements {
                let answer = on.under_inertia(&shapes.all[shape]);
                shapes.add(answer, |m| near[(m, number)], 2);
            }
        }
        let strained: Vec<usize> =
            (0..grid.points.len()).filter(|&i| losses.iter().any(|loss| loss.holds(grid.points[i].0, h))).collect();
        let mut mode_strains = Mat::<f64>::zeros(grid.points.len(), self.modes.len());
        for (m, mode) in self.modes.iter().enumerate() {
            strained.iter().for_each(|&point| mode_strains[(point, m)] = mode.field(grid.points[point].0)[3]);
        }
        for (number, strain) in losses.iter().flat_map(|loss| self.statics.strains(loss, &grid).into_iter().enumerate())
        {
            let of_mode = |m: usize| -> f64 {
                let work = |&(point, value): &(usize, f64)| value * grid.points[point].1 * mode_strains[(point, m)];
                strain.iter().map(work).sum()
            };
            let shape = shapes.add(on.strained(&strain), of_mode, 1);
            if number < ANSWERED {
                let answer = on.under_inertia(&shapes.all[shape]);
                shapes.add(answer, of_mode, 2);
            }
        }
        let Section { mass, rotary_inertia, .. } = self.statics.section;
        let [bending, shear] = self.statics.stiffness;
        let lambda = |m: usize| self.low.modes[m].2;
        let energies = [Energy(bending, |shape| &shape.curvature), Energy(shear, |shape| &shape.strain)];
        let stiffness = shapes.between(&energies, lambda);
        let inertias = [Energy(mass, |shape| &shape.deflection), Energy(rotary_inertia, |shape| &shape.rotation)];
        let lost = |x: f64| shear * losses.iter().filter(|loss| loss.holds(x, h)).map(|loss| loss.loss).sum::<f64>();
        InShapes {
            far: shapes.seen(&rows, &near),
            near,
            stiffness,
            mass: shapes.between(&inertias, |_| 1.0),
            lost: (!losses.is_empty()).then(|| shapes.shear(&strained, &mode_strains, lost)),
        }
    }
}

impl<'a> Shapes<'a> {
    fn new(base: &'a BeamBase, grid: &'a Grid) -> Self {
        let mode = |mode: &BeamMode| {
            let mut fields = [(); 4].map(|()| Vec::with_capacity(grid.points.len()));
            for (x, _) in &grid.points {
                fields.iter_mut().zip(mode.field(*x)).for_each(|(field, value)| field.push(value));
            }
            fields
        };
        let lowest = base.modes.iter().take(base.low.rigid + LOWEST).map(mode).collect();
        Self { base, grid, lowest, all: vec![], shares: vec![] }
    }

    /// Adds a shape that a load brings which does `of_mode` work on each mode: at first, or by inertia once more. Returns its number.
    fn add(&mut self, mut shape: StaticShape, of_mode: impl Fn(usize) -> f64, order: i32) -> usize {
        let low = &self.base.low;
        // What inertia answers has none of the lowest modes any more.
        let from = if order == 1 { low.rigid } else { self.lowest.len() };
        let share = |m: usize| if m < from { 0.0 } else { of_mode(m) * low.modes[m].2.powi(-order) };
        let shares: Vec<f64> = (0..low.modes.len()).map(share).collect();
        self.lowest.iter().zip(&shares).skip(from).for_each(|(mode, share)| shape.take(*share, mode));
        self.all.push(shape);
        self.shares.push(shares);
        self.all.len() - 1
    }

    /// Shares of the modes that are still in the shapes, a column a shape.
    fn shares_left(&self) -> Mat<f64> {
        let (modes, lowest) = (self.base.modes.len(), self.lowest.len());
        Mat::from_fn(modes, self.all.len(), |m, q| if m < lowest { 0.0 } else { self.shares[q][m] })
    }

    /// What some rows see of the shapes, less their modes: a row a shape.
    fn seen(&self, rows: &[(Motion, f64)], near: &Mat<f64>) -> Mat<f64> {
        let shares = Mat::from_fn(self.all.len(), self.base.modes.len(), |q, m| self.shares[q][m]);
        let of_modes = shares * near;
        Mat::from_fn(self.all.len(), rows.len(), |q, p| self.grid.seen(&self.all[q], rows[p]) - of_modes[(q, p)])
    }

    /// An energy between the shapes, less that of their modes.
    fn between(&self, energies: &[Energy], of_mode: impl Fn(usize) -> f64) -> Mat<f64> {
        let (points, count) = (&self.grid.points, self.all.len());
        let mut sum = Mat::<f64>::zeros(count, count);
        for Energy(factor, field) in energies {
            let own = Mat::from_fn(points.len(), count, |i, q| field(&self.all[q])[i]);
            let weighted = Mat::from_fn(points.len(), count, |i, q| factor * points[i].1 * own[(i, q)]);
            sum += own.transpose() * weighted;
        }
        let shares = self.shares_left();
        let weighted = Mat::from_fn(shares.nrows(), count, |m, q| of_mode(m) * shares[(m, q)]);
        sum - shares.transpose() * weighted
    }

    /// $\int k\,\gamma\gamma^Tdx$ over some points, of the modes and of the shapes less their modes.
    fn shear(&self, over: &[usize], mode_strains: &Mat<f64>, stiffness: impl Fn(f64) -> f64) -> Mat<f64> {
        let size = self.base.modes.len();
        let of_modes = mode_strains * self.shares_left();
        let all = Mat::from_fn(over.len(), size + self.all.len(), |i, column| match column.checked_sub(size) {
            None => mode_strains[(over[i], column)],
            Some(q) => self.all[q].strain[over[i]] - of_modes[(over[i], q)],
        });
        let weighted = Mat::from_fn(all.nrows(), all.ncols(), |i, column| {
            let (x, weight) = self.grid.points[over[i]];
            stiffness(x) * weight * all[(i, column)]
        });
        all.transpose() * weighted
    }
}

//! The test piece and places on it.

use serde::{Deserialize, Serialize};

use crate::{ModelError, limits};

/// A rectangular test piece: length $a$ along x, width $b$ along y, thickness $t$, mass per area $\rho t$.
///
/// The origin is the centre of the piece, as in the paper (figure 2), so $|x| \le a/2$ and $|y| \le b/2$.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Length $a$ \[m\], along x.
    pub length: f64,
    /// Width $b$ \[m\], along y.
    pub width: f64,
    /// Thickness $t$ \[m\].
    pub thickness: f64,
    /// Mass per area $\rho t$ \[kg/m²\].
    pub mass_per_area: f64,
}

/// A place on the piece \[m\], measured from its centre; in files `[x, y]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Place {
    /// Along the length.
    pub x: f64,
    /// Across the width.
    pub y: f64,
}

impl Place {
    /// So far along x and along y from here \[m\].
    pub fn moved(self, [x, y]: [f64; 2]) -> Self {
        Self { x: self.x + x, y: self.y + y }
    }
}

impl From<[f64; 2]> for Place {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y }
    }
}

impl From<Place> for [f64; 2] {
    fn from(place: Place) -> Self {
        [place.x, place.y]
    }
}

/// Densities of solids \[kg/m³\]: no foam is lighter, no metal heavier. Between are all panels; one in centimetres or
/// millimetres is not.
const LIGHTEST: f64 = 5.0;
const HEAVIEST: f64 = 23_000.0;

impl Piece {
    /// Checks that thickness and mass per area make a solid: sizes in millimetres do not.
    ///
    /// # Errors
    /// [`ModelError::Density`] with both and the density that they make.
    pub fn solid(self) -> Result<Self, ModelError> {
        let Self { thickness, mass_per_area, .. } = self;
        let density = mass_per_area / thickness;
        if (LIGHTEST..HEAVIEST).contains(&density) {
            Ok(self)
        } else {
            Err(ModelError::Density { thickness, mass_per_area, density, lightest: LIGHTEST, heaviest: HEAVIEST })
        }
    }

    /// Checks that every size is finite, greater than zero and one that a piece may have ([`limits`]).
    ///
    /// # Errors
    /// [`ModelError::Size`] and [`ModelError::SizeRange`] name the first size that is not.
    pub fn checked(self) -> Result<Self, ModelError> {
        let sizes = [
            ("length", self.length, "m", limits::SIZE),
            ("width", self.width, "m", limits::SIZE),
            ("thickness", self.thickness, "m", limits::SIZE),
            ("mass_per_area", self.mass_per_area, "kg/m2", limits::MASS_PER_AREA),
        ];
        for (name, value, unit, [low, high]) in sizes {
            if !(value.is_finite() && value > 0.0) {
                return Err(ModelError::Size { name, value, unit });
            }
            if !(low..=high).contains(&value) {
                return Err(ModelError::SizeRange { name, value, unit, low, high });
            }
        }
        Ok(self)
    }

    /// Between which frequencies \[Hz\] a flexible mode with at most so many nodal lines along x and along y lies, whatever the
    /// moduli within [`limits::MODULUS`] and however the edges are held.
    ///
    /// At least a tenth of that of a cantilever as long as the longer side, $\frac{3.516}{2\pi}\frac t{a^2}\sqrt{E/12\rho}$, of the
    /// softest: a tenth, for masses that a mode carries. At most that of a thin plate of the stiffest,
    /// $\frac{\pi}{2}\left(\frac{(n_x+2)^2}{a^2}+\frac{(n_y+2)^2}{b^2}\right)\sqrt{\frac{Et^2}{12\rho(1-\nu^2)}}$ with $\nu = 0.95$: two
    /// half-waves more than nodes, for edges that are clamped; shear and rotary inertia lower every mode.
    pub fn possible_frequencies(&self, nodes: [u32; 2]) -> (f64, f64) {
        const NU: f64 = 0.95;
        let [softest, stiffest] = limits::MODULUS;
        // sqrt(D / rho t) but for Poisson's ratio [m2/s].
        let bending = |modulus: f64| self.thickness * (modulus * self.thickness / (12.0 * self.mass_per_area)).sqrt();
        let waves = |nodes: u32, size: f64| ((f64::from(nodes) + 2.0) / size).powi(2);
        let both = waves(nodes[0], self.length) + waves(nodes[1], self.width);
        let least = 0.1 * 3.516 / std::f64::consts::TAU * bending(softest) / self.length.max(self.width).powi(2);
        let most = std::f64::consts::FRAC_PI_2 * both * bending(stiffest) / (1.0 - NU * NU).sqrt();
        (least, most)
    }

    /// Checks that `place` lies on the piece, its edges included.
    ///
    /// # Errors
    /// [`ModelError::OffPiece`] with the place and the limits.
    pub fn contains(&self, place: Place) -> Result<(), ModelError> {
        // A place typed as a decimal may miss the edge by rounding alone.
        let slack = 1e-12 * self.length;
        let (x_limit, y_limit) = (self.length / 2.0, self.width / 2.0);
        if place.x.abs() <= x_limit + slack && place.y.abs() <= y_limit + slack {
            Ok(())
        } else {
            Err(ModelError::OffPiece { x: place.x, y: place.y, x_limit, y_limit })
        }
    }

    /// Mass of the piece $\rho t\,a\,b$ \[kg\].
    pub fn mass(&self) -> f64 {
        self.mass_per_area * self.length * self.width
    }
}

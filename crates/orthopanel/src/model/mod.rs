//! A panel's model (`orthopanel.model/1`): what an identification leaves and an FMU is made of.

mod fmu;
mod shapes;
mod state_space;

use std::path::Path;

use orthopanel_data::limits;
use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

use crate::driving_force::DrivingForce;
use crate::error::InFile as _;
use crate::given_file::{self, Wanted};
use crate::measured_pairs::is_test_file;
use crate::motion::Motion;
use crate::time_response;
use crate::whole_accelerance::WholeAccelerance;
use crate::{Error, Observer, Steps, importer};
pub use fmu::is_fmu_name;
pub use state_space::StateSpace;

/// A model of one panel.
///
/// # Examples
/// ```
/// use orthopanel::{Model, Place};
///
/// let model = Model::load("../../examples/plate.json")?;
/// let (force, response) = (Place { x: -0.3, y: 0.0 }, Place { x: 0.3, y: 0.0 });
/// let lines = model.accelerance(&[10.0, 100.0], force, response)?;
/// assert_eq!(lines.len(), 2);
/// # Ok::<(), orthopanel::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    panel: PanelModel,
    name: std::path::PathBuf,
}

impl Model {
    /// Reads a model file.
    ///
    /// # Errors
    /// [`Error::Unreadable`], [`Error::Model`] with the key, and [`Error::OtherKind`] for a file that is something else.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let of_other_kind =
            |given, taken| Err(Error::OtherKind { path: path.into(), given, wanted: "a model file (JSON)", taken });
        if importer::is_fmu(path)? {
            return of_other_kind("an FMU", "name the one that the FMU was made from".into());
        }
        if is_test_file(path) {
            let taken = format!("`orthopanel identify {} -o model.json` makes one of it", path.display());
            return of_other_kind("a test file", taken);
        }
        let text = limits::MODEL_FILE.read_text(path);
        let text = text.map_err(|source| Error::Unreadable { path: path.into(), source });
        let model = text.and_then(|text| PanelModel::from_json(&text).in_file(path));
        let panel = model.map_err(|refused| given_file::or_kind_of(path, Wanted::Model, refused))?;
        Ok(Self { panel, name: path.into() })
    }

    /// Reads the text of a model file; `name` stands for it in messages.
    ///
    /// # Errors
    /// [`Error::Model`] with the key.
    pub fn from_json(text: &str, name: impl AsRef<Path>) -> Result<Self, Error> {
        let name = name.as_ref();
        Ok(Self { panel: PanelModel::from_json(text).in_file(name)?, name: name.into() })
    }

    /// A model; `name` stands for its file in messages.
    pub fn of(panel: PanelModel, name: impl AsRef<Path>) -> Self {
        Self { panel, name: name.as_ref().into() }
    }

    /// Sizes, constants, damping, effects, ports and provenance.
    pub fn panel(&self) -> &PanelModel {
        &self.panel
    }

    /// As it is named in messages.
    pub fn name(&self) -> &Path {
        &self.name
    }

    /// The text of its file.
    pub fn to_json(&self) -> String {
        self.panel.to_json()
    }

    /// Its motion at the responses of `ports`, from rest, under a force history at the forces of `ports`: one [`Motion`] a response.
    ///
    /// # Errors
    /// [`Error::Model`].
    #[doc(hidden)]
    pub fn simulate(
        &self,
        force: &DrivingForce,
        ports: &Ports,
        range: ModeRange,
        observer: &dyn Observer,
    ) -> Result<Vec<Motion>, Error> {
        let _shown = observer.begin("driving the model", Steps::Unknown);
        let seen = time_response::seen(&self.panel, range, ports).in_file(&self.name)?;
        time_response::simulate(&seen.modes, force).in_file(&self.name)
    }

    /// So many models, with constants and damping ratios drawn by their standard deviations and correlation; one seed gives the same draws.
    ///
    /// # Errors
    /// [`Error::Model`] for values so far outside their bounds that no draw lies within.
    ///
    /// # Examples
    /// ```
    /// let fit = orthopanel::Test::load("../../examples/piece-1/test.toml")?.identify()?;
    /// let draws = fit.models()[0].sample(3, 0)?;
    /// assert_eq!(draws.len(), 3);
    /// assert_ne!(draws[0], draws[1]);
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn sample(&self, count: usize, seed: u64) -> Result<Vec<Self>, Error> {
        let drawn = self.panel.draws(count, seed).in_file(&self.name)?;
        Ok(drawn.into_iter().map(|panel| Self::of(panel, &self.name)).collect())
    }

    /// Acceleration per force \[(m/s²)/N\] at each of the frequencies \[Hz\], for $e^{+j\omega t}$: that of all modes together.
    ///
    /// # Errors
    /// [`Error::Model`], as for a place that is not on the piece.
    pub fn accelerance(
        &self,
        frequencies: &[f64],
        force: Place,
        response: Place,
    ) -> Result<Vec<num_complex::Complex64>, Error> {
        self.accelerance_of_modes(frequencies, [force, response], None)
    }

    /// As [`Model::accelerance`], with the flexible modes of `range` summed one by one, and all beyond by their static flexibility.
    ///
    /// # Errors
    /// As [`Model::accelerance`].
    pub fn accelerance_of_modes(
        &self,
        frequencies: &[f64],
        [force, response]: [Place; 2],
        range: Option<ModeRange>,
    ) -> Result<Vec<num_complex::Complex64>, Error> {
        [force, response].into_iter().try_for_each(|place| self.panel.piece.contains(place)).in_file(&self.name)?;
        let highest = frequencies.iter().copied().fold(0.0, f64::max);
        let seen = match range {
            Some(range) => WholeAccelerance::of(&self.panel, range, force, response),
            None => WholeAccelerance::up_to(&self.panel, highest, force, response),
        };
        let seen = seen.in_file(&self.name)?;
        let value = |&frequency: &f64| {
            let (re, im) = seen.at(frequency);
            num_complex::Complex64::new(re, im)
        };
        Ok(frequencies.iter().map(value).collect())
    }
}

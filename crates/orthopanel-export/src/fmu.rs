//! [`Fmu`]: all parts of one FMU, ready to be written.

use std::io::Write;
use std::path::Path;

use orthopanel_fmu::{FmuError, PortNames, RESOURCE_FILE, Resource, VariableTable, content_token};
use orthopanel_model::{CoreFit, ModalModel, ModeRange, PanelModel, Ports, is_identifier};

use crate::acceleration_band::AccelerationBands;
use crate::archive::{Entry, pack};
use crate::origin::Origin;
use crate::reference::Reference;
use crate::{ExportError, frequency_doubt, library, model_description, terminals};
use crate::{FmiVersion, FmuOptions, documentation};

const ICON_PNG: &[u8] = include_bytes!("../icons/panel.png");
const ICON_SVG: &[u8] = include_bytes!("../icons/panel.svg");

/// Licences of all that is linked into the libraries (`.ci/licenses.py`); both versions of the standard want them here.
const LICENSES: [(&str, &str); 2] = [
    ("documentation/licenses/license.txt", include_str!("../licenses/license.txt")),
    ("documentation/licenses/rust-standard-library.html", include_str!("../licenses/rust-standard-library.html")),
];

/// What modes an FMU has.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuModes {
    /// Without strain, by themselves, before mounts hold them.
    pub rigid: usize,
    /// Flexible ones of the panel that are kept.
    pub flexible: usize,
    /// The highest frequency kept \[Hz\]; beside a core the end of the band in which it is fitted.
    pub highest_hz: f64,
    /// Frequencies of the residual modes \[Hz\].
    pub residual_hz: Vec<f64>,
    /// How a core's modulus is fitted, where one relaxes.
    pub core: Option<CoreFit>,
}

impl FmuModes {
    fn of(resource: &Resource, alone: &ModalModel, core: Option<CoreFit>) -> Self {
        let mut hz: Vec<f64> =
            alone.modes().iter().map(|mode| mode.angular_frequency / std::f64::consts::TAU).collect();
        let residual_hz = hz.split_off(hz.len() - resource.residual_modes());
        let rigid = hz.iter().filter(|frequency| **frequency == 0.0).count();
        // Beyond a core's band are its internal variables' own.
        let highest_hz = core.as_ref().map_or_else(|| hz.last().copied().unwrap_or(0.0), |fit| fit.band[1]);
        Self { rigid, flexible: resource.flexible_modes(), highest_hz, residual_hz, core }
    }
}

/// An FMU of a modal model, for co-simulation and model exchange.
///
/// The same model, ports and options give the same bytes, token included.
///
/// ```
/// use orthopanel_export::{Fmu, FmuOptions};
/// use orthopanel_model::{ModalModel, Mode, Place, Ports};
///
/// let mode = Mode { angular_frequency: 2000.0, damping_ratio: 0.01, at_forces: vec![1.3], at_responses: vec![-0.9] };
/// let model = ModalModel::new(1, 1, vec![mode])?;
/// let ports = Ports { forces: vec![Place { x: -0.3, y: 0.0 }], responses: vec![Place { x: 0.3, y: 0.0 }] };
/// let fmu = Fmu::new(model, ports, &FmuOptions::default())?;
/// assert!(fmu.model_description().contains("acceleration_1"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fmu {
    pub(crate) name: String,
    pub(crate) table: VariableTable,
    /// Step and stop time \[s\].
    pub(crate) experiment: (f64, f64),
    modes: FmuModes,
    /// As scalars, and how it is written.
    pub(crate) resource_in_scalars: Resource,
    pub(crate) options: FmuOptions,
    model_description: String,
    resource: String,
    documentation: String,
    pub(crate) reference: Reference,
    terminals: String,
    libraries: Vec<(String, Vec<u8>)>,
}

impl Fmu {
    /// Puts the parts together; nothing is written yet. In the FMU nothing of the panel can be set, and of the options' connections there
    /// are none.
    ///
    /// # Errors
    /// [`ExportError::NoPort`], [`ExportError::Name`], and [`ExportError::Resource`] where `ports` has other numbers
    /// of places than `model` has ports.
    pub fn new(model: ModalModel, ports: Ports, options: &FmuOptions) -> Result<Self, ExportError> {
        check(&ports, options)?;
        Self::of_resource(Resource::new(model, ports)?, None, options)
    }

    /// Puts together the FMU of a panel with the modes of `range`: their number is fixed, all else (sizes, mass,
    /// constants, damping ratios, places of the ports) can be set in the FMU, which then solves its modes anew.
    /// For the modes left out stand the residual modes of the forces, unless the options leave them out. Effects of the panel are in the modes, a viscoelastic
    /// core by internal variables, with the error of its fit in the documentation; those of rig and measuring chain are left
    /// out.
    ///
    /// # Errors
    /// As [`Fmu::new`], and [`ExportError::Resource`] where the panel cannot be solved.
    pub fn of_panel(
        panel: &PanelModel,
        range: ModeRange,
        ports: Ports,
        options: &FmuOptions,
    ) -> Result<Self, ExportError> {
        check(&ports, options)?;
        let (alone, _) = panel.panel_alone().map_err(FmuError::from)?;
        let (resource, core) = Resource::of_panel(&alone, range, ports, options.residual, options.connections.clone())?;
        let bands = AccelerationBands::of(&alone, &resource).map_err(FmuError::from)?;
        let doubt = frequency_doubt::of(&alone, resource.flexible_modes()).map_err(FmuError::from)?;
        Self::of_resource(resource, Some(Origin { panel, core, bands, doubt }), options)
    }

    fn of_resource(resource: Resource, origin: Option<Origin<'_>>, options: &FmuOptions) -> Result<Self, ExportError> {
        let resource_in_scalars = resource.with_names(options.names.clone())?;
        let resource = resource_in_scalars.clone();
        let resource = &if options.arrays { resource.in_arrays() } else { resource };
        let text = resource.to_json();
        let token = content_token(text.as_bytes());
        let experiment = model_description::experiment(resource);
        let alone = resource.panel_alone().map_err(FmuError::from)?;
        Ok(Self {
            name: options.name.clone(),
            table: resource.variables(),
            experiment,
            modes: FmuModes::of(resource, &alone, origin.as_ref().and_then(|origin| origin.core.clone())),
            model_description: model_description::write(resource, options, &token)?,
            documentation: documentation::write(resource, &alone, origin.as_ref(), options),
            reference: Reference::of(resource, experiment.0).map_err(FmuError::from)?,
            terminals: terminals::write(resource)?,
            libraries: library::all(options.version, &options.name, &options.libraries)?,
            resource: text,
            resource_in_scalars,
            options: options.clone(),
        })
    }

    /// What modes it has.
    pub fn modes(&self) -> &FmuModes {
        &self.modes
    }

    /// Text of `modelDescription.xml`.
    pub fn model_description(&self) -> &str {
        &self.model_description
    }

    /// Bytes of the archive.
    ///
    /// # Errors
    /// [`ExportError::Assemble`], should the archive not take an entry.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ExportError> {
        let text = |path: &str, content| Entry { path: path.into(), content, executable: false };
        let mut entries = vec![
            text("modelDescription.xml", self.model_description.as_bytes()),
            text(&format!("resources/{RESOURCE_FILE}"), self.resource.as_bytes()),
            text("documentation/index.html", self.documentation.as_bytes()),
            text("documentation/Reference.csv", self.reference.table.as_bytes()),
            text("documentation/Reference.opt", self.reference.settings.as_bytes()),
        ];
        entries.extend(LICENSES.iter().map(|(path, content)| text(path, content.as_bytes())));
        entries.extend(match self.options.version {
            FmiVersion::Fmi2 => vec![text("model.png", ICON_PNG)],
            FmiVersion::Fmi3 => {
                vec![text("terminalsAndIcons/icon.png", ICON_PNG), text("terminalsAndIcons/icon.svg", ICON_SVG)]
            }
        });
        if self.options.version == FmiVersion::Fmi3 {
            entries.push(text("terminalsAndIcons/terminalsAndIcons.xml", self.terminals.as_bytes()));
        }
        entries.extend(self.libraries.iter().map(|(path, content)| Entry {
            path: path.clone(),
            content,
            executable: true,
        }));
        pack(&entries)
    }

    /// Writes the archive to `path`: first beside it, then renamed, so that a failure leaves nothing behind and an
    /// older file as it was.
    ///
    /// # Errors
    /// [`ExportError::Write`] names the path; [`ExportError::Assemble`] as [`Fmu::to_bytes`].
    pub fn write(&self, path: &Path) -> Result<(), ExportError> {
        let bytes = self.to_bytes()?;
        let fail = |source| ExportError::Write { path: path.into(), source };
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".orthopanel-").suffix(".fmu");
        #[cfg(unix)]
        {
            // A temporary file is private by default; an FMU is an ordinary file, subject to the user's umask.
            use std::os::unix::fs::PermissionsExt as _;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let mut file = builder.tempfile_in(folder).map_err(fail)?;
        file.write_all(&bytes).map_err(fail)?;
        file.persist(path).map_err(|error| fail(error.error))?;
        Ok(())
    }
}

fn check(ports: &Ports, options: &FmuOptions) -> Result<(), ExportError> {
    for (kind, places) in [("force", &ports.forces), ("response", &ports.responses)] {
        if places.is_empty() {
            return Err(ExportError::NoPort { ports: kind });
        }
    }
    if options.arrays && options.version == FmiVersion::Fmi2 {
        return Err(ExportError::Arrays);
    }
    if options.arrays && options.names != PortNames::default() {
        return Err(ExportError::NamesInArrays);
    }
    for (kind, named, places) in [
        ("force", &options.names.forces, ports.forces.len()),
        ("response", &options.names.responses, ports.responses.len()),
    ] {
        let found = named.len();
        if found > places {
            return Err(ExportError::NamedPorts { ports: kind, found, places });
        }
    }
    if !is_identifier(&options.name) {
        return Err(ExportError::Name { name: options.name.clone() });
    }
    Ok(())
}

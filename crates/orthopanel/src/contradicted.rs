//! Records that no beam could give: they may be a plate's, or a large effect's, and their trace tells.

use std::path::Path;

use orthopanel_data::ImpactTest;
use orthopanel_identify::IdentifyError;
use orthopanel_model::StructureKind;

use crate::error::CommandError;
use crate::evidence::Evidence;
use crate::record_options::IdentifyOptions;
use crate::traced::Traced;
use crate::{console, report};

/// A test whose base model was refused, and its trace.
pub struct Contradicted {
    pub test: ImpactTest,
    pub traced: Traced,
    refused: CommandError,
}

impl Contradicted {
    /// Traces a test, read at `path`, of which identifying was `refused`, against a reference where there is one.
    ///
    /// # Errors
    /// The refusal itself where it is another than that records contradict a beam; what the trace refuses.
    pub fn of(
        test: ImpactTest,
        reference: Option<&ImpactTest>,
        path: &Path,
        refused: CommandError,
    ) -> Result<Self, CommandError> {
        if !matches!(refused, CommandError::Identify { source: IdentifyError::Contradiction { .. }, .. }) {
            return Err(refused);
        }
        if test.structure == Some(StructureKind::MindlinPlate) {
            return Err(refused);
        }
        console::say(format_args!("not identified: {refused}"));
        let traced = Traced::from_test(&test, reference)
            .map_err(|source| CommandError::Identify { path: path.into(), source })?;
        Ok(Self { test, traced, refused })
    }

    /// The page of what the trace tells.
    pub fn page(&self, path: &Path, options: &IdentifyOptions) -> Result<String, CommandError> {
        let evidence = Evidence::of_trace(&self.test, &self.traced, options.settings()?.estimation)?;
        let refused = match &self.refused {
            CommandError::Identify { source, .. } => source.to_string(),
            other => other.to_string(),
        };
        report::page_of_trace(path, &self.test, &refused, &self.traced, &evidence)
    }

    /// Where the trace explains nothing, the refusal stands.
    pub fn end(self) -> Result<(), CommandError> {
        if self.traced.explains() { Ok(()) } else { Err(self.refused) }
    }
}

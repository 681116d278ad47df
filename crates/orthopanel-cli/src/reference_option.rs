//! A sound panel of the same make, against which a suspect one is traced: the option that several commands share.

use std::path::PathBuf;

use clap::Args;
use orthopanel::outputs::Inputs;
use orthopanel::{Error, Test};

#[derive(Args)]
pub struct ReferenceOption {
    /// Test file of a sound panel of the same make: what the model misses of its natural frequencies is removed from those of TEST, and what
    /// is found is what differs between the two
    #[arg(long, value_name = "GOOD.toml")]
    reference: Option<PathBuf>,
}

impl ReferenceOption {
    /// The reference's test, where there is one, and its files beside the other `inputs`.
    ///
    /// # Errors
    /// As [`Inputs::reading_test`].
    pub fn read(&self, inputs: Inputs) -> Result<(Inputs, Option<Test>), Error> {
        let Some(reference) = &self.reference else { return Ok((inputs, None)) };
        let (more, reference) = Inputs::reading_test(reference)?;
        Ok((inputs.and_all(more), Some(reference)))
    }
}

//! Where an instance stands: kept, and gone back to.

use orthopanel_model::ModalStepper;

use super::Component;
use super::situation::Snapshot;
use crate::FmuError;

impl Component {
    /// All that a later [`Component::restore`] needs to go on from here.
    pub(crate) fn snapshot(&self) -> Snapshot {
        Snapshot { situation: self.now.clone(), motion: self.stepper.state() }
    }

    /// Does a snapshot fit this instance?
    pub(super) fn check_snapshot(&self, snapshot: &Snapshot) -> Result<(), FmuError> {
        snapshot.situation.check(&self.now)?;
        if snapshot.motion.len() != self.mode_count() {
            return Err(FmuError::State("it holds another number of modes"));
        }
        if !snapshot.motion.iter().flatten().all(|number| number.abs() <= ModalStepper::LARGEST) {
            return Err(FmuError::State("it holds a motion that is too large or no number"));
        }
        Ok(())
    }

    /// Goes back to where a snapshot was taken; one that does not fit changes nothing.
    pub(crate) fn restore(&mut self, snapshot: &Snapshot) -> Result<(), FmuError> {
        self.check_snapshot(snapshot)?;
        // Parameters that were set and never solved for may be wrong together: that is then told when they are used.
        self.parameters_changed = self.solve_for(&snapshot.situation.parameters).is_err();
        self.stepper.set_state(&snapshot.motion)?;
        self.now.clone_from(&snapshot.situation);
        self.forces_changed = true;
        Ok(())
    }

    /// Back to where instantiation left it.
    pub(crate) fn reset(&mut self) -> Result<(), FmuError> {
        // As exported: nothing is solved for.
        self.solve_for(&self.start.parameters.clone())?;
        let at_rest = vec![[0.0; 2]; self.mode_count()];
        self.stepper.set_state(&at_rest)?;
        self.now.clone_from(&self.start);
        (self.forces_changed, self.parameters_changed, self.nominals_changed) = (true, false, false);
        Ok(())
    }
}

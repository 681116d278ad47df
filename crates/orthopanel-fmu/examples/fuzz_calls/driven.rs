//! An instance and what its importer keeps of it.

use std::ptr::null_mut;

use crate::c_functions::Pointer;
use crate::functions::Instance;
use crate::panels::Fmu;

pub struct Driven {
    pub instance: Instance,
    /// The FMU state that the importer holds; null for none.
    pub state: Pointer,
}

impl Driven {
    pub fn new(instance: Instance) -> Self {
        Self { instance, state: null_mut() }
    }

    /// Time of the instance; zero while it cannot be read.
    pub fn now(&self, fmu: &Fmu) -> f64 {
        let mut time = [0.0];
        self.instance.get(&[fmu.time], &mut time);
        time[0]
    }

    /// The values of all variables that can be read now; none where a result would be too large to be a number.
    pub fn values(&self, fmu: &Fmu) -> Option<Vec<f64>> {
        let mut values = vec![0.0; fmu.reals.len()];
        (self.instance.get(&fmu.reals, &mut values) == 0).then_some(values)
    }

    pub fn outputs(&self, fmu: &Fmu) -> Option<Vec<f64>> {
        let mut values = vec![0.0; fmu.outputs.len()];
        (self.instance.get(&fmu.outputs, &mut values) == 0).then_some(values)
    }

    /// Whether initialization has ended: then a fixed parameter, set to the value that it has, is refused.
    pub fn has_started(&self, fmu: &Fmu) -> bool {
        let mut value = [0.0];
        self.instance.get(&[fmu.fixed], &mut value) == 0 && self.instance.set(&[fmu.fixed], &value) != 0
    }

    /// Modal coordinates and velocities, where they can be read.
    pub fn states(&self, fmu: &Fmu) -> Option<Vec<f64>> {
        let mut values = vec![0.0; fmu.modal.len()];
        (self.instance.get(&fmu.modal, &mut values) == 0).then_some(values)
    }

    /// All that the instance holds, as the bytes of an FMU state.
    pub fn bytes(&self) -> Result<Vec<u8>, String> {
        let mut state = null_mut();
        let written = self.instance.get_state(&mut state).and_then(|()| self.instance.serialize(state));
        self.instance.free_state(&mut state)?;
        written
    }
}

//! FMU states: kept for the importer, put back, written as bytes and read again.
//!
//! The importer never holds a pointer of ours, only a number that no other state of the process has. So a state that
//! was freed, or is another instance's, is noticed and nothing is read through it.

use sha2::{Digest, Sha256};

use super::Component;
use super::kept_states::UNKNOWN;
use super::situation::Snapshot;
use crate::FmuError;

/// Bytes of a state begin with this; the number behind it is the version of what follows.
const MAGIC: &[u8; 16] = b"orthopanel state";
const VERSION: u32 = 1;
/// Length of the check sum (SHA-256) at the end.
const CHECK: usize = 32;

impl Component {
    /// Keeps where the instance stands, in the place of the state `handle` or as a new one where that is 0; returns the
    /// handle.
    pub(crate) fn get_fmu_state(&mut self, handle: usize) -> Result<usize, FmuError> {
        let snapshot = self.snapshot();
        self.states.keep(handle, snapshot)
    }

    /// Goes back to where a kept state was taken; the state stays kept.
    pub(crate) fn set_fmu_state(&mut self, handle: usize) -> Result<(), FmuError> {
        let snapshot = self.states.get(handle)?.clone();
        self.restore(&snapshot)
    }

    /// Forgets a kept state; 0 is ignored, as the standard says of null.
    pub(crate) fn free_fmu_state(&mut self, handle: usize) -> Result<(), FmuError> {
        if handle != 0 {
            self.states.kept.remove(&handle).ok_or(FmuError::State(UNKNOWN))?;
        }
        Ok(())
    }

    /// A kept state as bytes: magic, version, token of the panel, the state, check sum of all before.
    pub(crate) fn serialize_fmu_state(&self, handle: usize) -> Result<Vec<u8>, FmuError> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(self.states.token.as_bytes());
        let mut bytes = postcard::to_extend(self.states.get(handle)?, bytes)
            .map_err(|_| FmuError::State("it cannot be written as bytes"))?;
        bytes.extend(Sha256::digest(&bytes));
        Ok(bytes)
    }

    /// Keeps the state that `bytes` hold, if they are whole and of this panel; handles as for
    /// [`Component::get_fmu_state`].
    pub(crate) fn deserialize_fmu_state(&mut self, bytes: &[u8], handle: usize) -> Result<usize, FmuError> {
        let damaged = || FmuError::State("the bytes are no state of an orthopanel FMU, or are damaged");
        let (signed, check) = bytes.split_last_chunk::<CHECK>().ok_or_else(damaged)?;
        let (head, body) = signed
            .split_at_checked(MAGIC.len() + size_of_val(&VERSION) + self.states.token.len())
            .ok_or_else(damaged)?;
        let (magic, head) = head.split_first_chunk().ok_or_else(damaged)?;
        let (version, token) = head.split_first_chunk().ok_or_else(damaged)?;
        if magic != MAGIC || Sha256::digest(signed)[..] != check[..] {
            return Err(damaged());
        }
        if u32::from_le_bytes(*version) != VERSION {
            return Err(FmuError::State("the bytes are of another version of this library"));
        }
        if token != self.states.token.as_bytes() {
            return Err(FmuError::State("the bytes are of another panel's FMU (its token differs)"));
        }
        let (snapshot, rest): (Snapshot, _) = postcard::take_from_bytes(body).map_err(|_| damaged())?;
        if !rest.is_empty() {
            return Err(damaged());
        }
        self.check_snapshot(&snapshot)?;
        self.states.keep(handle, snapshot)
    }
}

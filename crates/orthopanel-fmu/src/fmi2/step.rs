//! FMI 2.0, 4.2: co-simulation steps.

use super::Boolean;
use crate::boundary::entries;

entries! {
    #[frequent]
    fmi2DoStep(start: f64, step: f64, _no_state_before: Boolean) |instance| instance.component.do_step(start, step);
}

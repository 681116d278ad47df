//! Mounts: a spring and a dashpot between the panel and a base that moves, inside the FMU.
//!
//! With the panel's deflection $w$ at the mount and the base's displacement $u$ and velocity $v$, the base feels
//! $$F = k\,(w-u) + c\,(\dot w-v),$$
//! and the panel its opposite. On modes $w = \sum_m\phi_ma_m$ that is
//! $$\ddot a_m + 2\zeta_m\omega_m\dot a_m + \omega_m^2a_m + \phi_m\sum_n\phi_n(c\,\dot a_n + k\,a_n) = \dots + \phi_m(k\,u + c\,v),$$
//! whose exact step is taken whatever $k$ and $c$ are ([`ModalStepper`](orthopanel_model::ModalStepper)): for a base that goes on from $u$
//! at its velocity $v$, or with `force_linear` for both running linearly to what was set. Nothing is handed over between steps on the
//! panel's side.

use orthopanel_model::{DeflectionRow, ModelError};

use super::layout::Spring;
use super::{Layout, Load, MovedBy, Output, Setting, Signal};
use crate::{FmuError, Mount};

/// Most that a mount's stiffness \[N/m\] or damping \[N s/m\] may be: beyond, a place is clamped for any panel, and what is left of other
/// numbers is rounding.
const STIFFEST: f64 = 1e15;

/// # Errors
/// [`FmuError::Mount`] for what is below zero, too large or no number.
pub(crate) fn check(name: &str, what: &'static str, value: f64) -> Result<(), FmuError> {
    if (0.0..=STIFFEST).contains(&value) {
        return Ok(());
    }
    let unit = if what == "stiffness" { "N/m" } else { "N s/m" };
    Err(FmuError::Mount { name: name.into(), what, value, unit, largest: STIFFEST })
}

#[cold]
pub(super) fn join(setting: &Setting, layout: &mut Layout) -> Result<(), ModelError> {
    for (number, mount) in setting.connections.mounts.iter().enumerate() {
        let Mount { name, at, stiffness, damping } = mount;
        let place = described!("mount {name} at x = {} m, y = {} m from the centre, positive along +z", at.x, at.y);
        let moves = |what: &str| {
            described!(
                "{what} of the base under the {place}. Over a step the base goes on at its velocity, or with force_linear to the values set"
            )
        };
        let row = || Load::Base(DeflectionRow::at(*at));
        let displacement = layout.input(format!("base_displacement_{name}"), "m", moves("Displacement"), row());
        let velocity = layout.input(format!("base_velocity_{name}"), "m/s", moves("Velocity"), row());
        let response = layout.response(DeflectionRow::at(*at));
        layout.outputs.push(Output {
            name: format!("base_force_{name}"),
            unit: "N",
            description: described!("Force on the base of the {place}; the panel gets its opposite"),
            terms: vec![
                (Signal::Displacement(response), *stiffness),
                (Signal::Velocity(response), *damping),
                (Signal::Input(displacement), -stiffness),
                (Signal::Input(velocity), -damping),
            ],
            moved_by: MovedBy::Mount(number),
        });
        let (at, stiffness, damping) = (*at, *stiffness, *damping);
        layout.springs.push(Spring { at, stiffness, damping, displacement, velocity, response });
    }
    Ok(())
}

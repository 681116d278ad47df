//! Macros that define entry points, and those that differ between the versions of the standard by name alone.

/// Defines entry points: each runs its body on the instance that the first argument points to. Those that are called at every step
/// are marked `#[frequent]`.
///
/// The one `unsafe` block serves every body; what a body relies on is the FMI contract alone: arrays and places for
/// answers are null, which the bodies refuse, or as long as the call says, and no other call uses the instance.
macro_rules! entries {
    ($($(#[$how:ident])? $name:ident($($argument:ident: $kind:ty),*) |$instance:ident| $body:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: *mut std::ffi::c_void, $($argument: $kind),*) -> $crate::boundary::Status {
            // SAFETY: under the FMI contract the instance is null or alive and this call's alone, and so is every
            // array and place for an answer that the body turns into a slice or reference.
            unsafe { $crate::boundary::caller!($($how)?)(instance, stringify!($name), |$instance| $body) }
        }
    )*};
}
pub(crate) use entries;

/// What runs the body of an entry point.
macro_rules! caller {
    () => {
        $crate::boundary::call
    };
    (frequent) => {
        $crate::boundary::frequent_call
    };
}
pub(crate) use caller;

/// Defines calls that take the instance alone and are told to the log.
macro_rules! transitions {
    ($($name:ident: $method:ident, $event:literal;)*) => {
        $crate::boundary::entries! {$(
            $name() |instance| {
                instance.component.$method()?;
                instance.logger.log($crate::logging::Category::Events, $event);
                Ok(())
            };
        )*}
    };
}
pub(crate) use transitions;

/// Defines getters and setters of types that no variable has: a call with no reference is done, any other refused.
macro_rules! absent_types {
    ($($name:ident($asked:literal, $($argument:ty),+);)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(
            instance: *mut std::ffi::c_void,
            references: *const u32,
            count: usize,
            $(_: $argument),+
        ) -> $crate::boundary::Status {
            // SAFETY: a live instance and `count` references, under the FMI contract; nothing else is touched.
            unsafe {
                $crate::boundary::call(instance, stringify!($name), |instance| {
                    instance.component.refuse_type($crate::boundary::array(references, count, "references")?, $asked)
                })
            }
        }
    )*};
}
pub(crate) use absent_types;

/// Defines the entry points of a capability that is not offered: each says which flag of the XML says so.
macro_rules! not_offered {
    ($($flag:literal: $($name:ident($($argument:ty),*);)*)*) => {$($(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: *mut std::ffi::c_void, $(_: $argument),*) -> $crate::boundary::Status {
            // SAFETY: `instance` comes from the importer under the FMI contract; no other argument is touched.
            unsafe {
                $crate::boundary::call(instance, stringify!($name), |_| Err($crate::FmuError::NotOffered($flag)))
            }
        }
    )*)*};
}
pub(crate) use not_offered;

/// Defines the calls on FMU states. What C calls a pointer to a state is a number of ours, never read through.
macro_rules! fmu_state_entries {
    ($get:ident, $set:ident, $free:ident, $size:ident, $serialize:ident, $deserialize:ident) => {
        $crate::boundary::entries! {
            $get(state: *mut Pointer) |instance| {
                let state = place(state, "FMU state")?;
                *state = std::ptr::without_provenance_mut(instance.component.get_fmu_state(state.addr())?);
                Ok(())
            };
            $set(state: Pointer) |instance| instance.component.set_fmu_state(state.addr());
            $free(state: *mut Pointer) |instance| {
                let Some(state) = state.as_mut() else { return Ok(()) };
                instance.component.free_fmu_state(state.addr())?;
                *state = std::ptr::null_mut();
                Ok(())
            };
            $size(state: Pointer, size: *mut usize) |instance| {
                *place(size, "size")? = instance.component.serialize_fmu_state(state.addr())?.len();
                Ok(())
            };
            $serialize(state: Pointer, bytes: *mut u8, size: usize) |instance| {
                let written = instance.component.serialize_fmu_state(state.addr())?;
                let bytes = array_mut(bytes, size, "serializedState")?;
                let too_small = $crate::FmuError::StateBuffer { given: size, needed: written.len() };
                bytes.get_mut(..written.len()).ok_or(too_small)?.copy_from_slice(&written);
                Ok(())
            };
            $deserialize(bytes: *const u8, size: usize, state: *mut Pointer) |instance| {
                let state = place(state, "FMU state")?;
                let bytes = array(bytes, size, "serializedState")?;
                let handle = instance.component.deserialize_fmu_state(bytes, state.addr())?;
                *state = std::ptr::without_provenance_mut(handle);
                Ok(())
            };
        }
    };
}
pub(crate) use fmu_state_entries;

/// Defines the calls of model exchange that both versions have.
macro_rules! model_exchange_entries {
    ($time:ident, $set:ident, $get:ident, $derivatives:ident, $nominals:ident once_instantiated $early:literal,
     $indicators:ident, $completed:ident) => {
        $crate::boundary::entries! {
            $time(time: f64) |instance| instance.component.set_time(time);
            $set(states: *const f64, count: usize) |instance| {
                instance.component.set_continuous_states(array(states, count, "states")?)
            };
            $get(states: *mut f64, count: usize) |instance| {
                instance.component.get_continuous_states(array_mut(states, count, "states")?)
            };
            $derivatives(derivatives: *mut f64, count: usize) |instance| {
                instance.component.get_state_derivatives(array_mut(derivatives, count, "derivatives")?)
            };
            $nominals(nominals: *mut f64, count: usize) |instance| {
                instance.component.get_nominals(array_mut(nominals, count, "nominals")?, $early)
            };
            $indicators(_indicators: *mut f64, count: usize) |instance| instance.component.get_event_indicators(count);
            $completed(_no_state_before: Boolean, enter_event_mode: *mut Boolean, terminate: *mut Boolean) |instance| {
                let answers = [place(enter_event_mode, "enterEventMode")?, place(terminate, "terminateSimulation")?];
                instance.component.completed_integrator_step()?;
                answers.into_iter().for_each(|answer| *answer = 0);
                Ok(())
            };
        }
    };
}
pub(crate) use model_exchange_entries;

//! The C boundary, common to both versions: pointers become slices and texts, panics and errors become a status.
//!
//! Safety rests on the FMI contract: an instance pointer is one that an instantiate function returned and that has
//! not been freed, an array has as many entries as its length says. What can be checked (null) is checked.
#![allow(unsafe_code)]

mod entries;

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use crate::component::{Component, Interface};
use crate::floating_point::StandardEnvironment;
use crate::logging::{Category, Logger, Sink};
use crate::{FmuError, Resource};

pub(crate) use entries::{
    absent_types, caller, entries, fmu_state_entries, model_exchange_entries, not_offered, transitions,
};

/// FMI status; OK and Error have the same numbers in both versions.
pub(crate) type Status = c_int;
pub(crate) const OK: Status = 0;
pub(crate) const DISCARD: Status = 2;
pub(crate) const ERROR: Status = 3;

/// What an instance pointer points to.
pub(crate) struct Instance {
    pub component: Component,
    pub logger: Logger,
}

/// What both instantiate functions are given.
pub(crate) struct Instantiation {
    pub call: &'static str,
    pub interface: Interface,
    pub token: *const c_char,
    pub location: *const c_char,
    pub to_folder: fn(&str) -> Result<PathBuf, FmuError>,
    pub logging_on: bool,
}

/// Makes an instance, or logs why not and returns null.
///
/// # Safety
/// `token` and `location` are null or C strings.
pub(crate) unsafe fn instantiate(
    given: &Instantiation,
    sink: Sink,
    check: impl FnOnce() -> Result<(), FmuError>,
) -> *mut c_void {
    let _environment = StandardEnvironment::enter();
    let logger = Logger::new(sink, given.logging_on);
    let made = catch_unwind(AssertUnwindSafe(|| {
        check()?;
        // SAFETY: the caller passes null or C strings.
        let (token, location) = unsafe { (text(given.token, "token")?, text(given.location, "resource location")?) };
        let resource = Resource::read(&(given.to_folder)(location)?, token)?;
        Ok::<_, FmuError>(Component::new(&resource, given.interface, token))
    }));
    match made {
        Ok(Ok(component)) => {
            logger.log(Category::Events, "instantiated");
            Box::into_raw(Box::new(Instance { component, logger })).cast()
        }
        Ok(Err(error)) => refuse(&logger, given.call, &error),
        Err(_) => refuse(&logger, given.call, &"internal error (a panic); please report it"),
    }
}

fn refuse(logger: &Logger, call: &str, reason: &dyn std::fmt::Display) -> *mut c_void {
    logger.log(Category::Error, &format!("{call}: {reason}"));
    std::ptr::null_mut()
}

/// Frees an instance; null is ignored, as the standard says.
///
/// # Safety
/// `instance` is null or a live instance, not used again.
pub(crate) unsafe fn free(instance: *mut c_void) {
    if !instance.is_null() {
        // SAFETY: a live instance came from `Box::into_raw` in `instantiate`. Dropping it runs no code that panics.
        drop(unsafe { Box::from_raw(instance.cast::<Instance>()) });
    }
}

/// Runs one call on an instance in the standard floating-point environment: errors and panics are logged and become [`ERROR`].
///
/// # Safety
/// `instance` is null or a live instance that no other call is using.
pub(crate) unsafe fn call(
    instance: *mut c_void,
    name: &str,
    body: impl FnOnce(&mut Instance) -> Result<(), FmuError>,
) -> Status {
    let mut body = Some(body);
    let mut once = |instance: &mut Instance| body.take().map_or(Ok(()), |body| body(instance));
    // SAFETY: as here.
    unsafe { in_standard_environment(instance, name, &mut once) }
}

/// One for all of these calls, since each of its own would make the library larger.
#[inline(never)]
unsafe fn in_standard_environment(
    instance: *mut c_void,
    name: &str,
    body: &mut dyn FnMut(&mut Instance) -> Result<(), FmuError>,
) -> Status {
    let _environment = StandardEnvironment::enter();
    // SAFETY: as in `call`.
    unsafe { frequent_call(instance, name, body) }
}

/// The same in the importer's environment, for what is called at every step: two looks at it would make a step a fifth longer. A body
/// has nothing in it that could raise an exception, or enters the standard one for it.
///
/// # Safety
/// `instance` is null or a live instance that no other call is using.
pub(crate) unsafe fn frequent_call(
    instance: *mut c_void,
    name: &str,
    body: impl FnOnce(&mut Instance) -> Result<(), FmuError>,
) -> Status {
    // SAFETY: null, or a live instance that this call alone uses.
    let Some(instance) = (unsafe { instance.cast::<Instance>().as_mut() }) else {
        return ERROR;
    };
    // Judged inside, so that a result of many words need not be carried out of the frame that catches panics.
    let judged = catch_unwind(AssertUnwindSafe(|| match body(instance) {
        Ok(()) => OK,
        Err(error) => log_error(instance, name, &error),
    }));
    judged.unwrap_or_else(|_| log_error(instance, name, &"internal error (a panic); please report it"))
}

#[cold]
fn log_error(instance: &Instance, name: &str, reason: &dyn std::fmt::Display) -> Status {
    instance.logger.log(Category::Error, &format!("{name}: {reason}"));
    ERROR
}

/// An array that the importer passes in.
///
/// # Safety
/// `pointer` is null or has `count` entries that live as long as the call.
pub(crate) unsafe fn array<'a, T>(pointer: *const T, count: usize, what: &'static str) -> Result<&'a [T], FmuError> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(FmuError::Null(what)),
        // SAFETY: not null, and the caller vouches for `count` entries.
        _ => Ok(unsafe { std::slice::from_raw_parts(pointer, count) }),
    }
}

/// An array that the importer wants filled.
///
/// # Safety
/// As [`array()`], and nothing else refers to the entries.
pub(crate) unsafe fn array_mut<'a, T>(
    pointer: *mut T,
    count: usize,
    what: &'static str,
) -> Result<&'a mut [T], FmuError> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err(FmuError::Null(what)),
        // SAFETY: not null, and the caller vouches for `count` entries that it alone refers to.
        _ => Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) }),
    }
}

/// A place that the importer wants an answer in.
///
/// # Safety
/// `pointer` is null or a place that lives as long as the call and that nothing else refers to.
pub(crate) unsafe fn place<'a, T>(pointer: *mut T, what: &'static str) -> Result<&'a mut T, FmuError> {
    // SAFETY: null, or a place that the caller vouches for.
    unsafe { pointer.as_mut() }.ok_or(FmuError::Null(what))
}

/// A text that the importer passes in.
///
/// # Safety
/// `pointer` is null or a C string that lives as long as the call.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, what: &'static str) -> Result<&'a str, FmuError> {
    if pointer.is_null() {
        return Err(FmuError::Null(what));
    }
    // SAFETY: not null, and the caller vouches for a C string.
    unsafe { CStr::from_ptr(pointer) }.to_str().map_err(|_| FmuError::Text(what))
}

/// The log categories that the importer names.
///
/// # Safety
/// `pointer` is null or has `count` C strings.
pub(crate) unsafe fn set_logging(
    instance: &mut Instance,
    on: bool,
    count: usize,
    categories: *const *const c_char,
) -> Result<(), FmuError> {
    // SAFETY: the caller vouches for `count` C strings.
    let names = unsafe { array(categories, count, "categories")?.iter().map(|&name| text(name, "category")) };
    let names = names.collect::<Result<Vec<_>, _>>()?;
    instance.logger.set(on, &names)
}

/// A C string of `message`, NUL characters left out.
pub(crate) fn c_text(message: &str) -> CString {
    CString::new(message.replace('\0', "")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;

    use orthopanel_model::{ModalModel, Ports};

    use super::*;

    fn instance(messages: &Rc<RefCell<Vec<String>>>) -> Instance {
        let resource = Resource::new(ModalModel::new(0, 0, vec![]).expect("no mode"), Ports::default()).expect("sound");
        let messages = Rc::clone(messages);
        let sink: Sink = Box::new(move |_, message| messages.borrow_mut().push(message.into()));
        Instance { component: Component::new(&resource, Interface::CoSimulation, ""), logger: Logger::new(sink, false) }
    }

    #[test]
    fn a_panic_ends_at_the_boundary() {
        let messages = Rc::new(RefCell::new(Vec::new()));
        let mut instance = instance(&messages);
        let pointer = (&raw mut instance).cast();
        // SAFETY: a live instance that only this call uses.
        let status = unsafe { call(pointer, "fmi2Test", |_| panic!("on purpose")) };
        assert_eq!(status, ERROR);
        assert!(messages.borrow()[0].starts_with("fmi2Test: internal error"));
        // SAFETY: as above.
        assert_eq!(unsafe { call(pointer, "fmi2Test", |_| Ok(())) }, OK);
    }

    #[test]
    fn null_pointers_are_refused_unless_nothing_is_read() {
        // SAFETY: null pointers are what is tested; none is read.
        unsafe {
            assert_eq!(call(std::ptr::null_mut(), "fmi2Test", |_| Ok(())), ERROR);
            assert!(matches!(array::<f64>(std::ptr::null(), 1, "value"), Err(FmuError::Null("value"))));
            assert!(array::<f64>(std::ptr::null(), 0, "value").is_ok_and(<[f64]>::is_empty));
            assert!(matches!(array_mut::<f64>(std::ptr::null_mut(), 1, "value"), Err(FmuError::Null("value"))));
            assert!(matches!(text(std::ptr::null(), "name"), Err(FmuError::Null("name"))));
            free(std::ptr::null_mut());
        }
    }

    #[test]
    fn texts_that_are_not_utf_8_are_refused() {
        // SAFETY: a C string.
        assert!(matches!(unsafe { text(c"\xff".as_ptr(), "name") }, Err(FmuError::Text("name"))));
        assert_eq!(c_text("a\0b").as_c_str(), c"ab");
    }
}

//! What an FMU refuses: the message goes to the importer's logger.

use std::path::PathBuf;

use orthopanel_model::{ModelError, Readable};
use thiserror::Error;

/// Errors of this crate.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FmuError {
    /// A resource that is not there or cannot be read.
    #[error("{}: {source}: unpack the FMU with its resources/ folder and pass that folder's place", .path.display())]
    ResourceMissing {
        /// The file looked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A resource that does not belong to the token given by the importer.
    #[error(
        "the importer's token is {given}, {} belongs to {found}: pass the guid or instantiationToken of this FMU's own \
         modelDescription.xml; if it is, the file is damaged: export the FMU again", .path.display()
    )]
    Token {
        /// The file.
        path: PathBuf,
        /// Token that the importer gave.
        given: String,
        /// Token of the file's content.
        found: String,
    },
    /// A resource whose text is not a panel.
    #[error("resource: {0}: export the FMU again")]
    ResourceText(String),
    /// A place of the resources that is no path.
    #[error("resource location {location:?}: {reason}")]
    Location {
        /// The text given.
        location: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A port's name that cannot stand in those of variables.
    #[error("port {name:?}: must be a name of letters, digits and _ (128 at most, no digit first), as seat_left")]
    PortName {
        /// The name.
        name: String,
    },
    /// A mount whose law is none.
    #[error("mount {name}: {what} = {value} {unit}: must lie between 0 and {largest:e} {unit}")]
    Mount {
        /// Its name.
        name: String,
        /// `stiffness` or `damping`.
        what: &'static str,
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Largest value allowed.
        largest: f64,
    },
    /// A frame where no edge is held.
    #[error(
        "base acceleration: all edges of the panel are free, so no frame moves it: give mounts, or say in the model's \"boundary\" which \
         edges are clamped or pinned"
    )]
    NoFrame,
    /// Two variables of one name.
    #[error(
        "two variables are called {name:?}: give the ports names that are no other's, and not linear or such as end in _x or _y"
    )]
    SameName {
        /// The name.
        name: String,
    },
    /// A value reference that no variable has.
    #[error("value reference {reference}: no such variable; references run from 1 to {last}")]
    UnknownReference {
        /// The reference.
        reference: u32,
        /// The last one in use.
        last: u32,
    },
    /// A variable asked for in another type than its own.
    #[error("{name} (value reference {reference}) is a {expected}, not a {asked}: call the function of its type")]
    VariableType {
        /// Name of the variable.
        name: String,
        /// Its reference.
        reference: u32,
        /// Its type.
        expected: &'static str,
        /// The type of the call.
        asked: &'static str,
    },
    /// A variable that cannot be set, or not now.
    #[error("{name} (value reference {reference}) cannot be set: {reason}")]
    NotSettable {
        /// Name of the variable.
        name: String,
        /// Its reference.
        reference: u32,
        /// Why.
        reason: &'static str,
    },
    /// A number that must be finite.
    #[error("{what} = {value}: must be a finite number")]
    NotFinite {
        /// What it is.
        what: String,
        /// Its value.
        value: f64,
    },
    /// A force, rate, state or seed beyond what is reckoned with.
    #[error("{what} = {value:e}: must lie between -{largest:e} and {largest:e}")]
    TooLarge {
        /// What it is.
        what: String,
        /// Its value.
        value: f64,
        /// Largest size allowed.
        largest: f64,
    },
    /// A step or time beyond all that is simulated.
    #[error("{what} = {value:e} s: steps and times must stay below {limit:e} s")]
    TooLong {
        /// What it is.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Where such values begin.
        limit: f64,
    },
    /// A relative tolerance below zero.
    #[error("tolerance = {value}: a relative tolerance is zero or more; or say that none is defined")]
    Tolerance {
        /// The tolerance.
        value: f64,
    },
    /// A result that no number holds.
    #[error(
        "{what} = {value} under the forces, states and derivatives now set: these are too large together, set smaller ones"
    )]
    Overflow {
        /// What was asked for.
        what: String,
        /// What came out.
        value: f64,
    },
    /// A call of the other interface.
    #[error("the call is of <ModelExchange>: this instance is co-simulation, which advances its states itself")]
    ModelExchangeOnly,
    /// A call in the wrong order.
    #[error("not allowed in the state {state}: allowed in {allowed}")]
    Order {
        /// The state of the instance.
        state: &'static str,
        /// The states that allow the call.
        allowed: String,
    },
    /// A step that does not start where the last one ended.
    #[error(
        "the communication point is {} s, the instance stands at {} s: go on from there",
        Readable(*.given), Readable(*.time)
    )]
    CommunicationPoint {
        /// The point given.
        given: f64,
        /// Time of the instance.
        time: f64,
    },
    /// A step that ends behind the stop time that was set.
    #[error(
        "the step ends at {} s, behind the stop time {} s: set a later stop time, or none",
        Readable(*.end), Readable(*.stop)
    )]
    PastStop {
        /// End of the step.
        end: f64,
        /// Stop time of the experiment.
        stop: f64,
    },
    /// A stop time before the start time.
    #[error("the stop time {} s lies before the start time {} s", Readable(*.stop), Readable(*.start))]
    StopBeforeStart {
        /// Start time.
        start: f64,
        /// Stop time.
        stop: f64,
    },
    /// A derivative of an input of another order than the first.
    #[error("input derivative of order {order}: give order 1 only (the force runs linearly over the step)")]
    DerivativeOrder {
        /// The order.
        order: i32,
    },
    /// A derivative of an output of another order than the first.
    #[error("output derivative of order {order}: only order 1 is offered (maxOutputDerivativeOrder = 1)")]
    OutputDerivativeOrder {
        /// The order.
        order: i32,
    },
    /// A partial derivative of or by a variable that has none.
    #[error("{name} (value reference {reference}) has no such derivative: {reason}")]
    NotDifferentiable {
        /// Name of the variable.
        name: String,
        /// Its reference.
        reference: u32,
        /// Why.
        reason: &'static str,
    },
    /// Another number of continuous states than the FMU has.
    #[error("{found} continuous states given or asked for: the FMU has {expected}, two a mode")]
    StateCount {
        /// Number found.
        found: usize,
        /// Number expected.
        expected: usize,
    },
    /// Parameters that together are those of no panel.
    #[error(
        "{what} = {}: must lie between {low} and {high}; set the parameters it is made of", Readable(*.value)
    )]
    OutOfRange {
        /// The ratio.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Least value allowed.
        low: f64,
        /// Greatest value allowed.
        high: f64,
    },
    /// A panel that, with the parameters set, has another number of modes.
    #[error("with these parameters the panel has {found} modes, not {expected}: its ends must hold it as exported")]
    ModeCount {
        /// Number found.
        found: usize,
        /// Number of the FMU.
        expected: usize,
    },
    /// An FMU state that cannot be used.
    #[error("FMU state: {0}")]
    State(&'static str),
    /// A buffer for a serialized state that is too small.
    #[error("the buffer has {given} bytes, the state needs {needed}: ask for its serialized size")]
    StateBuffer {
        /// Size of the buffer.
        given: usize,
        /// Size needed.
        needed: usize,
    },
    /// Input derivatives beside `force_linear`.
    #[error("force_linear is true: the force already runs linearly between the values set; give no input derivatives")]
    DerivativeBesideLinear,
    /// A function of a capability that the FMU does not offer.
    #[error("not offered: modelDescription.xml says {0}")]
    NotOffered(&'static str),
    /// A pointer that must not be null.
    #[error("{0} is a null pointer")]
    Null(&'static str),
    /// A text that is not UTF-8.
    #[error("{0} is not UTF-8 text")]
    Text(&'static str),
    /// Lists whose lengths do not fit.
    #[error(
        "{values} values for {references} variables, each element of an array counted: give one value for each of these"
    )]
    Count {
        /// Number of values.
        values: usize,
        /// Number of scalars and elements of arrays.
        references: usize,
    },
    /// A log category that the FMU does not have.
    #[error("log category {0:?}: there are logEvents, logStatusError and logAll")]
    LogCategory(String),
    /// What the physics layer refused.
    #[error(transparent)]
    Model(#[from] ModelError),
}

//! What long work tells while it goes on, and whether it shall go on.

/// Hears what is noted, and how far the work is; may end it.
///
/// The command writes all of it to standard error. Who does not care passes [`Silent`], as the short forms do.
///
/// # Examples
/// ```
/// use std::sync::Mutex;
///
/// #[derive(Default)]
/// struct Kept(Mutex<Vec<String>>);
///
/// impl orthopanel::Observer for Kept {
///     fn say(&self, message: &str) {
///         self.0.lock().unwrap().push(message.to_owned());
///     }
/// }
///
/// let kept = Kept::default();
/// let test = orthopanel::Test::load("../../examples/piece-1/test.toml")?;
/// test.identify_with(Default::default(), &kept)?;
/// // A list of natural frequencies tells no damping.
/// assert!(kept.0.into_inner().unwrap()[0].starts_with("damping: natural frequencies alone measure none"));
/// # Ok::<(), orthopanel::Error>(())
/// ```
pub trait Observer: Sync {
    /// A sentence for people: what was assumed, left out or found wanting.
    fn say(&self, _message: &str) {}

    /// Work that begins; it ends when what is returned is dropped.
    fn begin(&self, _work: &'static str, _steps: Steps) -> Box<dyn Work + '_> {
        Box::new(Silent)
    }

    /// Asked between steps, from any thread: `true` ends the work with [`Error::Interrupted`](crate::Error::Interrupted).
    fn is_interrupted(&self) -> bool {
        false
    }
}

/// What is known of the steps of a piece of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Steps {
    /// Nothing.
    Unknown,
    /// How many there are.
    Of(usize),
    /// How many there are, and the name of each, will be told with each.
    Named,
}

/// A piece of work under way.
pub trait Work: Sync {
    /// `done` of `of` steps are done, `step` the last where they have names.
    fn at(&self, _done: usize, _of: usize, _step: &'static str) {}
}

/// Hears nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Observer for Silent {}
impl Work for Silent {}

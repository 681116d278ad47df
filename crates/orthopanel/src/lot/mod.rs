//! A lot of panels: a row for each, as a table in a file, and what the rows say together.

mod batch;
pub(crate) mod control_chart;
mod file;
mod page;
mod random_effects;
mod row;
mod table;
mod table_error;

pub use batch::{Batch, tests_in};
pub use control_chart::ControlChart;
pub use file::{content, known, load, save};
pub use page::page;
pub use random_effects::{Measured, RandomEffects};
pub use row::LotRow;
use table::{Format, read, written};
pub use table_error::TableError;

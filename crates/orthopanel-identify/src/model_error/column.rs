//! One column of the model error.

/// The power of $\tau_k$ that a column goes with: one, two where it is of second order, or none where its size is known.
pub(super) type Power = u8;

/// A column with its kind: places and values that are not zero.
pub(super) type Column = ((usize, Power), Vec<(usize, f64)>);

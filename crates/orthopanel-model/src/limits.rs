//! What a model may hold at most. Each is far beyond real panels, and low enough that no model file takes hours or all memory.

/// Places of force, and places of response. An FMU has a variable for each, and three for each place of response.
pub const PORTS: usize = 500;

/// Effects of a model or of a test.
pub const EFFECTS: usize = 200;

/// Flexible modes ([`crate::ModeRange::MOST`]).
pub(crate) const MODES: usize = 1000;

/// Damping ratios: as many as a model may have modes.
pub const DAMPING_RATIOS: usize = MODES;

/// Characters of a name.
pub const NAME: usize = 200;

/// Length, width and thickness of a piece \[m\], from a thousandth of a millimetre to ten kilometres.
pub const SIZE: [f64; 2] = [1e-6, 1e4];

/// Mass per area of a piece \[kg/m²\], from that of a foil of a thousandth of a millimetre to that of a hundred metres of metal.
pub const MASS_PER_AREA: [f64; 2] = [1e-6, 1e7];

/// Moduli that a natural frequency may come from \[Pa\]: foam so soft that none is made of it has $10^3$, and diamond $10^{12}$.
pub const MODULUS: [f64; 2] = [1e3, 1e13];

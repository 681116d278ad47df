//! Constants that are tried against the poles: a grid of $E_x/G_{zx}$, and from the lowest poles how stiff the whole is.

/// What constants are tried.
pub(super) struct StiffnessGrid<'a> {
    /// $E_x/G_{zx}$: lowest, highest and steps between, even in the logarithm.
    pub ratios: (f64, f64, usize),
    /// One of so many lowest poles is one of so many lowest modes.
    pub anchors: usize,
    /// \[Hz\], rising.
    pub poles: &'a [f64],
    /// $E_x$, $G_{zx}$ where they are declared.
    pub held: &'a [Option<f64>; 2],
}

impl StiffnessGrid<'_> {
    /// $E_x$, $G_{zx}$ of each ratio, of which those that nothing holds begin from this $E_x$.
    pub(super) fn units(&self, usual: f64) -> impl Iterator<Item = [f64; 2]> + use<> {
        let (lowest, highest, steps) = self.ratios;
        let held = *self.held;
        (0..=steps).map(move |step| {
            let ratio = lowest * (highest / lowest).powf(step as f64 / steps as f64);
            match held {
                [Some(e_x), g_zx] => [e_x, g_zx.unwrap_or(e_x / ratio)],
                [None, Some(g_zx)] => [ratio * g_zx, g_zx],
                [None, None] => [usual, usual / ratio],
            }
        })
    }

    /// Factors on frequencies, the roots of those on both constants, that bring one of these modes to one of the poles; one
    /// where a constant is declared.
    pub(super) fn factors(&self, modes: &[f64]) -> Vec<f64> {
        if *self.held != [None; 2] {
            return vec![1.0];
        }
        let lowest = &self.poles[..self.anchors.min(self.poles.len())];
        lowest.iter().flat_map(|pole| modes.iter().take(self.anchors).map(move |mode| pole / mode)).collect()
    }
}

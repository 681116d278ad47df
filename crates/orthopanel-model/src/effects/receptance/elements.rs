//! Elements joined to receptances.
//!
//! With the bare receptances $H$, an element at row $p$ takes the force $g_p$, and $A_px_p = B_pg_p$ for its displacement, where
//! $A/B$ is its impedance ([`ElementLaw::pair`](crate::ElementLaw)). A unit force at $f$ moves the element's place by
//! $x_p = H_{pf} - \sum_qH_{pq}g_q$, so with $g = A\mu$, $x = B\mu$
//! $$(B + H_{PP}A)\,\mu = H_{Pf},\qquad H'_{rf} = H_{rf} - H_{rP}A\mu .$$

use num_complex::Complex64;

/// Rows of the bare receptances before those of elements: force and response.
pub(super) const BARE: usize = 2;

/// The receptance between force and response with these elements joined; `bare` has a line for each row.
pub(super) fn joined(bare: &[Complex64], elements: &[[Complex64; 2]]) -> Complex64 {
    let n = BARE + elements.len();
    let width = elements.len() + 1;
    let mut system = Vec::with_capacity(elements.len() * width);
    for p in 0..elements.len() {
        for (q, [a, b]) in elements.iter().enumerate() {
            let own = if p == q { *b } else { Complex64::ZERO };
            system.push(own + bare[(BARE + p) * n + BARE + q] * a);
        }
        system.push(bare[(BARE + p) * n]);
    }
    eliminate(&mut system, elements.len());
    let taken = elements.iter().enumerate().map(|(p, [a, _])| {
        let state = system[p * width + elements.len()];
        bare[n + BARE + p] * a * state
    });
    bare[1] - taken.sum::<Complex64>()
}

/// Gauss's elimination with pivots on `count` rows of `count + 1` numbers: the last column becomes the solution.
fn eliminate(system: &mut [Complex64], count: usize) {
    let width = count + 1;
    for column in 0..count {
        let size = |row: &usize| system[row * width + column].norm_sqr();
        let pivot = (column..count).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(column);
        if pivot != column {
            (0..width).for_each(|j| system.swap(pivot * width + j, column * width + j));
        }
        let inverse = system[column * width + column].inv();
        (column..width).for_each(|j| system[column * width + j] *= inverse);
        for row in (0..count).filter(|row| *row != column) {
            let share = system[row * width + column];
            for j in column..width {
                let taken = share * system[column * width + j];
                system[row * width + j] -= taken;
            }
        }
    }
}

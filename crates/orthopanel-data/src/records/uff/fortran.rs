//! Numbers as Fortran writes them.

/// A number whose exponent may have lost its letter: Fortran prints 1e-100 as `0.10000-099` where columns are few.
pub(in crate::records) fn number(text: &str) -> Option<f64> {
    plain_number(text).or_else(|| {
        let sign = text.rfind(['+', '-']).filter(|&at| at > 0)?;
        let (mantissa, exponent) = text.split_at_checked(sign)?;
        format!("{mantissa}e{exponent}").parse().ok()
    })
}

/// A number with `e` or Fortran's `d` before its exponent.
pub(super) fn plain_number(text: &str) -> Option<f64> {
    text.parse().ok().or_else(|| text.replace(['d', 'D'], "e").parse().ok())
}

//! The importer's floating-point environment: traps, rounding, what becomes of the smallest numbers.
//!
//! Compiled code, Rust's as C's, takes it that no exception traps and that results are rounded to nearest: it may compute what it
//! then throws away, in lanes of a vector or before a branch, and a matrix library does. So whatever solves for modes runs in that
//! environment, and the importer has its own back afterwards, without a flag of INVALID, DIVBYZERO or OVERFLOW that it did not have.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
use x86_64 as registers;

#[cfg(target_arch = "aarch64")]
use aarch64 as registers;

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
use elsewhere as registers;

/// While it lives, the environment is the standard one.
pub(crate) struct StandardEnvironment {
    importers: registers::Environment,
}

impl StandardEnvironment {
    #[inline(always)]
    pub(crate) fn enter() -> Self {
        let importers = registers::read();
        if !registers::is_standard(importers) {
            registers::write(registers::STANDARD);
        }
        Self { importers }
    }
}

impl Drop for StandardEnvironment {
    #[inline(always)]
    fn drop(&mut self) {
        let importers = self.importers;
        if !registers::is_standard(importers) || registers::raised_since(importers) {
            registers::write(importers);
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod x86_64 {
    //! One register, MXCSR: flags in its lowest six bits, above them traps, rounding and what becomes of small numbers.
    use std::arch::asm;

    pub(super) type Environment = u32;
    /// No trap, to nearest, small numbers kept, no flag.
    pub(super) const STANDARD: Environment = 0x1f80;
    const FLAGS: Environment = 0x3f;
    /// Of INVALID, DIVBYZERO and OVERFLOW.
    const FORBIDDEN: Environment = 0b00_1101;

    #[inline(always)]
    pub(super) fn read() -> Environment {
        let mut found: Environment = 0;
        // SAFETY: stores the register in a place of its size, and changes nothing else.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut found, options(nostack, preserves_flags)) };
        found
    }

    #[cold]
    pub(super) fn write(wanted: Environment) {
        // SAFETY: what is written is the standard environment, or what was read when the call began.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const wanted, options(nostack)) };
    }

    #[inline(always)]
    pub(super) fn is_standard(environment: Environment) -> bool {
        environment & !FLAGS == STANDARD
    }

    #[inline(always)]
    pub(super) fn raised_since(environment: Environment) -> bool {
        read() & !environment & FORBIDDEN != 0
    }
}

#[cfg(target_arch = "aarch64")]
mod aarch64 {
    //! Two registers: FPCR has traps, rounding and what becomes of small numbers, FPSR the flags.
    use std::arch::asm;

    /// FPCR and FPSR.
    pub(super) type Environment = [u64; 2];
    /// No trap, to nearest, small numbers kept, no flag.
    pub(super) const STANDARD: Environment = [0, 0];
    /// Of INVALID, DIVBYZERO and OVERFLOW.
    const FORBIDDEN: u64 = 0b0111;

    #[inline(always)]
    pub(super) fn read() -> Environment {
        let (control, status): (u64, u64);
        // SAFETY: copies two registers, and changes nothing else.
        unsafe {
            asm!("mrs {}, fpcr", out(reg) control, options(nostack, preserves_flags));
            asm!("mrs {}, fpsr", out(reg) status, options(nostack, preserves_flags));
        }
        [control, status]
    }

    #[cold]
    pub(super) fn write([control, status]: Environment) {
        // SAFETY: what is written is the standard environment, or what was read when the call began.
        unsafe {
            asm!("msr fpcr, {}", in(reg) control, options(nostack));
            asm!("msr fpsr, {}", in(reg) status, options(nostack));
        }
    }

    #[inline(always)]
    pub(super) fn is_standard([control, _]: Environment) -> bool {
        control == STANDARD[0]
    }

    #[inline(always)]
    pub(super) fn raised_since([_, before]: Environment) -> bool {
        read()[1] & !before & FORBIDDEN != 0
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod elsewhere {
    //! Processors whose environment is left as it is.
    pub(super) type Environment = ();
    pub(super) const STANDARD: Environment = ();

    pub(super) fn read() -> Environment {}

    pub(super) fn write(_: Environment) {}

    pub(super) fn is_standard(_: Environment) -> bool {
        true
    }

    pub(super) fn raised_since(_: Environment) -> bool {
        false
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use std::hint::black_box;

    use super::{StandardEnvironment, registers};

    /// Zero over zero: INVALID.
    fn no_number() -> f64 {
        black_box(0.0) / black_box(0.0)
    }

    #[test]
    fn a_call_runs_in_the_standard_environment_and_the_importers_comes_back() {
        // INVALID trapped, rounded upwards, small numbers flushed; then the standard one with an older flag of INEXACT.
        for importers in [0x1f80 & !0x80 | 0xc040, 0x1fa0] {
            registers::write(importers);
            let environment = StandardEnvironment::enter();
            let inside = registers::read();
            let found = no_number();
            drop(environment);
            let after = registers::read();
            registers::write(registers::STANDARD);
            assert!(registers::is_standard(inside), "{inside:#x}");
            assert!(found.is_nan());
            assert_eq!(after, importers, "{after:#x}");
        }
    }
}

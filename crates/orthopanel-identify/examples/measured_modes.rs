//! The measured modes of a test, as a table: `cargo run --release -p orthopanel-identify --example measured_modes TEST`.
//!
//! Before any physics is asked: poles common to all records, each with its standard deviation by the noise of the data.
#![allow(clippy::print_stdout)]

use std::f64::consts::TAU;

use orthopanel_data::ImpactTest;
use orthopanel_identify::measured_modes;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("name a test file (test.toml), or the folder that holds it")?;
    let test = ImpactTest::read(path)?;
    for measured in measured_modes(&test)? {
        let [from, to] = measured.band;
        println!("{}: {} records, {from:.0} to {to:.0} Hz", test.pieces[measured.piece].name, measured.records.len());
        if let Some(chi_square) = measured.chi_square {
            println!("misfit per datum over the noise: {chi_square:.3}");
        }
        println!("mode  frequency [Hz]      std     zeta      std");
        let std = |place: usize| measured.covariance[(place, place)].sqrt();
        for (mode, pole) in measured.poles.iter().enumerate() {
            let frequency = pole.angular_frequency / TAU;
            print!("{:<4}  {frequency:14.4}  {:7.1e}", mode + 1, frequency * std(mode));
            match pole.damping_ratio {
                Some(zeta) => println!("  {zeta:7.1e}  {:7.1e}", zeta * std(measured.poles.len() + mode)),
                None => println!(),
            }
        }
    }
    Ok(())
}

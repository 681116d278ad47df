//! The physics, held against the paper, closed forms and other solvers.
//!
//! One program for all of a crate's tests: each of its own would be linked apart, for minutes. One file alone:
//! `cargo test --release -p orthopanel-model --test all FILE::`.

mod beam_paper;
mod beam_three_ways;
mod beam_with_effects;
mod core_in_models;
mod edges_that_yield;
mod effects_bench;
mod effects_document;
mod effects_in_models;
mod effects_physics;
mod every_effect;
mod mindlin_plate_closed_forms;
mod mindlin_plate_laws;
mod mindlin_plate_modes;
mod mindlin_plate_tables;
mod modal_sums;
mod model_file;
mod reduced_structure;
mod residual_modes;
mod section_3_5;
mod uniform_loads;
mod width_coupling;

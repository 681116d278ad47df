//! Records to accelerance: channels put right, hits judged, spectra averaged, each line with its variance.

mod accelerance;
mod blow;
mod blow_window;
mod channel_choice;
mod channel_noise;
mod channels;
mod coherence;
mod derivative;
mod estimate;
mod extremes;
mod force_noise;
mod gather;
mod hit_agreement;
mod hit_faults;
mod hit_verdict;
mod likely_motion;
mod misplaced_channel;
mod node_numbers;
mod overload;
mod scatter;
mod spectrum;
mod time_grid;
mod time_history;
mod trigger;
mod window;
mod wrong_sample;

pub use accelerance::Accelerance;
pub use channel_noise::ChannelNoise;
pub(crate) use coherence::own_coherence;
pub use estimate::{Estimation, Estimator};
pub use force_noise::ForceNoise;
pub use hit_faults::{Channel, HitFault};
pub use hit_verdict::HitVerdict;
pub use time_history::{Hit, TimeHistory};
pub use trigger::Cut;
pub use window::Window;

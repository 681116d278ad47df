#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    orthopanel_fuzz::model_json(bytes);
});

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    orthopanel_fuzz::test_toml(bytes);
});

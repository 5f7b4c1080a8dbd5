#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| tracelight_fuzz::formats::check(data));

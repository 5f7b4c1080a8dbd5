#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| tracelight_fuzz::wire::check(data));

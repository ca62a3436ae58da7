#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| hadar_fuzz::check("cube", bytes));

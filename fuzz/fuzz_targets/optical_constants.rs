#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| hadar_fuzz::check("optical_constants", bytes));

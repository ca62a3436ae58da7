//! Runs one core kernel a given number of times and nothing else, for a tool that counts instructions.
//!
//! `cargo bench --bench instructions -- NAME CALLS`; `.ci/instructions` takes the difference of two numbers of calls,
//! in which the set-up cancels. Without arguments it names the kernels.

mod kernels;
mod made_up;

use kernels::{NAMES, Scene};

fn main() {
    // Cargo adds an argument of its own.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let [name, calls] = arguments.as_slice() else {
        println!("{}", NAMES.join("\n"));
        return;
    };
    let scene = Scene::new();
    let mut kernel = scene.kernel(name).expect("one of the kernels");
    for call in 0..calls.parse().expect("a number of calls") {
        kernel(call);
    }
}

//! How far the core kernels are from what the processor can do: `cargo bench --bench hardware`, one core.
//!
//! First the machine at hand is measured: vector operations (an addition, a multiplication or both fused count as one),
//! divisions, bytes a second from the first-level cache and from memory. Then every kernel is timed in the same run, and set
//! against the longest of
//!
//!   operations/rate,   divisions/rate,   bytes/bandwidth
//!
//! with the least it has to do by its own equations, written beside the code below (estimates for nearest state and
//! windows). What all three do at once is not counted, neither are shuffles, calls, allocations and the folding of sums: a
//! ratio of 1 is out of reach.

mod kernels;
mod made_up;

use kernels::{BANDS, CUBE, Scene, materials};
use std::hint::black_box;
use std::time::Instant;

const LANES: usize = 8;
type Chunk = [f64; LANES];

/// A cache line of doubles.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Line(Chunk);

/// a·b + c.
#[inline(always)]
fn fused(a: Chunk, b: Chunk, c: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i].mul_add(b[i], c[i]))
}

/// a + b.
#[inline(always)]
fn sum(a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i] + b[i])
}

/// The sum of all lanes. Never inlined: the lanes then go through memory, which keeps the loop before in full-width
/// registers.
#[inline(never)]
fn all(chunks: &[Chunk]) -> f64 {
    chunks.iter().flatten().sum()
}

/// A loop compiled for the widest vector unit the processor has.
macro_rules! vectorised {
    ($name:ident($($arg:ident: $ty:ty),*) -> $ret:ty $body:block) => {
        fn $name<'a>($($arg: $ty),*) -> $ret {
            struct Loop<'a>($($ty,)* std::marker::PhantomData<&'a ()>);
            impl<'a> pulp::NullaryFnOnce for Loop<'a> {
                type Output = $ret;
                #[inline(always)]
                fn call(self) -> $ret {
                    let Self($($arg,)* _) = self;
                    $body
                }
            }
            pulp::Arch::new().dispatch(Loop($($arg,)* std::marker::PhantomData))
        }
    };
}

vectorised! {
    multiply_add(rounds: usize, factors: &'a [Chunk; 2]) -> f64 {
        let [a, b] = *factors;
        // Values that stay in registers, enough of them that none waits for its own last result.
        let [mut c, mut d, mut e, mut f, mut g, mut h] = [b; 6];
        let [mut i, mut j, mut k, mut l, mut m, mut n] = [a; 6];
        for _ in 0..rounds {
            (c, d, e, f) = (fused(c, a, b), fused(d, a, b), fused(e, a, b), fused(f, a, b));
            (g, h, i, j) = (fused(g, a, b), fused(h, a, b), fused(i, a, b), fused(j, a, b));
            (k, l, m, n) = (fused(k, a, b), fused(l, a, b), fused(m, a, b), fused(n, a, b));
        }
        all(&[c, d, e, f, g, h, i, j, k, l, m, n])
    }
}

vectorised! {
    reciprocals(x: &'a [Line], out: &'a mut [Line]) -> f64 {
        for (out, x) in out.iter_mut().zip(x) {
            let x = x.0;
            out.0 = std::array::from_fn(|i| 1.0 / x[i]);
        }
        0.0
    }
}

vectorised! {
    total(x: &'a [Line]) -> f64 {
        let [mut a, mut b, mut c, mut d] = [[0.0; LANES]; 4];
        let [mut e, mut f, mut g, mut h] = [[0.0; LANES]; 4];
        for x in x.as_chunks::<8>().0 {
            (a, b, c, d) = (sum(a, x[0].0), sum(b, x[1].0), sum(c, x[2].0), sum(d, x[3].0));
            (e, f, g, h) = (sum(e, x[4].0), sum(f, x[5].0), sum(g, x[6].0), sum(h, x[7].0));
        }
        all(&[a, b, c, d, e, f, g, h])
    }
}

/// The shortest of many runs, in seconds per call.
fn shortest(calls: usize, mut call: impl FnMut(usize)) -> f64 {
    call(0);
    let run = |_| {
        let start = Instant::now();
        (0..calls).for_each(&mut call);
        start.elapsed().as_secs_f64() / calls as f64
    };
    (0..60).map(run).fold(f64::INFINITY, f64::min)
}

/// Rates of one core, per second.
struct Machine {
    operations: f64,
    divisions: f64,
    cache_bytes: f64,
    memory_bytes: f64,
}

impl Machine {
    fn measured() -> Self {
        let rounds = 10_000;
        let fused = shortest(20, |_| {
            black_box(multiply_add(rounds, black_box(&[[0.999; LANES], [1e-3; LANES]])));
        });
        // 16 kB read, as much written.
        let (x, mut out) = (vec![Line([1.5; LANES]); 256], vec![Line([0.0; LANES]); 256]);
        let division = shortest(500, |_| {
            reciprocals(black_box(&x), &mut out);
            black_box(&out);
        });
        let cache = shortest(2000, |_| {
            black_box(total(black_box(&x)));
        });
        let large = vec![Line([1.5; LANES]); 1 << 22];
        let memory = (0..5).map(|_| {
            let start = Instant::now();
            black_box(total(black_box(&large)));
            start.elapsed().as_secs_f64()
        });
        let bytes = |chunks: usize| (chunks * size_of::<Chunk>()) as f64;
        Self {
            operations: (12 * LANES * rounds) as f64 / fused,
            divisions: (x.len() * LANES) as f64 / division,
            cache_bytes: bytes(x.len()) / cache,
            memory_bytes: bytes(large.len()) / memory.fold(f64::INFINITY, f64::min),
        }
    }
}

/// The least that one unit of a kernel has to do.
struct Work {
    kernel: &'static str,
    unit: &'static str,
    /// Units in a call, and calls in a run.
    units: f64,
    calls: usize,
    operations: f64,
    divisions: f64,
    cache_bytes: f64,
    memory_bytes: f64,
}

fn works() -> Vec<Work> {
    let bands = BANDS as f64;
    // x as two doubles 4, its exponential 18, e⁻ˣ and 1 − e⁻ˣ 4, B 3, ∂B/∂T 2; 1/p serves both.
    let planck = 31.0;
    // A second exponential of a small number, B(T) − B(T₀), B(T), 1/(1 − e⁻ˣ) from the first.
    let two_temperatures = planck + 26.0;
    // S 5, ∂S/∂g 5, the other columns 5, ΣS 1; 1/S.
    let signal_and_columns = 16.0;
    // Of n columns: u a, inner products, taken off the later ones; the last once more.
    let orthogonal = |n: f64| n + n * (n + 1.0) / 2.0 + n * (n - 1.0) / 2.0 + n + 1.0;
    // A target's own: S, columns, contrast, orthogonalisation, m and kᵢ.
    let of_target = signal_and_columns + orthogonal(2.0) + 8.0;
    let matrix = |kernel: &'static str, calls: usize| {
        let others = materials(kernel) as f64 - 1.0;
        Work {
            kernel,
            unit: "pair of a matrix",
            units: (others + 1.0) * others,
            calls,
            // Δ and Δ², the same both ways, then m Δ² and two kᵢ Δ.
            operations: (4.0 + of_target / others) * bands,
            divisions: bands / others,
            // e′, and a fifth of e, m and the kᵢ.
            cache_bytes: (8.0 + 32.0 / 5.0 + 100.0 / others) * bands,
            memory_bytes: 0.0,
        }
    };
    // A dozen states each with B(T′) by one exponential, S − S′, columns, inner products, √; 130 temperatures of the
    // grid in 134 bands with 8 operations.
    let (states, grid) = (12.0, 130.0 * 134.0);
    let samples = CUBE.iter().product::<usize>() as f64;
    vec![
        Work {
            kernel: "planck spectrum",
            unit: "B and ∂B/∂T, 536 bands",
            units: 1.0,
            calls: 200,
            operations: planck * bands,
            divisions: bands,
            cache_bytes: 24.0 * bands,
            memory_bytes: 0.0,
        },
        Work {
            kernel: "local pair",
            unit: "pair",
            units: 1.0,
            calls: 200,
            operations: (two_temperatures + signal_and_columns + orthogonal(3.0)) * bands,
            divisions: 2.0 * bands,
            // ν, e, e′; four arrays written, read three times, three of them written twice more.
            cache_bytes: (24.0 + 32.0 + 96.0 + 24.0) * bands,
            memory_bytes: 0.0,
        },
        matrix("local matrix", 10),
        matrix("local matrix of 300", 1),
        matrix("local matrix of 1000", 1),
        Work {
            kernel: "nearest",
            unit: "nearest state",
            units: 1.0,
            calls: 20,
            operations: states * 60.0 * bands + 8.0 * grid,
            divisions: states * 2.0 * bands,
            cache_bytes: states * 120.0 * bands + 16.0 * grid,
            memory_bytes: 0.0,
        },
        Work {
            kernel: "window information",
            unit: "sample of a cube",
            units: samples,
            calls: 5,
            // ∂N 2, (∂N)²/N 2, Σ over bands 2, running sums over windows of both 8, their quotient 2.
            operations: 16.0,
            divisions: 2.0,
            cache_bytes: 68.0,
            memory_bytes: 4.0,
        },
    ]
}

fn main() {
    // One core, whatever the machine has.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool before");
    let machine = Machine::measured();
    println!(
        "one core: {:.1} G vector operations/s, {:.2} G divisions/s, {:.0} GB/s from the cache, {:.1} GB/s from memory",
        machine.operations / 1e9,
        machine.divisions / 1e9,
        machine.cache_bytes / 1e9,
        machine.memory_bytes / 1e9
    );
    println!("\n| kernel | of one | operations | divisions | bytes | bound | limited by | time | ratio |");
    println!("|---|---|---|---|---|---|---|---|---|");
    let scene = Scene::new();
    for work in works() {
        let mut kernel = scene.kernel(work.kernel).expect("a kernel of that name");
        let time = shortest(work.calls, &mut kernel) / work.units;
        let limits = [
            ("operations", work.operations / machine.operations),
            ("divisions", work.divisions / machine.divisions),
            ("cache", work.cache_bytes / machine.cache_bytes),
            ("memory", work.memory_bytes / machine.memory_bytes),
        ];
        let (limit, bound) = limits.into_iter().fold(("", 0.0), |a, b| if b.1 > a.1 { b } else { a });
        println!(
            "| {} | {} | {:.0} | {:.1} | {:.0} | {:.4} µs | {limit} | {:.4} µs | {:.1} |",
            work.kernel,
            work.unit,
            work.operations,
            work.divisions,
            work.cache_bytes,
            bound * 1e6,
            time * 1e6,
            time / bound
        );
    }
}

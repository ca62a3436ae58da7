//! Loops compiled once per instruction set and chosen at run time.
//!
//! [`dispatched!`] wraps a plain function so that its body is compiled with the widest vector unit the
//! processor has. Bodies use explicit `mul_add` and fixed lanes, so every processor gives the same bits;
//! one without fused multiply-add is slower, not different. No `unsafe` of our own is involved.
//!
//! Not so the elementary functions of the system (`f64::exp`, `sin`, `atan2`…): its library chooses their instructions too,
//! and with them the last bit. What is drawn and ranged takes those of `libm`, which are the same everywhere; elsewhere a
//! distance rests on sums, products and roots, and such functions enter solutions and probabilities below what is printed.

/// Declares a function whose body is compiled per instruction set. Borrowed arguments take `'a`.
#[doc(hidden)]
#[macro_export]
macro_rules! dispatched {
    ($(#[$meta:meta])* $vis:vis fn $name:ident<'a>($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name<'a>($($arg: $ty),*) $(-> $ret)? {
            // A named type instead of a closure: a closure's shim need not be inlined, and then the body
            // would be compiled for the oldest processor.
            struct Kernel<'a> {
                $($arg: $ty,)*
                scope: std::marker::PhantomData<&'a ()>,
            }
            impl<'a> $crate::simd::pulp::NullaryFnOnce for Kernel<'a> {
                type Output = $crate::simd::dispatched_output!($($ret)?);
                #[inline(always)]
                fn call(self) -> Self::Output {
                    let Self { $($arg,)* scope: _ } = self;
                    $body
                }
            }
            $crate::simd::pulp::Arch::new().dispatch(Kernel { $($arg,)* scope: std::marker::PhantomData })
        }
    };
}

/// The return type, or `()` where none is written.
#[doc(hidden)]
#[macro_export]
macro_rules! dispatched_output {
    () => {
        ()
    };
    ($ret:ty) => {
        $ret
    };
}

#[doc(hidden)]
pub use pulp;
pub use {dispatched, dispatched_output};

/// Doubles per cache line, and per chunk of a loop with sums.
pub const LANES: usize = 8;

/// Values that are worked on side by side. They are passed by value: then the compiler keeps them in
/// registers of any width.
pub type Chunk = [f64; LANES];

/// a·b.
#[inline(always)]
pub fn product(a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i] * b[i])
}

/// a·b + c.
#[inline(always)]
pub fn added(a: Chunk, b: Chunk, c: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i].mul_add(b[i], c[i]))
}

/// factor·a + b.
#[inline(always)]
pub fn fused(factor: f64, a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| factor.mul_add(a[i], b[i]))
}

/// Fewer than [`LANES`] values, followed by zeros.
#[inline(always)]
pub fn padded(rest: &[f64]) -> Chunk {
    let mut chunk = [0.0; LANES];
    for (to, from) in chunk.iter_mut().zip(rest) {
        *to = *from;
    }
    chunk
}

/// The largest magnitude so far, in every lane.
#[derive(Default)]
pub struct Largest(Chunk);

impl Largest {
    #[inline(always)]
    /// Takes a chunk into account.
    pub fn see(&mut self, x: Chunk) {
        let so_far = self.0;
        self.0 = std::array::from_fn(|i| if x[i].abs() > so_far[i] { x[i].abs() } else { so_far[i] });
    }

    /// Never inlined, for the reason given at `CompensatedLanes::value`.
    #[inline(never)]
    pub fn value(&self) -> f64 {
        self.0.iter().fold(0.0, |largest, x| x.max(largest))
    }
}

dispatched! {
    /// Largest |x|.
    pub fn largest<'a>(x: &'a [f64]) -> f64 {
        let (eights, rest) = x.as_chunks::<LANES>();
        let mut largest = Largest::default();
        for x in eights {
            largest.see(*x);
        }
        largest.see(padded(rest));
        largest.value()
    }
}

/// Adds the lanes pairwise.
#[inline(always)]
pub fn fold(lanes: &Chunk) -> f64 {
    ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]))
}

/// Adds every second half of `a` and `b` to the first ones: `HALF` lanes of each in turn.
#[inline(always)]
fn halved<const HALF: usize>(a: Chunk, b: Chunk) -> Chunk {
    let lane =
        |i: usize| (if (i / HALF).is_multiple_of(2) { a } else { b }, i / (2 * HALF) * (2 * HALF) + i % HALF);
    std::array::from_fn(|i| {
        let (from, at) = lane(i);
        from[at] + from[at + HALF]
    })
}

/// factor · the sum of the lanes of each, added in the order of [`fold`]; eight at a time, so that all
/// lanes of all additions are used.
#[inline(always)]
pub fn fold_all(lanes: &[Chunk], factor: f64, sums: &mut [f64]) {
    let (eights, rest) = lanes.as_chunks::<LANES>();
    let (to, to_rest) = sums.split_at_mut(eights.len() * LANES);
    for (lanes, to) in eights.iter().zip(to.as_chunks_mut::<LANES>().0) {
        let [a, b, c, d, e, f, g, h] = *lanes;
        // In pairs of lanes 4 apart, then 2, then 1; the order of the arguments puts the sums in theirs.
        let fours = [halved::<4>(a, e), halved::<4>(b, f), halved::<4>(c, g), halved::<4>(d, h)];
        let twos = [halved::<2>(fours[0], fours[2]), halved::<2>(fours[1], fours[3])];
        *to = halved::<1>(twos[0], twos[1]).map(|sum| factor * sum);
    }
    for (lanes, to) in rest.iter().zip(to_rest) {
        *to = factor * fold(lanes);
    }
}
